"""What each type of block looks like. `SHAPES` has those that Xcos draws in a way of their own."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from tracewire.draw.curves import curve_of, table_curve
from tracewire.draw.font import SIZE, SMALL, shortened, text_width
from tracewire.draw.graph import Line, Look
from tracewire.library import Block

PITCH = 18.0  # px between ports
BOX = (44.0, 40.0)  # px, the least width and height
MOST_TEXT = 190.0  # px
MOST_GAIN = 74.0
LINE = 14.0
AXES = 46.0  # px, the side of a box with a curve


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
        return Look("box", AXES, max(AXES - 6, _height(drawn)), curve=curve, axes=True)
    return text_box(drawn.type.replace("_", " "), drawn)


def text_box(text: str, drawn: Drawn) -> Look:
    """A box with one line of text."""
    line = shortened(text, MOST_TEXT)
    width = max(BOX[0], text_width(line) + 16)
    return Look("box", round(width), _height(drawn), lines=(line,))


def _moving(block: Block) -> str | None:
    """The rate, where that is what a force depends on first; None: the first input."""
    names = [port.name for port in block.inputs]
    return "rate" if names[:1] != ["of"] and "rate" in names else None


def _height(drawn: Drawn) -> float:
    return max(BOX[1], PITCH * drawn.ports + 6)


def _gain(drawn: Drawn) -> Look:
    if drawn.ports > 1:  # the formulas of a matrix may read signals
        return text_box(drawn.settings.get("matrix", "k"), drawn)
    text = shortened(drawn.settings.get("k") or drawn.settings.get("matrix", "k"), MOST_GAIN, SIZE)
    return Look("triangle", round(max(46.0, text_width(text) / 0.62 + 10)), 40.0, lines=(text,))


def _integrator(drawn: Drawn) -> Look:
    return Look("box", 40.0, 40.0, lines=("1", "s"), fraction=True)


def _sum(drawn: Drawn) -> Look:
    if drawn.ports <= 3:
        return Look("circle", 34.0 if drawn.ports < 3 else 44.0, 34.0 if drawn.ports < 3 else 44.0)
    return Look("pill", 34.0, PITCH * drawn.ports + 10)


def _operation(sign: str) -> Shape:
    def shape(drawn: Drawn) -> Look:
        return Look("box", 40.0 if drawn.ports < 3 else 44.0, _height(drawn), lines=(sign,))

    return shape


def _function(name: str) -> Shape:
    return lambda drawn: text_box(name, drawn)


def _setting(name: str) -> Shape:
    return lambda drawn: text_box(drawn.settings.get(name, name), drawn)


def _bar(drawn: Drawn) -> Look:
    return Look("bar", 8.0, max(BOX[1], PITCH * drawn.ports + 6))


def _icon(*lines: Line, axes: bool = True) -> Shape:
    return lambda drawn: Look("box", AXES, max(AXES - 6, _height(drawn)), curve=lines, axes=axes)


def _power(drawn: Drawn) -> Look:
    return text_box(f"u^{drawn.settings.get('exponent', 'n')}", drawn)


SINE: Line = tuple((n / 12 - 1, 0.85 * math.sin(math.pi * (n / 12 - 1))) for n in range(25))
SQUARE: Line = ((-1, -0.7), (-0.5, -0.7), (-0.5, 0.7), (0, 0.7), (0, -0.7), (0.5, -0.7), (0.5, 0.7),
                (1, 0.7))  # fmt: skip
STEP: Line = ((-1, -0.6), (-0.2, -0.6), (-0.2, 0.7), (1, 0.7))
RAMP: Line = ((-1, -0.6), (-0.4, -0.6), (1, 0.8))
STAIRS: Line = ((-1, -0.8), (-0.6, -0.8), (-0.6, -0.2), (-0.2, -0.2), (-0.2, 0.5), (0.3, 0.5),
                (0.3, 0.8), (1, 0.8))  # fmt: skip
UP: Line = ((-1, -0.7), (0.45, -0.7), (0.45, 0.7), (1, 0.7))
DOWN: Line = ((1, 0.7), (-0.45, 0.7), (-0.45, -0.7), (-1, -0.7))
PLAY_UP: Line = ((-0.4, -0.8), (0.9, 0.8), (0.4, 0.8))
PLAY_DOWN: Line = ((0.4, 0.8), (-0.9, -0.8), (-0.4, -0.8))
ARM: Line = ((-1, 0.55), (-0.5, 0.55), (0.45, 0.05))
CONTACTS: tuple[Line, ...] = (((-1, -0.55), (-0.5, -0.55)), ((0.5, 0), (1, 0)))
BOUND: tuple[Line, ...] = (((-1, -0.8), (-0.5, -0.8), (0.5, 0.8), (1, 0.8)),)
FALL: Line = ((-1, 0.9), (-0.75, 0.3), (-0.55, -0.8), (-0.2, 0.2), (0.1, -0.8), (0.35, -0.3),
              (0.6, -0.8), (1, -0.8))  # fmt: skip
LOOP: Line = tuple(
    (math.cos(math.pi * n / 12), 0.8 * math.sin(math.pi * n / 12 + 0.9)) for n in range(25)
)

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
    "sine": _icon(SINE),
    "harmonic": _icon(SINE),
    "square": _icon(SQUARE),
    "step": _icon(STEP),
    "ramp": _icon(RAMP),
    "relay": _icon(UP, DOWN),
    "play_operator": _icon(PLAY_UP, PLAY_DOWN),
    "switch": _icon(ARM, *CONTACTS, axes=False),
    "zero_order_hold": _icon(STAIRS),
    "sample_and_hold": _icon(STAIRS),
    "limited_integrator": _icon(*BOUND),
    "bouncing_body": _icon(FALL, axes=False),
    "hysteresis": _icon(LOOP),
    "dahl": _icon(LOOP),
    "bouc_wen": _icon(LOOP),
    "lugre": _icon(LOOP),
    "mux": _bar,
    "demux": _bar,
    **{
        name: _function(name)
        for name in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh",
                     "exp", "log", "sqrt", "floor", "mod", "min", "max")
    },
}  # fmt: skip
"""The shape of a type; a type that is not here has its curve, or its name in a box."""


def subsystem_look(title: str, ports: int, labels: tuple[float, float]) -> Look:
    """A closed subsystem: a box with its type; `labels` are the widths of its ports' names."""
    line = shortened(title, MOST_TEXT)
    width = max(64.0, text_width(line) + 20 + sum(labels))
    return Look("box", round(width), max(46.0, PITCH * ports + 10), lines=(line,))


def tag_look(name: str) -> Look:
    """An input of the diagram: a tag with its name."""
    return Look("tag", round(max(34.0, text_width(shortened(name, MOST_TEXT)) + 22)), 24.0,
                lines=(shortened(name, MOST_TEXT),))  # fmt: skip


def port_width(text: str) -> float:
    """The width that the text beside a port takes inside of a block."""
    return text_width(text, SMALL) + 6 if text else 0.0
