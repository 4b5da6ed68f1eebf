"""Files that a diagram names: whether they can be read, and the text of a diagram file."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

from tracewire.diagram.diagram import Diagram
from tracewire.diagram.limits import LIMITS
from tracewire.errors import DiagramError, Location, Problem, unknown

STDIN = Path("<stdin>")


def problem_of(path: Path, place: Location) -> Problem | None:
    """Why `path` is no file that can be read, or None. `place` is where it is named."""
    try:
        if len(str(path)) > LIMITS.longest_path or "\0" in str(path):
            return Problem("no file can have this name", place, hint="Check the path.")
        if path.is_file():
            return None
        if path.is_dir():
            names = sorted(entry.name for entry in path.iterdir() if entry.is_file())
            return Problem(f"'{path}' is a folder", place, tuple(names), "Name a file in it.")
        if path.exists():
            what = f"'{path}' is not a regular file"
            return Problem(what, place, hint="Copy its content into a file.")
        if not path.parent.is_dir():
            what = f"there is no file '{path}', and no folder '{path.parent}'"
            return Problem(what, place, hint="Check the path.")
        names = sorted(entry.name for entry in path.parent.iterdir() if entry.is_file())
    except (OSError, ValueError) as error:
        return _unreadable(path, error, place)
    alike = [name for name in names if Path(name).suffix == path.suffix]
    problem = unknown("file", path.name, alike or names, place)
    return Problem(f"{problem.what} in '{path.parent}'", place, problem.exists, problem.hint)


def is_absent(path: Path) -> bool:
    """Whether there is nothing of this name, which a file could have."""
    try:
        possible = len(str(path)) <= LIMITS.longest_path and "\0" not in str(path)
        return possible and not path.exists()
    except (OSError, ValueError):
        return False


def absent_series(diagram: Diagram) -> dict[str, Problem]:
    """The measured series whose file is not there, each with what is to be said of it."""
    found = {}
    for name, series in diagram.measured.items():
        problem = problem_of(series.file, series.place) if is_absent(series.file) else None
        if problem is not None:
            hint = problem.hint or "The path is relative to the diagram's file."
            found[name] = replace(problem, what=f"series '{name}': {problem.what}", hint=hint)
    return found


def load_text(path: Path, place: Location = Location()) -> str:
    """The text of a diagram file, byte for byte (line ends and a byte order mark are kept).

    Raises DiagramError: no such file, a folder, larger than 1 MB, not UTF-8.
    """
    problem = problem_of(path, place)
    if problem is not None:
        raise DiagramError([problem])
    try:
        with path.open("rb") as file:
            content = file.read(LIMITS.most_bytes + 1)
    except OSError as error:
        raise DiagramError([_unreadable(path, error, place)]) from None
    return _decoded(content, path, place)


def load_stdin() -> str:
    """The text of a diagram from stdin. Raises DiagramError, as `load_text` does."""
    content = b"" if sys.stdin is None else sys.stdin.buffer.read(LIMITS.most_bytes + 1)
    return _decoded(content, STDIN, Location())


def _decoded(content: bytes, path: Path, place: Location) -> str:
    if len(content) > LIMITS.most_bytes:
        hint = "Put subsystems into files of their own and include them; data belongs into CSV."
        size = f"{LIMITS.most_bytes // 1_000_000} MB"
        what = f"'{path}' is larger than {size}, too large for a diagram"
        raise DiagramError.one(what, place, hint=hint)
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        column = error.start - (content.rfind(b"\n", 0, error.start) + 1) + 1
        what = f"the byte 0x{content[error.start]:02x} is not UTF-8 text"
        hint = "Save the file as text, in UTF-8."
        raise DiagramError.one(what, Location(str(path), line, column), hint=hint) from None


def _unreadable(path: Path, error: OSError | ValueError, place: Location) -> Problem:
    reason = getattr(error, "strerror", None) or str(error)
    return Problem(f"'{path}' cannot be read: {reason}", place, hint="Check its name and rights.")
