"""Sensors that do something to their signals, each as a block behind its signal."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from tracewire.diagram import Channel, Diagram, Series, Wire, find_signal, split_index
from tracewire.draw.details import value_text
from tracewire.draw.graph import Mark, Node, Port
from tracewire.draw.shapes import Drawn, lines_box
from tracewire.library import SENSOR_TERMS


def sensor_nodes(
    diagram: Diagram, level: Diagram, path: str, effects: Collection[str]
) -> Iterator[tuple[Node, Wire]]:
    """The sensors that have terms of the signals of a level, and the wire to each.

    level, path: what is inside of a subsystem, and the full name before its blocks; of `diagram`
    itself that and "". effects: full names of signals whose sensors are drawn in colour.
    """
    for signal in dict.fromkeys(name for one in diagram.measured.values() for name in one.channels):
        having = [one for one in diagram.measured.values() if signal in one.channels]
        terms = [
            term for term in SENSOR_TERMS if any(getattr(s.channels[signal], term) for s in having)
        ]
        found = _own(diagram, level, path, signal)
        if not terms or found is None:
            continue
        name, index = split_index(found)
        mark: Mark = "effect" if signal in effects else ""
        id = f"sensor of {signal}"  # no block has a blank in its name
        node = Node(
            id,
            "sensor",
            "sensor",
            lines_box(*terms)(Drawn("sensor", {}, {}, 1)),
            (Port(f"{id}<", "west"),),
            tuple(_details(signal, having, terms)),
            mark=mark,
        )
        yield node, Wire(name, index=index)


def _own(diagram: Diagram, level: Diagram, path: str, signal: str) -> str | None:
    """The name of a signal in a level; None where another level has it."""
    if level is diagram:
        return find_signal(diagram, signal)
    if not signal.startswith(path) or find_signal(diagram, signal) is not None:
        return None
    return find_signal(level, signal.removeprefix(path))


def _details(signal: str, series: list[Series], terms: list[str]) -> Iterator[str]:
    """The lines of the tooltip: the numbers of each series."""
    yield f"the sensor of {signal}"
    for one in series:
        numbers = ", ".join(_numbers(one.channels[signal], terms))
        if numbers:
            yield f"{one.name}: {numbers}"


def _numbers(channel: Channel, terms: list[str]) -> Iterator[str]:
    for term in terms:
        value = getattr(channel, term)
        if value is not None:
            unit = SENSOR_TERMS[term].unit
            if "{}" in unit:
                inner = unit.startswith("1/") and not channel.unit.isalnum()
                text = f"({channel.unit})" if inner else channel.unit
                unit = unit.format(text) if channel.unit else ""
            yield f"{term} = {value_text(value)} {unit}".rstrip()
