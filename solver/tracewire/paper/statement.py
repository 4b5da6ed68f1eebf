"""A statement of a paper: what is printed, how it is measured on a shipped diagram, what it met."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from tracewire.paper.runs import Systems

Measure = Callable[[Systems], float]
Verdict = Literal["agrees", "the print is wrong", "does not agree", "could not be measured"]
VERDICTS: tuple[Verdict, ...] = (
    "agrees",
    "the print is wrong",
    "does not agree",
    "could not be measured",
)


@dataclass(frozen=True)
class Bounds:
    """Where a measured number must lie: low <= value <= high; `text` says so in words."""

    text: str
    low: float = -math.inf
    high: float = math.inf

    def hold(self, value: float) -> bool:
        """Whether the value lies within; a value that is no number does not."""
        return self.low <= value <= self.high


def about(value: float, off: float) -> Bounds:
    """Within `off` of a value."""
    return Bounds(f"{value:.7g} ± {off:.2g}", value - off, value + off)


def below(value: float) -> Bounds:
    """At most a value."""
    return Bounds(f"≤ {value:.7g}", high=value)


def above(value: float) -> Bounds:
    """At least a value."""
    return Bounds(f"≥ {value:.7g}", low=value)


def between(low: float, high: float) -> Bounds:
    """From one value to another."""
    return Bounds(f"{low:.7g} to {high:.7g}", low, high)


@dataclass(frozen=True)
class Statement:
    """What a paper, or the theory that it rests on, states about a system.

    `name` begins with the system's id of the diagrams ("C15 grows"), `source` is the section,
    equation or figure of the paper. `measure` gives a number `what` in `unit` from the shipped
    diagrams; the statement agrees where it lies within `expected`. `erratum` tells why it cannot:
    what is printed is wrong, and the number shows it. `note` is what else a reader should know, as
    that the paper prints no numbers and those here are chosen.
    """

    name: str
    says: str
    source: str
    what: str
    measure: Measure
    expected: Bounds
    unit: str = ""
    erratum: str = ""
    note: str = ""

    @property
    def system(self) -> str:
        """The id of the system: A, S1, B, C32."""
        return self.name.split()[0]

    def judge(self, value: float) -> Verdict:
        """What a measured value says of the statement."""
        if self.expected.hold(value):
            return "agrees"
        return "the print is wrong" if self.erratum else "does not agree"
