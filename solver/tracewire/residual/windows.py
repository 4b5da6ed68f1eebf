"""Windows: a series cut into short runs whose start states are free.

A window begins at the last sample of the one before it, so that the end of one is a start for the
next. Its start states are projected out where it stands: what is left of the residual and of the
derivatives when all that a start could explain is taken away (variable projection).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.residual.criterion import Criterion
from tracewire.residual.limits import WINDOW
from tracewire.residual.linearisation import Linearisation, Projection
from tracewire.residual.measured import Measured
from tracewire.residual.past import longest_delay
from tracewire.residual.rest import states_along_inputs
from tracewire.residual.segment import Segment
from tracewire.residual.starts import start_from_data, whole_segment
from tracewire.solve import parameter_values


@dataclass(frozen=True, eq=False)
class Section:
    """Samples `first` to `end` of a series, which are cut into windows."""

    measured: Measured
    first: int
    end: int

    @property
    def count(self) -> int:
        """How many samples they are."""
        return self.end - self.first


def cut_windows(model: Model, section: Section, length: int, free: Sequence[str]) -> list[Segment]:
    """A section as windows of about `length` samples, each with free starts of the states `free`.

    A window that begins where the series does begins as the series says; where that start is
    declared, it is not free. Where no state is free at all, as with a prescribed motion, there is
    one window, whose run begins where the series does: what has a memory keeps it. The first window
    is at least as long as the longest delay, so that the others find their past in the record. No
    window goes over a gap in the samples that is longer than the window: the next one begins behind
    it.
    """
    measured = section.measured
    whole = whole_segment(model, measured)
    first = max(section.first, int(whole.rows[0]))
    if not free and not whole.free:
        return [replace(whole, rows=np.arange(first, section.end))]
    known = float(measured.t[0]) + longest_delay(model, measured)
    edges = edges_within(Section(measured, first, section.end), length)
    edges = [a for a in edges if a in (first, section.end) or measured.t[a - 1] >= known]
    windows = []
    for a, b in pairwise(edges):
        if a == int(whole.rows[0]):
            rows = np.arange(a, b)
            windows.append(Segment(measured, whole.begin, rows, whole.start, whole.free))
            continue
        t = measured.t
        row = a if t[a] - t[a - 1] > t[b - 1] - t[a] and b - a > 1 else a - 1
        states = start_from_data(model, measured, row)
        start = {**whole.start, **{name: states[name] for name in free if name in states}}
        for name in free:
            start.setdefault(name, 0.0)
        windows.append(Segment(measured, float(t[row]), np.arange(a, b), start, tuple(free)))
    return windows


def edges_within(section: Section, length: int) -> list[int]:
    """Where a section is cut into parts of about `length` samples: into equal parts, and behind
    each gap in time that is longer than a part, where half a part or more is on either side."""
    count = max(round(section.count / length), 1)
    edges: list[int] = np.linspace(section.first, section.end, count + 1).astype(int).tolist()
    if count == 1:
        return edges
    steps = np.diff(section.measured.t[section.first : section.end])
    half = section.count / count / 2
    gaps = np.flatnonzero(steps > 2 * half * np.median(steps)) + section.first + 1
    behind = [row for row in gaps.tolist() if _is_far(row, (section.first, section.end), half)]
    others = [edge for edge in edges[1:-1] if _is_far(edge, behind, half)]
    return sorted({section.first, section.end, *behind, *others})


def _is_far(row: int, others: Sequence[int], least: float) -> bool:
    """Whether a row is at least so many rows from others."""
    return all(abs(row - other) >= least for other in others)


def with_lead_in(model: Model, segment: Segment, values: Mapping[str, float]) -> Segment:
    """A window whose run begins so early that its first samples are seen through the delays of
    sensors, with the unknowns in `values`; where its start is not free, as it is."""
    measured, first = segment.measured, float(segment.t[0])
    signals = segment.signals
    delay = max(values.get(f"delay.{name}", measured.sensor(name).delay) for name in signals)
    begin = first - WINDOW.ahead * delay
    if not segment.free or segment.begin <= begin:
        return segment
    row = int(np.searchsorted(measured.t, begin, side="right")) - 1
    return replace(segment, begin=begin) if row < 0 else _begun_at(model, segment, row, values)


def with_memory(
    model: Model,
    segments: Sequence[Segment],
    lasting: Sequence[str] = (),
    values: Mapping[str, float] | None = None,
) -> list[Segment]:
    """Windows whose runs find what a model remembers beside the states that are free at a start.

    A lag or a hysteresis begins as its block says, which is wrong inside a record. A lag of an
    input is where the input has led it, with the parameters in `values`. What else is remembered
    is as an earlier run has left it (`memory`). Where there was none, the run of a window that
    follows no other begins ahead of it, by twice its length or a tenth of the series. Other states
    that are `lasting` are free there: no run ahead would forget where they began. So is a lag where
    a record begins, which tells nothing of its input before.
    """
    found: list[Segment] = []
    remembers = any(mode.kind == "memory" for mode in model.modes)
    for n, segment in enumerate(segments):
        follows = n > 0 and segment.continues(segments[n - 1])
        if not segment.free or follows:
            found.append(segment)
            continue
        t, row = segment.measured.t, int(segment.rows[0]) - 1
        led = _led_by_inputs(model, segment, values or {})
        if unknown := [state for state in lasting if state not in led]:
            start = {**dict.fromkeys(unknown, 0.0), **segment.start}
            free = tuple(dict.fromkeys((*segment.free, *unknown)))
            segment = replace(segment, start=start, free=free)
        memory = {**segment.memory, **led}
        known = set(model.states) <= {*segment.free, *memory} and not remembers
        if led and row < 0:
            segment = replace(segment, start={**led, **segment.start})
        elif memory and known:
            segment = replace(segment, start={**segment.start, **memory})
        elif not known and row > 0 and segment.begin >= t[row]:
            most = WINDOW.remembered_windows * len(segment.rows)
            ahead = min(int(WINDOW.remembered * len(t)), most)
            segment = _begun_at(model, segment, max(row - ahead, 0), values or {})
        found.append(segment)
    return found


def _led_by_inputs(model: Model, segment: Segment, values: Mapping[str, float]) -> dict[str, float]:
    """The states that are not free and follow inputs alone, where the run of a window begins."""
    measured, own = segment.measured, model.flat.parameters
    given = {name: value for name, value in values.items() if name in own}
    known = parameter_values(model, {**given, **measured.parameters}, measured.preset)
    inputs = {name: u for name, u in measured.inputs.items() if u[0][0] < segment.begin}
    led = states_along_inputs(model, known, inputs, segment.begin)
    return {name: value for name, value in led.items() if name not in segment.free}


def _begun_at(model: Model, segment: Segment, row: int, values: Mapping[str, float]) -> Segment:
    """A window whose run begins at a row of its series, with the free states that the data tell,
    and those that its inputs have led there."""
    states = start_from_data(model, segment.measured, row)
    start = {name: states[name] for name in segment.free if name in states}
    begun = replace(segment, begin=float(segment.measured.t[row]), memory={})
    led = _led_by_inputs(model, begun, values)
    return replace(begun, start={**segment.start, **start, **led})


@dataclass(frozen=True, eq=False)
class Windows:
    """Windows at some values of the unknowns: their starts, and each of them linearised there.

    A window whose mean squared residual is at most `inlier_limit`, in the noise's variance, is not
    astray.
    """

    criterion: Criterion
    values: Mapping[str, float]
    starts: tuple[Mapping[str, float], ...]
    linearisations: tuple[Linearisation, ...]
    inlier_limit: float = 2.0

    @property
    def squares(self) -> Vector:
        """The sum of squared residuals of each window, in sigma."""
        return np.array([near.square for near in self.linearisations])

    @property
    def rss(self) -> float:
        """The sum of squared residuals."""
        return float(np.sum(self.squares))

    @property
    def projections(self) -> list[Projection]:
        """What the start of each window can explain."""
        return [near.projection for near in self.linearisations]

    @property
    def residuals(self) -> list[Vector]:
        """The residuals in sigma by window, shape (N, signals)."""
        return [near.residual for near in self.linearisations]

    @property
    def segments(self) -> list[Segment]:
        """The windows with their fitted starts, and memories as the window before has left them."""
        found = []
        for n, segment in enumerate(self.criterion.segments):
            left = self.linearisations[n - 1].final if self.criterion.follows(n) else {}
            memory = {name: x for name, x in left.items() if name not in segment.free}
            start = {**segment.start, **memory, **self.starts[n]}
            found.append(replace(segment, start=start, memory=memory or segment.memory))
        return found


def project_out_initial_states(windows: Windows) -> tuple[Matrix, Vector]:
    """Derivatives (M, unknowns) in SI and residuals (M,) without what the starts can explain."""
    count = len(windows.values)
    reduced = np.concatenate(
        [n.projection.project_out(n.slopes[:, :count]) for n in windows.linearisations]
    )
    residual = np.concatenate(
        [n.projection.project_out(n.residual.ravel()) for n in windows.linearisations]
    )
    return reduced, residual


def evaluate_windows(criterion: Criterion, inlier_limit: float = 2.0) -> Windows:
    """The windows where their segments begin; `inlier_limit` as in Windows."""
    values = {u.name: u.value for u in criterion.unknowns}
    starts = [{name: s.start[name] for name in s.free} for s in criterion.segments]
    near = criterion.linearise(values, dict(enumerate(starts)))
    linearisations = tuple(near[n] for n in range(len(starts)))
    return Windows(criterion, values, tuple(starts), linearisations, inlier_limit)


def with_initial_states(windows: Windows, starts: Mapping[int, Mapping[str, float]]) -> Windows:
    """The windows with other starts of some, by number; the unknowns stay.

    Where memories go on from one to the next all of them run, else those.
    """
    if not starts:
        return windows
    there = {**dict(enumerate(windows.starts)), **starts}
    run = there if windows.criterion.remembers else starts
    found = windows.criterion.linearise(windows.values, run)
    near = tuple(found.get(n, old) for n, old in enumerate(windows.linearisations))
    return replace(windows, starts=tuple(there[n] for n in range(len(near))), linearisations=near)


def keep_better(windows: Windows, other: Windows, rows: Sequence[int]) -> Windows:
    """The windows with those of some others where these do better."""
    starts, near = list(windows.starts), list(windows.linearisations)
    for n in rows:
        if other.linearisations[n].square < near[n].square:
            starts[n], near[n] = other.starts[n], other.linearisations[n]
    return replace(windows, starts=tuple(starts), linearisations=tuple(near))
