"""What is given in Python as the YAML of a diagram, and the lines of it that each part has."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Mapping
from dataclasses import replace
from numbers import Real
from pathlib import Path
from typing import Any

from tracewire.diagram.problems import Problems
from tracewire.diagram.strict import Entries, Items, Node, Scalar, compose
from tracewire.diagram.yaml_text import document
from tracewire.errors import DiagramError, Location, OptionError, Problem
from tracewire.formula import number_text

PACKAGE = str(Path(__file__).parents[1])
Data = Any
"""A number, a text, a list of data or a mapping of names to data."""
Names = tuple[str, ...]
"""The names that lead to a part from the top on: `("subsystems", "rod", "blocks", "drag")`."""


def caller() -> Location:
    """The line of the program that called into this package."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(PACKAGE):
        frame = frame.f_back
    return Location(frame.f_code.co_filename, frame.f_lineno)


def node_of(value: Data, what: str) -> Node:
    """The node of a value. Raises OptionError: it is no number, text, list or mapping of such."""
    place = Location()
    if isinstance(value, Mapping):
        keys = {key: Scalar(key, place, 0, 0) for key in value if isinstance(key, str)}
        if len(keys) < len(value):
            raise OptionError.one(f"{what} has a key that is no text", caller())
        values = {key: node_of(part, what) for key, part in value.items()}
        return Entries(keys, values, place, 0, 0, False)
    if isinstance(value, str | Path):
        return Scalar(str(value), place, 0, 0, '"' if "\n" in str(value) else "")
    if isinstance(value, Real) and not isinstance(value, bool):
        if math.isnan(value):
            hint = "Give it a number."
            raise OptionError.one(f"{what} has a value that is no number (NaN)", caller(), (), hint)
        return Scalar(number_text(float(value)), place, 0, 0)
    if hasattr(value, "tolist"):
        return node_of(value.tolist(), what)
    if isinstance(value, list | tuple):
        return Items(tuple(node_of(item, what) for item in value), place, 0, 0, True)
    shown = type(value).__name__
    hint = "Give a number, a text, a list or a mapping."
    raise OptionError.one(f"{what} has a value of type {shown}", caller(), (), hint)


def text_of(data: Mapping[str, Data], comments: Mapping[Names, str], above: str = "") -> str:
    """A diagram as YAML. comments stand behind the first line of their part, `above` before all."""
    text = document({name: node_of(part, f"'{name}'") for name, part in data.items()})
    lines = text.splitlines()
    for path, number in _lines_of(text).items():
        if path in comments:
            lines[number - 1] += f"  # {' '.join(comments[path].split())}"
    head = [f"# {line}".rstrip() for line in above.strip().splitlines()]
    return "".join(f"{line}\n" for line in [*head, *lines])


def by_python(
    error: DiagramError, text: str, file: Path, places: Mapping[Names, Location]
) -> list[Problem]:
    """The problems of a text, each at the line of Python that gave the part it stands in."""
    lines = {path: line for path, line in _lines_of(text).items() if path in places}
    found = []
    for problem in error.problems:
        if problem.place.file != str(file):
            found.append(problem)
            continue
        before = [path for path, line in lines.items() if line <= problem.place.line]
        place = places[max(before, key=lambda path: (lines[path], len(path)), default=())]
        found.append(replace(problem, place=replace(place, block=problem.place.block)))
    return sorted(found, key=lambda problem: (problem.place.file, problem.place.line))


def _lines_of(text: str) -> dict[Names, int]:
    """The first line of each section and entry of a diagram, by the names that lead there."""

    def inside(entries: Entries, path: Names) -> Iterator[tuple[Names, int]]:
        for section, key, node in entries:
            yield (*path, section), key.place.line
            for number, item in enumerate(node.items if isinstance(node, Items) else ()):
                yield (*path, section, str(number)), item.place.line
            for name, inner, part in node if isinstance(node, Entries) else ():
                yield (*path, section, name), inner.place.line
                if section in ("subsystems", "variants") and isinstance(part, Entries):
                    yield from inside(part, (*path, section, name))

    root = compose(text, Path(), Problems()) if text.strip() else None
    return dict(inside(root, ())) if isinstance(root, Entries) else {}
