"""Waves along a coordinate: which lengths of a wave a record shows, by a scan of all of them; and
waves in time, by a scan of periods that are near."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import TracewireError
from tracewire.residual import Windows
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.signal_scales import Trajectory
from tracewire.trace.candidates.static_outputs import static_outputs
from tracewire.trace.limits import BATCH
from tracewire.trace.thresholds import CandidateOptions

Samples = NDArray[np.intp]
Answer = Callable[[str, Sequence[Matrix]], Matrix]
"""What torques (N, k) by series at a place, by its name, do to the residuals, (M, k), without what
the starts of windows and the unknowns imitate."""
"""Lengths that are scanned at once: what the columns of all would take is much memory."""


def scan_waves(
    model: Model,
    candidates: Sequence[Candidate],
    runs: Sequence[Trajectory],
    used: Sequence[Samples],
    residual: Vector,
    answer: Answer,
    options: CandidateOptions,
) -> list[Candidate]:
    """The candidates, those with a wave with the lengths that promise most in place of their grid.

    `used` are the samples of each run in the windows that are looked at. Of a period in time those
    are scanned that the candidate says.

    All lengths between the bounds are scored, some of them for each wave more on the way, and
    where the coordinate is an angle also 2 pi/n; the peaks of the score are kept. A candidate that
    cannot be computed along samples alone keeps its grid.
    """
    found = []
    for candidate in candidates:
        for shape in (*candidate.waves, *candidate.scan_grid):
            try:
                grid = _peaks(model, candidate, shape, runs, used, residual, answer, options)
            except TracewireError:
                continue
            candidate = replace(candidate, shapes={**candidate.shapes, shape: grid})
        found.append(candidate)
    return found


def as_measured(windows: Windows, runs: Sequence[Trajectory]) -> list[Trajectory]:
    """The trajectories with measured signals as their sensors show them, where nothing is declared
    of the sensor."""
    names = list(dict.fromkeys(s.measured.name for s in windows.criterion.segments))
    series = {s.measured.name: s.measured for s in windows.criterion.segments}
    found = []
    for name, run in zip(names, runs, strict=True):
        plain = {n: x for n, x in series[name].values.items() if n not in series[name].sensors}
        known = {
            n: x for n, x in plain.items() if n in run.signals and n not in series[name].periods
        }
        found.append(replace(run, signals={**run.signals, **known}))
    return found


def _peaks(
    model: Model,
    candidate: Candidate,
    shape: str,
    runs: Sequence[Trajectory],
    used: Sequence[Samples],
    residual: Vector,
    answer: Answer,
    options: CandidateOptions,
) -> tuple[float, ...]:
    """The lengths at the highest peaks of the score, the best first. Between a peak and the lengths
    beside it finer ones are scored, unless it is a part of a turn."""
    angle = model.flat.units.get(candidate.place.q) == "rad"
    near = candidate.scan_grid.get(shape)
    lengths = np.array(near) if near else _lengths(*candidate.limits[shape], angle, options)

    def score(lengths: Vector) -> Vector:
        parts = []
        for first in range(0, len(lengths), BATCH.lengths):
            some = lengths[first : first + BATCH.lengths]
            torques = [
                _outputs(model, candidate, shape, some, run, samples)
                for run, samples in zip(runs, used, strict=True)
            ]
            columns = answer(candidate.place.name, torques)
            groups = columns.reshape(len(columns), len(some), -1)
            parts.append(_rss_reductions(groups, residual, candidate.most))
        return np.concatenate(parts)

    scores = score(lengths)
    ahead = np.r_[-np.inf, scores[:-1]], np.r_[scores[1:], -np.inf]
    peaks = np.flatnonzero((scores >= ahead[0]) & (scores >= ahead[1]))
    best = peaks[np.argsort(-scores[peaks])][: options.wave_peaks]
    turns = set(_turns(options)) if angle else set()
    found = {float(lengths[peak]): float(scores[peak]) for peak in best}
    finer = {
        float(lengths[peak]): _between(lengths, peak, options.finer_lengths)
        for peak in best
        if len(lengths) > 1 and lengths[peak] not in turns
    }
    if finer:
        edges = np.cumsum([len(some) for some in finer.values()])[:-1]
        scored = np.split(score(np.concatenate([*finer.values()])), edges)
        for (length, some), each in zip(finer.items(), scored, strict=True):
            if each.max() > found[length]:
                del found[length]
                found[float(some[each.argmax()])] = float(each.max())
    return tuple(sorted(found, key=lambda length: -found[length]))


def _between(lengths: Vector, peak: int, count: int) -> Vector:
    """So many lengths on each side of a peak, evenly in their inverse up to those beside it."""
    beside = [end for end in (peak - 1, peak + 1) if 0 <= end < len(lengths)]
    parts, middle = np.arange(1, count + 1) / (count + 1), 1 / lengths[peak]
    return 1 / np.concatenate([middle + parts * (1 / lengths[end] - middle) for end in beside])


def _turns(options: CandidateOptions) -> list[float]:
    """The parts of a turn by whole numbers of teeth, in rad."""
    return [2 * math.pi / teeth for teeth in range(1, options.teeth + 1)]


def _lengths(low: float, high: float, angle: bool, options: CandidateOptions) -> Vector:
    """Lengths between two bounds, evenly in waves on the way, the longest first."""
    most = min(high / low, options.most_waves)
    waves = np.arange(1.0, most + 1e-9, 1 / options.lengths_a_wave)
    lengths = set((high / waves).tolist())
    if angle:
        lengths |= {length for length in _turns(options) if low <= length <= high}
    return np.array(sorted(lengths, reverse=True))


def _outputs(
    model: Model,
    candidate: Candidate,
    shape: str,
    lengths: Vector,
    run: Trajectory,
    samples: Samples,
) -> Matrix:
    """The outputs (N, lengths * phases) of the effect, with each length and each other shape; zero
    but at the samples asked for."""
    rest = {n: g for n, g in candidate.shapes.items() if n != shape}
    # all phases, which may be negative, but of a width only the first
    grids = [grid if candidate.limits[n][0] < 0 else grid[:1] for n, grid in rest.items()]
    choices = [
        dict(zip((shape, *rest), values, strict=True))
        for values in product(lengths.tolist(), *grids)
    ]
    found = np.zeros((len(run.t), len(choices)))
    found[samples] = static_outputs(model.diagram, candidate, choices, run, samples)
    return found


def part_up_to(most: float, coefficients: Vector) -> Vector:
    """The part of its fall of a sum of squares that a column keeps whose coefficient goes no
    farther than this: 1 - (1 - most/|c|)^2, where |c| is larger."""
    sizes = np.maximum(np.abs(coefficients), most)
    return np.asarray(
        1 - (1 - np.divide(most, sizes, np.ones_like(sizes), where=sizes > most)) ** 2
    )


def _rss_reductions(columns: Matrix, residual: Vector, most: float = math.inf) -> Vector:
    """By how much each group of columns (M, groups, k) together lowers the sum of squares of a
    residual, (groups,): by their products, as k is 1 or 2. The coefficient of a column that stands
    alone goes no farther than `most`."""
    count = range(columns.shape[2])
    products = np.array(
        [[np.einsum("mg,mg->g", columns[..., i], columns[..., j]) for i in count] for j in count]
    ).transpose(2, 0, 1)
    sizes = np.sqrt(np.einsum("gkk->gk", products))
    sizes[sizes == 0] = 1.0
    along = np.einsum("mgk,m->gk", columns, residual) / sizes
    squared, directions = np.linalg.eigh(products / (sizes[:, :, None] * sizes[:, None, :]))
    parts = np.einsum("gkj,gk->gj", directions, along) ** 2
    shown = squared > 1e-12 * squared[:, -1:]
    found = np.sum(np.divide(parts, squared, np.zeros_like(parts), where=shown), axis=1)
    alone = columns.shape[2] == 1
    return np.asarray(found * part_up_to(most, along[:, 0] / sizes[:, 0]) if alone else found)
