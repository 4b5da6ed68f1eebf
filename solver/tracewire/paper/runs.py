"""The shipped diagrams of the papers, each compiled once, and runs that several statements need."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from tracewire.analyse import Floquet, floquet
from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.errors import DiagramError, Problem
from tracewire.shipped import shipped
from tracewire.solve import Run, simulate

Vector = NDArray[np.float64]
RTOL = 1e-9
T = TypeVar("T")


class Systems:
    """Models and runs by name; what was made once is kept.

    A diagram is named by its file in the papers' folder without its ending, or by how that begins:
    `c32`, `pendulum`. `full` asks for the long runs. `tell` is told what is done, in words.
    """

    def __init__(
        self,
        folder: str,
        *,
        full: bool = False,
        workers: int | None = None,
        tell: Callable[[str], None] | None = None,
    ) -> None:
        self.folder: Path = shipped("diagrams") / "papers" / folder
        self.full = full
        self.workers = workers
        self.tell = tell if tell is not None else _silent
        self._kept: dict[object, Any] = {}

    def kept(self, key: object, make: Callable[[], T]) -> T:
        """What `make` gives, made at the first time."""
        if key not in self._kept:
            self._kept[key] = make()
        return cast(T, self._kept[key])

    def model(self, name: str, record: Sequence[str] | None = None) -> Model:
        """The model of a diagram. Raises DiagramError: no such file."""
        return self.kept((name, tuple(record or ())), lambda: self._compiled(name, record))

    def _compiled(self, name: str, record: Sequence[str] | None) -> Model:
        exact = self.folder / f"{name}.yaml"
        files = [exact] if exact.is_file() else sorted(self.folder.glob(f"{name}_*.yaml"))
        if not files:
            exists = tuple(path.stem for path in sorted(self.folder.glob("*.yaml")))
            what = f"there is no diagram '{name}' in {self.folder}"
            raise DiagramError([Problem(what, exists=exists)])
        return compile(read(files[0]), record=tuple(record or ()))

    def run(self, name: str, preset: str = "", **parameters: float) -> Run:
        """A run of a diagram over its own span; the same one is made once."""
        key = ("run", name, preset, tuple(parameters.items()))
        return self.kept(
            key,
            lambda: simulate(self.model(name), preset=preset, parameters=parameters, rtol=RTOL),
        )

    def floquet(
        self, name: str, period: float | str, preset: str = "", **parameters: float
    ) -> Floquet:
        """The Floquet multipliers of a linear system over a period, which may be a formula."""
        return floquet(self.model(name), period, preset=preset, parameters=parameters)

    def growth(
        self, name: str, period: float | str, preset: str = "", **parameters: float
    ) -> float:
        """The growth rate in 1/s of the solution that grows most, from the multipliers."""
        return float(self.floquet(name, period, preset, **parameters).exponents[0].real)


def drift(signal: Vector, scale: float | None = None) -> float:
    """How far a signal goes from its start, in parts of that, or of `scale`."""
    size = abs(float(signal[0])) if scale is None else scale
    return float(np.max(np.abs(signal - signal[0]))) / size


def largest(signal: Vector) -> float:
    """The largest absolute value of a signal."""
    return float(np.max(np.abs(signal)))


def _silent(_: str) -> None:
    pass
