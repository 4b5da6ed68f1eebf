"""The nouns of a diagram file: what the user wrote, checked, with the place of every part."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from tracewire.data import column_unit
from tracewire.errors import FormulaError, Location
from tracewire.formula import Expression, read_unit
from tracewire.library import Effect, Library

Use = Literal["train", "gate", "validate"]
Crosses = Literal["up", "down", "both"]
Hold = Literal["previous", "linear", "smooth"]


@dataclass(frozen=True)
class Value:
    """A number or a formula over parameters; `factor` times it is the value in SI.

    `unit` is the SI unit to show, and `written` the user's where that is another one. `fit` holds
    the bounds in SI of a value that a fit may change.
    `named`: the user wrote a mapping ({value: ..., unit: ..., fit: ...}), so the value is a
    parameter of its own that can be set and fitted.
    """

    formula: Expression
    unit: str = ""
    factor: float = 1.0
    fit: tuple[float, float] | None = None
    named: bool = False
    place: Location = Location()
    written: str = ""


@dataclass(frozen=True)
class Points:
    """A table: points (x ascending, y), in SI, for interp().

    `units` are those of x and y in SI where a file says them, '' of plain numbers; else None.
    """

    x: tuple[float, ...]
    y: tuple[float, ...]
    place: Location = Location()
    units: tuple[str | None, str | None] = (None, None)


@dataclass(frozen=True)
class Array:
    """A list of values, for a vector: `start: [1, 0]`."""

    items: tuple[Value, ...]
    place: Location = Location()


@dataclass(frozen=True)
class Wire:
    """A connection from a signal of the same diagram: a block, `block.output`, or an input.

    `index` names an element where the signal is a vector or a matrix: `q[1]`.
    """

    signal: str
    negative: bool = False
    place: Location = Location()
    index: tuple[int, ...] = ()


@dataclass(frozen=True)
class Shown:
    """How a signal is shown: its name in figures, and a unit with its factor to SI.

    An empty label is the name of the signal, an empty unit the one in SI.
    """

    label: str = ""
    unit: str = ""
    factor: float = 1.0


@dataclass(frozen=True)
class BlockUse:
    """One block of a diagram: a library block, or a subsystem of the diagram (`subsystem`).

    `guess` is the value of its outputs at which the search of an algebraic loop begins. `row` is
    the name of the line with `replicate` that it comes from; empty where it has a line of its own.
    """

    name: str
    type: str
    inputs: Mapping[str, tuple[Wire, ...]]
    settings: Mapping[str, Value | Array | Points | Expression]
    unit: str = ""
    local: Mapping[str, str] = field(default_factory=dict)
    subsystem: Diagram | None = None
    guess: Value | Array | None = None
    place: Location = Location()
    shown: Shown = Shown()
    row: str = ""


@dataclass(frozen=True)
class InputPort:
    """A named input of a diagram. `default` is used by a run that gives no source for it."""

    name: str
    unit: str = ""
    default: Value | None = None
    place: Location = Location()
    shown: Shown = Shown()


@dataclass(frozen=True)
class Event:
    """A reset: where `when` crosses zero, the states in `set` get new values, all read from x⁻.

    `when` may be the name of an event of a block: it happens where that one does. A clock has
    `every` instead, a period: it happens at `offset` + k*period, where `offset` is above zero not
    before it.
    """

    when: Expression | None
    crosses: Crosses
    set: Mapping[str, Expression]
    every: Value | None = None
    offset: Value | None = None
    place: Location = Location()


@dataclass(frozen=True)
class Channel:
    """A measured signal: the column of the file, its unit, its noise, and what its sensor does.

    `declared` is the unit as the diagram writes it; None: it names none, and the header of the file
    may. `factor` puts numbers of the column into SI, `unit` is the text of that. sigma and modulo,
    and the numbers of offset, quad and drift, are in SI where a unit is declared, else in the unit
    of the column. A column has gain*z + offset + quad*z^2 + drift*(t - t0), z = signal(t - delay),
    t0 the first sample. `weight` counts the signal in a criterion, and it is compared modulo
    `modulo`. A channel without a column is made by a step of `clean`. `hold` says how an input acts
    between its samples; None: as `tracewire.residual.inputs` finds it to be.
    """

    signal: str
    column: str
    factor: float = 1.0
    unit: str = ""
    sigma: float | None = None
    offset: Value | None = None
    place: Location = Location()
    declared: str | None = None
    gain: Value | None = None
    delay: Value | None = None
    weight: float = 1.0
    modulo: float | None = None
    quad: Value | None = None
    drift: Value | None = None
    hold: Hold | None = None


@dataclass(frozen=True)
class Clock:
    """The time of a record: a column and its unit (None: that of the header, else s), or `every`.

    `zero`: the time in the file, in the unit of the column, that is t = 0 of the diagram. `every`:
    the interval in s between the rows of a file without a column of time; the first is at 0.
    """

    column: str
    unit: str | None = None
    zero: float = 0.0
    every: float | None = None


@dataclass(frozen=True)
class Cleaning:
    """A step of `clean`: its name, and its options as they are given to the record's method.

    Signals go by their full names, an input by `input NAME`. A size is in the unit of its column.
    """

    step: str
    options: Mapping[str, float | int | str | tuple[str, ...]]
    place: Location = Location()


@dataclass(frozen=True)
class Format:
    """How the file of a record is written: what is None is found from its first rows. `missing` are
    numbers that stand for no value there."""

    delimiter: str | None = None
    decimal: str | None = None
    comment: str = "#"
    missing: tuple[float, ...] = ()


@dataclass(frozen=True)
class Series:
    """A measured record: file, use, columns of time, signals and inputs, start, and the window.

    `start` gives start values of this record by state; None there is a free start value.
    `parameters` gives parameters of the diagram a value of their own in this record. `begin`
    and `end` cut the record, and so do `windows`, one for each use that the record has; all are in
    the file's own time in s. `where` names the rows by the values in other columns. `burn_in` is
    the time in s after the begin in which samples do not count. `clean` is done in its order.
    """

    name: str
    file: Path
    use: Use
    time: Clock
    channels: Mapping[str, Channel]
    inputs: Mapping[str, Channel] = field(default_factory=dict)
    start: Mapping[str, Value | None] = field(default_factory=dict)
    preset: str = ""
    begin: float | None = None
    end: float | None = None
    place: Location = Location()
    windows: Mapping[Use, tuple[float, float]] = field(default_factory=dict)
    where: Mapping[str, str | float] = field(default_factory=dict)
    burn_in: float = 0.0
    weight: float = 1.0
    clean: tuple[Cleaning, ...] = ()
    format: Format = Format()
    parameters: Mapping[str, Value] = field(default_factory=dict)

    def unit_of(self, channel: Channel) -> tuple[str, float]:
        """The unit of the column of a channel and its factor to SI: as declared, else that of the
        file's header; no text and 1 where neither says one."""
        if channel.declared is not None or not channel.column:
            return channel.declared or "", channel.factor
        text = column_unit(self.file, channel.column, self.format.delimiter)
        try:
            return text, read_unit(text).factor
        except FormulaError:  # brackets in the header that hold no unit
            return "", 1.0


