"""What a block is: ports, parameters, states and formulas. It has no procedure."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Literal

from tracewire.errors import BlockError, Place
from tracewire.formula import Expression, names_of, parse
from tracewire.library.check import check_block

Kind = Literal["number", "points", "formula"]
Symbol = Literal["q", "v"]


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
    formula: str
    unit: str = ""
    doc: str = ""


@dataclass(frozen=True)
class State:
    """A state, the formula of its rate, and the formula of its start over the parameters."""

    name: str
    rate: str
    start: str
    unit: str = ""


@dataclass(frozen=True)
class Effect:
    """Says that a block may be tried as a missing effect, and how.

    `inputs` tells which local signal of the place each port reads: `q` the coordinate, `v` its
    rate. `coefficient` is the parameter in which the output is linear; the effect vanishes where it
    is zero. `sign` is 1 where physics allows only positive coefficients, 0 where it allows both.
    """

    coefficient: str
    inputs: Mapping[str, Symbol] = field(default_factory=dict, hash=False)
    sign: Literal[0, 1] = 0


@dataclass(frozen=True)
class Block:
    """A block declaration; it is checked when it is made.

    `doc` is one sentence, `source` the paper and equation it comes from. Raises BlockError: a name
    that cannot be used or stands twice, a formula that does not parse or reads what does not exist,
    a text that is no unit, bounds that exclude the default, an effect that cannot be tried.
    """

    name: str
    doc: str
    inputs: tuple[Input, ...] = ()
    parameters: tuple[Parameter, ...] = ()
    states: tuple[State, ...] = ()
    outputs: tuple[Output, ...] = ()
    effect: Effect | None = None
    source: str = ""
    place: Place = field(default_factory=lambda: _caller(), compare=False, repr=False)

    def __post_init__(self) -> None:
        problems = check_block(self)
        if problems:
            raise BlockError(problems)

    @cached_property
    def formulas(self) -> dict[str, Expression]:
        """The parsed formula of each output."""
        return {output.name: parse(output.formula) for output in self.outputs}

    @cached_property
    def rates(self) -> dict[str, Expression]:
        """The parsed formula of each state's rate."""
        return {state.name: parse(state.rate) for state in self.states}

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
