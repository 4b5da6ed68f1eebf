"""The parts of a piecewise linear hybrid system: what each puts out in a mode, and what ends it.

z holds the number 1 in front, then the states, a sine and a cosine for each wave. In a mode the
output of an element is linear in z, and so are the guards that end the mode.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
CLOSE = 1e-7  # guards are of the size 1: what is nearer to zero is not told from it


class Unclear(Exception):
    """What happens is not for this solution to say."""


@dataclass
class Guard:
    """While it lasts row @ z is positive; where it ends `act` is called."""

    row: Vector
    act: Callable[[], None]
    armed: bool = True


@dataclass
class Element:
    """A part of a system with a mode of its own, and an output that is linear in z: row @ z."""

    into: Vector  # how the output acts on z'

    def output(self) -> Vector:
        raise NotImplementedError

    def guards(self) -> list[Guard]:
        raise NotImplementedError

    def begin(self, z: Vector) -> None:
        """Set the mode at the start."""


@dataclass
class Piecewise(Element):
    """A continuous function of row @ z with slopes between knots; `one` picks the number 1."""

    row: Vector
    knots: tuple[float, ...]
    slopes: tuple[float, ...]
    offsets: tuple[float, ...]
    one: Vector
    piece: int = 0

    def output(self) -> Vector:
        return self.slopes[self.piece] * self.row + self.offsets[self.piece] * self.one

    def guards(self) -> list[Guard]:
        found = []
        if self.piece > 0:
            low = self.knots[self.piece - 1]
            found.append(Guard(self.row - low * self.one, lambda: self.move(-1)))
        if self.piece < len(self.knots):
            high = self.knots[self.piece]
            found.append(Guard(high * self.one - self.row, lambda: self.move(1)))
        return found

    def move(self, by: int) -> None:
        self.piece += by

    def begin(self, z: Vector) -> None:
        self.piece = int(np.searchsorted(self.knots, float(self.row @ z)))


@dataclass
class Relay(Element):
    """on_value from where row @ z reaches on_at, off_value from where it falls to off_at."""

    row: Vector
    on_at: float
    off_at: float
    values: tuple[float, float]
    one: Vector
    on: bool = False

    def output(self) -> Vector:
        return self.values[self.on] * self.one

    def guards(self) -> list[Guard]:
        if self.on:
            return [Guard(self.row - self.off_at * self.one, self.turn)]
        return [Guard(self.on_at * self.one - self.row, self.turn)]

    def turn(self) -> None:
        self.on = not self.on

    def begin(self, z: Vector) -> None:
        self.on = float(self.row @ z) >= self.on_at


@dataclass
class Switch(Element):
    """level times the sign of row @ z; on the surface a value up to `stick` levels holds it."""

    row: Vector
    level: float
    stick: float
    one: Vector
    mode: int = 1  # 0: held
    held: Vector | None = None  # the row of the mode that holds, over the level
    friction: bool = False  # it holds wherever it can; else a relay
    lying: bool = False  # with a body on a stop, which its sticking force helps to hold there

    def output(self) -> Vector:
        if self.lying:
            return self.level * self.stick * self.mode * self.one
        return self.level * (self.held if self.held is not None else self.mode * self.one)

    def guards(self) -> list[Guard]:
        if self.lying:
            return []
        if self.held is not None:
            return [
                Guard(self.stick * self.one - way * self.held, lambda way=way: self.leave(way))
                for way in (1, -1)
            ]
        return [Guard(self.mode * self.row, self.meet)]

    def leave(self, way: int) -> None:
        self.mode, self.held, self.left = way, None, True
        self.met = False

    def meet(self) -> None:
        self.met = True

    met: bool = False
    left: bool = False  # its surface, at this instant

    def begin(self, z: Vector) -> None:
        value = float(self.row @ z)
        if abs(value) < CLOSE:
            self.met = True
        self.mode = 1 if value >= 0 else -1


@dataclass
class Play(Element):
    """The play operator on row @ z, whose rate is rate @ z; `at` is the place of its state in z."""

    row: Vector
    rate: Vector
    half: float
    at: int
    one: Vector
    mode: str = "free"
    leaves: float = 0.0  # what z[at] is set to, in half gaps below the driving part

    def output(self) -> Vector:
        if self.mode == "free":
            return np.eye(len(self.row))[self.at]
        return self.row - self.one * (self.half if self.mode == "up" else -self.half)

    def guards(self) -> list[Guard]:
        if self.mode == "up":
            return [Guard(self.rate, lambda: self.turn("free", 1.0))]
        if self.mode == "down":
            return [Guard(-self.rate, lambda: self.turn("free", -1.0))]
        gap = self.row - np.eye(len(self.row))[self.at]
        return [
            Guard(self.half * self.one - gap, lambda: self.turn("up", 0.0)),
            Guard(self.half * self.one + gap, lambda: self.turn("down", 0.0)),
        ]

    def turn(self, mode: str, leaves: float) -> None:
        self.mode, self.leaves = mode, leaves


@dataclass
class Stop(Element):
    """A body between two stops: its place and rate in z, and its restitution."""

    x: int
    v: int
    low: float
    high: float
    restitution: float
    one: Vector
    side: int = 0  # of the stop on which it lies; 0: none
    hit: int = 0
    force: Vector = field(default_factory=lambda: np.zeros(0))
    lying: list[Switch] = field(default_factory=list)  # on its rate, while the body lies there
    still: float = -np.inf  # when its last flights, which are left out, are long over

    def output(self) -> Vector:
        return np.zeros(len(self.one))

    def guards(self) -> list[Guard]:
        if self.side:
            return [Guard(self.side * self.force, self.release)]
        x = np.eye(len(self.one))[self.x]
        return [
            Guard(self.high * self.one - x, lambda: self.strike(1)),
            Guard(x - self.low * self.one, lambda: self.strike(-1)),
        ]

    def release(self) -> None:
        self.side = 0
        for switch in self.lying:
            switch.lying = False
        self.lying = []

    def strike(self, side: int) -> None:
        self.hit = side


@dataclass
class Reset(Element):
    """Where row @ z rises through zero, z[i] becomes rows[i] @ z for each i."""

    row: Vector
    rows: dict[int, Vector]
    above: bool = False
    due: bool = False

    def output(self) -> Vector:
        return np.zeros(len(self.row))

    def guards(self) -> list[Guard]:
        return [Guard(self.row if self.above else -self.row, self.cross)]

    def cross(self) -> None:
        self.above = not self.above
        self.due = self.above

    def begin(self, z: Vector) -> None:
        self.above = float(self.row @ z) >= 0


@dataclass
class Reader(Reset):
    """A reset whose guard reads a switch, too, in any mode: row @ z + weight times its output."""

    weight: float = 0.0
    of: Switch | None = None

    def guards(self) -> list[Guard]:
        row = self.whole()
        return [Guard(row if self.above else -row, self.cross)]

    def whole(self) -> Vector:
        """The row of the guard in the mode of the switch."""
        return self.row if self.of is None else self.row + self.weight * self.of.output()

    def begin(self, z: Vector) -> None:
        self.above = float(self.whole() @ z) >= 0


@dataclass
class Wave(Element):
    """A square wave: its value changes its sign at known times."""

    level: float
    half: float
    one: Vector
    value: int = 1

    def output(self) -> Vector:
        return self.level * self.value * self.one

    def guards(self) -> list[Guard]:
        return []


@dataclass
class Clock:
    """z[i] becomes rows[i] @ z at period, 2 period, ..."""

    period: float
    rows: dict[int, Vector]


@dataclass
class System:
    """z' = matrix z + the outputs of the elements, from `start`."""

    matrix: Matrix
    start: Vector
    elements: Sequence[Element]
    clocks: Sequence[Clock] = ()


