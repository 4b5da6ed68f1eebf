"""Lines of a picture: outlines of blocks, paths of wires, arrow heads."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tracewire.draw.graph import Outline
from tracewire.draw.layout import Point, Rectangle
from tracewire.draw.limits import SHAPE


def number(value: float) -> str:
    """A coordinate with one decimal, none where it is whole."""
    return f"{round(value, 1):g}"


def path(points: Sequence[Point]) -> str:
    """Straight lines through points as SVG has them."""
    return "M" + "L".join(f"{number(x)} {number(y)}" for x, y in points)


def outline(kind: Outline, place: Rectangle, flipped: bool) -> str:
    """The outline of a block as a path; a flipped one points to the left."""
    x, y, w, h = place.x, place.y, place.width, place.height
    if kind == "triangle":
        tip, base = (x, x + w) if flipped else (x + w, x)
        return path([(base, y), (tip, y + h / 2), (base, y + h)]) + "Z"
    if kind == "tag":
        tip = x + w - SHAPE.tip
        return path([(x, y), (tip, y), (x + w, y + h / 2), (tip, y + h), (x, y + h)]) + "Z"
    corner = {"circle": w / 2, "pill": w / 2, "bar": 1.0}.get(kind, SHAPE.corner)
    return _rounded(place, corner)


def _rounded(place: Rectangle, corner: float) -> str:
    x, y, w, h = place.x, place.y, place.width, place.height
    r = number(corner)
    turn = f"a{r} {r} 0 0 1"
    across, down = number(w - 2 * corner), number(h - 2 * corner)
    return (
        f"M{number(x + corner)} {number(y)}h{across}{turn} {r} {r}v{down}{turn} -{r} {r}"
        f"h-{across}{turn} -{r} -{r}v-{down}{turn} {r} -{r}Z"
    )


def rim(kind: Outline, place: Rectangle, point: Point, flipped: bool) -> Point:
    """Where a wire that comes to a port at the side of a block's rectangle meets its outline."""
    x, y = point
    left = abs(x - place.x) < abs(x - place.x - place.width)
    if kind in ("circle", "pill"):
        radius = place.width / 2
        top, bottom = place.y + radius, place.y + place.height - radius
        off = top - y if y < top else y - bottom if y > bottom else 0.0
        inset = radius - math.sqrt(max(radius**2 - off**2, 0.0))
        return (x + inset if left else x - inset, y)
    return point


def arrow(line: Sequence[Point]) -> str:
    """The head of the arrow at the end of a line; none where its last part is too short."""
    (x0, y0), (x1, y1) = line[-2], line[-1]
    length = math.hypot(x1 - x0, y1 - y0)
    if length < 1.0:
        return ""
    long, wide = min(SHAPE.arrow_head[0], length), SHAPE.arrow_head[1]
    dx, dy = (x1 - x0) / length, (y1 - y0) / length
    bx, by = x1 - long * dx, y1 - long * dy
    head = [(x1, y1), (bx - wide * dy, by + wide * dx), (bx + wide * dy, by - wide * dx)]
    return f'<path class="head" d="{path(head)}Z"/>'
