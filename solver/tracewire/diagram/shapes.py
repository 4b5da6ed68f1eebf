"""The shapes of what stands in a diagram file: texts, numbers, formulas, lists and mappings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

Names = Literal[
    "", "new", "wire", "signal", "state", "parameter", "input", "port", "preset", "unit"
]
"""What a name is: of nothing in a diagram, of a new part, or of a part that is there.

A wire is a signal that the diagram itself sees, a signal also one inside of its subsystems.
"""


@dataclass(frozen=True)
class Text:
    """A text. `words`: it is one of them; `names`: it is the name of such a part, or its path."""

    words: tuple[str, ...] = ()
    names: Names = ""


@dataclass(frozen=True)
class Number:
    """A plain number; `words` may stand instead."""

    words: tuple[str, ...] = ()
    above: float | None = None
    low: float | None = None


@dataclass(frozen=True)
class Formula:
    """A number, or a formula that reads parameters, or with `signals` these and `t`, too."""

    signals: bool = False
    condition: bool = False


@dataclass(frozen=True)
class Listed:
    """A list; `count`: of so many entries. `alone`: a single entry needs no list."""

    of: Shape
    count: int | None = None
    alone: bool = False


@dataclass(frozen=True)
class Mapped:
    """A mapping of names to what stands under each, of which there are at least so many."""

    of: Shape
    names: Names = ""
    least: int = 0


@dataclass(frozen=True)
class Record:
    """A mapping with certain keys. `one`: it has exactly one of them.

    `some`: at least one of these keys is given; with `apart` only one of them.
    """

    keys: Mapping[str, Key] = field(hash=False)
    one: bool = False
    some: tuple[str, ...] = ()
    apart: bool = False


@dataclass(frozen=True)
class Either:
    """One of several shapes, of which each is a scalar, a list or a mapping."""

    shapes: tuple[Shape, ...]


@dataclass(frozen=True)
class Named:
    """A shape by its name in `SHAPES`; a block has one that depends on its type."""

    name: str


@dataclass(frozen=True)
class Anything:
    """What another file or another part decides, such as changes of a block."""


Shape = Text | Number | Formula | Listed | Mapped | Record | Either | Named | Anything


@dataclass(frozen=True)
class Key:
    """What stands under a key, what it is in one sentence, and whether it must be given."""

    shape: Shape
    doc: str
    required: bool = False
