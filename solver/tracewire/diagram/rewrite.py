"""The last step of every edit: a text with changes read anew, and numbers as a person has them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tracewire.diagram.diagram import Diagram
from tracewire.diagram.read import read_text
from tracewire.diagram.splice import Change, changed
from tracewire.formula import number_text


def reread(diagram: Diagram, changes: Sequence[Change]) -> Diagram:
    """The diagram of the changed text, in the same file. Raises DiagramError."""
    return read_text(changed(diagram.text, changes), diagram.file, library=diagram.library)


def digits(value: float, low: float = -math.inf, high: float = math.inf) -> str:
    """The value with six digits, or as many more as it takes to stay within its bounds."""
    for count in (6, 9, 12, 15):
        rounded = float(f"{value:.{count}g}")
        if low <= rounded <= high:
            return number_text(rounded)
    return number_text(value)


def bounds(fit: tuple[float, float]) -> str:
    """The bounds of a fit: `free`, or `[low, high]`, where an end may be infinite."""
    if fit == (-math.inf, math.inf):
        return "free"
    ends = (number_text(float(f"{x:.12g}")) if math.isfinite(x) else str(x) for x in fit)
    return f"[{', '.join(ends)}]"
