"""The keys of a diagram file, and what stands under each: one table for all that read or write it.

The reader refuses the keys that are not here. The JSON Schema, the completion of an editor, the
layout of `format` and the places of a name for `rename` follow from the same table.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, get_args

from tracewire.data import STEPS, Option
from tracewire.diagram.diagram import Crosses, Hold, Use
from tracewire.diagram.scene_kinds import COLORS, KINDS, Kind
from tracewire.diagram.shapes import (
    Anything,
    Either,
    Formula,
    Key,
    Listed,
    Mapped,
    Named,
    Number,
    Record,
    Shape,
    Text,
)
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.library import SCALES, SENSOR_TERMS, SYMBOLS, Where

SIGNS: dict[str, Literal[0, 1]] = {"positive": 1, "either": 0}
TEXT, UNIT = Text(), Text(names="unit")
VALUE = {
    "value": Key(Formula(), "A number, or a formula of parameters.", required=True),
    "unit": Key(UNIT, "The unit of the number, such as N m/rad; SI unless given."),
}
BOUNDS = Either((Text(("free",)), Listed(Number(("inf", "+inf", "-inf")), count=2)))
FITTED = VALUE | {"fit": Key(BOUNDS, "A fit may change it: bounds [low, high], or free.")}
FREE = FITTED | {"value": Key(Formula(), VALUE["value"].doc)}
TIME = {
    "value": Key(Number(), "A number.", required=True),
    "unit": Key(UNIT, "A unit of time, such as ms; s unless given."),
}
FIXED, FITTABLE = Named("value"), Named("fitted value")
AXIS = {
    "column": Key(TEXT, "The column of the file.", required=True),
    "unit": Key(UNIT, "The unit of the column; that of the header unless given."),
}
_AXIS = Either((TEXT, Record(AXIS)))
POINTS_FILE = {
    "file": Key(TEXT, "A file of measured points, relative to the diagram.", required=True),
    "x": Key(_AXIS, "The column of the abscissa, or {column, unit}.", required=True),
    "y": Key(_AXIS, "The column of the ordinate, or {column, unit}.", required=True),
}
INPUT = {
    "unit": Key(UNIT, "The unit of the signal, in which it is printed and drawn."),
    "label": Key(TEXT, "The name of the signal in figures, in any letters: label: φ."),
    "default": Key(FIXED, "The value where nothing is connected."),
}
EVENT = {
    "when": Key(
        Formula(signals=True, condition=True),
        "A comparison that becomes true, a number that crosses zero, or an event of a block.",
    ),
    "crosses": Key(Text(get_args(Crosses)), "The direction in which a number crosses zero."),
    "every": Key(FIXED, "A clock instead of `when`: its period in s."),
    "offset": Key(FIXED, "The time of the first tick of a clock in s."),
    "set": Key(
        Mapped(Formula(signals=True), "state", least=1),
        "States and their new values, all computed from the values before the event.",
        required=True,
    ),
}
CHANGED = ("parameters", "blocks", "subsystems", "events")
ROW = {
    "count": Key(Either((Number(), TEXT)), "How many blocks there are.", required=True),
    "first": Key(Anything(), "What the first block has in place of what the line says."),
    "last": Key(Anything(), "The same of the last block."),
}
WORDS = {
    "input": ("of", "rate"),
    "in": ("of",),
    "from": ("of",),
    "u": ("of",),
    "gain": ("k", "kp"),
    "factor": ("k",),
    "initial": ("start",),
    "init": ("start",),
    "x0": ("start",),
    "ic": ("start",),
    "upper": ("high",),
    "max": ("high",),
    "maximum": ("high",),
    "lower": ("low",),
    "min": ("low",),
    "minimum": ("low",),
    "t": ("period", "lag"),
    "ts": ("period",),
    "sample_time": ("period",),
    "dt": ("period",),
    "delay": ("time",),
    "tau": ("lag", "time"),
    "time_constant": ("lag",),
    "time": ("at",),
    "t0": ("at",),
    "final": ("height",),
    "size": ("height", "amplitude"),
    "j": ("inertia",),
    "m": ("mass",),
    "backlash": ("gap", "width"),
}
"""Words of other tools for inputs and parameters of blocks, in small letters, and ours."""
OF_A_BLOCK = {
    "type": Key(Text(), "A block of the library, or a subsystem of the diagram.", required=True),
    "unit": Key(UNIT, "The unit of the signal, in which it is printed and drawn."),
    "label": Key(TEXT, "The name of the signal in figures, in any letters: label: φ."),
    "place": Key(
        Mapped(Text(names="wire")),
        "Of a sum: the signals by which a trace tries effects there, {q: theta, v: omega}.",
    ),
    "guess": Key(Either((FIXED, Listed(FIXED))), "Where the search of an algebraic loop begins."),
    "replicate": Key(
        Either((Number(), TEXT, Record(ROW))), "The line stands for so many blocks in a row."
    ),
    "variant": Key(TEXT, "Which of its variants a subsystem has here; the first unless given."),
}
SHAPE = {
    "at": Key(Listed(Number(), alone=True), "The values that a trace tries first.", required=True),
    "of": Key(Text(tuple(word for word in SCALES if word)), "What the values are multiples of."),
    "low": Key(Number(), "The least value in a refit."),
}
EFFECT = {
    "coefficient": Key(
        Text(names="parameter"), "The parameter that is 0 without the effect.", required=True
    ),
    "inputs": Key(Mapped(Text(tuple(SYMBOLS)), "input"), "What each input reads at a place."),
    "sign": Key(Text(tuple(SIGNS)), "Whether the coefficient is never negative."),
    "shapes": Key(
        Mapped(Either((Record(SHAPE), Listed(Number(), alone=True))), "parameter"),
        "Other parameters, each with the values that a trace tries first.",
    ),
    "place": Key(Text(get_args(Where)), "Where it acts: on a body (sum), or on a drive."),
    "at": Key(
        Either((Record(SHAPE), Listed(Number(), alone=True))),
        "The values of the coefficient at which the effect is first tried.",
    ),
}
CLOCK = {
    "column": Key(TEXT, "The column of the time; not with `every`."),
    "unit": Key(UNIT, "Its unit, such as ms; that of the header, or s, unless given."),
    "zero": Key(Number(), "The time in the file that is t = 0 of the diagram."),
    "every": Key(Named("time"), "The time between two rows of a file without such a column."),
}
FORMAT = {
    "delimiter": Key(TEXT, "What stands between two columns: ';', ',', tab or blank."),
    "decimal": Key(Text((".", ",")), "The decimal sign."),
    "comment": Key(TEXT, "What a line of comment begins with."),
    "missing": Key(
        Listed(Number(), alone=True), "Numbers that stand for no value, as in the file: -9999."
    ),
}
COLUMN = {
    "column": Key(TEXT, "The column of the file.", required=True),
    "unit": Key(UNIT, "The unit of the column; that of the header unless given."),
    "sigma": Key(
        Number(above=0), "The standard deviation of the noise, in the unit of the column."
    ),
}
SIGNAL = (
    COLUMN
    | {
        "weight": Key(Number(above=0), "It counts the signal more or less than others."),
        "modulo": Key(Number(above=0), "The period of the column in its unit, such as 360."),
    }
    | {
        name: Key(Named("free value"), f"The sensor shows {term.words}.")
        for name, term in SENSOR_TERMS.items()
    }
)
MEASURED_INPUT = COLUMN | {
    "hold": Key(Text(get_args(Hold)), "How the input acts between two samples.")
}


def _option(option: Option) -> Shape:
    """What an option of a step of `clean` takes."""
    shapes: dict[str, Shape] = {
        "signal": Text(names="signal"),
        "new": Text(names="signal"),
        "signals": Listed(Text(names="signal"), alone=True),
        "time": Named("time"),
        "count": Number(low=0),
        "size": Number(above=0),
        "word": Text(option.words),
    }
    return shapes.get(option.kind, Number())


STEP = {
    name: {
        key: Key(_option(option), f"An option of the step {name}.", option.required)
        for key, option in options.items()
    }
    for name, options in STEPS.items()
}
STEP["differentiate"]["sigma"] = Key(Number(above=0), "The noise of the signal that is made.")


def _step(name: str) -> Shape:
    """A step of `clean`: all its options, or only the first one."""
    options = STEP[name]
    first = next(iter(options.values())).shape
    short = first.of if isinstance(first, Listed) else first
    return Either((Record(options), short, Listed(short)))


BARE = Text(("sort",))
"""A step of `clean` that may be its name alone."""
STEPS_OF_CLEAN = Record({name: Key(_step(name), f"Do {name}.") for name in STEPS}, one=True)
SERIES = {
    "file": Key(TEXT, "The measured file, relative to the diagram.", required=True),
    "format": Key(Record(FORMAT), "How the file is written, where that is not found."),
    "where": Key(Mapped(TEXT), "The texts or numbers that a row has in other columns."),
    "use": Key(
        Either((Text(get_args(Use)), Mapped(Listed(Named("time"), count=2)))),
        "What it is for: train, gate or validate; or windows of them, {train: [0, 30]}.",
    ),
    "time": Key(
        Either((TEXT, Record(CLOCK, some=("column", "every"), apart=True))),
        "The column of the time.",
        required=True,
    ),
    "from": Key(Named("time"), "The begin of the series in its own time."),
    "to": Key(Named("time"), "The end of the series in its own time."),
    "burn_in": Key(Named("time"), "The time after the begin in which samples do not count."),
    "weight": Key(Number(above=0), "It counts the series more or less than others."),
    "signals": Key(
        Mapped(Either((TEXT, Record(SIGNAL))), "signal", least=1),
        "Which column shows which signal.",
    ),
    "inputs": Key(
        Mapped(Either((TEXT, Record(MEASURED_INPUT))), "input"), "Which column drives which input."
    ),
    "clean": Key(
        Either((Listed(Either((BARE, STEPS_OF_CLEAN))), BARE)),
        "What is done to the columns, in this order.",
    ),
    "start": Key(
        Mapped(Either((Text(("free",)), FIXED)), "state"), "Start values of states; free: fitted."
    ),
    "preset": Key(Text(names="preset"), "The preset that holds in this series."),
    "parameters": Key(
        Mapped(FITTABLE, "parameter"), "Values of parameters that hold in this series alone."
    ),
}


def _part(part: Kind) -> Shape:
    """What a part of a scene takes."""
    keys = {key: Key(Named("point"), "A point [x, y] in m.", True) for key in part.points}
    keys |= {key: Key(Formula(signals=True), "A number in SI.", True) for key in part.sizes}
    keys |= {key: Key(Formula(signals=True), "A number in SI.") for key in part.usual}
    return Record(keys | {"color": Key(Text(COLORS), "The color.")})


_INPUTS = Key(
    Either((Mapped(Record(INPUT), "new"), Listed(Text(names="new"), alone=True))),
    "Signals from outside: a list of names, or {name: {unit: N, default: 0}}.",
)
_PARAMETERS = Key(
    Mapped(FITTABLE, "new"), "Numbers with a name: {k: {value: 3, unit: N/m, fit: [0, 10]}}."
)
_BLOCKS = Key(Mapped(Named("block"), "new"), "The blocks, each with its type and its inputs.")
_EVENTS = Key(
    Listed(Record(EVENT, some=("when", "every"), apart=True)),
    "Resets of states: [{when: x > limit, set: {v: -0.5*v}}].",
)
_SUBSYSTEMS = Key(Mapped(Named("subsystem"), "new"), "Diagrams that are used as blocks.")
_TITLE = Key(TEXT, "The title of figures and reports.")
_LIBRARIES = Key(
    Either((Mapped(TEXT), Listed(TEXT, alone=True))),
    'Installed libraries, as a list or with a condition on the version: {mylab: ">=1.2"}.',
)
_INCLUDE = Key(Listed(TEXT, alone=True), "Files with further subsystems.")

DIRECTIONS = ("up", "down", "both", "up_down", "down_up", "apart")
FIT_METHODS = (
    "fminsearch",
    "least_squares",
    "growing_windows",
    "multiple_shooting",
    "shooting",
    "multistart",
)
SETTING = {
    "preset": Key(Text(names="preset"), "The preset of the run."),
    "set": Key(Mapped(FIXED, "parameter"), "Parameters of the run: {k: 2}."),
    "start": Key(Mapped(FIXED, "state"), "Starts of states: {x: 0.1}."),
    "series": Key(TEXT, "The measured series that drives the run."),
    "from": Key(FIXED, "The begin of the run in s."),
    "until": Key(FIXED, "The end of the run in s."),
    "since": Key(FIXED, "The time from which on quantities are taken."),
    "samples": Key(Number(low=2), "How many samples the run has."),
    "rtol": Key(Number(above=0), "The relative tolerance of the run."),
    "period": Key(FIXED, "Of an orbit or a section: the period in s."),
    "phase": Key(FIXED, "Of a section: the phase at which points are taken."),
    "length": Key(FIXED, "Of an analysis: its length in s."),
    "transient": Key(FIXED, "Of an analysis: what is left out at the begin, in s."),
    "interval": Key(FIXED, "Of exponents: the time between two orthonormalisations in s."),
    "skip": Key(Number(low=0), "Points or periods that are left out at the begin."),
    "keep": Key(Number(low=1), "Points or periods that are taken."),
    "edge": Key(Text(names="signal"), "Of a section: points are taken where this signal jumps."),
    "guard": Key(Formula(signals=True, condition=True), "Of a section: points are taken there."),
    "method": Key(Text(FIT_METHODS), "Of a fit: its method."),
    "direction": Key(Text(DIRECTIONS), "The direction of the crossing, or of a sweep."),
    "modulo": Key(Mapped(FIXED, "state"), "What is one turn of a state: {phi: 2*pi}."),
    "over": Key(
        Mapped(Either((TEXT, Listed(TEXT))), "parameter"),
        "The values of one parameter: {f: 0.3:0.9:800}.",
    ),
}
REFERENCE = SETTING | {
    "full": Key(Record(SETTING), "The setting of the longest runs."),
    "diagram": Key(TEXT, "The file of another diagram, whose names these are."),
}
EXPECTED = ("is", "above", "below", "between")
"""What a statement expects: one of these."""
STATEMENT = {
    "that": Key(Formula(signals=True), "The quantity, such as end(x).", required=True),
    "is": Key(Formula(signals=True), "The value that is expected, or a word such as stable."),
    "within": Key(TEXT, "Its tolerance, in the unit of the quantity or in %."),
    "above": Key(Formula(signals=True), "The quantity is more than this."),
    "below": Key(Formula(signals=True), "The quantity is less than this."),
    "between": Key(Listed(Formula(signals=True), count=2), "The quantity lies between these."),
    "unit": Key(UNIT, "The unit of the numbers; SI unless given."),
    "name": Key(TEXT, "The name in tables; the quantity unless given."),
    "says": Key(TEXT, "The statement in words."),
    "what": Key(TEXT, "The quantity in words."),
    "source": Key(TEXT, "Where it is stated: Table 3."),
    "erratum": Key(TEXT, "Why the source is wrong; then it need not hold."),
    "note": Key(TEXT, "What else is to be said."),
    "run": Key(
        Record(SETTING | {"full": Key(Record(SETTING), "The setting of the longest runs.")}),
        "The setting of the run in which it is measured.",
    ),
    "reference": Key(Record(REFERENCE), "The setting of another run, or of another diagram."),
}
_PRESETS = Key(Mapped(Mapped(FIXED, "parameter")), "Named values of parameters: {free: {c: 0}}.")
_EFFECT = Key(Record(EFFECT), "How a trace may add this subsystem as a missing effect.")
VARIANT = {
    "remove": Key(Listed(TEXT, alone=True), "What is taken away of the blocks above."),
    **{name: Key(Anything(), "What is added or changed.") for name in CHANGED},
    "effect": _EFFECT,
}
TOP = {  # in the order in which `format` puts them
    "title": _TITLE,
    "extends": Key(TEXT, "The diagram that this one changes: a file, relative to this one."),
    "remove": Key(
        Listed(TEXT, alone=True), "What is taken away of the diagram that is extended: [friction]."
    ),
    "span": Key(Listed(FIXED, count=2), "Begin and end of a run in s: [0, 40]."),
    "every": Key(FIXED, "The time between samples in s."),
    "max_step": Key(FIXED, "The longest step of a run in s."),
    "record": Key(
        Listed(Text(names="signal"), alone=True), "The signals that a run keeps; else all states."
    ),
    "libraries": _LIBRARIES,
    "include": _INCLUDE,
    "inputs": _INPUTS,
    "parameters": _PARAMETERS,
    "require": Key(
        Listed(Formula(condition=True)), "Conditions on parameters: [B1*B2 - N12**2 > 0]."
    ),
    "blocks": Key(_BLOCKS.shape, _BLOCKS.doc, required=True),
    "events": _EVENTS,
    "subsystems": _SUBSYSTEMS,
    "presets": _PRESETS,
    "measured": Key(
        Mapped(Record(SERIES, some=("signals", "inputs"))), "Measured series, by name."
    ),
    "scene": Key(
        Listed(Record({n: Key(_part(p), f"A {n}.") for n, p in KINDS.items()}, one=True)),
        "How the diagram is drawn as a mechanism: parts that signals move.",
    ),
    "expect": Key(
        Listed(Record(STATEMENT, some=EXPECTED, apart=True)),
        "What the diagram must show: statements.",
    ),
}
INSIDE = {
    "title": _TITLE,
    "extends": Key(TEXT, "The subsystem of an included file that this one changes: cart."),
    "remove": Key(Listed(TEXT, alone=True), "What is taken away of what is extended: [friction]."),
    "inputs": _INPUTS,
    "outputs": Key(
        Either((Mapped(Text(names="wire"), "new"), Listed(Text(names="port"), alone=True))),
        "The signals that a subsystem gives: a list, or {name: signal}.",
    ),
    "parameters": _PARAMETERS,
    "blocks": _BLOCKS,
    "events": _EVENTS,
    "subsystems": _SUBSYSTEMS,
    "effect": _EFFECT,
    "variants": Key(
        Mapped(Record(VARIANT)),
        "Several bodies, each a change of the blocks above, of which a use chooses one.",
    ),
}
INCLUDED = {
    "title": _TITLE,
    "libraries": _LIBRARIES,
    "include": _INCLUDE,
    "parameters": _PARAMETERS,
    "presets": _PRESETS,
    "subsystems": _SUBSYSTEMS,
}

SHAPES: dict[str, Shape] = {
    "diagram": Record(TOP),
    "subsystem": Record(INSIDE),
    "value": Either((Formula(), Record(VALUE))),
    "fitted value": Either((Formula(), Record(FITTED))),
    "free value": Either((Formula(), Record(FREE, some=("value", "fit")))),
    "time": Either((Number(), Record(TIME))),
    "point": Listed(Formula(signals=True), count=2),
    "points": Either((Listed(Listed(Number(), count=2)), Record(POINTS_FILE))),
    "values": Either((FITTABLE, Listed(FITTABLE))),
    "formulas": Either(
        (
            Formula(signals=True),
            Listed(Either((Formula(signals=True), Listed(Formula(signals=True))))),
        )
    ),
    "wire": Text(names="wire"),
    "wires": Listed(Text(names="wire"), alone=True),
}
OF_KINDS = {"number": "values", "points": "points", "formula": "formulas"}
"""The shape of a block's parameter by its kind."""


