"""The nouns of a flat model: equations between named signals, with all subsystems dissolved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from tracewire.diagram import Condition, Crosses, Points, Shown
from tracewire.errors import Location
from tracewire.formula import Expression


@dataclass(frozen=True)
class FlatParameter:
    """A parameter by its full name: formula of other parameters in SI, unit, bounds of a fit.

    `written` is the user's unit where that is not of SI, and `factor` brings its numbers to SI.
    """

    name: str
    formula: Expression
    unit: str = ""
    fit: tuple[float, float] | None = None
    factor: float = 1.0
    place: Location = Location()
    written: str = ""

    @property
    def users_unit(self) -> tuple[str, float]:
        """The unit of its numbers in the file, and the factor of that to SI."""
        return (
            (self.written, self.factor) if self.written and self.factor != 1 else (self.unit, 1.0)
        )


@dataclass(frozen=True)
class FlatAsked:
    """A value whose unit something says: by the full name of a block's parameter, or by its key.

    The unit is `unit`, or that of the signal or parameter `like`. `given` is the unit that the text
    writes at the value, and `taker` what takes it.
    """

    name: str
    formula: Expression
    unit: str = ""
    place: Location = Location()
    like: Expression | None = None
    given: str = ""
    taker: str = "the block"


@dataclass(frozen=True)
class FlatState:
    """A state by its full name: x' = rate, x(t0) = start."""

    name: str
    rate: Expression
    start: Expression
    unit: str = ""
    place: Location = Location()


@dataclass(frozen=True)
class FlatEvent:
    """A reset: where `when` crosses zero, states get the values of `set`, all reading x⁻.

    `clocked`: where `when` reaches a whole number; it is then (t - offset)/period, and not whole
    before an offset above zero. `block` is the path of the block whose event it is, empty for one
    of a diagram.
    """

    name: str
    when: Expression
    crosses: Crosses
    set: Mapping[str, Expression]
    place: Location = Location()
    kind: Literal["reset", "impact"] = "reset"
    clocked: bool = False
    block: str = ""


@dataclass(frozen=True)
class FlatTransition:
    """While a memory is in the mode `source` and the condition `when` holds: it becomes `target`.

    States get the values of `set`, all reading x⁻ and the mode before.
    """

    source: int
    target: int
    when: Expression
    set: Mapping[str, Expression] = field(default_factory=dict)


@dataclass(frozen=True)
class FlatMemory:
    """The memory of a block: the number of the mode it is in, by which formulas know it.

    `name` is the block's path and `mode`; `modes` are the names behind the numbers 0, 1, 2, ...;
    `start` is the formula of the number at the start, over states, signals, parameters and `t`.
    """

    name: str
    modes: tuple[str, ...]
    start: Expression
    transitions: tuple[FlatTransition, ...]
    place: Location = Location()


@dataclass(frozen=True)
class FlatBlock:
    """What is known of the block behind a signal: its type, its name in its own file, its place.

    `definition` is the path by which an edit of the text finds it: block names of the file for the
    top diagram, `subsystem.block` for a block inside the definition of a subsystem.
    """

    name: str
    type: str
    definition: str
    local: Mapping[str, str] = field(default_factory=dict)
    place: Location = Location()


@dataclass(frozen=True)
class Loop:
    """Signals that need their own value at the same instant.

    `names` begins with the `unknowns`, at which the loop is opened; each of the others stands after
    those of the loop that it reads. `text` is a way round it, `place` that of its first block.
    """

    names: tuple[str, ...]
    unknowns: tuple[str, ...]
    text: str
    place: Location = Location()


@dataclass(frozen=True)
class Flat:
    """A diagram as equations, each of a number: a vector `q` is its elements `q[0]`, `q[1]`, ...

    `signals` maps each signal to its formula over states, parameters, inputs, `t` and other
    signals, ordered so that a signal stands after those it reads; the signals of an algebraic loop
    stand together, as `loops` tells. `guesses` are values where the search of a loop begins.
    `shapes` holds the vectors, `(n,)`, and matrices, `(n, m)`, by name. `outputs` maps the names of
    subsystem ports and of blocks to the signal or state that they are. `require` holds what the
    parameters must meet, `shown` how signals are shown that have a label or a unit that is not SI.
    `asked` has the values whose unit something says: the declarations of blocks, a clock, the span.
    """

    title: str
    states: tuple[FlatState, ...]
    signals: Mapping[str, Expression]
    parameters: Mapping[str, FlatParameter]
    inputs: Mapping[str, Expression | None]
    tables: Mapping[str, Points]
    events: tuple[FlatEvent, ...]
    record: tuple[str, ...]
    span: tuple[Expression, Expression]
    every: Expression | None
    presets: Mapping[str, Mapping[str, Expression]]
    blocks: Mapping[str, FlatBlock]
    units: Mapping[str, str]
    loops: tuple[Loop, ...] = ()
    guesses: Mapping[str, Expression] = field(default_factory=dict)
    shapes: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    memories: tuple[FlatMemory, ...] = ()
    require: tuple[Condition, ...] = ()
    max_step: Expression | None = None
    shown: Mapping[str, Shown] = field(default_factory=dict)
    asked: tuple[FlatAsked, ...] = ()
