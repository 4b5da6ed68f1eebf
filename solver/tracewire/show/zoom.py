"""The curves of a figure as data, for a page on which they zoom.

They are taken from the figure that matplotlib drew, so that there is one description of it.
"""

from __future__ import annotations

import base64
import json
from typing import TYPE_CHECKING, Any

import numpy as np

from tracewire.array_types import Vector
from tracewire.show.limits import FIGURE

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D


TIME = "t [s]"
WHOLE, ACROSS, ALONG = "points", "across", "along"
"""What an artist is placed by: by its points, from left to right, or from bottom to top."""


def curves_of(figure: Figure) -> str | None:
    """The panels of a figure over time as JSON; None where it has another axis than time.

    Numbers are in `arrays`, each the base64 of float32, lowest byte first; curves name them by
    their place there. The text can stand inside of a page: it has no `<`.
    """
    panels = [axes for axes in figure.axes if axes.get_visible()]
    lefts = {round(axes.get_position().x0, 3) for axes in panels}
    if not panels or len(lefts) > 1 or panels[-1].get_xlabel() != TIME:
        return None
    arrays: list[str] = []
    numbers: dict[str, int] = {}

    def keep(values: Vector) -> int:
        text = base64.b64encode(values.astype("<f4").tobytes()).decode("ascii")
        if text not in numbers:
            numbers[text] = len(arrays)
            arrays.append(text)
        return numbers[text]

    try:
        made = [_panel(axes, keep) for axes in panels]
    except NotOverTime:
        return None
    _name_lines(made)
    data = {"panels": made, "arrays": arrays}
    text = json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    return text if len(text) <= FIGURE.zoom_bytes else None


def _name_lines(panels: list[dict[str, Any]]) -> None:
    """Give a line without a label that of the same colour in another panel, else its axis'."""
    known = {line["color"]: line["label"] for p in panels for line in p["lines"] if line["label"]}
    for panel in panels:
        for line in panel["lines"]:
            line["label"] = line["label"] or (
                known.get(line["color"], "") if len(panel["lines"]) > 1 else panel["label"]
            )


class NotOverTime(Exception):
    """The figure has something that is no curve over time, no band and no mark."""


def _panel(axes: Axes, keep: Any) -> dict[str, Any]:
    if axes.images or {axes.get_xscale(), axes.get_yscale()} != {"linear"}:
        raise NotOverTime
    lines = [line for line in axes.lines if _placed(line, axes) == WHOLE]
    texts = [*(text.get_text() for text in axes.texts), axes.get_title(loc="left")]
    shades = [str(patch.get_label()) for patch in axes.patches]
    texts += [f"shade: {label}" for label in shades if label and not label.startswith("_")]
    across = {str(line.get_label()) for line in axes.lines if _placed(line, axes) == ACROSS}
    texts += [f"dotted: {label}" for label in sorted(across) if not label.startswith("_")]
    bottom, top = axes.get_ylim()
    data: dict[str, Any] = {
        "title": "   ".join(text.strip() for text in texts if text.strip()),
        "label": " ".join(axes.get_ylabel().split()),
        "x": [float(end) for end in axes.get_xlim()],
        "y": sorted((float(bottom), float(top))),
        "down": bool(bottom > top),
        "inches": round(axes.get_window_extent().height / axes.figure.dpi, 2),
        "lines": [_line(line, keep) for line in lines],
        "levels": [
            {"at": float(np.asarray(line.get_ydata())[0]), **_look(line)}
            for line in axes.lines
            if _placed(line, axes) == ACROSS
        ],
        "instants": [
            {"at": float(np.asarray(line.get_xdata())[0]), **_look(line)}
            for line in axes.lines
            if _placed(line, axes) == ALONG
        ],
        "bands": _bands(axes),
        **_marks(axes),
    }
    if not lines:  # rows with names
        data["rows"] = [text.get_text() for text in axes.get_yticklabels()]
    return data


def _placed(artist: Artist, axes: Axes) -> str:
    """How an artist is placed in a panel. Raises NotOverTime for another way."""
    given = getattr(artist, "get_data_transform", artist.get_transform)()
    for transform, word in (
        (axes.transData, WHOLE),
        (axes.get_yaxis_transform(which="grid"), ACROSS),
        (axes.get_xaxis_transform(which="grid"), ALONG),
    ):
        if given == transform:
            return word
    raise NotOverTime


