"""Candidates: an effect at a place, and the diagram that has it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tracewire.compile import Model
from tracewire.diagram import Diagram, add_addend, add_offset
from tracewire.fit.segment import Unknown
from tracewire.formula import evaluate
from tracewire.library import Block
from tracewire.trace.places import Place

SENSOR_OFFSET = "sensor_offset"


@dataclass(frozen=True)
class Candidate:
    """An effect that may be missing: a block at a sum, or the offset of a measured channel.

    `unknown` is the name of its coefficient in the extended model, `sign` 1 where only positive
    coefficients make sense.
    """

    effect: str
    place: str
    unknown: str
    sign: int
    block: Block | None = None
    at: Place | None = None

    def __str__(self) -> str:
        return f"{self.effect} @ {self.place}"

    def parameter(self) -> str:
        """The name of the coefficient in the block."""
        return self.unknown.rpartition(".")[2] if self.block is not None else "offset"

    def as_unknown(self, value: float, scale: float) -> Unknown:
        """The coefficient as an unknown of a fit."""
        return Unknown(self.unknown, value, 0.0 if self.sign else -math.inf, math.inf, scale)


def find_candidates(
    model: Model, places: Sequence[Place], taken: Sequence[Candidate] = ()
) -> list[Candidate]:
    """Every effect of the library at every place whose signals it needs, and sensor offsets.

    `taken` are effects that the model has already got from the trace.
    """
    found: list[Candidate] = []
    have = {(c.effect, c.place) for c in taken}
    names = set(model.diagram.blocks) | set(model.diagram.parameters)
    for place in places:
        for block in model.diagram.library.effects():
            effect = block.effect
            if effect is None or (block.name, place.name) in have:
                continue
            if "q" in effect.inputs.values() and not place.q:
                continue
            name = block.name
            number = 2
            while name in names:
                name, number = f"{block.name}_{number}", number + 1
            names.add(name)
            unknown = f"{name}.{effect.coefficient}"
            found.append(Candidate(block.name, place.name, unknown, effect.sign, block, place))
    for series in model.diagram.measured.values():
        for signal, channel in series.channels.items():
            place_name = f"sensor.{signal}"
            free = channel.offset is not None and channel.offset.fit is not None
            if channel.column and not free and (SENSOR_OFFSET, place_name) not in have:
                have.add((SENSOR_OFFSET, place_name))
                found.append(Candidate(SENSOR_OFFSET, place_name, f"offset.{signal}", 0))
    return found


def extend(diagram: Diagram, chosen: Sequence[tuple[Candidate, float]]) -> Diagram:
    """The diagram with effects added, each with its coefficient: an edit of the text."""
    for candidate, value in chosen:
        if candidate.block is None or candidate.block.effect is None or candidate.at is None:
            signal = candidate.unknown.removeprefix("offset.")
            high = _above(value)
            diagram = add_offset(diagram, signal, value, (-high, high))
            continue
        name, _, coefficient = candidate.unknown.partition(".")
        signals = {"q": candidate.at.q, "v": candidate.at.v}
        ports = [f"{p}: {signals[s]}" for p, s in candidate.block.effect.inputs.items()]
        high = _above(value)
        low = 0.0 if candidate.sign else -high
        setting = f"{coefficient}: {{value: {value:.6g}, fit: [{low:g}, {high:g}]}}"
        line = f"{{type: {candidate.effect}, {', '.join([*ports, setting])}}}"
        diagram = add_addend(diagram, candidate.at.definition, name, line)
    return diagram


def _above(value: float) -> float:
    """A round bound well above a value."""
    if value == 0.0:
        return 1.0
    return float(10.0 ** math.ceil(math.log10(abs(value)) + 1.0))


def coefficient_scale(candidate: Candidate, levels: Mapping[str, float]) -> float:
    """The coefficient at which an effect is as large as the sum at its place.

    `levels` holds the root mean square of signals on the trajectory.
    """
    block, at = candidate.block, candidate.at
    if block is None or at is None or block.effect is None:
        return max(levels[candidate.unknown.removeprefix("offset.")], 1e-12)
    inputs = {
        port: levels[at.q if symbol == "q" else at.v]
        for port, symbol in block.effect.inputs.items()
    }
    defaults = {
        p.name: float(p.default) for p in block.parameters if isinstance(p.default, int | float)
    }
    given = defaults | inputs | {block.effect.coefficient: 1.0, "t": 0.0}
    size = abs(evaluate(next(iter(block.formulas.values())), given))
    return max(levels[at.name] / max(size, 1e-300), 1e-300)
