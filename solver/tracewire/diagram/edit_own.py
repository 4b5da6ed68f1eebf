"""Edits of what measured series have of their own: values of parameters, and free starts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tracewire.diagram.diagram import Diagram, Series, Value
from tracewire.diagram.names import find_parameter, parameters
from tracewire.diagram.override import with_parts
from tracewire.diagram.rewrite import as_written, bounds, reread
from tracewire.diagram.source_map import SourceMap
from tracewire.diagram.strict import Entries, Node
from tracewire.diagram.text_edits import entry_last
from tracewire.errors import OptionError, unknown
from tracewire.formula import number_text


def add_own(
    diagram: Diagram,
    values: Mapping[str, Mapping[str, float]],
    fit: Mapping[str, tuple[float, float]] | None = None,
) -> Diagram:
    """The diagram with values of parameters that hold in single series: series -> path -> value.

    Each is written under `parameters` of its series, in the unit that the diagram has for it, with
    six digits, and those in `fit` with their bounds in SI; none may have a value there yet. Raises
    OptionError: a series does not exist.
    """
    texts = {}
    for series, own in values.items():
        if series not in diagram.measured:
            raise OptionError([unknown("measured series", series, diagram.measured)])
        texts[series] = {
            path: _text(value, declared_parameter(diagram, path).factor, (fit or {}).get(path))
            for path, value in own.items()
        }
    return _add(diagram, "parameters", texts)


def free_starts(diagram: Diagram, states: Sequence[str]) -> Diagram:
    """The diagram with states that begin free in each measured series that has a free start."""
    having = having_free_starts(diagram)
    return _add(diagram, "start", {s.name: dict.fromkeys(states, "free") for s in having})


def having_free_starts(diagram: Diagram) -> list[Series]:
    """The measured series with a state whose start is free."""
    return [one for one in diagram.measured.values() if None in one.start.values()]


def _add(diagram: Diagram, section: str, texts: Mapping[str, Mapping[str, str]]) -> Diagram:
    """The diagram with entries in a section of single series: series -> key -> text."""
    changes = []
    parts: dict[tuple[str, ...], str] = {}
    source_map = SourceMap(diagram)
    for series, own in texts.items():
        node = source_map.root.inside("measured", series)
        given = node.values.get(section)
        parts_of_series: tuple[Node, ...] = (node, *node.keys.values())
        if not all(map(source_map.is_own, parts_of_series)):
            parts |= {("measured", series, section, key): text for key, text in own.items()}
        elif isinstance(given, Entries) and given.keys:
            changes += [entry_last(diagram.text, given, key, text) for key, text in own.items()]
        else:
            text = ", ".join(f"{key}: {number}" for key, number in own.items())
            changes.append(entry_last(diagram.text, node, section, f"{{{text}}}"))
    return with_parts(reread(diagram, changes), parts)


def _text(value: float, factor: float, fit: tuple[float, float] | None) -> str:
    number, ends = as_written(value, factor, fit)
    if ends is None:
        return number_text(number)
    return f"{{value: {number_text(number)}, fit: {bounds(ends)}}}"


def declared_parameter(diagram: Diagram, path: str) -> Value:
    """The declaration of a parameter by its path. Raises OptionError: there is none."""
    known = find_parameter(diagram, path)
    if known is None:
        raise OptionError([unknown("parameter", path, parameters(diagram))])
    return known
