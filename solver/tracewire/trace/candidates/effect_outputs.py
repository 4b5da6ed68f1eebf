"""What candidate effects would have put out along recorded signals."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.compile import Model, compile
from tracewire.diagram import BlockUse, Diagram, InputPort, Value, Wire
from tracewire.errors import FormulaError, TracewireError
from tracewire.errors import Location as Spot
from tracewire.formula import Number
from tracewire.solve import Interrupted, simulate
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.signal_scales import Trajectory
from tracewire.trace.candidates.static_outputs import is_static, static_outputs
from tracewire.trace.thresholds import CandidateOptions

Samples = NDArray[np.intp]


@dataclass(frozen=True)
class Variant:
    """A candidate with one choice of its shapes: (parameter, value in SI)."""

    candidate: Candidate
    shapes: tuple[tuple[str, float], ...] = ()

    def __str__(self) -> str:
        shapes = ", ".join(f"{name} {value:.3g}" for name, value in self.shapes)
        return f"{self.candidate}" + (f" ({shapes})" if shapes else "")


def variants_of(candidate: Candidate, most: int) -> list[Variant]:
    """The choices of shapes that are tried first: all, or `most` by thinning the longest grids."""
    counts = {name: len(grid) for name, grid in candidate.shapes.items()}
    while math.prod(counts.values()) > most:
        longest = max(counts, key=counts.__getitem__)
        others = math.prod(counts.values()) // counts[longest]
        counts[longest] = max(most // others, counts[longest] // 2, 1)
    grids = (
        [grid[number] for number in np.linspace(0, len(grid) - 1, counts[name]).round().astype(int)]
        for name, grid in candidate.shapes.items()
    )
    choices = itertools.product(*grids)
    return [Variant(candidate, tuple(zip(counts, chosen, strict=True))) for chosen in choices]


def effect_outputs(
    model: Model,
    candidates: Sequence[Candidate],
    trajectories: Sequence[Trajectory],
    samples: Sequence[Samples],
    options: CandidateOptions,
    tell: Callable[[str], None],
) -> dict[Variant, list[Vector]]:
    """The output of each variant of each candidate at the samples of each trajectory, (samples,).

    The output is that of the coefficient 1; where it is not linear in the coefficient, that of
    `candidate.at`, divided by it. Effects without memory are evaluated at the samples; other blocks
    run on the recorded signals, joined by straight lines. Candidates at sensors are passed over,
    and so are variants that put out nothing, or cannot be computed; `tell` gets the reason where
    that is so of all variants of a candidate. Raises Interrupted: Ctrl-C.
    """
    variants: list[Variant] = []
    found: dict[Variant, list[Vector]] = {}
    # memories need shorter steps, and may fail: the others shall not pay for that
    groups: dict[str, list[Variant]] = {}
    for candidate in (c for c in candidates if c.place.kind != "sensor"):
        own = variants_of(candidate, options.variants)
        variants += own
        try:
            known = _evaluate_outputs(model.diagram, candidate, own, trajectories, samples)
        except FormulaError:  # a run says why, or can do it
            known = {}
        found |= known
        if not known:
            groups.setdefault(_memory(model.diagram, candidate.effect), []).extend(own)
    failed: dict[str, str] = {}
    queue = list(groups.values())
    while queue:
        group = queue.pop()
        try:
            found |= _simulate_outputs(model.diagram, group, trajectories, samples, options)
        except Interrupted:
            raise
        except TracewireError as error:
            if len(group) > 1:  # one of them cannot be computed, or is slow: find out which
                middle = len(group) // 2
                queue += [group[:middle], group[middle:]]
            else:
                failed.setdefault(str(group[0].candidate), error.problems[0].what)
    for name in sorted(failed.keys() - {str(variant.candidate) for variant in found}):
        tell(f"{name} was not tried: {failed[name]}")
    return {v: found[v] for v in variants if any(x.any() for x in found.get(v, ()))}


def _memory(diagram: Diagram, effect: str) -> str:
    """What an effect remembers: nothing, states, modes, or what its subsystem holds."""
    if effect in diagram.subsystems:
        return effect
    block = diagram.library[effect]
    return "modes" if block.modes else "states" if block.states else ""


def _evaluate_outputs(
    diagram: Diagram,
    candidate: Candidate,
    variants: Sequence[Variant],
    trajectories: Sequence[Trajectory],
    samples: Sequence[Samples],
) -> dict[Variant, list[Vector]]:
    """The outputs of the variants of a candidate without memory; of one with memory nothing."""
    if not is_static(diagram, candidate.effect):
        return {}
    choices = [dict(variant.shapes) for variant in variants]
    outputs = [
        static_outputs(diagram, candidate, choices, run, rows)
        for run, rows in zip(trajectories, samples, strict=True)
    ]
    return {v: [run[:, n] for run in outputs] for n, v in enumerate(variants)}


def _simulate_outputs(
    diagram: Diagram,
    variants: Sequence[Variant],
    trajectories: Sequence[Trajectory],
    samples: Sequence[Samples],
    options: CandidateOptions,
) -> dict[Variant, list[Vector]]:
    """The outputs of several variants, in one small diagram whose inputs are the signals.

    Raises SimulationError: one variant cannot be computed, or one of several needs so many steps
    that the others, which take them too, had better run without it.
    """
    signals = dict.fromkeys(s for v in variants for s in v.candidate.signals.values())
    inputs = {signal: f"input_{number}" for number, signal in enumerate(signals)}
    blocks = [f"output_{number}" for number in range(len(variants))]
    small = Diagram(
        name="histories",
        file=Path("histories"),
        text="",
        library=diagram.library,
        inputs={name: InputPort(name, default=_number(0.0)) for name in inputs.values()},
        blocks={
            name: _use(name, variant, inputs, diagram)
            for name, variant in zip(blocks, variants, strict=True)
        },
        subsystems=diagram.subsystems,
    )
    outputs = [_output(small, name) for name in blocks]
    small = Diagram(**{**vars(small), "record": dict.fromkeys(outputs, Spot())})
    model = compile(small, backend="quick")
    found: dict[Variant, list[Vector]] = {variant: [] for variant in variants}
    for run, rows in zip(trajectories, samples, strict=True):
        given = {name: (run.t, run.signals[signal]) for signal, name in inputs.items()}
        own = {
            f"{name}.{parameter}": value
            for variant, name in zip(variants, blocks, strict=True)
            for parameter, value in variant.candidate.own.get(run.series, {}).items()
        }
        sizes = [float(np.max(np.abs(x))) for _, x in given.values()]
        least = min([1.0, *(size for size in sizes if size > 0)])
        kept = np.union1d([0], rows)  # memories begin where the record does
        rtol = options.memory_tolerance
        limits = {"steps": options.memory_steps * len(run.t)} if len(variants) > 1 else None
        result = simulate(
            model, parameters=own, times=run.t[kept], inputs=given, rtol=rtol,
            atol=1e-3 * rtol * least, limits=limits,
        )  # fmt: skip
        for variant, name in zip(variants, outputs, strict=True):
            output = result.signals[name][np.searchsorted(kept, rows)]
            found[variant].append(output / variant.candidate.at)
    return found


def _use(name: str, variant: Variant, inputs: Mapping[str, str], diagram: Diagram) -> BlockUse:
    candidate = variant.candidate
    values = {candidate.parameter: candidate.at, **dict(variant.shapes)}
    first: Mapping[str, float] = next(iter(candidate.own.values()), {})
    own = {parameter: Value(Number(value), named=True) for parameter, value in first.items()}
    return BlockUse(
        name,
        candidate.effect,
        {port: (Wire(inputs[signal]),) for port, signal in candidate.signals.items()},
        {parameter: _number(value) for parameter, value in values.items()} | own,
        subsystem=diagram.subsystems.get(candidate.effect),
    )


def _output(diagram: Diagram, name: str) -> str:
    use = diagram.blocks[name]
    if use.subsystem is None:
        return name
    return f"{name}.{next(iter(use.subsystem.outputs))}"


def _number(value: float) -> Value:
    return Value(Number(value))
