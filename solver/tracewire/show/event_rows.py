"""What happened in a run, as rows of marks over time: one for each block that had events."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from tracewire.show.limits import FIGURE
from tracewire.show.sticking import Interval, join_intervals, stick_intervals
from tracewire.show.style import EDGE, MARK, QUIET, STICK, cut
from tracewire.solve import Event, Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STRONG = ("impact", "reset", "rest")
"""Events that change a state, or end a motion."""
TICK = "tick"
"""A reset by the clock of a sampled block: what that block does all the time."""
WEAK = ("crossing", "scheduled", "transition", TICK)
CLOCK = "clock of "
"""How the guard of a clock begins."""


def event_rows(run: Run) -> list[str]:
    """The blocks that had events, in the order of the first, and one row for all that are left."""
    names = list(dict.fromkeys(event.block for event in run.events))
    if len(names) <= FIGURE.event_rows:
        return names
    return [*names[: FIGURE.event_rows - 1], f"{len(names) - FIGURE.event_rows + 1} others"]


def is_tick(run: Run, event: Event) -> bool:
    """Whether an event is a tick of the clock of a block, and not one that the diagram declares."""
    known = run.model is None or event.block in run.model.flat.blocks
    return event.kind == "reset" and event.guard.startswith(CLOCK) and known


def jump_times(run: Run, signals: Collection[str]) -> list[float]:
    """The times in s at which an event gives one of these signals another value."""
    times = (
        event.time
        for event in run.events
        if event.kind in STRONG
        and any(n in signals and event.before[n] != after for n, after in event.after.items())
    )
    return list(dict.fromkeys(times))


def draw_events(panel: Axes, run: Run, rows: Sequence[str], shaded: bool = False) -> None:
    """Draw the events of a run into a panel; `shaded`: the panels above show what sticks, too."""
    position = {name: n for n, name in enumerate(rows)}
    last = len(rows) - 1
    for block, intervals in stick_intervals(run).items():
        at = position.get(block, last)
        # as long as it sticks; the edge is seen where a bar is thinner than a pixel
        _draw_bars(panel, intervals, at, 0.3, facecolor=STICK, edgecolor=EDGE, linewidth=0.9)
    kinds_of = [TICK if is_tick(run, event) else event.kind for event in run.events]
    counts = [0] * len(rows)
    for event in run.events:
        counts[position.get(event.block, last)] += 1
    apart = _span(run) / FIGURE.apart
    for kinds, color, half in ((WEAK, QUIET, 0.2), (STRONG, MARK, 0.38)):
        for row in range(len(rows)):
            times = [
                event.time
                for event, kind in zip(run.events, kinds_of, strict=True)
                if kind in kinds and position.get(event.block, last) == row
            ]
            groups = join_intervals(((time, time) for time in times), apart)
            many = [(begin, end) for begin, end in groups if end > begin]
            _draw_bars(panel, many, row, half, facecolor=color, alpha=FIGURE.dense, linewidth=0)
            marks = list(dict.fromkeys(time for ends in groups for time in ends))
            panel.vlines(marks, row - half, row + half, color=color, linewidth=0.9)
    labels = (f"{cut(name)} ({count})" for name, count in zip(rows, counts, strict=True))
    panel.set_yticks(range(len(rows)), list(labels))
    panel.set_ylim(last + 0.6, -0.6)
    panel.grid(False)
    panel.spines["left"].set_visible(False)
    panel.tick_params(axis="y", length=0)
    legend = _legend(set(kinds_of), shaded)
    panel.set_title(legend, fontsize=8.5, color="#555555", loc="left", pad=3)


def _span(run: Run) -> float:
    return float(run.t[-1] - run.t[0])


def _draw_bars(
    panel: Axes, intervals: Sequence[Interval], row: int, half: float, **look: object
) -> None:
    """Draw intervals of time as bars of a row."""
    spans = [(begin, end - begin) for begin, end in intervals]
    panel.broken_barh(spans, (row - half, 2 * half), **look)  # type: ignore[arg-type]


def _legend(kinds: Collection[str], shaded: bool) -> str:
    parts = []
    if "stick" in kinds or "slip" in kinds:
        parts.append("bar and shade: sticks" if shaded else "bar: sticks")
    if strong := [kind for kind in STRONG if kind in kinds]:
        parts.append(f"long, red: {', '.join(strong)}")
    if weak := [kind for kind in WEAK if kind in kinds]:
        parts.append(f"short, grey: {', '.join(weak)}")
    return "events   " + "    ".join(parts)
