"""The parts of a scene along a run, and as lines and faces of a figure."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.diagram import ScenePart
from tracewire.errors import FormulaError, OptionError, Problem
from tracewire.formula import evaluate_along
from tracewire.show.limits import SCENE
from tracewire.show.style import LINES, QUIET
from tracewire.solve import Run

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

Points = NDArray[np.float64]

COLORS = {
    "black": "#333333",
    "grey": QUIET,
    **dict(zip(("blue", "orange", "green", "pink"), LINES, strict=True)),
}
USUAL = {"rod": "black", "spring": "black", "disc": "blue", "box": "blue", "ground": "grey"}
TRACED = "orange"


@dataclass(frozen=True)
class Moved:
    """A part of a scene along a run: its points (N, 2) in m, and its sizes (N,) in SI, by key."""

    kind: str
    points: Mapping[str, Points]
    sizes: Mapping[str, Vector]
    color: str

    @property
    def reach(self) -> Points:
        """How far the part reaches around its points, to the sides and up (N, 2)."""
        if self.kind == "disc":
            return np.abs(np.column_stack([self.sizes["radius"]] * 2))
        if self.kind not in ("box", "ground"):
            return np.zeros((1, 2))
        width = self.sizes["width" if self.kind == "box" else "length"]
        height = self.sizes["height"] if self.kind == "box" else 0.06 * width
        cos, sin = np.cos(self.sizes["angle"]), np.sin(self.sizes["angle"])
        sides = np.abs(width * cos) + np.abs(height * sin)
        up = np.abs(width * sin) + np.abs(height * cos)
        return np.column_stack([sides, up]) / 2


def required_scene(model: Model | None) -> tuple[ScenePart, ...]:
    """The parts of the scene of a model. Raises OptionError where there is none."""
    if model is not None and model.scene:
        return model.scene
    file = model.diagram.file if model is not None else "the run"
    what = f"'{file}' has no scene: nothing says how it is drawn as a mechanism"
    hint = (
        "Add to the diagram: 'scene: [{rod: {from: [0, 0], to: [sin(phi), -cos(phi)]}}]', "
        "with a signal of yours."
    )
    raise OptionError([Problem(what, hint=hint)])


def moved_parts(run: Run) -> list[Moved]:
    """The parts of the scene of a run's diagram at each sample.

    Raises OptionError: no scene, a signal that was not recorded, a value that is not finite.
    """
    scene = required_scene(run.model)
    reads = run.model.read_by_scene if run.model is not None else ()
    missing = [name for name in reads if name not in run.signals]
    if missing:
        names = ", ".join(f"'{name}'" for name in missing)
        what = f"the scene reads {names}, which the run did not record"
        hint = f"Compile it with compile(diagram, record={missing!r})."
        raise OptionError([Problem(what, scene[0].place, hint=hint)])
    values: dict[str, float | Vector] = {**run.parameters, **run.signals, "t": run.t}
    return [_moved(part, values, len(run.t)) for part in scene]


def _moved(part: ScenePart, values: Mapping[str, float | Vector], count: int) -> Moved:
    try:
        points = {
            # each coordinate in a row of the memory: what takes the least of many does so at once
            key: np.array([evaluate_along(formula, values, count) for formula in point]).T
            for key, point in part.points.items()
        }
        sizes = {key: evaluate_along(f, values, count) for key, f in part.sizes.items()}
    except FormulaError as error:
        hint = "Draw from signals that are finite over the whole run."
        what = f"a {part.kind} of the scene cannot be drawn: {error.problems[0].what}"
        raise OptionError([Problem(what, part.place, hint=hint)]) from error
    coils = sizes.get("coils", np.ones(1))[0]
    if not 1 <= coils <= SCENE.most_coils:
        what = f"a spring with {coils:g} coils cannot be drawn"
        raise OptionError([Problem(what, part.place, hint=f"Give it 1 to {SCENE.most_coils}.")])
    usual = TRACED if part.kind == "trace" else USUAL[part.kind]
    return Moved(part.kind, points, sizes, COLORS[part.color or usual])


def extent_of(parts: list[Moved]) -> tuple[float, float, float, float]:
    """What a scene covers over a whole run, (left, right, bottom, top) in m, with a margin.

    Raises OptionError for a scene that is too large for a picture.
    """
    low, high = [], []
    with np.errstate(over="ignore"):
        for part in parts:
            for points in part.points.values():
                low.append((points - part.reach).min(axis=0))
                high.append((points + part.reach).max(axis=0))
    least, most = np.min(low, axis=0), np.max(high, axis=0)
    largest = float(np.abs([least, most]).max())
    if not largest < SCENE.largest:
        what = f"the scene reaches as far as {largest:g} m, and cannot be drawn"
        raise OptionError([Problem(what, hint="Give a shorter span, or draw what stays near.")])
    # a point alone, and one far away, have a surrounding, too
    margin = 0.08 * max(float((most - least).max()), 1e-6 * largest, 1e-9)
    left, bottom = least - margin
    right, top = most + margin
    return float(left), float(right), float(bottom), float(top)


Update = Callable[[int], None]


def add_part(panel: Axes, part: Moved, t: Vector, size: float) -> tuple[list[Artist], Update]:
    """Add a part to a panel: its artists, and what sets them to a sample by its number.

    t: the times (N,) in s; size: the extent of the scene in m.
    """
    return ADD[part.kind](panel, part, t, size)


def _rod(panel: Axes, part: Moved, t: Vector, size: float) -> tuple[list[Artist], Update]:
    (rod,) = panel.plot([], [], color=part.color, linewidth=3, solid_capstyle="round", zorder=3)
    (ends,) = panel.plot(
        [], [], "o", color=part.color, markerfacecolor="white", markersize=5, zorder=3.5
    )

    def update(k: int) -> None:
        both = np.array([part.points["from"][k], part.points["to"][k]]).T
        rod.set_data(*both)
        ends.set_data(*both)

    return [rod, ends], update


def _spring(panel: Axes, part: Moved, t: Vector, size: float) -> tuple[list[Artist], Update]:
    (wire,) = panel.plot([], [], color=part.color, linewidth=1.3, zorder=2.5)
    coils = round(float(part.sizes["coils"][0]))
    # a straight piece at each end, and between them from side to side
    along = np.array([0.0, *np.linspace(0.1, 0.9, 4 * coils + 1), 1.0])
    across = np.array([0.0, *np.resize([0.0, 0.5, 0.0, -0.5], 4 * coils + 1), 0.0])

    def update(k: int) -> None:
        begin, end = part.points["from"][k], part.points["to"][k]
        way = end - begin
        length = float(np.hypot(*way))
        normal = np.array([-way[1], way[0]]) / length if length else np.zeros(2)
        width = float(part.sizes["width"][k]) if "width" in part.sizes else SCENE.spring * size
        wire.set_data(*(begin + np.outer(along, way) + np.outer(across, width * normal)).T)

    return [wire], update


def _disc(panel: Axes, part: Moved, t: Vector, size: float) -> tuple[list[Artist], Update]:
    from matplotlib.patches import Circle

    disc = Circle((0, 0), 1, facecolor=part.color, edgecolor="#333333", linewidth=1, zorder=4)
    panel.add_patch(disc)
    (spoke,) = panel.plot([], [], color="white", linewidth=1.5, zorder=4.5)
    turned = part.sizes.get("angle")

    def update(k: int) -> None:
        (x, y), radius = part.points["at"][k], abs(float(part.sizes["radius"][k]))
        disc.set_center((x, y))
        disc.set_radius(radius)
        if turned is not None:
            way = 0.85 * radius * np.array([np.cos(turned[k]), np.sin(turned[k])])
            spoke.set_data([x - way[0], x + way[0]], [y - way[1], y + way[1]])

    return [disc, spoke], update


def _box(panel: Axes, part: Moved, t: Vector, size: float) -> tuple[list[Artist], Update]:
    from matplotlib.patches import Polygon

    box = Polygon(
        np.zeros((4, 2)), facecolor=part.color, edgecolor="#333333", linewidth=1, zorder=3
    )
    panel.add_patch(box)
    corners = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])

    def update(k: int) -> None:
        sides = np.array([part.sizes["width"][k], part.sizes["height"][k]])
        box.set_xy(part.points["at"][k] + (corners * sides) @ _turn(part.sizes["angle"][k]).T)

    return [box], update


def _ground(panel: Axes, part: Moved, t: Vector, size: float) -> tuple[list[Artist], Update]:
    from matplotlib.collections import LineCollection

    widths = [2.0] + [0.8] * SCENE.hatches
    lines = LineCollection([], colors=part.color, linewidths=widths, zorder=1)
    panel.add_collection(lines, autolim=False)

    def update(k: int) -> None:
        length = float(part.sizes["length"][k])
        deep = min(0.03 * size, abs(length) / SCENE.hatches * 1.5)
        at = np.linspace(-0.5, 0.5, SCENE.hatches + 1)[1:] * length
        strokes = [np.array([[x, 0.0], [x - deep, -deep]]) for x in at]
        turn = _turn(part.sizes["angle"][k])
        pieces = [np.array([[-length / 2, 0.0], [length / 2, 0.0]]), *strokes]
        lines.set_segments([piece @ turn.T + part.points["at"][k] for piece in pieces])

    return [lines], update


def _trace(panel: Axes, part: Moved, t: Vector, size: float) -> tuple[list[Artist], Update]:
    (line,) = panel.plot([], [], color=part.color, linewidth=1, alpha=0.8, zorder=2)
    seconds = float(part.sizes["seconds"][0]) if "seconds" in part.sizes else np.inf

    def update(k: int) -> None:
        first = int(np.searchsorted(t, t[k] - seconds))
        line.set_data(*part.points["at"][first : k + 1].T)

    return [line], update


def _turn(angle: float) -> Points:
    """The matrix that turns a point to the left by an angle in rad."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


Add = Callable[["Axes", Moved, Vector, float], tuple[list["Artist"], Update]]
ADD: dict[str, Add] = {
    "rod": _rod,
    "spring": _spring,
    "disc": _disc,
    "box": _box,
    "ground": _ground,
    "trace": _trace,
}
