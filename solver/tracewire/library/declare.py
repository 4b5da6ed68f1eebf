"""What a block is: ports, parameters, states, formulas, modes and events. It has no procedure."""

from __future__ import annotations

import inspect
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from tracewire.errors import BlockError, Location
from tracewire.formula import Call, Expression, Name, Number, parse, parse_condition, read_at_once
from tracewire.library.check import check_block
from tracewire.library.parts import ByMode, Parts


@dataclass(frozen=True)
class Block(Parts):
    """A block declaration; it is checked when it is made.

    `doc` is one sentence, `source` the paper and equation it comes from, `require` holds conditions
    on the parameters, such as low <= high, without which the block has no meaning. A block with
    memory has `modes`, one of which it is in, and `transitions` between them. There a formula of an
    output, of a rate or of an event's reset may be a mapping: {mode: formula}. Formulas see the
    number of the mode, from 0 in the order of declaration, as `mode`. Raises BlockError: a name
    that cannot be used or stands twice, a formula that does not parse or reads what does not exist,
    a text that is no unit, bounds that exclude the default, an effect that cannot be tried, a mode
    that does not exist or is never reached, a transition or an event that can do nothing.
    """

    place: Location = field(default_factory=lambda: _caller(), compare=False, repr=False)

    def __post_init__(self) -> None:
        problems = check_block(self, self.place)
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
    def conditions(self) -> tuple[Expression, ...]:
        """The parsed conditions that the parameters must meet."""
        return tuple(map(parse_condition, self.require))

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
        return frozenset(inputs.intersection(read_at_once(self.formulas[output])))


def _caller() -> Location:
    """The line of the block file that makes a declaration."""
    frame = inspect.currentframe()
    # the frame of the dataclass's own __init__ has the globals of this module, too
    while frame is not None and frame.f_globals.get("__name__") == __name__:
        frame = frame.f_back
    if frame is None:
        return Location()
    return Location(Path(frame.f_code.co_filename).name, frame.f_lineno)
