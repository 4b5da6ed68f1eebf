"""Windows: a series cut into short runs whose start states are free, and how they are fitted.

A window begins at the last sample of the one before it, so that the end of one is a start for the
next. Its start states are eliminated where it stands: what is left of the residual and of the
derivatives when all that a start could explain is taken away (variable projection).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from tracewire.compile import Model
from tracewire.fit.criterion import Criterion
from tracewire.fit.linearised import Linearised
from tracewire.fit.measured import Measured
from tracewire.fit.segment import Segment
from tracewire.fit.starts import start_from_data, whole_segment

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
UNSEEN = 1e-7
"""A direction of a window's start that moves its residual less than this part of the strongest."""
SETTLING, RESCUING = 8, 2
FAR_OFF = 100.0
"""A start this many scales of its state away from the one that the data show."""
AHEAD = 2.0
"""How many delays of a sensor a window's run begins ahead of its first sample: a fit may find a
longer delay than it began with."""
CONVERGED = 1e-4
CREEPS = 5e-4
"""A step that gains less than this part of the sum of squares is the last one."""
SETTLED = 0.05
"""What is still to gain, in units of the noise's variance, where a fit has converged."""
FIRST_DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-3, 1e-9, 1e6
MOST_FAILURES = 8
PATIENCE, HOPE = 4, 2.0
"""Steps in a row that are too slow until a fit is given up, and how many times the gain that its
pace promises may still come."""


@dataclass(frozen=True, eq=False)
class Section:
    """Samples `first` to `end` of a series, which are cut into windows."""

    measured: Measured
    first: int
    end: int


def cut(model: Model, section: Section, length: int, free: Sequence[str]) -> list[Segment]:
    """A section as windows of about `length` samples, each with free starts of the states `free`.

    A window that begins where the series does begins as the series says; where that start is
    declared, it is not free. Where no state is free at all, as with a prescribed motion, there is
    one window, whose run begins where the series does: what has a memory keeps it.
    """
    measured = section.measured
    whole = whole_segment(model, measured)
    first = max(section.first, int(whole.rows[0]))
    if not free and not whole.free:
        return [replace(whole, rows=np.arange(first, section.end))]
    count = max(round((section.end - first) / length), 1)
    edges = np.linspace(first, section.end, count + 1).astype(int).tolist()
    windows = []
    for a, b in pairwise(edges):
        if a == int(whole.rows[0]):
            start = {name: whole.start[name] for name in free if name in whole.start}
            start |= {name: whole.start.get(name, 0.0) for name in whole.free}
            windows.append(Segment(measured, whole.begin, np.arange(a, b), start, whole.free))
            continue
        told = start_from_data(model, measured, a - 1)
        start = {**whole.start, **{name: told[name] for name in free if name in told}}
        for name in free:
            start.setdefault(name, 0.0)
        begin = float(measured.t[a - 1])
        windows.append(Segment(measured, begin, np.arange(a, b), start, tuple(free)))
    return windows


def begun_before(model: Model, segment: Segment, delays: Mapping[str, float]) -> Segment:
    """A window whose run begins so early that its first samples are seen through delays in s, by
    the name of the sensor's unknown; where its start is not free, as it is."""
    measured, first = segment.measured, float(segment.t[0])
    signals = segment.signals
    delay = max(delays.get(f"delay.{name}", measured.sensor(name).delay) for name in signals)
    begin = first - AHEAD * delay
    if not segment.free or segment.begin <= begin:
        return segment
    row = int(np.searchsorted(measured.t, begin, side="right")) - 1
    if row < 0:
        return replace(segment, begin=begin)
    told = start_from_data(model, measured, row)
    start = {name: told[name] for name in segment.free if name in told}
    return replace(segment, begin=float(measured.t[row]), start={**segment.start, **start})


