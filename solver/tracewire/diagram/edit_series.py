"""Edits of the measured series of a diagram: other files, and back to what the user's text has."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Collection, Mapping
from pathlib import Path

from tracewire.diagram.diagram import Diagram
from tracewire.diagram.edit_sensors import add_sensor, sensor_numbers, set_sensors
from tracewire.diagram.outline import Outline
from tracewire.diagram.rewrite import reread
from tracewire.diagram.splice import Change, end_of, entry_last, replaced, without_entry
from tracewire.diagram.strict import Entries, Items, Node, Scalar

SECTION = "measured"
PLAIN = re.compile(r"(?:[^\W\d]|[/.]\w)(?:[\w./*^+-]|-(?!\s))*")
"""What needs no quotes between braces."""


def quoted(text: str) -> str:
    """A text as YAML has it: plain where it can be, else in quotes."""
    return text if PLAIN.fullmatch(text) else json.dumps(text, ensure_ascii=False)


def mapping_text(parts: Mapping[str, str]) -> str:
    """`{key: value, ...}` of values that are YAML."""
    return "{" + ", ".join(f"{quoted(key)}: {value}" for key, value in parts.items()) + "}"


def series_parts(diagram: Diagram, series: str, without: Collection[str] = ()) -> dict[str, str]:
    """The keys of a series in the text, each with its value on one line."""
    node: Node = Outline(diagram).root
    for key in (SECTION, series):
        assert isinstance(node, Entries)
        node = node.values[key]
    assert isinstance(node, Entries)
    return {key: _on_one_line(diagram.text, part) for key, _, part in node if key not in without}


def replace_series(diagram: Diagram, series: Mapping[str, str]) -> Diagram:
    """The diagram with other measured series: name -> mapping as YAML on one line."""
    text, root = diagram.text, Outline(diagram).root
    given = root.values.get(SECTION)
    ending = "\r\n" if "\r\n" in text else "\n"
    lines = [f"{quoted(name)}: {line}" for name, line in series.items()]
    if given is not None and isinstance(given, Entries) and not given.flow:
        indent = text[text.rfind("\n", 0, given.start) + 1 : given.start]
        change = replaced(given, f"{ending}{indent}".join(lines))
    elif given is not None:
        change = replaced(given, "{" + ", ".join(lines) + "}")
    elif root.flow:
        change = entry_last(text, root, SECTION, "{" + ", ".join(lines) + "}")
    else:
        begin = "" if text.endswith("\n") else ending
        added = ending.join([f"{SECTION}:", *(f"  {line}" for line in lines)])
        change = Change(len(text), len(text), f"{begin}{added}{ending}")
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
    root, own = Outline(edited).root, Outline(original).root
    if SECTION not in own.values:
        if numbers:
            return _moved(edited, root, target or original.file)
        new = reread(edited, [without_entry(edited.text, root, SECTION)])
        short = not original.text.endswith("\n") and new.text.endswith("\n")
        return (
            reread(new, [Change(len(new.text.rstrip("\r\n")), len(new.text), "")]) if short else new
        )
    section = own.values[SECTION]
    text = original.text[section.start : end_of(section)]
    new = reread(edited, [replaced(root.values[SECTION], text)])
    known = sensor_numbers(original)
    measured = {signal for series in original.measured.values() for signal in series.channels}
    for path, (value, fit) in numbers.items():
        kind, _, signal = path.partition(".")
        if path not in known and signal in measured:
            new = add_sensor(new, signal, kind, value, fit)
    changed = {path: value for path, (value, fit) in numbers.items() if path in known and fit}
    return set_sensors(new, changed)


def _moved(diagram: Diagram, root: Entries, target: Path) -> Diagram:
    """The diagram with the files of its series as seen from another file."""
    changes = []
    measured = root.values[SECTION]
    assert isinstance(measured, Entries)
    for name, _, series in measured:
        assert isinstance(series, Entries)
        text = quoted(path_text(diagram.measured[name].file, target.parent))
        changes.append(replaced(series.values["file"], text))
    return reread(diagram, changes)


def path_text(file: Path, folder: Path) -> str:
    """The path of a file as a diagram in this folder names it: relative where it lies below."""
    full, base = Path(os.path.abspath(file)), Path(os.path.abspath(folder))
    return (full.relative_to(base) if full.is_relative_to(base) else full).as_posix()


def _on_one_line(text: str, node: Node) -> str:
    if isinstance(node, Entries):
        return mapping_text({key: _on_one_line(text, part) for key, _, part in node})
    if isinstance(node, Items):
        return "[" + ", ".join(_on_one_line(text, item) for item in node.items) + "]"
    assert isinstance(node, Scalar)
    if node.style in ("'", '"') or node.number is not None:
        return text[node.start : node.end]
    return quoted(node.text)
