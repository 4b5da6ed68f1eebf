"""Values beside those of blocks whose unit something says: times, presets, values of a series."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from tracewire.compile.flat import FlatAsked
from tracewire.diagram import Diagram, Event, Value
from tracewire.formula import Expression, Name

Read = Callable[[Value], Expression]
DIAGRAM = "the diagram"


def unit_text(value: Value) -> str:
    """The unit that the text writes at a value."""
    return value.written or value.unit


def asked_of_clock(event: Event, read: Read) -> list[FlatAsked]:
    """The times of an event that is a clock."""
    times = {"every": event.every, "offset": event.offset}
    return [_time(key, value, read, "a clock") for key, value in times.items() if value]


def asked_of_top(diagram: Diagram, read: Read) -> list[FlatAsked]:
    """The times of a run, the values of presets, and those of measured series."""
    begin, end = diagram.span or (None, None)
    times = [("span", begin), ("span", end), ("every", diagram.every)]
    times.append(("max_step", diagram.max_step))
    found = [_time(key, value, read, "a run") for key, value in times if value]
    for preset in diagram.presets.values():
        found += _like_own(preset, read)
    for series in diagram.measured.values():
        found += _like_own(series.parameters, read)
        found += _like_own(series.start, read)
    return found


def _time(key: str, value: Value, read: Read, taker: str) -> FlatAsked:
    given = unit_text(value)
    return FlatAsked(key, read(value), "s", value.place, given=given, taker=taker)


def _like_own(values: Mapping[str, Value | None], read: Read) -> Iterator[FlatAsked]:
    """Values for what the diagram has in a unit of its own."""
    for name, value in values.items():
        if value is not None:
            place, given = value.place, unit_text(value)
            yield FlatAsked(name, read(value), "", place, Name(name), given, DIAGRAM)
