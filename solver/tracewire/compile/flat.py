"""The nouns of a flat model: equations between named signals, with all subsystems dissolved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from tracewire.diagram import Points
from tracewire.errors import Place
from tracewire.formula import Expression


@dataclass(frozen=True)
class FlatParameter:
    """A parameter by its full name: formula of other parameters in SI, unit, bounds of a fit."""

    name: str
    formula: Expression
    unit: str = ""
    fit: tuple[float, float] | None = None
    factor: float = 1.0
    place: Place = Place()


@dataclass(frozen=True)
class FlatState:
    """A state by its full name: x' = rate, x(t0) = start."""

    name: str
    rate: Expression
    start: Expression
    unit: str = ""
    place: Place = Place()


@dataclass(frozen=True)
class FlatEvent:
    """A reset: where `when` crosses zero, states get the values of `set`, all reading x⁻."""

    name: str
    when: Expression
    crosses: str
    set: Mapping[str, Expression]
    place: Place = Place()


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
    place: Place = Place()


@dataclass(frozen=True)
class Flat:
    """A diagram as equations.

    `signals` maps each signal to its formula over states, parameters, inputs, `t` and other
    signals, ordered so that a signal stands after those it reads. `outputs` maps the names of
    subsystem ports and of blocks to the signal or state that they are.
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