def named(shape: Shape) -> Shape:
    """The shape itself in place of its name; a block stays a name."""
    while isinstance(shape, Named) and shape.name in SHAPES:
        shape = SHAPES[shape.name]
    return shape


def fitting(shape: Shape, node: Node) -> Shape | None:
    """The shape of those possible that is of the kind of the node: scalar, list or mapping."""
    shape = named(shape)
    if isinstance(shape, Either):
        found = (fitting(one, node) for one in shape.shapes)
        return next((one for one in found if one is not None), None)
    if isinstance(shape, Listed) and shape.alone and isinstance(node, Scalar):
        return fitting(shape.of, node)
    if isinstance(shape, Text) and shape.words and isinstance(node, Scalar):
        return shape if node.text in shape.words else None
    kinds: type | tuple[type, ...] = Scalar
    if isinstance(shape, Listed):
        kinds = Items
    elif isinstance(shape, Mapped | Record | Named):
        kinds = Entries
    return shape if isinstance(node, kinds) else None


def parts_of(shape: Shape, node: Node) -> Iterator[tuple[Scalar | None, Node, Shape]]:
    """The parts of a list or mapping of a shape, each with its key and its own shape."""
    if isinstance(shape, Listed) and isinstance(node, Items):
        yield from ((None, item, shape.of) for item in node.items)
    elif isinstance(node, Entries):
        for name, key, value in node:
            if isinstance(shape, Mapped):
                yield key, value, shape.of
            elif isinstance(shape, Record) and name in shape.keys:
                yield key, value, shape.keys[name].shape