def _line(line: Line2D, keep: Any) -> dict[str, Any]:
    x = np.asarray(line.get_xdata(), dtype=float)
    y = np.asarray(line.get_ydata(), dtype=float)
    if (np.diff(x) < 0).any():
        raise NotOverTime
    x, y = thin_curve(x, y)
    label = str(line.get_label())
    return {
        "x": keep(x),
        "y": keep(y),
        "label": "" if label.startswith("_") else label,
        "dots": line.get_linestyle() in ("None", "")
        and line.get_marker() not in ("None", "", None),
        **_look(line),
    }


def thin_curve(x: Vector, y: Vector) -> tuple[Vector, Vector]:
    """A curve of `FIGURE.zoom_points` at most: of each stretch the least and the greatest value, in
    order.

    A value that is not finite counts as the least one: a gap stays a gap.
    """
    if len(x) <= FIGURE.zoom_points:
        return x, y
    edges = np.linspace(0, len(x), FIGURE.zoom_points // 2 + 1).astype(int)
    kept = set()
    for begin, end in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        part = y[begin:end]
        known = np.isfinite(part)
        low = np.argmin(part) if known.all() else np.argmin(known)
        high = np.argmax(np.where(known, part, -np.inf))
        kept |= {begin + int(low), begin + int(high)}
    chosen = sorted(kept | {0, len(x) - 1})
    return x[chosen], y[chosen]


def _bands(axes: Axes) -> list[dict[str, Any]]:
    """What `axvspan` and `axhspan` shade."""
    found = []
    for patch in axes.patches:
        word = _placed(patch, axes)
        box = patch.get_path().get_extents(patch.get_patch_transform())
        if word == WHOLE:
            raise NotOverTime
        ends = (box.x0, box.x1) if word == ALONG else (box.y0, box.y1)
        color, opacity = _paint(patch.get_facecolor())
        look = {"color": color, "alpha": opacity, "upright": word == ALONG}
        found.append({"from": float(ends[0]), "to": float(ends[1]), **look})
    return found


def _marks(axes: Axes) -> dict[str, list[dict[str, Any]]]:
    """Upright strokes and bars of rows: [t, from, to], and [from t, to t, from, to]."""
    from matplotlib.collections import LineCollection, PolyCollection

    marks: list[dict[str, Any]] = []
    bars: list[dict[str, Any]] = []
    for collection in axes.collections:
        paths = [np.asarray(path.vertices) for path in collection.get_paths()]
        if not paths:
            continue
        if isinstance(collection, LineCollection):
            color, _ = _paint(collection.get_edgecolor()[0])
            if any(len(path) != 2 or path[0, 0] != path[1, 0] for path in paths):
                raise NotOverTime
            places = [[float(p[0, 0]), float(p[0, 1]), float(p[1, 1])] for p in paths]
            marks.append({"color": color, "at": places})
        elif isinstance(collection, PolyCollection):
            color, opacity = _paint(collection.get_facecolor()[0])
            ends = [(*path[:, 0][[0, 2]], *path[:, 1][[0, 2]]) for path in paths]
            if any(len(path) != 5 for path in paths):
                raise NotOverTime
            places = [sorted(map(float, e[:2])) + sorted(map(float, e[2:])) for e in ends]
            bars.append({"color": color, "alpha": opacity, "at": places})
        else:
            raise NotOverTime
    return {"marks": marks, "bars": bars}


def _look(line: Line2D) -> dict[str, Any]:
    """The colour, the opacity, the width in pixels and the dashes of a line."""
    color, opacity = _paint(line.get_color(), line.get_alpha())
    dashes = {"--": [6, 4], ":": [2, 3], "-.": [6, 3, 2, 3]}.get(str(line.get_linestyle()), [])
    return {"color": color, "alpha": opacity, "width": line.get_linewidth(), "dash": dashes}


def _paint(color: Any, alpha: float | None = None) -> tuple[str, float]:
    from matplotlib.colors import to_hex, to_rgba

    return to_hex(color), round(float(to_rgba(color, alpha)[3]), 3)
