"""A vector or matrix of formulas, and what is said of shapes that do not go together."""

from __future__ import annotations

from dataclasses import dataclass

from tracewire.formula import Expression

Shape = tuple[int, ...]
"""() a number, (n,) a vector, (n, m) a matrix of n rows."""


class Mismatch(Exception):
    """Shapes that do not go together."""


@dataclass(frozen=True)
class Elements:
    """A number, vector or matrix of formulas, row by row."""

    shape: Shape
    items: tuple[Expression, ...]

    def at(self, position: int) -> Expression:
        """The formula at a position; a single number stands at every one."""
        return self.items[position] if self.shape else self.items[0]


def shape_text(shape: Shape) -> str:
    """A shape in words."""
    match shape:
        case ():
            return "a number"
        case (length,):
            return f"a vector of {length}"
    return f"a {'x'.join(map(str, shape))} matrix"
