"""The two horizons of prediction, and the blocks of time on which models are compared.

A record is cut into blocks that are as long as the longer horizon: five periods of the motion, so
that there are 7 to 20 of them. Windows of the shorter horizon, a third of a period, tile the same
blocks, of a long record a part of each. Where a body has come to rest for good there are no blocks:
nothing can be claimed there, and its samples are in every fit. What is missing in a sensor, or as a
ripple, shows in the short windows; friction and drift show in the long ones. Where no start is
free, or the motion has no period, there is one horizon, and the blocks are pieces of its runs.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.residual import Section, Segment, cut_windows, edges_within
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.period import period_of

Ints = NDArray[np.intp]
REST = -1
"""The block of samples at rest, which is never left out."""


@dataclass(frozen=True, eq=False)
class Horizon:
    """The windows of a horizon over all fitted data, of about `length` samples, and for each of
    them the block of each of its rows."""

    length: int
    segments: tuple[Segment, ...]
    blocks: tuple[Ints, ...]

    def without(self, blocks: Sequence[int]) -> list[tuple[int, Ints]]:
        """The windows that keep rows outside of some blocks: number and these rows."""
        return self._where(blocks, inside=False)

    def within(self, blocks: Sequence[int]) -> list[tuple[int, Ints]]:
        """The windows that have rows in some blocks: number and these rows."""
        return self._where(blocks, inside=True)

    def sparse_windows(self, most: int, least_blocks: int) -> list[int]:
        """The numbers of windows that have about `most` samples together, of all blocks where that
        can be: the first windows of each, or every so many blocks where windows are as long as
        they are. All windows where there are no more samples, or where one has several blocks."""
        sizes = [len(of) for of in self.blocks]
        of_window = [set(np.unique(of).tolist()) for of in self.blocks]
        if sum(sizes) <= most or any(len(of) > 1 for of in of_window):
            return list(range(len(self.blocks)))
        windows: dict[int, list[int]] = {}
        for number, (block,) in enumerate(of_window):
            if block != REST:
                windows.setdefault(block, []).append(number)
        wanted = most / max(sum(sizes), 1)
        found = []
        if all(len(mine) == 1 for mine in windows.values()):
            order = sorted(windows)
            count = min(max(round(wanted * len(order)), least_blocks), len(order))
            chosen = np.linspace(0, len(order) - 1, count).astype(int).tolist()
            return [windows[order[n]][0] for n in chosen]
        for mine in windows.values():
            found += mine[: max(round(wanted * len(mine)), 1)]
        return sorted(found)

    def thin(self, most: int) -> Horizon:
        """The horizon with about `most` samples of all blocks, and that part of those at rest."""
        size, rests = sum(len(of) for of in self.blocks), self.within([REST])
        if size <= most:
            return self
        some = rests[: math.ceil(len(rests) * most / size)]
        chosen = sorted({*self.sparse_windows(most, self.count), *(number for number, _ in some)})
        return Horizon(
            self.length,
            tuple(self.segments[n] for n in chosen),
            tuple(self.blocks[n] for n in chosen),
        )

    @property
    def count(self) -> int:
        """How many blocks its windows have."""
        return len(set(np.concatenate(self.blocks).tolist()) - {REST})

    def _where(self, blocks: Sequence[int], inside: bool) -> list[tuple[int, Ints]]:
        chosen = np.isin(np.concatenate(self.blocks), blocks) == inside
        edges = np.cumsum([len(of) for of in self.blocks])[:-1]
        rows = map(np.flatnonzero, np.split(chosen, edges))
        return [(number, some) for number, some in enumerate(rows) if len(some)]


@dataclass(frozen=True, eq=False)
class Horizons:
    """The horizons, the shorter first, with common blocks: the series and the start in s of each,
    first those that are fitted and then those of series that only judge (`gate`, by horizon).
    `folds` are the groups of fitted blocks that are left out together, by family; `interval` is
    the time in s between samples."""

    each: tuple[Horizon, ...]
    gate: tuple[Horizon, ...]
    series: tuple[str, ...]
    begin: Vector
    folds: tuple[tuple[tuple[int, ...], ...], ...]
    interval: float

    @property
    def fitted(self) -> int:
        """How many blocks are fitted."""
        return sum(len(group) for group in self.folds[0])

    @property
    def count(self) -> int:
        """How many blocks there are."""
        return len(self.series)

    @property
    def groups(self) -> tuple[tuple[tuple[int, ...], ...], ...]:
        """The groups of blocks that one fit predicts, by family."""
        judging = tuple(range(self.fitted, self.count))
        return tuple((*family, judging) if judging else family for family in self.folds)


def horizons_of(
    model: Model,
    sections: Sequence[Section],
    gate: Sequence[Section],
    free: Sequence[str],
    sigma: Mapping[str, float],
    options: TraceOptions,
) -> Horizons:
    """The horizons of the sections that are fitted and of those that only judge; `free` are the
    states where a window begins, `sigma` is the noise of each signal."""
    whole = sections
    sections, gate = (
        [moving_part(section, sigma, options) for section in some] for some in (sections, gate)
    )
    total = sum(section.count for section in sections)
    interval = float(np.median([section.measured.interval for section in sections]))
    period = float(np.median([period_of(model, section, options) for section in sections]))
    periodic = bool(np.isfinite(period))
    long = options.horizon / interval if options.horizon else options.long_horizon * period
    most, least = total / options.least_blocks, total / options.most_blocks
    block = int(np.clip(long, max(least, 1), max(most, 1)))
    short = max(int(options.short_horizon * period) if periodic else 0, options.shortest_window)
    pieces = [piece for section in sections for piece in _pieces(section, block)]
    judging = [piece for section in gate for piece in _pieces(section, block)]
    if not free or block < 2 * short or not periodic:
        each: tuple[Horizon, ...] = (_cut_runs(model, whole, pieces, None, free),)
        unseen: tuple[Horizon, ...] = (_cut_runs(model, gate, judging, None, free),)
    else:
        rests = [
            Section(one.measured, moving.end, one.end)
            for one, moving in zip(whole, sections, strict=True)
            if moving.end < one.end
        ]
        # in a record of few periods the blocks are shorter than the runs of the longer horizon; of
        # a long one, runs over several blocks could not be screened at some of them
        longest = max(section.count for section in sections)
        span = max(block, int(min(long, longest))) if total <= options.most_samples else block
        over, judged = (sections, gate) if span > block else (pieces, judging)
        each = (
            _cut_runs(model, [*pieces, *rests], pieces, short, free).thin(options.most_short),
            _cut_runs(model, [*over, *rests], pieces, span, free),
        )
        unseen = (
            _cut_runs(model, judging, judging, short, free),
            _cut_runs(model, judged, judging, span, free),
        )
    both = [*pieces, *judging]
    return Horizons(
        each,
        unseen if judging else (),
        tuple(p.measured.series or p.measured.name for p in both),
        np.array([p.measured.t[p.first] for p in both]),
        _folds(pieces, options),
        interval,
    )


def _pieces(section: Section, block: int) -> list[Section]:
    """A section as blocks of equal length, cut at gaps that are longer."""
    edges = edges_within(section, block)
    return [Section(section.measured, a, b) for a, b in pairwise(edges) if b > a]


def moving_part(section: Section, sigma: Mapping[str, float], options: TraceOptions) -> Section:
    """A section up to where its signals change by no more than noise any more, until its end."""
    last = section.first
    for name, values in section.measured.values.items():
        y = values[section.first : section.end]
        back = y[::-1]
        change = (np.maximum.accumulate(back) - np.minimum.accumulate(back))[::-1]
        still = max(options.still * sigma.get(name, 0.0), options.still_part * float(np.ptp(y)))
        last = max(last, section.first + int(np.sum(change > still)))
    if section.end - last < max(options.shortest_window, options.long_rest * section.count):
        return section
    few = section.first + options.shortest_window
    return Section(section.measured, section.first, max(last, few))


def _cut_runs(
    model: Model,
    parts: Sequence[Section],
    pieces: Sequence[Section],
    length: int | None,
    free: Sequence[str],
) -> Horizon:
    """Runs of about `length` samples within each part, or over all of it where that is None. A row
    belongs to the block of the piece that it is in."""
    names = list(dict.fromkeys(part.measured.name for part in (*pieces, *parts)))
    segments, blocks = [], []
    for part in sorted(parts, key=lambda one: (names.index(one.measured.name), one.first)):
        mine = [(n, p) for n, p in enumerate(pieces) if p.measured.name == part.measured.name]
        for segment in cut_windows(model, part, length or part.count, free):
            of = np.full(len(segment.rows), REST)
            for number, piece in mine:
                of[(segment.rows >= piece.first) & (segment.rows < piece.end)] = number
            segments.append(segment)
            blocks.append(of)
    longest = length or max((part.count for part in parts), default=0)
    return Horizon(longest, tuple(segments), tuple(blocks))


def _folds(
    pieces: Sequence[Section], options: TraceOptions
) -> tuple[tuple[tuple[int, ...], ...], ...]:
    """Groups of blocks that are left out together: scattered ones, and contiguous thirds or, of
    three series and more, whole series."""
    count = len(pieces)
    scattered = min(options.folds, count)
    names = list(dict.fromkeys(p.measured.name for p in pieces))
    parts = min(options.thirds, count)
    if len(names) >= parts:
        of = [names.index(p.measured.name) * parts // len(names) for p in pieces]
    else:
        of = [n * parts // count for n in range(count)]
    return (
        tuple(tuple(range(n, count, scattered)) for n in range(scattered)),
        tuple(tuple(n for n in range(count) if of[n] == part) for part in range(parts)),
    )


def restrict(segment: Segment, rows: Ints) -> Segment:
    """A window of which some rows count, by their place among those that count."""
    return segment if len(rows) == len(segment.rows) else replace(segment, rows=segment.rows[rows])
