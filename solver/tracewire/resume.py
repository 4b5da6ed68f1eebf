"""The file of work that can go on from where it was: what is done, written now and then."""

from __future__ import annotations

import json
import math
import time
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tracewire.files import replacing, write_file, writing


class ResumeLimits:
    """How often a file is written from which work goes on."""

    every: Final[float] = 2.0
    """Wall time between two writings, s, at least."""


RESUME = ResumeLimits()


class ResumeFile:
    """What is done of some work, in a file: JSON, or .npz where it `has_arrays` beside that.

    kind: words in the file that say what work it is of.
    """

    def __init__(self, path: str | Path, kind: str, has_arrays: bool = False) -> None:
        self.path, self.kind, self.has_arrays = Path(path), kind, has_arrays
        self._written = -math.inf

    @property
    def is_due(self) -> bool:
        """Whether it is time to write it again."""
        return time.monotonic() - self._written > RESUME.every

    def write(self, content: Mapping[str, object], **arrays: NDArray[Any]) -> None:
        """Write the file, which is never half a file. Raises OptionError."""
        self._written = time.monotonic()
        text = json.dumps({"kind": self.kind, **content}, indent=None if self.has_arrays else 1)
        with writing(self.path):
            if not self.has_arrays:
                write_file(self.path, text)
                return
            with replacing(self.path) as file:
                np.savez(file, allow_pickle=False, **arrays, content=np.array(text))

    def read(self) -> dict[str, Any] | None:
        """The content of the file, and its arrays by name; None where it is not of this kind.

        Raises OSError where it cannot be read.
        """
        arrays: dict[str, NDArray[Any]] = {}
        try:
            if self.has_arrays:
                with np.load(str(self.path), allow_pickle=False) as file:
                    arrays = {name: file[name] for name in file.files}
                content = json.loads(str(arrays.pop("content")))
            else:
                content = json.loads(self.path.read_text(encoding="utf-8"))
        except (ValueError, KeyError, EOFError, zipfile.BadZipFile):
            return None
        is_of_this_kind = isinstance(content, dict) and content.get("kind") == self.kind
        return {**content, **arrays} if is_of_this_kind else None