@dataclass(frozen=True, eq=False)
class Windows:
    """Windows at some values of the unknowns: their starts, and each of them linearised there."""

    criterion: Criterion
    values: Mapping[str, float]
    starts: tuple[Mapping[str, float], ...]
    near: tuple[Linearised, ...]

    @property
    def squares(self) -> Vector:
        """The sum of squared residuals of each window, in sigma."""
        return np.array([near.square for near in self.near])

    @property
    def rss(self) -> float:
        """The sum of squared residuals."""
        return float(np.sum(self.squares))

    @property
    def residuals(self) -> list[Vector]:
        """The residuals in sigma by window, shape (N, signals)."""
        return [near.residual for near in self.near]

    @property
    def segments(self) -> list[Segment]:
        """The windows with their fitted starts, and memories as the window before has left them."""
        found = []
        for n, segment in enumerate(self.criterion.segments):
            left = self.near[n - 1].final if self.criterion.follows(n) else {}
            start = {**segment.start, **left, **self.starts[n]}
            found.append(replace(segment, start=start))
        return found


@dataclass(frozen=True, eq=False)
class Projection:
    """A window without what its start can explain: an orthonormal basis of that, (N*signals, r),
    and the start's answer to a residual, (states, N*signals)."""

    basis: Matrix
    answer: Matrix

    def off(self, columns: Matrix) -> Matrix:
        """Columns without what the start can explain."""
        return np.asarray(columns - self.basis @ (self.basis.T @ columns))


def projection(windows: Windows, n: int) -> Projection:
    """What the start of window n can explain."""
    segment = windows.criterion.segments[n]
    scales = np.array([segment.start_scale(name) for name in segment.free])
    moved = windows.near[n].slopes[:, len(windows.values) :] * scales
    if not moved.size:
        return Projection(np.zeros((len(moved), 0)), np.zeros((0, len(moved))))
    left, singular, right = np.linalg.svd(moved, full_matrices=False)
    kept = singular > UNSEEN * max(float(singular[0]), 1e-300)
    answer = (scales[:, None] * right[kept].T / singular[kept]) @ left[:, kept].T
    return Projection(left[:, kept], answer)


def opened(criterion: Criterion) -> Windows:
    """The windows where their segments begin."""
    values = {u.name: u.value for u in criterion.unknowns}
    starts = [{name: s.start[name] for name in s.free} for s in criterion.segments]
    near = criterion.linearised(values, dict(enumerate(starts)))
    return Windows(criterion, values, tuple(starts), tuple(near[n] for n in range(len(starts))))


def begun_at(windows: Windows, starts: Mapping[int, Mapping[str, float]]) -> Windows:
    """The windows with other starts of some, by number; the unknowns stay.

    Where memories go on from one to the next all of them run, else those.
    """
    if not starts:
        return windows
    there = {**dict(enumerate(windows.starts)), **starts}
    run = there if windows.criterion.remembers else starts
    found = windows.criterion.linearised(windows.values, run)
    near = tuple(found.get(n, old) for n, old in enumerate(windows.near))
    return replace(windows, starts=tuple(there[n] for n in range(len(near))), near=near)


def better(windows: Windows, other: Windows, rows: Sequence[int]) -> Windows:
    """The windows with those of some others where these do better."""
    starts, near = list(windows.starts), list(windows.near)
    for n in rows:
        if other.near[n].square < near[n].square:
            starts[n], near[n] = other.starts[n], other.near[n]
    return replace(windows, starts=tuple(starts), near=tuple(near))


def settled(windows: Windows) -> Windows:
    """The starts alone fitted, each window for itself; the unknowns stay.

    A window whose start is led astray (a start inside a stiff barrier kicks it away) is tried from
    the end of the window before it.
    """
    windows = _settled(windows, range(len(windows.near)), SETTLING)
    off = [n for n, near in enumerate(windows.near) if not _is_good(near)]
    return _again(_from_ends(windows, off, SETTLING))


def _from_ends(windows: Windows, rows: Sequence[int], steps: int) -> Windows:
    """Some windows from the ends of those before them, where that does better; once more, where the
    one before has changed by that."""
    changed = {n - 1 for n in rows}
    while True:
        off = [n for n in rows if n - 1 in changed and not _is_good(windows.near[n])]
        there = begun_at(windows, _ends_before(windows, off))
        tried = [n for n in off if there.starts[n] is not windows.starts[n]]
        if not tried:
            return windows
        found = better(windows, _settled(there, tried, steps), tried)
        changed = {n for n in tried if found.starts[n] is not windows.starts[n]}
        windows = found


