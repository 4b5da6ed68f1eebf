"""What effects without memory put out along samples, by their formulas alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix
from tracewire.diagram import Diagram
from tracewire.errors import FormulaError
from tracewire.formula import evaluate_along
from tracewire.library import Block
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.signal_scales import Trajectory

Samples = NDArray[np.intp]


def is_static(diagram: Diagram, effect: str) -> bool:
    """Whether an effect is a block whose outputs are formulas of its inputs and the time alone."""
    if effect in diagram.subsystems:
        return False
    block = diagram.library[effect]
    return not (block.modes or block.states or block.events) and len(block.outputs) == 1


def static_outputs(
    diagram: Diagram,
    candidate: Candidate,
    choices: Sequence[Mapping[str, float]],
    run: Trajectory,
    samples: Samples,
) -> Matrix:
    """The outputs (samples, choices) at samples of a run of an effect that `is_static`, with each
    choice of its shapes, over the coefficient `candidate.at`.

    A sign of exactly 0 is 0. Raises FormulaError where a value is not finite, a condition of the
    block is not kept, or a function, as of a dead time, has no meaning for samples alone.
    """
    block = diagram.library[candidate.effect]
    shape = len(samples), len(choices)
    known = _parameters(block, candidate, choices, run.series)
    known |= {port: run.signals[name][samples, None] for port, name in candidate.signals.items()}
    known["t"] = run.t[samples, None]
    for port, formula in block.port_defaults.items():
        if port not in known:
            known[port] = evaluate_along(formula, known, shape)
    (formula,) = block.formulas.values()
    return np.asarray(evaluate_along(formula, known, shape) / candidate.at)


def _parameters(
    block: Block, candidate: Candidate, choices: Sequence[Mapping[str, float]], series: str
) -> dict[str, Any]:
    """The parameters of a block, each a number or one for each choice, (choices,)."""
    known: dict[str, Any] = {
        p.name: float(p.default) for p in block.parameters if isinstance(p.default, float | int)
    }
    known[candidate.parameter] = candidate.at
    known |= {name: np.array([choice[name] for choice in choices]) for name in choices[0]}
    known |= candidate.own.get(series, next(iter(candidate.own.values()), {}))
    for name, formula in block.defaults.items():
        if name not in known:
            known[name] = evaluate_along(formula, known, len(choices))
    for condition in block.conditions:
        if not evaluate_along(condition, known, len(choices)).all():
            raise FormulaError.one(f"a condition of '{block.name}' is not kept")
    return known
