"""The picture with which a report opens: the diagram, and in colour what a trace says of it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.diagram import Diagram, find_signal, split_index
from tracewire.draw import Drawing, Needed, draw
from tracewire.show.document import Figure
from tracewire.show.limits import TRACE
from tracewire.show.trace_law import along, depends_on, has_law, is_function, is_sure, means_over
from tracewire.trace import Force, Found, Missing, signal_of, unit_at

PLAIN = "The blocks and wires of the diagram"
MEASURED = "blue names are measured"
ADDED = "green is what the trace added"
LACKING = "amber is where something is missing that no effect explains"
NEEDED = "the plot below a sum is what the data need there"


def diagram_figure(diagram: Diagram) -> Figure:
    """The figure that shows a diagram."""
    caption = f"{PLAIN}; {MEASURED}" if diagram.measured else PLAIN
    return Figure("diagram.svg", caption, lambda path: draw(diagram, measured=True).write(path))


def traced_figure(found: Found) -> Figure:
    """The figure that shows the diagram of a trace, with what it added, or what is missing."""

    def plot(path: Path) -> Path:
        return draw_trace(found).write(path)

    return Figure("diagram.svg", caption_of(found), plot)


def caption_of(found: Found) -> str:
    """What the marks in the picture of a trace mean, those alone that it has."""
    plots = has_law(found) or (found.missing is not None and len(found.missing.grid) in (1, 2))
    marks = ((bool(found.effects), ADDED), (found.missing is not None, LACKING), (plots, NEEDED))
    *first, last = [f"{PLAIN}; {MEASURED}", *(words for there, words in marks if there)]
    return f"{', '.join(first)}, and {last}" if first else last


def draw_trace(found: Found, effects: Collection[str] | None = None) -> Drawing:
    """The picture of a trace: its effects in green, and at their places what the data need there.

    effects: those that are accepted, by their texts; None: all. Subsystems with an effect are open,
    and the blocks of the diagram stand as in its own picture.
    Raises OptionError: no such effect, or a choice from a trace that was loaded.
    """
    chosen = [effect for effect in found.effects if effects is None or str(effect) in effects]
    diagram = found.apply(effects=effects)
    blocks = [effect.block for effect in chosen if effect.block]
    sensors = [effect.sensor for effect in chosen if effect.sensor]
    needed = dict(_needed(found, {effect.place for effect in chosen}))
    inside = [name for name in sensors if find_signal(diagram, name) is None]
    depth = max((name.count(".") for name in (*blocks, *needed, *inside)), default=0)
    before = draw(found.original, depth, measured=True)
    return draw(
        diagram, depth, measured=True, effects=blocks, sensors=sensors, needed=needed, like=before
    )


def _needed(found: Found, places: set[str]) -> Mapping[str, Needed]:
    """What the data need, by the full name of the block that it is needed at."""
    needed = {}
    if has_law(found):
        needed = {
            split_index(force.place)[0]: _given(found, force)
            for force in _forces(found)
            if force.place in places and len(force.needed)
        }
    if found.missing is not None:
        kind, _, signal = found.missing.place.partition(".")
        place = signal if kind in ("sensor", "drive") and signal else found.missing.place
        needed[split_index(place)[0]] = _lacking(found, found.missing)
    return needed


def _forces(found: Found) -> tuple[Force, ...]:
    try:
        return found.forces
    except Exception:  # of any kind: the figure of the forces tells why, this one the diagram
        return ()


def _given(found: Found, force: Force) -> Needed:
    """What is needed where effects were added: means of the data, and the law that was fitted."""
    over = depends_on(force)
    at, means = along(force, over), means_over(force, over)
    order = np.argsort(at, kind="stable")
    lines = (_line(at[order], force.fitted[order]),) if is_function(at, force.fitted) else ()
    sure = is_sure(means)
    dots = tuple(zip(means.at[sure].tolist(), means.mean[sure].tolist(), strict=True))
    most = max(abs(y) for line in lines or (dots,) for _, y in line)
    return Needed(dots, lines, _words(found, force.place, force.names[over], most))


def _lacking(found: Found, missing: Missing) -> Needed:
    """What is missing at a place, as a function of its first variable where samples are near."""
    rows = list(_rows(missing))
    lines = tuple(_line(missing.grid[0][known], row[known]) for row, known in rows if any(known))
    if not lines:
        return Needed(explained=False)
    names = [signal_of(found, missing.place, name) for name in missing.variables]
    most = max(abs(y) for line in lines for _, y in line)
    return Needed((), lines, _words(found, missing.place, ", ".join(names), most), explained=False)


def _rows(missing: Missing) -> Iterator[tuple[Vector, NDArray[np.bool_]]]:
    """The force over the first variable, and where samples are near, at some values of a second."""
    torque, density = missing.torque, missing.density
    if len(missing.grid) == 1:
        yield torque, density > 0
    elif len(missing.grid) == 2:
        weight = np.cumsum(density.sum(axis=0))
        numbers = np.searchsorted(weight, np.array(TRACE.among) * weight[-1])
        for number in dict.fromkeys(numbers.tolist()):
            yield torque[:, number], density[:, number] > 0


def _line(x: Vector, y: Vector) -> tuple[tuple[float, float], ...]:
    every = np.unique(np.linspace(0, len(x) - 1, min(len(x), TRACE.law_points)).astype(int))
    return tuple(zip(x[every].tolist(), y[every].tolist(), strict=True))


def _words(found: Found, place: str, over: str, most: float) -> str:
    unit = unit_at(found, place)
    size = f"{most:.3g}" if 100 <= most < 1000 else f"{most:.2g}"  # 650 and not 6.5e+02
    return f"needed: up to {size}{f' {unit}' if unit else ''} over {over}"
