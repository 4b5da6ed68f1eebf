"""How exact a run is, and how long its steps may be."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.errors import Location, OptionError, Problem, unknown
from tracewire.formula import evaluate
from tracewire.solve.core.codes import ABSOLUTE
from tracewire.solve.core.methods import STEPPED
from tracewire.solve.limits import STEP, Limits


@dataclass(frozen=True)
class Tolerance:
    """How exact a run is: relative, absolute per state (n,), the step of a fixed method, and the
    longest step in s that any may take. An absolute one of 0 follows the size of the state, and
    begins as `first` (n,) has it, till the core knows of what size the states are.
    """

    rtol: float
    atol: Vector
    first: Vector
    step: float = np.inf
    longest: float = np.inf


def tolerance_of(
    model: Model,
    rtol: float,
    atol: float | Mapping[str, float] | None,
    method: str,
    step: float | None,
    length: float,
    longest: float = math.inf,
) -> Tolerance:
    """The tolerances as the core takes them. Raises OptionError."""
    given = atol if isinstance(atol, Mapping) else {}
    problems = [unknown("state", name, model.states) for name in given if name not in model.states]
    if problems:
        raise OptionError(problems)
    usual = None if atol is None or isinstance(atol, Mapping) else atol
    wanted = [*given.values(), *([] if usual is None else [usual])]
    if not (1e-14 <= rtol < 1 and all(0 < value < math.inf for value in wanted)):
        shown = ", ".join(f"{name}: {value:g}" for name, value in given.items())
        told = f"{{{shown}}}" if given else f"{rtol * 1e-3 if usual is None else usual:g}"
        what = f"rtol = {rtol:g} and atol = {told} cannot be met"
        raise OptionError([Problem(what, hint="Take rtol between 1e-13 and 0.1 and atol above 0.")])
    if (method in STEPPED) != (step is not None):
        known = " or ".join(STEPPED)
        needs = f"the method {method} needs a step"
        what = needs if step is None else f"only the method {known} takes a step"
        raise OptionError([Problem(what, hint=f"Give method='{known}' and step= in s together.")])
    if step is not None and not 0 < step <= length:
        what = f"steps of {step:g} s do not fit into a span of {length:g} s"
        raise OptionError([Problem(what, hint="Give a step above 0 and below the span.")])
    absolute = [given.get(name, usual or 0.0) for name in model.states]
    fixed = math.inf if step is None else step
    first = [value or ABSOLUTE * rtol for value in absolute]
    return Tolerance(rtol, np.array(absolute, dtype=float), np.array(first), fixed, longest)


def longest_step(model: Model, values: Mapping[str, float], limits: Limits) -> float:
    """The longest step in s: that of the diagram or of the limits, and no longer than a delay, so
    that what is read is known. Raises OptionError.
    """
    given, longest = model.flat.max_step, limits.max_step
    if given is not None:
        longest = min(longest, float(evaluate(given, values)))
    for delay in model.lowered.delays:
        time = float(evaluate(delay.shortest, values))
        if not 0 < time < math.inf:
            what = f"'{delay.text}' is delayed by {time:g} s"
            raise OptionError([Problem(what, hint="Give a delay above 0.")])
        longest = min(longest, STEP.known_past * time)
    if not longest > 0:
        what = f"steps of {longest:g} s at most lead nowhere"
        place = _place_of_step(model, values, longest)
        raise OptionError([Problem(what, place, hint="Give a max_step above 0.")])
    return longest


def refuse_short_steps(
    model: Model, values: Mapping[str, float], length: float, longest: float, most: float
) -> None:
    """Raises OptionError: a run that would take more steps than it may, however it goes."""
    count = length / longest
    if count > most:
        what = f"{length:g} s in steps of at most {longest:g} s are {count:.2g} steps"
        place = _place_of_step(model, values, longest)
        hint = f"A run takes at most {most:.2g}: take longer steps (step, max_step)."
        raise OptionError.one(what, place, hint=hint)


def _place_of_step(model: Model, values: Mapping[str, float], longest: float) -> Location:
    """Where the diagram sets the longest step to this one in s; nowhere if something else does."""
    given, written = model.flat.max_step, model.diagram.max_step
    if given is None or written is None or float(evaluate(given, values)) != longest:
        return Location()
    return written.place
