"""Edits of what measured series have of their own: values of parameters in one series."""

from __future__ import annotations

from collections.abc import Mapping

from tracewire.diagram.diagram import Diagram, Value
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
    changes = []
    parts: dict[tuple[str, ...], str] = {}
    source_map = SourceMap(diagram)
    root = source_map.root
    for series, own in values.items():
        if series not in diagram.measured:
            raise OptionError([unknown("measured series", series, diagram.measured)])
        node = root
        for key in ("measured", series):
            inner = node.values[key]
            assert isinstance(inner, Entries)
            node = inner
        texts = {
            path: _text(value, declared_parameter(diagram, path).factor, (fit or {}).get(path))
            for path, value in own.items()
        }
        given = node.values.get("parameters")
        parts_of_series: tuple[Node, ...] = (node, *node.keys.values())
        if not all(map(source_map.is_own, parts_of_series)):
            parts |= {("measured", series, "parameters", p): text for p, text in texts.items()}
        elif isinstance(given, Entries) and given.keys:
            changes += [entry_last(diagram.text, given, path, n) for path, n in texts.items()]
        else:
            text = ", ".join(f"{path}: {number}" for path, number in texts.items())
            changes.append(entry_last(diagram.text, node, "parameters", f"{{{text}}}"))
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
