"""The parts of a block: ports, parameters, states, modes, transitions and events."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from tracewire.library.effect import Effect

Kind = Literal["number", "points", "formula"]
Crosses = Literal["up", "down", "both"]
ByMode = str | Mapping[str, str]
"""A formula; or, in a block with modes, a formula for each mode by its name."""


@dataclass(frozen=True)
class Input:
    """An input port. `many`: it takes a list of signed wires, read by sum(), product(), min(),
    max() or join().

    `sampled` is the event, a clock, at which the port takes a new value: that of its wire just
    before the tick; where the same clock holds that value already, it passes at once.
    `continuous`: the block is not defined for a signal that jumps; what is certain to is refused.
    `default` is a formula for the port where nothing is connected; without it a wire is needed.
    """

    name: str
    unit: str = ""
    doc: str = ""
    many: bool = False
    default: str | None = None
    sampled: str | None = None
    continuous: bool = False


@dataclass(frozen=True)
class Parameter:
    """A parameter of a block: its unit, default (None: must be given) and bounds.

    `low` and `high` are values that it may have, `above` is one that it must exceed; of a list or
    a table each number, of its points both.
    Kind `points` is a table of points, which interp(), cubic_spline() or monotone_cubic() reads;
    kind `formula` is a formula over the signals and parameters of the diagram that uses the block.
    A default in text is a formula of the parameters that stand before this one.
    `unit_of` is an input whose unit the number has where `unit` is none, as a limit has that of
    what it limits.
    """

    name: str
    unit: str = ""
    doc: str = ""
    default: float | str | None = None
    low: float | None = None
    high: float | None = None
    kind: Kind = "number"
    above: float | None = None
    unit_of: str = ""


@dataclass(frozen=True)
class Output:
    """An output port and its formula over inputs, parameters, states and `t`.

    Its unit is `unit`, or that of the input `unit_of`, unless its factor, the parameter `factor`,
    is set: it may have a unit, too.
    """

    name: str
    formula: ByMode = field(hash=False)
    unit: str = ""
    doc: str = ""
    unit_of: str = ""
    factor: str = ""


@dataclass(frozen=True)
class State:
    """A state, the formula of its rate, and the formula of its start over the parameters.

    A `hidden` one is of no interest outside: a run keeps it only where `record` names it.
    """

    name: str
    rate: ByMode = field(hash=False)
    start: str
    unit: str = ""
    hidden: bool = False


@dataclass(frozen=True)
class Mode:
    """A named mode of a block with memory, which keeps it until a transition leaves it.

    `start` is a condition over inputs, parameters, states and `t` at the start of a run: the block
    starts in the first mode whose condition holds, else in the first mode. Transitions that are due
    fire at the start, too.
    """

    name: str
    start: str | None = None
    doc: str = ""


@dataclass(frozen=True)
class Transition:
    """While the block is in the mode `source` and the condition `when` holds, it becomes `target`.

    The states in `set` get new values at that instant; their formulas read what was before, the
    mode included.
    """

    source: str
    target: str
    when: str
    set: Mapping[str, str] = field(default_factory=dict, hash=False)


@dataclass(frozen=True)
class Event:
    """A reset: where `when` crosses zero, the states in `set` get new values, all read from x⁻.

    `when` is a formula, or several: the event happens where any of them crosses; one that is
    constant between events, where it jumps. A clock has `every` instead, a period in s: it happens
    at `offset` + k*period, and at the start of a run where that is such a time; an `offset` above
    zero is the time of the first one. A diagram may add to an event by its name:
    `when: block.name`. An event of kind `impact` is that of a contact: the log says so. A contact,
    of either kind, is an event whose reset turns the rate of its guard round: it comes to rest,
    holds the guard at zero by a force along its reset, and lets go where that would have to pull.
    """

    name: str
    when: str | tuple[str, ...] = ()
    crosses: Crosses = "both"
    set: Mapping[str, ByMode] = field(default_factory=dict, hash=False)
    every: str | None = None
    offset: str = "0"
    kind: Literal["reset", "impact"] = "reset"
    doc: str = ""

    @property
    def guards(self) -> tuple[str, ...]:
        """The formulas whose crossing it is; none for a clock."""
        return (self.when,) if isinstance(self.when, str) else self.when


@dataclass(frozen=True)
class Parts:
    """All parts of a block as they were declared: what a check reads before there is a `Block`."""

    name: str
    doc: str
    inputs: tuple[Input, ...] = ()
    parameters: tuple[Parameter, ...] = ()
    states: tuple[State, ...] = ()
    outputs: tuple[Output, ...] = ()
    effect: Effect | None = None
    source: str = ""
    modes: tuple[Mode, ...] = ()
    transitions: tuple[Transition, ...] = ()
    events: tuple[Event, ...] = ()
    require: tuple[str, ...] = ()
