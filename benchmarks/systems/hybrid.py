"""What a peer in Python is given: smooth rates between events, and what an event changes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Modes = tuple[int, ...]
State = Sequence[float] | Vector


class Hybrid(Protocol):
    """A flat ODE whose right-hand side switches: x' = rates(t, x, modes).

    While `modes` hold, all `margins` are positive; the first that falls through zero ends them.
    Each is a scalar function, for solvers that watch them one by one.
    """

    times: Vector  # (N,) of the samples, in s; the run starts at the first
    file: str  # the same system in C
    constants: Vector  # its parameters, in the order that the C file names them

    def begin(self) -> tuple[Vector, Modes]:
        """The states and the modes at the start."""

    def rates(self, t: float, x: State, on: Modes) -> Sequence[float]:
        """dx/dt with frozen modes."""

    def margins(self, t: float, x: State, on: Modes) -> list[float]:
        """What is positive while the modes hold."""

    def margin(self, index: int, t: float, x: State, on: Modes) -> float:
        """One of them, without the cost of the others."""

    def count(self, on: Modes) -> int:
        """How many there are."""

    def happen(self, t: float, x: Vector, on: Modes, index: int) -> tuple[Vector, Modes]:
        """A margin has reached zero: the state, put exactly on the surface, and the next modes."""

    def due(self, on: Modes) -> float:
        """The next scheduled time, in s; infinity for none."""

    def tick(self, on: Modes) -> Modes:
        """The modes after it."""
