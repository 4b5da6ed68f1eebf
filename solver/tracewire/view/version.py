"""A text of a diagram file as the page has it: what was read of it, and its compiled model."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from threading import Lock

from tracewire.compile import Model, compile, unit_problems
from tracewire.diagram import Diagram, read_readable_text
from tracewire.draw import Drawing
from tracewire.errors import Problem, TracewireError
from tracewire.library import Library
from tracewire.view.comparison import SeriesConditions


@dataclass(eq=False)
class Version:
    """A text, the diagram as far as it could be read, its mistakes, and the model if it can be run.

    `shown` names the signals to draw; the model records those that the scene reads, too. `stamp`
    tells the state of the other files that the diagram names. `lock` is held by what runs the
    model. `drawing` is set when it is first drawn, `panels` by the first run: the signals that are
    drawn together; `series` by the first run of each measured series.
    """

    key: str
    text: str
    diagram: Diagram | None
    problems: tuple[Problem, ...]
    model: Model | None
    shown: tuple[str, ...]
    stamp: str
    lock: Lock = field(default_factory=Lock)
    panels: list[list[str]] = field(default_factory=list)
    series: dict[str, SeriesConditions] = field(default_factory=dict)
    drawing: Drawing | None = None


def read_version(text: str, file: Path, library: Library) -> Version:
    """Read and compile a text. What is wrong with it is told in `problems`, and not raised."""
    diagram: Diagram | None = None
    problems: tuple[Problem, ...] = ()
    model: Model | None = None
    shown: tuple[str, ...] = ()
    try:
        diagram, problems = read_readable_text(text, file, library)
        if not problems:
            plain = compile(diagram)
            problems = tuple(unit_problems(plain.flat))  # it runs all the same
            sensed = [name for one in diagram.measured.values() for name in one.channels]
            shown = compile(diagram, sensed).recorded
            model = compile(diagram, [*sensed, *plain.read_by_scene])
    except TracewireError as error:
        problems = tuple(error.problems)
    stamp = stamp_of(diagram)
    key = hashlib.sha256(f"{text}\0{stamp}".encode()).hexdigest()[:32]
    return Version(key, text, diagram, problems, model, shown, stamp)


def stamp_of(diagram: Diagram | None) -> str:
    """Size and time of each file that a diagram names beside its own: it changes as they do."""
    if diagram is None:
        return ""
    parts = []
    for path in sorted({path for path in _files(diagram) if path != diagram.file}):
        try:
            known = path.stat()
            parts.append(f"{path}:{known.st_size}:{known.st_mtime_ns}")
        except OSError:
            parts.append(f"{path}:none")
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


def _files(diagram: Diagram) -> Iterator[Path]:
    """The files of a diagram, of its subsystems and of its measured series."""
    yield diagram.file
    for series in diagram.measured.values():
        yield series.file
    for subsystem in diagram.subsystems.values():
        yield from _files(subsystem)
    yield from diagram.sources
