"""A record: columns of numbers with names and formats, as the software of a rig writes them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
DEGREE = math.pi / 180
"""In rad."""
TURNS_PER_MINUTE = 2 * math.pi / 60
"""In rad/s."""


@dataclass(frozen=True, eq=False)
class Record:
    """Columns by name, the format of each, and how a line is written."""

    names: tuple[str, ...]
    formats: tuple[str, ...]
    columns: Sequence[Sequence[Any] | NDArray[Any]]
    delimiter: str = ","
    decimal_comma: bool = False

    def write(self, file: Path) -> None:
        """Write a line with the names, then one for each sample."""
        with file.open("w", encoding="utf-8", newline="\n") as out:
            out.write(self.delimiter.join(self.names) + "\n")
            for row in zip(*self.columns, strict=True):
                line = self.delimiter.join(f % x for f, x in zip(self.formats, row, strict=True))
                out.write((line.replace(".", ",") if self.decimal_comma else line) + "\n")


def append(columns: Sequence[list[Any]], more: Sequence[Iterable[Any]]) -> None:
    """Put the samples of one more run below those of the columns."""
    for column, values in zip(columns, more, strict=True):
        column.extend(values)


def correlated(
    random: np.random.Generator, samples: int, interval: float, time: float, deviation: float
) -> Array:
    """Noise (samples,) that forgets itself within `time` seconds, with a standard deviation."""
    kept = math.exp(-interval / time)
    pushes = random.normal(size=samples) * deviation * math.sqrt(1 - kept * kept)
    noise = np.empty(samples)
    noise[0] = random.normal() * deviation
    for k in range(1, samples):
        noise[k] = kept * noise[k - 1] + pushes[k]
    return noise


def rounded(values: ArrayLike, step: float) -> Array:
    """The values as a sensor with steps of `step` reads them."""
    return np.asarray(np.round(np.asarray(values) / step) * step, dtype=np.float64)