def _is_good(near: Linearised) -> bool:
    """Whether a window is so near the noise that it is not astray."""
    return near.square <= 2 * near.residual.size


def _again(windows: Windows) -> Windows:
    """The windows with memories as they are after starts of some have moved."""
    remembers = windows.criterion.remembers
    return begun_at(windows, dict(enumerate(windows.starts))) if remembers else windows


def _ends_before(windows: Windows, rows: Sequence[int]) -> dict[int, Mapping[str, float]]:
    """The ends of the windows before some, which are starts for these, by number."""
    found: dict[int, Mapping[str, float]] = {}
    for n in rows:
        ends = windows.near[n - 1].final if windows.criterion.follows(n) else {}
        if ends:
            found[n] = {name: ends[name] for name in windows.starts[n]}
    return found


def _settled(windows: Windows, rows: Sequence[int], steps: int) -> Windows:
    """The starts of some windows fitted by damped Gauss-Newton steps, each for itself."""
    share = {n: 1.0 for n in rows if windows.starts[n]}
    answers: dict[int, Vector] = {}
    for _ in range(steps):
        moved: dict[int, Mapping[str, float]] = {}
        for n in list(share):
            near = windows.near[n]
            if n not in answers:
                view = projection(windows, n)
                gain = float(np.sum((view.basis.T @ near.residual.ravel()) ** 2))
                if gain < max(SETTLED, CONVERGED * near.square):
                    del share[n]
                    continue
                answers[n] = -view.answer @ near.residual.ravel()
            start = np.array(list(windows.starts[n].values())) + share[n] * answers[n]
            moved[n] = dict(zip(windows.starts[n], start.tolist(), strict=True))
            if _far_off(windows, n, moved[n]):
                share[n] /= 4
                del moved[n]
        if not share:
            break
        there = begun_at(windows, moved)
        for n in moved:
            if not there.near[n].ran:
                del share[n]
            elif there.near[n].square < windows.near[n].square:
                share[n] = min(2 * share[n], 1.0)
                del answers[n]
            else:
                share[n] /= 4
        windows = better(windows, there, list(moved))
    return windows


def descended(windows: Windows, steps: int = 20, target: float = np.inf) -> tuple[Windows, bool]:
    """The unknowns and all starts fitted by Levenberg and Marquardt; whether it converged.

    Each step comes from the problem without the starts, within the bounds of the unknowns. Windows
    that do worse than the step promised are settled for themselves before it is judged. It ends
    early where the sum of squares would not fall to `target` at its pace in the steps that are
    left: it has lost against what reached that.
    """
    unknowns = windows.criterion.unknowns
    low, high = np.array([u.low for u in unknowns]), np.array([u.high for u in unknowns])
    scales = np.array([u.scale for u in unknowns])
    damping, failures = FIRST_DAMPING, 0
    windows = settled(windows)
    if not len(unknowns):
        return windows, True
    gained, too_slow = np.inf, 0
    for left_over in reversed(range(steps)):
        views = [projection(windows, n) for n in range(len(windows.near))]
        reduced, residual = eliminated(windows, views)
        reduced = reduced * scales
        values = np.array([windows.values[u.name] for u in unknowns])
        room = (low - values) / scales, (high - values) / scales
        refused = False
        while True:
            step = _bounded(reduced, residual, damping, room)
            left = residual + reduced @ step
            promised = float(residual @ residual - left @ left)
            start_gain = windows.rss - float(residual @ residual)
            if promised + start_gain < max(SETTLED, CONVERGED * windows.rss):
                return windows, True
            there = _moved(windows, views, step * scales)
            failures += there is None
            if there is not None and there.rss < windows.rss:
                before, gained = gained, windows.rss - there.rss
                windows = there
                # what was refused a moment ago would be refused again
                damping = damping if refused else max(damping / 10, LEAST_DAMPING)
                break
            if there is not None and there.rss < (1 + CREEPS) * windows.rss:
                return windows, True  # as flat as the solver is exact
            damping = max(damping * (100 if refused else 10), FIRST_DAMPING)
            refused = True
            if damping > MOST_DAMPING or failures > MOST_FAILURES:
                return windows, False
        if gained < max(SETTLED, CREEPS * windows.rss):
            return windows, True
        pace = min(gained / before, 1 - 1e-9)
        coming = HOPE * gained * min(left_over, pace / (1 - pace))
        too_slow = too_slow + 1 if windows.rss - coming > target else 0
        if too_slow >= PATIENCE:
            return windows, False
    return windows, False


