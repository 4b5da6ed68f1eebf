"""The last step of every edit: a text with changes read anew, and numbers as a person has them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tracewire.diagram.diagram import Diagram
from tracewire.diagram.reader import read_text
from tracewire.diagram.text_edits import TextEdit, apply_edits
from tracewire.formula import number_text


def reread(diagram: Diagram, changes: Sequence[TextEdit]) -> Diagram:
    """The diagram of the changed text, in the same file. Raises DiagramError."""
    return read_text(apply_edits(diagram.text, changes), diagram.file, library=diagram.library)


def rounded(value: float, low: float = -math.inf, high: float = math.inf) -> float:
    """The value with six digits, or as many more as it takes to stay within its bounds."""
    for count in (6, 9, 12, 15):
        found = float(f"{value:.{count}g}")
        if low <= found <= high:
            return found
    return value


def digits(value: float, low: float = -math.inf, high: float = math.inf) -> str:
    """The text of a rounded value."""
    return number_text(rounded(value, low, high))


def as_written(
    value: float, factor: float, fit: tuple[float, float] | None = None
) -> tuple[float, tuple[float, float] | None]:
    """A value in SI, and its bounds, as a text has them in a unit with this factor to SI."""
    if fit is None:
        return rounded(value / factor), None
    low, high = fit[0] / factor, fit[1] / factor
    return rounded(value / factor, low, high), (float(f"{low:.12g}"), float(f"{high:.12g}"))


def bounds(fit: tuple[float, float]) -> str:
    """The bounds of a fit: `free`, or `[low, high]`, where an end may be infinite."""
    if fit == (-math.inf, math.inf):
        return "free"
    ends = (number_text(float(f"{x:.12g}")) if math.isfinite(x) else str(x) for x in fit)
    return f"[{', '.join(ends)}]"
