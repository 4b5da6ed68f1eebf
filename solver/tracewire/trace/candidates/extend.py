"""Candidates put into a diagram: an edit of its text."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from tracewire.diagram import Diagram, add_addend, add_own, add_sensor, add_to_drive
from tracewire.formula import number_text
from tracewire.trace.candidates.candidate import Candidate, is_default
from tracewire.trace.candidates.inside import local_name


def extend(diagram: Diagram, chosen: Sequence[tuple[Candidate, Mapping[str, float]]]) -> Diagram:
    """The diagram with effects added, each with the values of its coefficient and shapes.

    values: by parameter (`level`, `width`; `offset` of a sensor), in SI. Each is written with round
    bounds for a fit, the coefficient with bounds well above its value. A shape that is off is not
    written; one that is not given has the first value that is tried. Raises DiagramError or
    OptionError: the text cannot be edited by program.
    """
    for candidate, values in chosen:
        kind = candidate.parameter
        value = values[kind]
        low, high = _bounds(candidate, value)
        if not candidate.block:
            signal = candidate.place.definition
            diagram = add_sensor(diagram, signal, kind, value, (low, high))
            continue
        parts = [f"type: {candidate.effect}"]
        within = candidate.place.within
        parts += [
            f"{port}: {_signal(local_name(diagram, within, name))}"
            for port, name in candidate.signals.items()
        ]
        factor = _factors(diagram, candidate)
        parts.append(f"{kind}: {_setting(value, low, high, factor.get(kind, 1.0))}")
        for name, grid in candidate.shapes.items():
            value = values.get(name, grid[0])
            own = [v for key, v in values.items() if key.startswith(f"{name}@")]
            if own:  # the value where a series says nothing
                parts.append(f"{name}: {{value: {number_text(own[0])}}}")
            elif name in candidate.fixed:
                shown = number_text(float(f"{value / factor.get(name, 1.0):.6g}"))
                parts.append(f"{name}: {shown}")
            elif not is_default(candidate, name, value):
                ends = candidate.limits[name]
                parts.append(f"{name}: {_setting(value, *ends, factor.get(name, 1.0))}")
        first: Mapping[str, float] = next(iter(candidate.own.values()), {})
        parts += [f"{name}: {{value: {number_text(value)}}}" for name, value in first.items()]
        line = f"{{{', '.join(parts)}}}"
        name = candidate.block.removeprefix(f"{within}.") if within else candidate.block
        if candidate.place.kind == "drive":
            diagram = add_to_drive(diagram, candidate.place.definition, name, line)
        else:
            element = candidate.place.element
            diagram = add_addend(diagram, candidate.place.definition, name, line, element=element)
        known = {n: own for n, own in _own(candidate, values).items() if n in diagram.measured}
        if known:
            fit = {f"{candidate.block}.{name}": candidate.limits[name] for name in candidate.each}
            diagram = add_own(diagram, known, fit)
    return diagram


def _signal(name: str) -> str:
    """The name of a signal as a value inside braces: that of an element is quoted, as YAML asks."""
    return f'"{name}"' if "[" in name else name


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


def _setting(value: float, low: float, high: float, factor: float) -> str:
    """A number with its bounds as text; the bounds are rounded outwards."""
    shown = float(f"{value / factor:.6g}")
    bottom, top = float(f"{low / factor:.3g}"), float(f"{high / factor:.3g}")
    bottom, top = min(bottom, shown), max(top, shown)
    return f"{{value: {number_text(shown)}, fit: [{number_text(bottom)}, {number_text(top)}]}}"
