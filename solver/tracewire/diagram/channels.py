"""The columns of a measured series: which signal each shows, in which unit, by what sensor."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import get_args

from tracewire.diagram.body import Body
from tracewire.diagram.diagram import Channel, Diagram, Hold, Value
from tracewire.diagram.grammar import FREE, MEASURED_INPUT, SIGNAL
from tracewire.diagram.names import find_recorded, recordable
from tracewire.diagram.problems import Problems, clip
from tracewire.diagram.quantities import SECOND, read_above_zero, read_unit_like
from tracewire.diagram.strict import Entries, Node, Scalar
from tracewire.diagram.values import read_bounds, read_value
from tracewire.errors import Location
from tracewire.formula import Number, Unit
from tracewire.library import SENSOR_TERMS

HOLDS: dict[str, Hold] = {word: word for word in get_args(Hold)}
NO_UNIT = Unit("", 1.0)


def read_signals(node: Node, body: Body, diagram: Diagram, what: str) -> dict[str, Channel]:
    """`signals` of a series: a mapping of signals to columns."""
    found: dict[str, Channel] = {}
    example = "{theta: {column: angle, unit: deg, sigma: 0.1}}"
    signals = body.entries(node, f"'signals' of {what}", example)
    for name, key, given in signals or ():
        signal = find_recorded(diagram, name)
        if signal is None:
            place = body.place(key)
            body.problems.unknown("signal", name, recordable(diagram), place)
        elif signal in found:
            problem = f"two definitions of the signal '{clip(name)}' in {what}"
            body.problems.add(problem, body.place(key), (), "Remove one.")
        channel = _channel(signal or name, key, given, body, what, "signal")
        if channel is not None:
            found[channel.signal] = channel
    if signals is not None and not signals.keys:
        body.problems.add(f"{what} has no signals", body.place(node))
    return found


def read_measured_inputs(node: Node, body: Body, diagram: Diagram, what: str) -> dict[str, Channel]:
    """`inputs` of a series: a mapping of the diagram's inputs to columns."""
    found: dict[str, Channel] = {}
    inputs = body.entries(
        node, f"'inputs' of {what}", "{drive: {column: u, unit: N m, sigma: 0.1}}"
    )
    for name, key, given in inputs or ():
        if name not in diagram.inputs:
            hint = "An input of the diagram is named under 'inputs' at its top."
            body.problems.unknown("input", name, diagram.inputs, body.place(key), hint)
        channel = _channel(name, key, given, body, what, "input")
        if channel is not None:
            found[name] = channel
    return found


def _channel(
    signal: str, key: Scalar, node: Node, body: Body, series: str, kind: str
) -> Channel | None:
    place = body.place(key)
    if isinstance(node, Scalar):
        return Channel(signal, node.text.strip(), place=place)
    what = f"'{clip(signal)}' of {series}"
    entries = body.entries(node, what, "{column: angle, unit: deg}")
    if entries is None:
        return None
    keys = SIGNAL if kind == "signal" else MEASURED_INPUT
    body.check_keys(entries, keys, f"key of a measured {kind}")
    column_node = body.required(entries, "column", what)
    column = None if column_node is None else body.text(column_node, "'column'")
    values = {name: node for name, node in entries.values.items() if name in keys}
    unit, declared = NO_UNIT, None
    if "unit" in entries.values:
        unit = body.unit(entries.values["unit"])
        declared = body.text(entries.values["unit"], "a unit")
    sizes = {
        "sigma": "It is the standard deviation of the noise, in the unit of the column.",
        "modulo": "It is the period in the unit of the column, such as 360 for degrees.",
        "weight": "It counts the signal more or less than others.",
    }
    numbers = {
        name: read_above_zero(values[name], body, f"'{name}'", hint)
        for name, hint in sizes.items()
        if name in values
    }
    scaled = {
        name: None if (number := numbers.get(name)) is None else number * unit.factor
        for name in ("sigma", "modulo")
    }
    sensor = {
        name: _of_sensor(name, values[name], body, unit_of_term(name, unit))
        for name in SENSOR_TERMS
        if name in values
    }
    hold = _hold(values["hold"], body) if "hold" in values else None
    if column is None:
        return None
    return Channel(
        signal,
        column,
        unit.factor,
        unit.text,
        sigma=scaled["sigma"],
        offset=sensor.get("offset"),
        place=place,
        declared=declared,
        gain=sensor.get("gain"),
        delay=sensor.get("delay"),
        weight=numbers.get("weight") or 1.0,
        modulo=scaled["modulo"],
        quad=sensor.get("quad"),
        drift=sensor.get("drift"),
        hold=hold,
    )


def _hold(node: Node, body: Body) -> Hold | None:
    """How an input acts between its samples."""
    word = body.text(node, "'hold'")
    if word is not None and word not in HOLDS:
        hint = "previous: each value acts until the next; linear: straight lines; smooth: a spline."
        body.problems.unknown("hold", word, HOLDS, body.place(node), hint)
    return HOLDS.get(word or "")


def unit_of_term(name: str, unit: Unit) -> Unit:
    """The unit of a number of a sensor, from that of the column; none where the column has none."""
    text, factor = SENSOR_TERMS[name].unit, SENSOR_TERMS[name].factor(unit.factor)
    if text == "{}":
        return Unit(unit.text, unit.factor)
    if "{}" not in text:
        return SECOND if text == "s" else NO_UNIT
    plain = unit.text if re.fullmatch(r"\w*", unit.text) else f"({unit.text})"
    return Unit(text.format(plain), factor) if unit.text else Unit("", factor)


def _of_sensor(name: str, node: Node, body: Body, unit: Unit) -> Value | None:
    """A number of a sensor; where only bounds are given it does nothing at first."""
    if isinstance(node, Entries) and "unit" in node.values and name in ("gain", "delay"):
        read_unit_like(node.values["unit"], body, unit.text)
    if isinstance(node, Entries) and "value" not in node.keys and "fit" in node.keys:
        return _free(name, node, body, unit)
    value = read_value(node, body, unit=unit)
    if value is None:
        return None
    check_term(name, value, body.place(node), body.problems)
    return replace(value, named=True)


def check_term(name: str, value: Value, place: Location, problems: Problems) -> None:
    """Note a number that a sensor cannot have."""
    if name == "gain" and value.formula == Number(0.0):
        hint = "It is the number that the signal is multiplied by."
        problems.add("a gain of 0 shows nothing of the signal", place, (), hint)


def _free(name: str, node: Entries, body: Body, unit: Unit) -> Value | None:
    body.check_keys(node, FREE, "key of a value")
    own = body.unit(node.values["unit"]) if "unit" in node.values else unit
    bounds = read_bounds(node.values["fit"], body)
    if bounds is None:
        return None
    begin, place = SENSOR_TERMS[name].neutral, body.place(node)
    if not bounds[0] <= begin <= bounds[1]:
        what = (
            f"the {name} begins at {begin:g}, outside of its bounds {bounds[0]:g} to {bounds[1]:g}"
        )
        body.problems.add(what, place, (), "Give a 'value' to begin with, or widen 'fit'.")
    scaled = (bounds[0] * own.factor, bounds[1] * own.factor)
    return Value(Number(begin), own.text, own.factor, scaled, named=True, place=place)