def eliminated(windows: Windows, views: Sequence[Projection]) -> tuple[Matrix, Vector]:
    """Derivatives (M, unknowns) in SI and residuals (M,) without what the starts can explain."""
    count = len(windows.values)
    pairs = list(zip(views, windows.near, strict=True))
    reduced = np.concatenate([view.off(near.slopes[:, :count]) for view, near in pairs])
    residual = np.concatenate([view.off(near.residual.ravel()) for view, near in pairs])
    return reduced, residual


def _bounded(
    reduced: Matrix, residual: Vector, damping: float, room: tuple[Vector, Vector]
) -> Vector:
    """The step that minimises the squares, damped by the sizes of its columns, within bounds."""
    corner = np.asarray(np.linalg.qr(np.column_stack((reduced, residual)), mode="r"))
    count = reduced.shape[1]
    sizes = np.linalg.norm(reduced, axis=0)
    damped = np.diag(np.sqrt(damping) * np.maximum(sizes, 1e-12 * max(sizes.max(), 1e-300)))
    matrix = np.vstack((corner[:, :count], damped))
    target = np.concatenate((-corner[:, count], np.zeros(count)))
    low, high = np.minimum(room[0], 0.0), np.maximum(room[1], 0.0)
    high = np.maximum(high, low + 1e-12)
    sizes = np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
    found = lsq_linear(matrix / sizes, target, (low * sizes, high * sizes), method="bvls")
    return np.asarray(found.x / sizes)


def _moved(windows: Windows, views: Sequence[Projection], step: Vector) -> Windows | None:
    """The windows after a step of the unknowns, their starts following by the linear answer; None
    where one does not run."""
    count = len(windows.values)
    names = windows.values
    values = {name: windows.values[name] + float(d) for name, d in zip(names, step, strict=True)}
    for u in windows.criterion.unknowns:
        values[u.name] = min(max(values[u.name], u.low), u.high)
    starts: dict[int, Mapping[str, float]] = {}
    promised = []
    for n, (view, old) in enumerate(zip(views, windows.near, strict=True)):
        expected = old.residual.ravel() + old.slopes[:, :count] @ step
        moved = np.array(list(windows.starts[n].values())) - view.answer @ expected
        start: Mapping[str, float] = dict(zip(windows.starts[n], moved.tolist(), strict=True))
        starts[n] = windows.starts[n] if _far_off(windows, n, start) else start
        promised.append(float(np.sum(view.off(expected) ** 2)))
    there = begun_at(replace(windows, values=values), starts)
    # a start that is led into a barrier is kicked away
    lost = [n for n, old in enumerate(windows.near) if old.ran and not there.near[n].ran]
    there = begun_at(there, {n: windows.starts[n] for n in lost})
    if not all(there.near[n].ran for n in lost):
        return None
    limits = 2 * np.array(promised) + 2 * np.array([x.residual.size for x in there.near])
    far = np.flatnonzero(there.squares > np.maximum(limits, windows.squares)).tolist()
    return _rescued(there, {n: windows.starts[n] for n in far}) if far else there


def _rescued(windows: Windows, before: Mapping[int, Mapping[str, float]]) -> Windows:
    """Some windows from where they were `before`, or from the ends of those before them, where that
    does better."""
    rows = list(before)
    tried = better(windows, begun_at(windows, before), rows)
    ends = _ends_before(tried, rows)
    tried = better(tried, begun_at(tried, ends), list(ends))
    return _again(_from_ends(_settled(tried, rows, RESCUING), rows, RESCUING))


def _far_off(windows: Windows, n: int, start: Mapping[str, float]) -> bool:
    """Whether a start is where no body of this record can be: no run is worth its time there."""
    segment = windows.criterion.segments[n]
    return any(
        not abs(value - segment.start.get(name, 0.0)) < FAR_OFF * segment.start_scale(name)
        for name, value in start.items()
    )
