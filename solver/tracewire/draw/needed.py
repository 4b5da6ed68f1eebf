"""What data need at a place, as a small plot below the block that is there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tracewire.draw.graph import Line, Plot


@dataclass(frozen=True)
class Needed:
    """What data need at a place, over one signal: points (x, y) in one unit each.

    `dots` are what was found in the data, `lines` the law that stands for it. `words` say what is
    drawn: `needed: up to 0.25 N m over omega`. `explained`: an effect in the diagram gives it.
    """

    dots: Line = ()
    lines: tuple[Line, ...] = ()
    words: str = ""
    explained: bool = True

    def plot(self) -> Plot | None:
        """The points in the box of a plot, where y = 0 is in the middle; None: there are none."""
        points = [*self.dots, *(point for line in self.lines for point in line)]
        if not points:
            return None
        xs = [x for x, _ in points]
        low, high = min(xs), max(xs)
        if low < 0 < high:
            high = max(-low, high)
            low = -high
        half, middle = (high - low) / 2 or 1.0, (high + low) / 2
        tall = max(abs(y) for _, y in points) or 1.0

        def scaled(line: Sequence[tuple[float, float]]) -> Line:
            return tuple((round((x - middle) / half, 4), round(y / tall, 4)) for x, y in line)

        zero = -middle / half
        lines = tuple(scaled(line) for line in self.lines)
        return Plot(scaled(self.dots), lines, self.words, zero if -1 <= zero <= 1 else None)
