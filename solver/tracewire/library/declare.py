"""What a block is: ports, parameters, states, formulas, modes and events. It has no procedure."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Literal

from tracewire.errors import BlockError, Place
from tracewire.formula import Call, Expression, Name, Number, names_of, parse, parse_condition
from tracewire.library.check import check_block
from tracewire.library.effect import Effect

Kind = Literal["number", "points", "formula"]
Crosses = Literal["up", "down", "both"]
ByMode = str | Mapping[str, str]
"""A formula; or, in a block with modes, a formula for each mode by its name."""


@dataclass(frozen=True)
class Input:
    """An input port. `many`: it takes a list of signed wires, read by sum() or product().

    `default` is a formula for the port where nothing is connected; without it a wire is needed.
    """

    name: str
    unit: str = ""
    doc: str = ""
    many: bool = False
    default: str | None = None


@dataclass(frozen=True)
class Parameter:
    """A parameter of a block: its unit, default (None: must be given) and bounds.

    Kind `points` is a table of points for interp(); kind `formula` is a formula over the signals
    and parameters of the diagram that uses the block. A default in text is a formula of the
    parameters that stand before this one.
    """

    name: str
    unit: str = ""
    doc: str = ""
    default: float | str | None = None
    low: float | None = None
    high: float | None = None
    kind: Kind = "number"


@dataclass(frozen=True)
class Output:
    """An output port and its formula over inputs, parameters, states and `t`."""

    name: str
    formula: ByMode = field(hash=False)
    unit: str = ""
    doc: str = ""


@dataclass(frozen=True)
class State:
    """A state, the formula of its rate, and the formula of its start over the parameters."""

    name: str
    rate: ByMode = field(hash=False)
    start: str
    unit: str = ""


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
class Block:
    """A block declaration; it is checked when it is made.

    `doc` is one sentence, `source` the paper and equation it comes from. A block with memory has
    `modes`, one of which it is in, and `transitions` between them. There a formula of an output, of
    a rate or of an event's reset may be a mapping: {mode: formula}. Formulas see the number of the
    mode, from 0 in the order of declaration, as `mode`. Raises BlockError: a name that cannot be
    used or stands twice, a formula that does not parse or reads what does not exist, a text that is
    no unit, bounds that exclude the default, an effect that cannot be tried, a mode that does not
    exist or is never reached, a transition or an event that can do nothing.
    """

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
    place: Place = field(default_factory=lambda: _caller(), compare=False, repr=False)

    def __post_init__(self) -> None:
        problems = check_block(self)
        if problems:
            raise BlockError(problems)

    @cached_property
    def formulas(self) -> dict[str, Expression]:
        """The parsed formula of each output."""
        return {output.name: self.read(output.formula) for output in self.outputs}

    @cached_property
    def rates(self) -> dict[str, Expression]:
        """The parsed formula of each state's rate."""
        return {state.name: self.read(state.rate) for state in self.states}

    @cached_property
    def starts(self) -> dict[str, Expression]:
        """The parsed formula of each state's start."""
        return {state.name: parse(state.start) for state in self.states}

    @cached_property
    def defaults(self) -> dict[str, Expression]:
        """The parsed formula of each parameter whose default is one."""
        return {p.name: parse(p.default) for p in self.parameters if isinstance(p.default, str)}

    @cached_property
    def port_defaults(self) -> dict[str, Expression]:
        """The parsed formula of each input that need not be connected."""
        return {port.name: parse(port.default) for port in self.inputs if port.default is not None}

    @cached_property
    def start_mode(self) -> Expression:
        """The formula of the number of the mode in which the block starts."""
        formula: Expression = Number(0.0)
        for number, mode in reversed(list(enumerate(self.modes))):
            if mode.start is not None:
                condition = parse_condition(mode.start)
                formula = Call("if", (condition, Number(float(number)), formula))
        return formula

    def number(self, mode: str) -> int:
        """The number of a mode, by which formulas and runs know it."""
        return [m.name for m in self.modes].index(mode)

    def read(self, formula: ByMode) -> Expression:
        """A formula of this block; one for each mode becomes a choice by the number of the mode."""
        if isinstance(formula, str):
            return parse(formula)
        chosen, *others = (parse(formula[mode.name]) for mode in self.modes)
        for number, other in enumerate(others, start=1):
            at_least = Call(">=", (Name("mode"), Number(float(number))))
            chosen = Call("if", (at_least, other, chosen))
        return chosen

    def feedthrough(self, output: str) -> frozenset[str]:
        """The inputs on which an output depends at the same instant."""
        inputs = {port.name for port in self.inputs}
        return frozenset(inputs.intersection(names_of(self.formulas[output])))


def _caller() -> Place:
    """The line of the block file that makes a declaration."""
    frame = inspect.currentframe()
    # the frame of the dataclass's own __init__ has the globals of this module, too
    while frame is not None and frame.f_globals.get("__name__") == __name__:
        frame = frame.f_back
    if frame is None:
        return Place()
    return Place(Path(frame.f_code.co_filename).name, frame.f_lineno)
