"""What a motion that never comes back cannot show."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from tracewire.compile import Model
from tracewire.errors import TracewireError
from tracewire.formula import evaluate, names_of
from tracewire.library import Block
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.places import Place
from tracewire.trace.candidates.signal_scales import Trajectory
from tracewire.trace.data_thresholds import CheckOptions

PITCH = "pitch"


def has_revisits(places: Sequence[Place], trajectories: Sequence[Trajectory], again: float) -> bool:
    """Whether in some series some body is twice at the same coordinate: the way it goes is `again`
    times the range."""
    coordinates = {place.q for place in places if place.kind == "sum" and place.q}
    known = [(run, q) for run in trajectories for q in coordinates if q in run.signals]
    for run, q in known:
        way = float(np.sum(np.abs(np.diff(run.signals[q]))))
        if way > again * float(np.ptp(run.signals[q])):
            return True
    return not known


def observable_candidates(
    model: Model,
    candidates: Sequence[Candidate],
    trajectories: Sequence[Trajectory],
    options: CheckOptions,
) -> list[Candidate]:
    """The candidates that a motion without return can show.

    Where a body is nowhere twice, as in one fall, time tells nothing that its coordinate does not:
    effects that read the time are left out, and so are memories of the motion, which show in what
    is different when the body comes back, and what is more in one direction than in the other. A
    wave over the coordinate must fit into its range, and a period of what swings on the body into
    the record, twice. A shaft that turns on and on has no spring and no stop.
    """
    angles = [name for name, unit in model.flat.units.items() if unit == "rad"]
    turns = {
        name: max(float(np.ptp(run.signals[name])) for run in known) / (2 * np.pi)
        for name in angles
        if (known := [run for run in trajectories if name in run.signals])
    }
    found = []
    for candidate in candidates:
        block = model.diagram.library.blocks.get(candidate.effect)
        timed = block is not None and any("t" in names_of(f) for f in block.formulas.values())
        if block is not None and block.effect and _even(block):
            continue
        if timed or (block is not None and (block.modes or _remembers_motion(block))):
            continue
        of = candidate.place.q
        if (
            block is not None
            and _reads_travel(block, candidate)
            and turns.get(of, 0) > options.turns
        ):
            continue
        most: dict[str, float] = {}
        if PITCH in candidate.shapes and of:
            ranges = [float(np.ptp(run.signals[of])) for run in trajectories if of in run.signals]
            most[PITCH] = max(ranges, default=0.0)
        if candidate.lasting:
            longest = max(float(np.ptp(run.t)) for run in trajectories)
            most |= dict.fromkeys(candidate.lines, longest / options.swings)
        bounded = _bounded(candidate, most)
        if bounded is not None:
            found.append(bounded)
    return found


def _bounded(candidate: Candidate, most: Mapping[str, float]) -> Candidate | None:
    """A candidate with some shapes of it at most so large; None where nothing is left."""
    shapes, limits = dict(candidate.shapes), dict(candidate.limits)
    for name, largest in most.items():
        low, high = limits[name]
        shapes[name] = tuple(value for value in shapes[name] if value <= largest)
        limits[name] = low, min(high, largest)
        if not shapes[name] or low >= largest:
            return None
    return replace(candidate, shapes=shapes, limits=limits)


def _remembers_motion(block: Block) -> bool:
    """Whether an effect has a memory of where a body was and how fast: what follows a drive late,
    or swings on the body, has none."""
    reads = set() if block.effect is None else {*block.effect.inputs.values()}
    return bool(block.states) and not reads.isdisjoint({"q", "v"})


def _reads_travel(block: Block, candidate: Candidate) -> bool:
    """Whether an effect depends on how far a body has come, and is no wave along its way."""
    reads = block.effect is not None and "q" in block.effect.inputs.values()
    return reads and not candidate.waves


def _even(block: Block) -> bool:
    """Whether an effect of the rate alone is the same in both directions."""
    if [*block.effect.inputs.values()] != ["v"] or block.states or block.modes:  # type: ignore[union-attr]
        return False
    (rate,) = (port.name for port in block.inputs)
    (formula,) = block.formulas.values()
    values = {parameter.name: 1.0 for parameter in block.parameters}
    try:
        ahead, back = (evaluate(formula, {**values, rate: v, "t": 1.0}) for v in (0.5, -0.5))
    except TracewireError:
        return False
    return ahead == back
