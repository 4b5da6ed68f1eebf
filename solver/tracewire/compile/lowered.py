"""The nouns of a model on the tape: modes, resets, transitions, and the tape with its roots."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from tracewire.compile.tape import Tape
from tracewire.errors import Location
from tracewire.formula import Expression

ModeKind = Literal["sign", "floor", "segment", "memory", "delay"]
Direction = Literal["up", "down", "both"]


@dataclass(frozen=True)
class Mode:
    """A frozen choice of the model and the guard that changes it.

    kind `sign`: 1 where guard >= 0, else 0. `floor`: the whole number below the guard. `segment`:
    the piece of table `table` on which the guard lies. `delay`: the smooth stretch, between two
    instants at which the delayed signal `table` has jumped, in which the guard lies. `timed`: the
    guard is a*t + b with these entries, so its changes are known times. `holds`: at guard = 0 a
    `dry` may hold the guard at zero. `at_zero`: the sign mode that the user's comparison gives at
    exactly zero. `compares`: the comparison does not move what it compares, and its mode is
    `at_zero` wherever the guard rests at zero. `memory`: the number of the mode of a block with
    memory, by the order of `names`; its guard is the number at the start, and only the model's
    transitions change it. `jumps`: it is there for an event, and no log shows it: the `side` of
    zero that a guard is on which only jumps, the memory by which the event fires where that goes
    `up` or `down`, or the time at which a `clock` begins.
    """

    kind: ModeKind
    guard: int
    leaf: int
    signal: str
    text: str
    timed: tuple[int, int] | None = None
    holds: bool = False
    at_zero: int = 1
    compares: bool = False
    table: int = -1
    names: tuple[str, ...] = ()
    jumps: Literal["", "side", "up", "down", "clock"] = ""


@dataclass(frozen=True)
class Reset:
    """States that get new values where the mode `trigger` crosses; -1: where a transition says so.

    values: {number of a state: entry of its new value}. `kind` is what the log calls it, `owner` is
    the block or the event of the diagram that the log names.
    """

    name: str
    kind: Literal["reset", "impact"]
    trigger: int
    direction: Direction
    values: Mapping[int, int] = field(hash=False)
    place: Location = Location()
    owner: str = ""


@dataclass(frozen=True)
class Transition:
    """While mode `memory` is `source` and mode `trigger` is `level`, `memory` becomes `target`.

    `reset` is the number of the reset that fires with it, -1: none. `level` is 1, or 0 where the
    condition is that of the mirrored guard. at_zero: whether the condition holds at a guard of
    exactly zero.
    """

    memory: int
    source: int
    trigger: int
    target: int
    reset: int = -1
    level: int = 1
    at_zero: bool = True


@dataclass(frozen=True)
class Delay:
    """A signal that is read with a delay: its entry, and those of the delay and the longest one.

    `mode` is the number of its mode, `shortest` and `most` are the least and the longest delay as
    formulas of parameters, `text` is what the signal is in the diagram.
    """

    signal: int
    lag: int
    longest: int
    mode: int
    shortest: Expression
    most: Expression
    text: str


@dataclass
class Lowered:
    """The tape of a model with its roots: entries of signals, rates, starts, resets; the modes.

    The resets of `flat.events` come first, in their order, and then those of transitions. `loops`
    holds the modes inside of each algebraic loop: their guards read the solution, which jumps with
    them, so that they are decided together. `delays` are the signals that are read with a delay,
    `shifts` tells whether a signal of t alone is read at another time.
    """

    tape: Tape = field(default_factory=Tape)
    modes: list[Mode] = field(default_factory=list)
    entries: dict[str, int] = field(default_factory=dict)
    states: list[int] = field(default_factory=list)
    rates: list[int] = field(default_factory=list)
    starts: list[int] = field(default_factory=list)
    tables: list[str] = field(default_factory=list)
    resets: list[Reset] = field(default_factory=list)
    transitions: list[Transition] = field(default_factory=list)
    loops: list[tuple[int, ...]] = field(default_factory=list)
    delays: list[Delay] = field(default_factory=list)
    shifts: bool = False
