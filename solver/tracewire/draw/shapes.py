"""What each type of block looks like. `SHAPES` has those that Xcos draws in a way of their own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from tracewire.draw import icons
from tracewire.draw.curves import curve_of, table_curve
from tracewire.draw.font import shorten, text_width
from tracewire.draw.fractions import items_of, polynomial, raised, times
from tracewire.draw.graph import Line, Look
from tracewire.draw.limits import LETTER, SHAPE
from tracewire.library import Block


@dataclass(frozen=True)
class Drawn:
    """What a shape is drawn from: the settings of a block as text, and as numbers where they are.

    ports: how many wires go in and come out, the larger of both. block: None where it is not known.
    points: those of a table, x and y.
    """

    type: str
    settings: Mapping[str, str]
    numbers: Mapping[str, float]
    ports: int
    block: Block | None = None
    points: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())


Shape = Callable[[Drawn], Look]


def shape_of(drawn: Drawn) -> Look:
    """The look of a block: its own shape, else its characteristic curve, else its type in a box."""
    if drawn.type in SHAPES:
        return SHAPES[drawn.type](drawn)
    if drawn.block is None:
        return text_box("?", drawn)
    curve = table_curve(*drawn.points)
    curve = curve or curve_of(drawn.block, drawn.numbers, _moving(drawn.block))
    if curve:
        return Look("box", SHAPE.axes, max(SHAPE.axes - 6, _height(drawn)), curve=curve, axes=True)
    return text_box(drawn.type.replace("_", " "), drawn)


def text_box(text: str, drawn: Drawn) -> Look:
    """A box with one line of text."""
    line = shorten(text, LETTER.most_text)
    width = max(SHAPE.box[0], text_width(line) + 16)
    return Look("box", round(width), _height(drawn), lines=(line,))


def _moving(block: Block) -> str | None:
    """The rate, where that is what a force depends on first; None: the first input."""
    names = [port.name for port in block.inputs]
    return "rate" if names[:1] != ["of"] and "rate" in names else None


def _height(drawn: Drawn) -> float:
    return max(SHAPE.box[1], SHAPE.pitch * drawn.ports + 6)


def _gain(drawn: Drawn) -> Look:
    if drawn.ports > 1:  # the formulas of a matrix may read signals
        return text_box(drawn.settings.get("matrix", "k"), drawn)
    gain = drawn.settings.get("k") or drawn.settings.get("matrix", "k")
    text = shorten(gain, LETTER.most_gain, LETTER.size)
    return Look("triangle", round(max(46.0, text_width(text) / 0.62 + 10)), 40.0, lines=(text,))


def _fraction(above: str, below: str, drawn: Drawn, short: tuple[str, str] = ("", "")) -> Look:
    """A fraction; `short` is written where it would be too wide."""
    lines = (above, below)
    if any(text_width(line) > LETTER.most_text for line in lines) and all(short):
        lines = short
    lines = (shorten(lines[0], LETTER.most_text), shorten(lines[1], LETTER.most_text))
    width = max(40.0, *(text_width(line) + 16 for line in lines))
    return Look("box", round(width), _height(drawn), lines=lines, fraction=True)


def _integrator(drawn: Drawn) -> Look:
    return _fraction("1", "s", drawn)


def _transfer_function(letter: str) -> Shape:
    def shape(drawn: Drawn) -> Look:
        above, below = (
            polynomial(items_of(drawn.settings.get(name, "1")), letter)
            for name in ("numerator", "denominator")
        )
        return _fraction(above, below, drawn, (f"b({letter})", f"a({letter})"))

    return shape


def _first_order(drawn: Drawn) -> Look:
    return _fraction(drawn.settings.get("k", "1"), _lagging(drawn), drawn, ("k", "T s + 1"))


def _lead_lag(drawn: Drawn) -> Look:
    leading = polynomial([drawn.settings.get("lead", "lead"), "1"], "s")
    k = drawn.settings.get("k", "1")
    above = leading if k == "1" else times(k, f"({leading})")
    return _fraction(above, _lagging(drawn), drawn, ("lead s + 1", "lag s + 1"))


def _derivative(drawn: Drawn) -> Look:
    above = times(drawn.settings.get("k", "1"), "s")
    return _fraction(above, _lagging(drawn), drawn, ("k s", "T s + 1"))


def _lagging(drawn: Drawn) -> str:
    return polynomial([drawn.settings.get("lag", "lag"), "1"], "s")


EULER_TO_EULER = {0.0: ("T", "z − 1"), 0.5: ("T (z + 1)", "2 (z − 1)"), 1.0: ("T z", "z − 1")}
"""Discrete integrators by their weight: forward Euler, trapezoidal, backward Euler."""


def _discrete_integrator(drawn: Drawn) -> Look:
    weight = drawn.numbers.get("weight")
    if weight not in EULER_TO_EULER:
        return text_box("discrete integrator", drawn)
    above, below = EULER_TO_EULER[weight]
    return _fraction(times(drawn.settings.get("gain", "1"), above), below, drawn, (above, below))


def _compare(drawn: Drawn) -> Look:
    return text_box("≥" if drawn.ports > 1 else f"≥ {drawn.settings.get('level', '0')}", drawn)


def lines_box(*lines: str) -> Shape:
    """A box with lines of text."""
    width = round(max(map(text_width, lines)) + 16)
    return lambda drawn: Look(
        "box", width, max(_height(drawn), SHAPE.line * len(lines) + 12), lines=lines
    )


def _sum(drawn: Drawn) -> Look:
    if drawn.ports <= 3:
        return Look("circle", 34.0 if drawn.ports < 3 else 44.0, 34.0 if drawn.ports < 3 else 44.0)
    return Look("pill", 34.0, SHAPE.pitch * drawn.ports + 10)


def _operation(sign: str) -> Shape:
    def shape(drawn: Drawn) -> Look:
        return Look("box", 40.0 if drawn.ports < 3 else 44.0, _height(drawn), lines=(sign,))

    return shape


def _function(name: str) -> Shape:
    return lambda drawn: text_box(name, drawn)


def _setting(name: str) -> Shape:
    return lambda drawn: text_box(drawn.settings.get(name, name), drawn)


def _bar(drawn: Drawn) -> Look:
    return Look("bar", 8.0, max(SHAPE.box[1], SHAPE.pitch * drawn.ports + 6))


def _icon(*lines: Line, axes: bool = True) -> Shape:
    side = SHAPE.axes
    return lambda drawn: Look("box", side, max(side - 6, _height(drawn)), curve=lines, axes=axes)


def _machine(*lines: Line) -> Shape:
    """An icon in a square, where circles are round."""

    def shape(drawn: Drawn) -> Look:
        side = max(SHAPE.axes - 6, _height(drawn))
        return Look("box", side, side, curve=lines)

    return shape


def _friction_table(drawn: Drawn) -> Look:
    """The force of both directions, against the rate."""
    x, y = drawn.points
    both = ([*(-u for u in reversed(x)), *x], [*reversed(y), *(-u for u in y)])
    curve = table_curve(*both)
    return _icon(*curve)(drawn) if curve else text_box("friction table", drawn)


def _signal_builder(drawn: Drawn) -> Look:
    """The lines themselves, where their points are plain numbers."""
    try:
        x, y = (
            [float(item) for item in items_of(drawn.settings.get(name, ""))]
            for name in ("times", "values")
        )
    except ValueError:
        return _icon(icons.STEP)(drawn)
    begin, width = x[0], (x[-1] - x[0]) or 1.0
    curve = (
        table_curve([2 * (time - begin) / width - 1 for time in x], y) if len(x) == len(y) else ()
    )
    return _icon(*(curve or (icons.STEP,)))(drawn)


def _power(drawn: Drawn) -> Look:
    return text_box(f"u^{drawn.settings.get('exponent', 'n')}", drawn)


SHAPES: dict[str, Shape] = {
    "gain": _gain,
    "matrix_gain": _gain,
    "integrator": _integrator,
    "sum": _sum,
    "product": _operation("×"),
    "divide": _operation("÷"),
    "dot": _operation("·"),
    "total": _operation("Σ"),
    "constant": _setting("value"),
    "bias": _setting("level"),
    "expression": _setting("formula"),
    "time": _function("t"),
    "power": _power,
    "sine": _icon(icons.SINE),
    "harmonic": _icon(icons.SINE),
    "square": _icon(icons.SQUARE),
    "step": _icon(icons.STEP),
    "ramp": _icon(icons.RAMP),
    "relay": _icon(icons.UP, icons.DOWN),
    "play_operator": _icon(icons.PLAY_UP, icons.PLAY_DOWN),
    "switch": _icon(icons.ARM, *icons.CONTACTS, axes=False),
    "zero_order_hold": _icon(icons.STAIRS),
    "sample_and_hold": _icon(icons.STAIRS),
    "limited_integrator": _icon(icons.BOUND),
    "bouncing_body": _icon(icons.FALL, axes=False),
    "hysteresis": _icon(icons.LOOP),
    "dahl": _icon(icons.LOOP),
    "bouc_wen": _icon(icons.LOOP),
    "lugre": _icon(icons.LOOP),
    "pulse": _icon(icons.PULSES),
    "sawtooth": _icon(icons.SAWTOOTH),
    "triangle": _icon(icons.TRIANGLE),
    "chirp": _icon(icons.CHIRP),
    "multisine": _icon(icons.MULTISINE),
    "noise": _icon(icons.NOISE),
    "random_steps": _icon(icons.LEVELS),
    "prbs": _icon(icons.BITS),
    "transfer_function": _transfer_function("s"),
    "discrete_transfer_function": _transfer_function("z"),
    "first_order": _first_order,
    "lead_lag": _lead_lag,
    "derivative": _derivative,
    "second_order": _icon(icons.RINGING),
    "low_pass": _icon(icons.LOW_PASS),
    "high_pass": _icon(icons.HIGH_PASS),
    "band_pass": _icon(icons.BAND_PASS),
    "notch": _icon(icons.NOTCH),
    "state_space": lines_box("x′ = A x + B u", "y = C x + D u"),
    "discrete_state_space": lines_box("x⁺ = A x + B u", "y = C x + D u"),
    "pid": _function("PID(s)"),
    "discrete_pid": _function("PID(z)"),
    "unit_delay": _function(raised("z", -1)),
    "discrete_integrator": _discrete_integrator,
    "delay": _function("exp(−T s)"),
    "variable_delay": _function("exp(−T(t) s)"),
    "pade_delay": _function("≈ exp(−T s)"),
    "quantizer": _icon(icons.LADDER),
    "compare": _compare,
    "and": _function("AND"),
    "or": _function("OR"),
    "xor": _function("XOR"),
    "not": _function("NOT"),
    "jk_flip_flop": _function("JK"),
    "select": _icon(icons.ARM, *icons.WAYS, axes=False),
    "edge": _icon(icons.RISE, icons.RISE_HEAD, axes=False),
    "monostable": _icon(icons.ONE_PULSE, axes=False),
    "timer": _icon(icons.COUNTED),
    "mass": _machine(*icons.BODY),
    "rotating_mass": _machine(*icons.WHEEL),
    "gear": _machine(*icons.GEAR),
    "rack": _machine(*icons.RACK),
    "lever": _machine(*icons.LEVER),
    "belt": _machine(*icons.BELT),
    "elastic_gear": _icon(icons.GAP),
    "spring_damper": _machine(*icons.SPRING_DAMPER),
    "clutch": _machine(*icons.CLUTCH),
    "brake": _machine(*icons.BRAKE),
    "friction_table": _friction_table,
    "maxwell_slip": _icon(icons.LOOP),
    "maxwell_element": _icon(icons.LOOP),
    "signal_builder": _signal_builder,
    "lookup_table_2d": _icon(*icons.GRID, axes=False),
    "debounce": _icon(icons.BOUNCES, axes=False),
    "mux": _bar,
    "demux": _bar,
    **{
        name: _function(name)
        for name in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh",
                     "exp", "log", "sqrt", "floor", "mod", "min", "max")
    },
}  # fmt: skip
"""The shape of a type; a type that is not here has its curve, or its name in a box."""


def subsystem_look(
    title: str, ports: int, labels: tuple[float, float], closed: bool = True
) -> Look:
    """A subsystem: a box with its title; `labels` are the widths of its ports' names.

    The title of an open one is one line above what is inside.
    """
    titles = _in_two(title) if closed else (title,)
    lines = tuple(shorten(line, LETTER.most_text) for line in titles)
    width = max(64.0, max(text_width(line) for line in lines) + 20 + sum(labels))
    return Look("box", round(width), max(46.0, SHAPE.pitch * ports + 10), lines=lines)


def _in_two(title: str) -> tuple[str, ...]:
    """A title as one line, or as two of about one width where it is a long one of several words."""
    words = title.split()
    if text_width(title) <= LETTER.most_line or len(words) < 2:
        return (title,)
    ways = [(" ".join(words[:n]), " ".join(words[n:])) for n in range(1, len(words))]
    return min(ways, key=lambda way: max(text_width(line) for line in way))


def tag_look(name: str) -> Look:
    """An input of the diagram: a tag with its name."""
    return Look("tag", round(max(34.0, text_width(shorten(name, LETTER.most_text)) + 22)), 24.0,
                lines=(shorten(name, LETTER.most_text),))  # fmt: skip


def port_width(text: str) -> float:
    """The width that the text beside a port takes inside of a block."""
    return text_width(text, LETTER.small) + 6 if text else 0.0
