"""Edits of what the sensors of measured signals do: changes of the text that keep its layout."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from tracewire.diagram.diagram import Diagram, Series, Value
from tracewire.diagram.names import find_recorded
from tracewire.diagram.override import localise
from tracewire.diagram.rewrite import as_written, bounds, digits, reread
from tracewire.diagram.source_map import SourceMap
from tracewire.diagram.strict import Entries, Node, Scalar
from tracewire.diagram.text_edits import TextEdit, entry_last, replace_node
from tracewire.errors import OptionError, unknown
from tracewire.formula import Number, number_text
from tracewire.library import SENSOR_TERMS


def add_sensor(
    diagram: Diagram,
    signal: str,
    kind: str,
    value: float,
    fit: tuple[float, float] | None = None,
) -> Diagram:
    """The diagram with an offset, gain, delay, quad or drift of a measured signal.

    Every series in which the signal is a column gets it. value, fit: the number and its bounds in
    SI; the text gets them in the unit of the column (a delay in s). Raises OptionError: there is no
    such measured signal, or no such kind.
    """
    full, having = series_of(diagram, signal, kind)
    source_map = SourceMap(diagram)
    nodes = [_channel(diagram, source_map.root, series, full) for series in having]
    diagram = localise(diagram, source_map, nodes)
    root = SourceMap(diagram).root
    changes = []
    for series in having:
        node = _channel(diagram, root, series, full)
        text = _value_text(
            value, fit, SENSOR_TERMS[kind].factor(series.unit_of(series.channels[full])[1])
        )
        changes.append(_with_number(diagram.text, node, kind, text))
    return reread(diagram, changes)


def series_of(diagram: Diagram, signal: str, kind: str) -> tuple[str, list[Series]]:
    """The full name of a measured signal, and the series that may get a number of its sensor.

    Raises OptionError: there is no such measured signal, or no such kind.
    """
    if kind not in SENSOR_TERMS:
        raise OptionError([unknown("number of a sensor", kind, SENSOR_TERMS)])
    full = find_recorded(diagram, signal)
    having = [
        series
        for series in diagram.measured.values()
        if full in series.channels and series.channels[str(full)].column
    ]
    if full is None or not having:
        measured = {name for series in diagram.measured.values() for name in series.channels}
        raise OptionError([unknown("measured signal", signal, measured)])
    return full, having


def set_sensors(diagram: Diagram, values: Mapping[str, float]) -> Diagram:
    """The diagram with other numbers of sensors, and of series, that are free in a fit.

    `values` has them by `offset.SIGNAL`, `gain.SIGNAL` ... in SI; every series in which one is free
    gets it, in the unit that its text has. `harmonic.phase@run_1` is the value of a parameter in
    one series, under its `parameters`.
    """
    source_map = SourceMap(diagram)
    nodes = [node for node, _ in _numbers(diagram, source_map.root, values)]
    diagram = localise(diagram, source_map, nodes)
    changes = []
    for node, number in _numbers(diagram, SourceMap(diagram).root, values):
        if not isinstance(node, Entries):
            changes.append(replace_node(node, number))
        elif "value" in node.values:
            changes.append(replace_node(node.values["value"], number))
        else:
            changes.append(entry_last(diagram.text, node, "value", number))
    return reread(diagram, changes)


def _numbers(
    diagram: Diagram, root: Entries, values: Mapping[str, float]
) -> Iterator[tuple[Node, str]]:
    """The text of each number of a sensor or of a series, and what it becomes."""
    for path, value in values.items():
        parameter, of_series, name = path.partition("@")
        if of_series:
            yield _own(diagram, root, parameter, name, value)
            continue
        kind, _, signal = path.partition(".")
        for series in diagram.measured.values():
            channel = series.channels.get(signal)
            known: Value | None = getattr(channel, kind, None)
            if channel is None or known is None or known.fit is None:
                continue
            node = _channel(diagram, root, series, signal)
            assert isinstance(node, Entries)
            factor = factor_of(known, kind, series, signal)
            low, high = (end / known.factor for end in known.fit)  # as the text has them
            yield node.values[kind], digits(value / factor, low, high)


def _own(
    diagram: Diagram, root: Entries, parameter: str, series: str, value: float
) -> tuple[Node, str]:
    """The text of a parameter's value in one series, and what it becomes."""
    known = own_value(diagram, parameter, series)
    node = root.inside("measured", series, "parameters")
    low, high = known.fit or (-math.inf, math.inf)
    number = digits(value / known.factor, low / known.factor, high / known.factor)
    return node.values[parameter], number


def own_value(diagram: Diagram, parameter: str, series: str) -> Value:
    """The value of a parameter in one series. Raises OptionError: there is none."""
    if series not in diagram.measured:
        raise OptionError([unknown("measured series", series, diagram.measured)])
    given = diagram.measured[series].parameters
    if parameter not in given:
        raise OptionError([unknown(f"parameter of the series '{series}'", parameter, given)])
    return given[parameter]


def sensor_numbers(
    diagram: Diagram,
) -> dict[str, tuple[float, tuple[float, float] | None]]:
    """The numbers of sensors in the series of a diagram, each with its bounds: by `offset.SIGNAL`.

    In SI, of the first series that has one; without those that are formulas over parameters.
    """
    found: dict[str, tuple[float, tuple[float, float] | None]] = {}
    for series in diagram.measured.values():
        for signal, channel in series.channels.items():
            for kind in SENSOR_TERMS:
                known: Value | None = getattr(channel, kind)
                if known is None or not isinstance(known.formula, Number):
                    continue
                own = factor_of(known, kind, series, signal)
                bounds = None
                if known.fit is not None:
                    low, high = (end * own / known.factor for end in known.fit)
                    bounds = (low, high)
                found.setdefault(f"{kind}.{signal}", (known.formula.value * own, bounds))
    return found


def factor_of(known: Value, kind: str, series: Series, signal: str) -> float:
    """The factor to SI of a number of a sensor as it stands in the text."""
    if known.unit or series.channels[signal].declared is not None:
        return known.factor
    return known.factor * SENSOR_TERMS[kind].factor(series.unit_of(series.channels[signal])[1])


def _channel(diagram: Diagram, root: Entries, series: Series, signal: str) -> Node:
    """The text of a measured signal in its series."""
    signals = root.inside("measured", series.name, "signals")
    return next(n for name, _, n in signals if find_recorded(diagram, name) == signal)


def _value_text(value: float, fit: tuple[float, float] | None, factor: float) -> str:
    number, ends = as_written(value, factor, fit)
    shown = "" if ends is None else f", fit: {bounds(ends)}"
    return f"{{value: {number_text(number)}{shown}}}"


def _with_number(text: str, channel: Node, kind: str, number: str) -> TextEdit:
    """The text of a channel with a number of its sensor."""
    if isinstance(channel, Scalar):
        column = text[channel.start : channel.end]
        return replace_node(channel, f"{{column: {column}, {kind}: {number}}}")
    assert isinstance(channel, Entries)
    if kind in channel.values:
        return replace_node(channel.values[kind], number)
    return entry_last(text, channel, kind, number)