@dataclass(frozen=True)
class Condition:
    """A comparison of parameters that must hold, or the diagram has no meaning; why, as a hint."""

    formula: Expression
    place: Location = Location()
    hint: str = "The diagram requires it: see its section 'require'."


@dataclass(frozen=True)
class ScenePart:
    """A part of the picture of a mechanism: a rod, a disc, a spring, a box, the ground, a trace.

    `points` are formulas (x, y) by key, y upwards, and `sizes` formulas by key, over signals,
    parameters and `t` in SI; an angle is in rad and turns to the left. A size that is not here is
    the usual one of its kind. An empty color is the one of its kind.
    """

    kind: str
    points: Mapping[str, tuple[Expression, Expression]]
    sizes: Mapping[str, Expression]
    color: str = ""
    place: Location = Location()

    @property
    def formulas(self) -> dict[str, Expression]:
        """All formulas, by the key that they stand under: `from`, `from y`, ..., `radius`."""
        points = {key: x for key, (x, _) in self.points.items()}
        return points | {f"{key} y": y for key, (_, y) in self.points.items()} | dict(self.sizes)


@dataclass(frozen=True)
class Setting:
    """How a statement is measured: what a run is given, and what an analysis needs beside that.

    `preset`, `values` of parameters and `start` of states, as of a preset; `series`: as a measured
    series is driven. The run goes from `begin` to `until`, its samples are those of the diagram or
    `samples` evenly spaced ones, and those before `since` do not count. `options` are further ones
    by their keys: `rtol` of the run, `period`, `skip` and so on of analyses. `over` has the values
    of a parameter, in SI. `file` is another diagram. `full` replaces what it has where runs as
    long as those of the source are asked for.
    """

    preset: str = ""
    values: Mapping[str, Value] = field(default_factory=dict)
    start: Mapping[str, Value] = field(default_factory=dict)
    series: str = ""
    begin: Value | None = None
    until: Value | None = None
    since: Value | None = None
    samples: int | None = None
    options: Mapping[str, Value | str] = field(default_factory=dict)
    modulo: Mapping[str, Value] = field(default_factory=dict)
    over: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    file: Path | None = None
    full: Setting | None = None
    place: Location = Location()


