"""Edits of the measured series of a diagram: other files, and back to what the user's text has."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping
from pathlib import Path

from tracewire.diagram.diagram import Diagram
from tracewire.diagram.edit_sensors import add_sensor, sensor_numbers, set_sensors
from tracewire.diagram.override import without_part
from tracewire.diagram.problems import Problems
from tracewire.diagram.rewrite import reread
from tracewire.diagram.source_map import SourceMap
from tracewire.diagram.strict import Entries, Scalar, compose
from tracewire.diagram.text_edits import (
    TextEdit,
    apply_edits,
    end_of,
    entry_last,
    lines_last,
    remove_entry,
    replace_node,
)
from tracewire.diagram.yaml_text import inline, quote

SECTION = "measured"


def series_parts(diagram: Diagram, series: str, without: Collection[str] = ()) -> dict[str, str]:
    """The keys of a series in the text, each with its value on one line."""
    source_map = SourceMap(diagram)
    node = source_map.root.inside(SECTION, series)
    parts = {key: inline(part) for key, _, part in node if key not in without}
    if "file" in parts and not source_map.is_own(node.values["file"]):
        parts["file"] = quote(path_text(diagram.measured[series].file, diagram.file.parent))
    return parts


def replace_series(diagram: Diagram, series: Mapping[str, str]) -> Diagram:
    """The diagram with other measured series: name -> mapping as YAML on one line."""
    diagram = _without_extended(diagram)
    text, root = diagram.text, SourceMap(diagram).own
    given = root.values.get(SECTION)
    ending = "\r\n" if "\r\n" in text else "\n"
    lines = [f"{quote(name)}: {line}" for name, line in series.items()]
    if given is not None and isinstance(given, Entries) and not given.flow:
        indent = text[text.rfind("\n", 0, given.start) + 1 : given.start]
        change = replace_node(given, f"{ending}{indent}".join(lines))
    elif given is not None:
        change = replace_node(given, "{" + ", ".join(lines) + "}")
    elif root.flow:
        change = entry_last(text, root, SECTION, "{" + ", ".join(lines) + "}")
    else:
        change = lines_last(text, [f"{SECTION}:", *(f"  {line}" for line in lines)])
    return reread(diagram, [change])


def with_series_of(edited: Diagram, original: Diagram, target: Path | None = None) -> Diagram:
    """An edited diagram with the measured series of the text that it came from.

    What the edit did to sensors goes into the series of the original that measure these signals.
    An original without series keeps those of the edited one where its sensors do something, with
    their files as seen from `target`, the file that it shall be written to; else it loses them.
    """
    if edited.measured == original.measured:
        return edited
    numbers = sensor_numbers(edited)
    source_map, own = SourceMap(edited), SourceMap(original).own
    root = source_map.own
    if _is_extended(original):
        new = _with_sections_of(edited, original)
    elif SECTION not in own.values:
        if numbers:
            return _moved(edited, root, target or original.file)
        new = reread(edited, [remove_entry(edited.text, root, SECTION)])
        short = not original.text.endswith("\n") and new.text.endswith("\n")
        return (
            reread(new, [TextEdit(len(new.text.rstrip("\r\n")), len(new.text), "")])
            if short
            else new
        )
    else:
        section = own.values[SECTION]
        text = original.text[section.start : end_of(section)]
        new = reread(edited, [replace_node(root.values[SECTION], text)])
    known = sensor_numbers(original)
    measured = {signal for series in original.measured.values() for signal in series.channels}
    for path, (value, fit) in numbers.items():
        kind, _, signal = path.partition(".")
        if path not in known and signal in measured:
            new = add_sensor(new, signal, kind, value, fit)
    changed = {path: value for path, (value, fit) in numbers.items() if path in known and fit}
    return set_sensors(new, changed)


def _is_extended(diagram: Diagram) -> bool:
    """Whether a series, or a part of one, stands in a file that the diagram extends."""
    source_map = SourceMap(diagram)
    section = source_map.root.values.get(SECTION)
    inside = [] if not isinstance(section, Entries) else [*section.values.values()]
    keys = [key for node in inside if isinstance(node, Entries) for key in node.keys.values()]
    return not all(map(source_map.is_own, keys))


def _without_extended(diagram: Diagram) -> Diagram:
    """The diagram without the series of the files that it extends, and without changes of them."""
    if not _is_extended(diagram):
        return diagram
    source_map = SourceMap(diagram)
    if SECTION in source_map.own.values:
        change = remove_entry(diagram.text, source_map.own, SECTION)
        diagram = reread(diagram, [change])
    return without_part(diagram, SECTION)


def _with_sections_of(edited: Diagram, original: Diagram) -> Diagram:
    """The edited diagram, its series and what it removes as the text of the original has them."""
    text, own = edited.text, SourceMap(original).own
    for section in (SECTION, "remove"):
        root = compose(text, edited.file, Problems())
        assert isinstance(root, Entries)
        if section in root.values:
            text = apply_edits(text, [remove_entry(text, root, section)])
        if section in own.values:
            part = original.text[own.keys[section].start : end_of(own.values[section])]
            ending = "\r\n" if "\r\n" in text else "\n"
            text += ("" if text.endswith("\n") else ending) + part + ending
    return reread(edited, [TextEdit(0, len(edited.text), text)])


def _moved(diagram: Diagram, root: Entries, target: Path) -> Diagram:
    """The diagram with the files of its series as seen from another file."""
    changes = []
    for name in root.inside(SECTION).keys:
        text = quote(path_text(diagram.measured[name].file, target.parent))
        changes.append(replace_node(root.inside(SECTION, name).values["file"], text))
    return reread(diagram, changes)


def text_from(diagram: Diagram, folder: Path) -> str:
    """The text of a diagram as a file in another folder has it: the files of its own series as
    seen from there. A file that is not there, or has its whole path, keeps that."""
    section = SourceMap(diagram).own.values.get(SECTION)
    changes = []
    for name, _, series in section if isinstance(section, Entries) else ():
        node = series.values.get("file") if isinstance(series, Entries) else None
        file = diagram.measured[name].file if name in diagram.measured else None
        if not isinstance(node, Scalar) or Path(node.text).is_absolute():
            continue
        if file is not None and file.is_file():
            seen = Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix()
            changes.append(replace_node(node, quote(seen)))
    return apply_edits(diagram.text, changes)


def path_text(file: Path, folder: Path) -> str:
    """The path of a file as a diagram in this folder names it: relative where it lies below."""
    full, base = Path(os.path.abspath(file)), Path(os.path.abspath(folder))
    return (full.relative_to(base) if full.is_relative_to(base) else full).as_posix()
