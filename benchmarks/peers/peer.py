"""What a case gives a peer, and what it gets back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from benchmarks.systems.hybrid import Hybrid, Vector


@dataclass(frozen=True)
class Problem:
    """One system in all its forms, and the columns of the state that are judged."""

    title: str
    system: Hybrid
    names: tuple[str, ...]  # of the states in the diagram, in the order of the system's
    judged: tuple[int, ...]
    stiff: bool
    diagram: Path
    preset: str = ""
    parameters: Mapping[str, float] = field(default_factory=dict)
    script: str = ""  # the same system for Scilab


@dataclass(frozen=True, eq=False)
class Answer:
    """A run: states (N, n) at times (N,); `seconds` where the peer keeps its own clock.

    `steps`: the accepted ones, where the peer tells.
    """

    times: Vector
    states: Vector
    seconds: float | None = None
    steps: int | None = None


Solve = Callable[[float], Answer]  # of the relative tolerance; the absolute one is a thousandth


class TooSlow(Exception):
    """A run was given up."""


class Peer(Protocol):
    """A solver by name."""

    name: str

    def missing(self, problem: Problem) -> str:
        """Why it cannot be timed on this problem; empty where it can."""

    def prepare(self, problem: Problem) -> Solve:
        """Everything that is done once; the rest is timed."""