def same(one: Vector, other: Vector) -> bool:
    """Whether two rows have one surface."""
    size = float(np.linalg.norm(one) * np.linalg.norm(other))
    return bool(abs(abs(float(one @ other)) - size) < 1e-12 * size)


def joined(elements: Sequence[Element]) -> list[Element]:
    """The elements, with the switches on one surface that act alike as one.

    It has one side, and one slide. Of two that do not act alike nobody knows the shares.
    """
    found: list[Element] = []
    switches: list[Switch] = []
    of: dict[int, tuple[Switch, float]] = {}
    for element in elements:
        if isinstance(element, Switch):
            for known in switches:
                alike = same(known.row, element.row) and same(known.into, element.into)
                if alike and known.stick == element.stick:
                    weight = element.level * math.copysign(1.0, float(known.row @ element.row))
                    apart = float(known.into @ element.into) * weight < 0
                    if apart and (known.friction or element.friction):
                        raise Unclear("a friction holds what a relay drives away")
                    known.into = known.into + weight * element.into
                    of[id(element)] = known, weight
                    break
            else:
                into, friction = element.level * element.into, element.friction
                one = Switch(into, element.row, 1.0, element.stick, element.one, friction=friction)
                switches.append(one)
                found.append(one)
                of[id(element)] = one, element.level
        else:
            found.append(element)
    for element in found:
        if isinstance(element, Reader) and element.of is not None:
            element.of, weight = of[id(element.of)]
            element.weight *= weight
    return found
