"""Candidates as changes of a diagram."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from tracewire.diagram import AddBlock, AddOwn, AddSensorTerm, Change, Diagram, FreeStarts, Value
from tracewire.formula import Number
from tracewire.trace.candidates.candidate import Candidate, is_default
from tracewire.trace.candidates.inside import local_name


def changes_of(
    diagram: Diagram, chosen: Sequence[tuple[Candidate, Mapping[str, float]]]
) -> list[Change]:
    """What adds effects to a diagram, each with the values of its coefficient and shapes.

    values: by parameter (`level`, `width`; `offset` of a sensor), in SI. Each is written with round
    bounds for a fit, the coefficient with bounds well above its value. A shape that is off is not
    written; one that is not given has the first value that is tried. Effects at a drive come last,
    so that all the others read the drive as they leave it, whatever was found first.
    """
    order = sorted(chosen, key=lambda one: one[0].place.kind == "drive")
    return [change for one, values in order for change in _changes(diagram, one, values)]


def _changes(
    diagram: Diagram, candidate: Candidate, values: Mapping[str, float]
) -> Iterator[Change]:
    kind, place = candidate.parameter, candidate.place
    value = values[kind]
    ends = _bounds(candidate, value)
    if not candidate.block:
        yield AddSensorTerm(place.definition, kind, value, ends)
        return
    factor = _factors(diagram, candidate)
    settings = {kind: _fitted(value, ends, factor.get(kind, 1.0))}
    for name, grid in candidate.shapes.items():
        value = values.get(name, grid[0])
        own = [v for key, v in values.items() if key.startswith(f"{name}@")]
        if own:  # the value where a series says nothing
            settings[name] = Value(Number(own[0]), named=True)
        elif name in candidate.fixed:
            number = Number(float(f"{value / factor.get(name, 1.0):.6g}"))
            settings[name] = Value(number, named=name in candidate.scanned)
        elif not is_default(candidate, name, value):
            settings[name] = _fitted(value, candidate.limits[name], factor.get(name, 1.0))
    first: Mapping[str, float] = next(iter(candidate.own.values()), {})
    settings |= {name: Value(Number(value), named=True) for name, value in first.items()}
    yield AddBlock(
        candidate.block.removeprefix(f"{place.within}.") if place.within else candidate.block,
        candidate.effect,
        {port: local_name(diagram, place.within, n) for port, n in candidate.signals.items()},
        settings,
        place.definition,
        place.kind == "drive",
        place.element,
        place.own,
    )
    known = {n: own for n, own in _own(candidate, values).items() if n in diagram.measured}
    if known:
        fit = {f"{candidate.block}.{name}": candidate.limits[name] for name in candidate.each}
        yield AddOwn(known, fit)
    if candidate.lasting:
        yield FreeStarts(candidate.lasting)


def _own(candidate: Candidate, values: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """What each series has of its own, by series and path."""
    found = {
        series: {f"{candidate.block}.{name}": value for name, value in own.items()}
        for series, own in candidate.own.items()
    }
    for key, value in values.items():
        name, of_series, series = key.partition("@")
        if of_series:
            found.setdefault(series, {})[f"{candidate.block}.{name}"] = value
    return found


def _bounds(candidate: Candidate, value: float) -> tuple[float, float]:
    """Round bounds well around the value of a coefficient, within those of its parameter."""
    low, high = candidate.limits.get(candidate.parameter, (-math.inf, math.inf))
    size = abs(value) or candidate.scale
    wide = 10.0 ** math.ceil(math.log10(size) + 1.0)
    return max(low, -wide), min(high, wide)


def _factors(diagram: Diagram, candidate: Candidate) -> dict[str, float]:
    """The factors to SI of numbers that a subsystem takes in the units of its parameters."""
    inside = diagram.subsystems.get(candidate.effect)
    return {} if inside is None else {n: value.factor for n, value in inside.parameters.items()}


def _fitted(value: float, ends: tuple[float, float], factor: float) -> Value:
    """A number with bounds in a unit with this factor to SI; these are rounded outwards."""
    shown = float(f"{value / factor:.6g}")
    bottom, top = (float(f"{end / factor:.3g}") for end in ends)
    return Value(Number(shown), fit=(min(bottom, shown), max(top, shown)), named=True)