@dataclass(frozen=True)
class Statement:
    """What a diagram must show: a quantity `that` lies where it is expected, measured in `run`.

    Exactly one of these is given: `value` with `within`, a part of it where `relative`; `above`
    or `below` or both, as formulas in the unit; `word` of a quantity that is one, such as stable.
    A formula that reads parameters is in SI. `unit` and `factor` are those of value and bounds.
    `name`, `says` (a sentence), `what` (the quantity in words) and `source` tell a reader what is
    stated where. `erratum`: it cannot hold, as what is printed is wrong, and why. `reference` is
    the run that the quantity calls so.
    """

    that: Expression
    name: str
    says: str = ""
    what: str = ""
    source: str = ""
    value: Expression | None = None
    within: float = 0.0
    relative: bool = False
    above: Expression | None = None
    below: Expression | None = None
    word: str = ""
    unit: str = ""
    factor: float = 1.0
    erratum: str = ""
    note: str = ""
    run: Setting = Setting()
    reference: Setting | None = None
    place: Location = Location()


@dataclass(frozen=True, repr=False)
class Diagram:
    """A diagram, or a subsystem of one, with everything that its file says.

    `file` and `text` are those of the file the diagram was read from; an edit of the diagram is an
    edit of that text. `library` holds the blocks that it may use. `effect`: a subsystem that may be
    tried as a missing effect, and how. `scene` says how it is drawn as a mechanism, and `expect`
    what it must show. `counts` are the parameters that say how many blocks there are; a run cannot
    change them. `variant`: which of its bodies, the `variants`, a subsystem has here; `bodies` has
    all of them, at the definition. `sources` are the other diagram files that it extends or
    includes.
    """

    name: str
    file: Path
    text: str
    library: Library
    title: str = ""
    span: tuple[Value, Value] | None = None
    every: Value | None = None
    max_step: Value | None = None
    record: Mapping[str, Location] = field(default_factory=dict)
    inputs: Mapping[str, InputPort] = field(default_factory=dict)
    outputs: Mapping[str, Wire] = field(default_factory=dict)
    parameters: Mapping[str, Value] = field(default_factory=dict)
    require: tuple[Condition, ...] = ()
    blocks: Mapping[str, BlockUse] = field(default_factory=dict)
    subsystems: Mapping[str, Diagram] = field(default_factory=dict)
    events: tuple[Event, ...] = ()
    presets: Mapping[str, Mapping[str, Value]] = field(default_factory=dict)
    measured: Mapping[str, Series] = field(default_factory=dict)
    place: Location = Location()
    effect: Effect | None = None
    scene: tuple[ScenePart, ...] = ()
    counts: Mapping[str, float] = field(default_factory=dict)
    variant: str = ""
    variants: tuple[str, ...] = ()
    bodies: Mapping[str, Diagram] = field(default_factory=dict)
    sources: tuple[Path, ...] = ()
    expect: tuple[Statement, ...] = ()

    if not TYPE_CHECKING:  # which knows the attributes that there are

        def __getattr__(self, name: str) -> Any:
            what = f"a diagram has no attribute '{name}'"
            raise AttributeError(f"{what}. Where a model is meant: tracewire.compile(diagram).")

    def __repr__(self) -> str:  # with its text and library it would fill many screens
        shown = f"{len(self.blocks)} blocks, {len(self.parameters)} parameters"
        return f"Diagram({(self.title or self.name)!r}: {shown})"

    def users_unit(self, signal: str, unit: str) -> tuple[str, float]:
        """The unit in which a user has a signal or an input, and its factor to SI: `deg`, pi/180.

        It is that of the measured files; where these have none, or differ, that in which figures
        show the signal; else its `unit` in SI.
        """
        every = [{**series.inputs, **series.channels} for series in self.measured.values()]
        units = {
            series.unit_of(known[signal])
            for series, known in zip(self.measured.values(), every, strict=True)
            if signal in known
        }
        if len(units) == 1 and (found := units.pop())[0]:
            return found
        own = self.blocks.get(signal) or self.inputs.get(signal)
        return (own.shown.unit, own.shown.factor) if own and own.shown.unit else (unit, 1.0)

    def _repr_svg_(self) -> str:
        """The picture of the diagram, as a notebook shows it."""
        # the package stands above its subpackages: they do not import it, but it is there
        return str(sys.modules["tracewire"].draw(self).svg)
