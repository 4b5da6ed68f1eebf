"""The partial file of a sweep: what is done of it, kept so that it can go on from there."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.errors import Location, OptionError, Problem
from tracewire.formula import to_text
from tracewire.resume import ResumeFile

KIND = "a sweep of tracewire"


class Partial:
    """The rows of a sweep (count, width) as they are done, in memory and, with a path, in a file.

    A file that is there is read, and must belong to the same diagram, grid and options.
    """

    def __init__(
        self, path: str | Path | None, identity: Mapping[str, object], count: int, width: int
    ) -> None:
        self.path = None if path is None else Path(path)
        self.identity = {name: json.loads(json.dumps(value)) for name, value in identity.items()}
        self.rows = np.full((count, width), np.nan)
        self.done = np.zeros(count, dtype=bool)
        self.errors: dict[int, str] = {}
        self._file: ResumeFile | None = None
        if self.path is not None:
            _check(self.path)
            self._file = ResumeFile(self.path, KIND, has_arrays=True)
            if self.path.exists():
                self._read(self._file)

    def put(self, number: int, row: NDArray[np.float64] | None, error: str = "") -> None:
        """Keep what has become of a row."""
        if row is not None:
            self.rows[number] = row
        if error:
            self.errors[number] = error
        self.done[number] = True
        if self._file is not None and self._file.is_due:
            with suppress(OptionError):  # a full disk may have space again; the last writing tells
                self.write()

    def write(self) -> None:
        """Write the file, if there is to be one. Raises OptionError."""
        if self._file is not None:
            content = {"identity": self.identity, "errors": self.errors}
            self._file.write(content, rows=self.rows, done=self.done)

    def _read(self, file: ResumeFile) -> None:
        place = Location(str(file.path))
        try:
            content = file.read()
        except OSError:
            content = None
        if content is None or not content.keys() >= {"identity", "errors", "rows", "done"}:
            hint = "Name the file that a sweep has left here, or a new one."
            raise OptionError.one("this is no partial file of a sweep", place, hint=hint)
        there, rows, done = content["identity"], content["rows"], content["done"]
        other = [name for name in {**there, **self.identity}
                 if there.get(name) != self.identity.get(name)]  # fmt: skip
        if other or rows.shape != self.rows.shape:
            what = f"this is the partial file of another sweep: {_told(other)}"
            raise OptionError([Problem(what, place, hint="Delete it, or name another file.")])
        self.rows, self.done = rows, done
        self.errors = {int(number): text for number, text in content["errors"].items()}


def fingerprint(model: Model) -> str:
    """What tells one model from another: its equations, parameters and presets."""
    flat = model.flat
    lines = [model.equations]
    lines += [f"{name} = {to_text(p.formula)}" for name, p in flat.parameters.items()]
    for preset, values in flat.presets.items():
        lines += [f"{preset}: {name} = {to_text(value)}" for name, value in values.items()]
    for name, points in flat.tables.items():
        lines += [f"{name}: {list(points.x)} {list(points.y)}"]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]


def _told(other: list[str]) -> str:
    return f"it differs in {', '.join(other)}" if other else "it has another size"


def _check(path: Path) -> None:
    """Raises OptionError for a file that could not be written."""
    if path.suffix != ".npz":
        what = f"a partial file cannot be called '{path.name}'"
        raise OptionError([Problem(what, hint="End its name in .npz.")])
    if path.is_dir() or not path.parent.is_dir():
        what = f"there is no folder '{path.parent}'" if not path.is_dir() else "it is a folder"
        raise OptionError([Problem(what, Location(str(path)), hint="Name a file in a folder.")])
