"""The screen: one linearisation that promises what each effect, and each pair, would bring."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix, Vector
from tracewire.residual import Unknown, Windows, project_out_initial_states
from tracewire.trace.candidates.candidate import PHASE, Candidate, is_default
from tracewire.trace.candidates.effect_outputs import Variant, effect_outputs
from tracewire.trace.candidates.lines import with_lines
from tracewire.trace.candidates.signal_scales import Trajectory
from tracewire.trace.candidates.waves import as_measured, part_up_to, scan_waves
from tracewire.trace.limits import BATCH, ROUNDING
from tracewire.trace.screen.projection import project_out, project_out_starts
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.thresholds import ScreenOptions
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.statistics import BoundedColumns, CandidateColumns, orthonormal
from tracewire.trace.trials.trial import Trial

Ints = NDArray[np.intp]
QUADRATURE = (0.0, math.pi / 2)


@dataclass(frozen=True, eq=False)
class ScreenRow:
    """A variant of a candidate in the screen: its columns (two where a phase is free), the fall of
    the sum of squares that it promises, that fall as half a fall of BIC, and the values to begin
    with."""

    candidate: Candidate
    shapes: Mapping[str, float]
    columns: tuple[int, ...]
    rss_reduction: float
    gain: float
    values: Mapping[str, float]
    absorbed_fraction: float
    possible: bool
    series: tuple[str, ...] = ()
    """Those that have a phase of their own: there is a column for each, and each quadrature."""
    options: ScreenOptions = field(default_factory=ScreenOptions)

    @property
    def count(self) -> int:
        """How many numbers the effect takes."""
        return _count(self.candidate, self.shapes, self.series)

    @property
    def placed_effect(self) -> PlacedEffect:
        """The effect as a refit begins it, within the bounds of its numbers: a coefficient of the
        wrong sign begins with a small one of the right sign."""
        values = dict(self.values)
        for name, (low, high) in self.candidate.limits.items():
            if name in values:
                values[name] = min(max(values[name], low), high)
        name, neutral = self.candidate.parameter, self.candidate.neutral
        if values[name] == neutral != self.values[name]:
            small = self.options.wrong_sign * abs(self.values[name] - neutral)
            values[name] = min(neutral + small, self.candidate.limits[name][1])
        return PlacedEffect(self.candidate, values)


@dataclass(frozen=True, eq=False)
class Proposal:
    """Effects to try together, and what they promise."""

    rows: tuple[ScreenRow, ...]
    gain: float
    values: Mapping[str, float] = field(default_factory=dict)
    """Where the refit begins with other values of what is declared."""

    @property
    def count(self) -> int:
        """How many numbers the effects take."""
        return sum(row.count for row in self.rows)

    @property
    def names(self) -> list[str]:
        """The effects, as `name @ place`."""
        return [str(row.candidate) for row in self.rows]


@dataclass(frozen=True, eq=False)
class Screen:
    """All variants of all candidates, scored on one linearisation; `kept` are the residuals that
    were looked at, by number among all of its windows."""

    columns: CandidateColumns
    rows: tuple[ScreenRow, ...]
    kept: Ints
    unknowns: Mapping[str, float] = field(default_factory=dict)
    """The values of what is fitted beside the candidates."""

    def with_values(self, proposal: Proposal) -> Proposal:
        """A proposal with the values that what is declared has beside it."""
        columns = [number for row in proposal.rows for number in row.columns]
        moved = self.columns.unknown_changes(columns)
        if moved is None:
            return proposal
        values = np.array(list(self.unknowns.values())) + moved
        return replace(proposal, values=dict(zip(self.unknowns, values.tolist(), strict=True)))

    def best(self) -> list[ScreenRow]:
        """The best possible variant of each candidate, the most promising first."""
        possible = (row for row in self.rows if row.possible)
        found = _best_of_each(possible, lambda row: row.gain)
        return sorted(found.values(), key=lambda row: -row.gain)

    def observable(self) -> dict[str, ScreenRow]:
        """The best variant of each candidate that the unknowns do not imitate, of any sign, by its
        name."""
        seen = (row for row in self.rows if row.absorbed_fraction < 1 - ROUNDING.absorbed)
        return _best_of_each(seen, lambda row: row.rss_reduction)

    def best_rows_only(self) -> Screen:
        """The same with the best variants of each candidate alone: all others are much memory."""
        best = {*self.best(), *self.observable().values()}
        rows = [row for row in self.rows if row in best]
        kept = [number for row in rows for number in row.columns]
        ends = np.cumsum([len(row.columns) for row in rows]).tolist()
        moved = [
            replace(row, columns=tuple(range(end - len(row.columns), end)))
            for row, end in zip(rows, ends, strict=True)
        ]
        return replace(self, columns=self.columns.some(kept), rows=tuple(moved))

    def p_value(self) -> float:
        """The probability that noise alone looks as good as the best row does."""
        rows = [row for row in self.rows if row.possible]
        if not rows:
            return 1.0
        best = max(row.rss_reduction for row in rows)
        groups = [row.columns for row in self.rows]
        return self.columns.p_value(groups, [row.candidate.sign for row in self.rows], best)

    def pairs(self) -> list[Proposal]:
        """Pairs of candidates with possible signs, the most promising first.

        Also of effects whose sign is impossible alone: beside another one it may be possible.
        """
        options, best = self.columns.options, self.best()
        known = {str(row.candidate) for row in best}
        hidden = [row for name, row in self.observable().items() if name not in known]
        hidden.sort(key=lambda row: -row.rss_reduction)
        singles = [*best[: options.paired], *hidden[: options.paired_hidden]]
        found = []
        for one, other in combinations(singles, 2):
            rss_reduction, values = self.columns.score((*one.columns, *other.columns))
            split = len(one.columns)
            parts = (one, values[:split]), (other, values[split:])
            if all(
                _has_possible_sign(row.candidate, effective_fraction)
                for row, effective_fraction in parts
            ):
                rows = tuple(
                    _with_first_values(row, effective_fraction) for row, effective_fraction in parts
                )
                found.append(
                    Proposal(rows, self.columns.gain(rss_reduction, one.count + other.count))
                )
        return sorted(found, key=lambda proposal: -proposal.gain)

    def by_count(self, each: int) -> dict[int, list[Proposal]]:
        """The most promising singles and pairs at each number of numbers, `each` of them.

        What takes many numbers, as a wave does, then hides no simple pair.
        """
        singles = [Proposal((row,), row.gain) for row in self.best()]
        found: dict[int, list[Proposal]] = {}
        for proposal in sorted([*singles, *self.pairs()], key=lambda proposal: -proposal.gain):
            same = found.setdefault(proposal.count, [])
            if len(same) < each:
                same.append(proposal)
        return dict(sorted(found.items()))


def _best_of_each(
    rows: Iterable[ScreenRow], worth: Callable[[ScreenRow], float]
) -> dict[str, ScreenRow]:
    """The row of each candidate that is worth most, by its name."""
    found: dict[str, ScreenRow] = {}
    for row in rows:
        known = found.setdefault(str(row.candidate), row)
        if worth(row) > worth(known):
            found[str(row.candidate)] = row
    return found


def screen_candidates(
    linearisation: TorqueLinearisation,
    trial: Trial,
    candidates: Sequence[Candidate],
    scan: bool = True,
    most: int = 10**9,
    tell: Callable[[str], None] = lambda text: None,
) -> Screen:
    """The score test of every variant of every candidate, at coefficient zero.

    `tell` gets the candidates that cannot be computed, and why.
    `scan`: the lengths of waves are scanned, else they are those of the candidates' grids. Of more
    than `most` residuals only every second, third, ... one of a window is looked at.
    """
    windows = linearisation.windows
    every = -(-linearisation.size // most)
    kept = _thin([near.residual.size for near in windows.linearisations], every)
    unknowns, residual = (
        projected[kept] * every**0.5 for projected in project_out_initial_states(windows)
    )
    if not linearisation.along_data:  # a value that sits on its bound cannot give way to an effect
        unknowns = unknowns[
            :, [not _on_bound(u, windows.values[u.name]) for u in windows.criterion.unknowns]
        ]
    basis, rest = orthonormal(unknowns), residual
    residual = residual - basis @ (basis.T @ residual)

    measured = as_measured(windows, linearisation.trajectories)
    options = linearisation.options
    candidates = with_lines(candidates, windows, measured, options.candidate)
    if scan:
        candidates = _scan(linearisation, candidates, measured, every, unknowns, rest)
    reduced, whole, variants = _rows(linearisation, candidates, measured, every, tell)
    with np.errstate(over="ignore", invalid="ignore"):  # answers that grow without bounds
        is_seen = _squares(reduced) >= ROUNDING.seen * whole
    reduced[~(is_seen & np.isfinite(whole))] = 0.0
    reduced, variants = _by_series(linearisation, reduced, variants, kept)
    seen = _squares(reduced)
    both = reduced.T.copy() if linearisation.along_data else None
    left = project_out(reduced, basis)
    absorbed = 1 - _squares(left) / np.maximum(seen, 1e-300)
    absorbed = np.where(seen > 0, np.clip(absorbed, 0.0, 1.0), 1.0)
    effective_fraction = min(trial.effective_fraction * every, 1.0)
    degrees_of_freedom = max(trial.degrees_of_freedom // every, 1)
    columns = CandidateColumns(
        residual, left.T, absorbed, effective_fraction, degrees_of_freedom, options.screen
    )
    if both is not None:
        columns = _with_bounds(columns, both, unknowns, rest, windows)
    names = tuple(run.series for run in linearisation.trajectories)
    rows = [_row(columns, group, names) for group in _groups(variants)]
    return Screen(columns, tuple(rows), kept, windows.values)


def _scan(
    linearisation: TorqueLinearisation,
    candidates: Sequence[Candidate],
    measured: Sequence[Trajectory],
    every: int,
    unknowns: Matrix,
    residual: Vector,
) -> list[Candidate]:
    """The candidates, waves with the lengths that promise most on windows that are spread evenly
    over the record, the first of each series among them. The rows of `unknowns` and `residual` are
    every so many of each window."""
    windows, options = linearisation.windows, linearisation.options.candidate
    sizes = np.array([-(-near.residual.size // every) for near in windows.linearisations])
    apart = -(-int(sizes.sum()) // options.scanned)
    of_series = {number: n for n, number in reversed(list(enumerate(linearisation.series)))}
    chosen = sorted({*range(0, len(sizes), apart), *of_series.values()})
    used = np.isin(np.repeat(np.arange(len(sizes)), sizes), chosen)
    basis = orthonormal(unknowns[used])

    def answer(place: str, torques: Sequence[Matrix]) -> Matrix:
        given = {place: torques}
        rows, _ = project_out_starts(linearisation, windows.projections, given, every, chosen)
        return project_out(rows, basis).T

    return scan_waves(
        windows.criterion.model,
        candidates,
        measured,
        linearisation.samples_in(chosen),
        residual[used] - basis @ (basis.T @ residual[used]),
        answer,
        options,
    )


def _with_bounds(
    columns: CandidateColumns, both: Matrix, unknowns: Matrix, rest: Vector, windows: Windows
) -> CandidateColumns:
    """Columns beside unknowns that move as far as their bounds; promises are kept whole, as both
    move together."""
    values = np.array([windows.values[u.name] for u in windows.criterion.unknowns])
    low = np.array([u.low for u in windows.criterion.unknowns]) - values
    high = np.array([u.high for u in windows.criterion.unknowns]) - values
    least = ROUNDING.on_bound * np.array([u.scale for u in windows.criterion.unknowns])
    found = BoundedColumns(
        columns.residual,
        columns.matrix,
        columns.absorbed_fraction,
        columns.effective_fraction,
        columns.degrees_of_freedom,
        replace(columns.options, trust=1.0),
        both,
        unknowns,
        rest,
        (np.minimum(low, -least), np.maximum(high, least)),
    )
    return replace(found, residual=found.left(()))


def _thin(sizes: Sequence[int], every: int) -> Ints:
    """Every so many residuals of windows of these sizes, by number among all."""
    ends = np.cumsum(sizes)
    parts = [
        np.arange(end - size, end, every) for size, end in zip(sizes, ends.tolist(), strict=True)
    ]
    return np.concatenate(parts)


def _rows(
    linearisation: TorqueLinearisation,
    candidates: Sequence[Candidate],
    measured: Sequence[Trajectory],
    every: int,
    tell: Callable[[str], None],
) -> tuple[Matrix, Vector, list[Variant]]:
    """What the coefficients of all variants do to the residuals in sigma, as rows (K, M) without
    what the starts of windows imitate, and their squares (K,) with it.

    Waves are taken along what is measured: a part of their length matters, and a fit far from the
    noise is off by more than the noise.
    """
    windows = linearisation.windows
    wired = [c for c in candidates if c.place.kind != "sensor"]
    sensors = [c for c in candidates if c.place.kind == "sensor"]
    model, options = windows.criterion.model, linearisation.options.candidate
    plain = [c for c in wired if not c.waves]
    waves = [c for c in wired if c.waves]
    samples = linearisation.samples_in(range(len(windows.linearisations)))
    known = effect_outputs(model, plain, linearisation.trajectories, samples, options, tell)
    known |= effect_outputs(model, waves, measured, samples, options, tell)
    by_place: dict[str, list[Variant]] = {}
    for variant in known:
        by_place.setdefault(variant.candidate.place.name, []).append(variant)
    variants = [variant for group in by_place.values() for variant in group]
    size = sum(-(-near.residual.size // every) for near in windows.linearisations)
    rows, first = np.empty((len(variants) + len(sensors), size)), 0
    whole = np.empty(len(rows))
    together = max(BATCH.torques // sum(len(run.t) for run in linearisation.trajectories), 1)
    for place, group in by_place.items():
        for begin in range(0, len(group), together):  # all of them twice are much memory
            part = group[begin : begin + together]
            given = [np.zeros((len(run.t), len(part))) for run in linearisation.trajectories]
            for column, variant in enumerate(part):
                for torques, used, output in zip(given, samples, known.pop(variant), strict=True):
                    torques[used, column] = output
            mine = slice(first, first + len(part))
            _, whole[mine] = project_out_starts(
                linearisation, windows.projections, {place: given}, every, rows=rows[mine]
            )
            first += len(part)
    edges = np.cumsum([near.residual.size for near in windows.linearisations])[:-1]
    for row, candidate in enumerate(sensors, start=first):
        shown = linearisation.sensor_response(candidate.effect, candidate.place.definition)
        whole[row] = shown @ shown
        parts = zip(windows.projections, np.split(shown, edges), strict=True)
        left = [view.project_out(part)[::every] for view, part in parts]
        rows[row] = np.concatenate(left) * every**0.5
    variants += [Variant(candidate, ()) for candidate in sensors]
    return rows, np.maximum(whole, 1e-300), variants


def _by_series(
    linearisation: TorqueLinearisation, rows: Matrix, variants: list[Variant], kept: Ints
) -> tuple[Matrix, list[Variant]]:
    """What variants do to the residuals, (K, M), with a row for each series, zero in the others,
    where a phase is its own there."""
    count = len(linearisation.trajectories)
    if count < 2 or not any(variant.candidate.each for variant in variants):
        return rows, variants
    sizes = [near.residual.size for near in linearisation.windows.linearisations]
    of = np.repeat(linearisation.series, sizes)[kept]
    parts = [count if variant.candidate.each else 1 for variant in variants]
    found, first = np.zeros((sum(parts), rows.shape[1])), 0
    for row, own in zip(rows, parts, strict=True):
        for n in range(own):
            mine = of == n if own > 1 else slice(None)
            found[first + n, mine] = row[mine]
        first += own
    return found, [v for v, own in zip(variants, parts, strict=True) for _ in range(own)]


def _groups(variants: Sequence[Variant]) -> Iterator[list[tuple[int, Variant]]]:
    """Variants with their columns; those that differ only in phase stand together."""
    groups: dict[tuple[str, tuple[tuple[str, float], ...]], list[tuple[int, Variant]]] = {}
    for number, variant in enumerate(variants):
        phases = variant.candidate.shapes.get(PHASE, ())
        joint = len(phases) == 2 and bool(np.allclose(phases, QUADRATURE, atol=1e-3))
        key = tuple((n, x) for n, x in variant.shapes if n != PHASE or not joint)
        groups.setdefault((str(variant.candidate), key), []).append((number, variant))
    yield from groups.values()


def _row(
    columns: CandidateColumns, group: Sequence[tuple[int, Variant]], names: tuple[str, ...]
) -> ScreenRow:
    """One row: the score of a variant."""
    indices = tuple(number for number, _ in group)
    candidate = group[0][1].candidate
    rss_reduction, values = columns.score(indices)
    if len(values) == 1:
        rss_reduction *= float(part_up_to(candidate.most, values)[0])
    shapes = dict(group[0][1].shapes)
    series = names if candidate.each and len(names) > 1 else ()
    row = ScreenRow(
        candidate=candidate,
        shapes=shapes,
        columns=indices,
        rss_reduction=rss_reduction,
        gain=columns.gain(rss_reduction, _count(candidate, shapes, series)),
        values={},
        absorbed_fraction=float(np.max(columns.absorbed_fraction[list(indices)])),
        possible=rss_reduction > 0 and _has_possible_sign(candidate, values),
        series=series,
        options=columns.options,
    )
    return _with_first_values(row, values)


def _with_first_values(row: ScreenRow, values: Vector) -> ScreenRow:
    """The row with the values at which a refit begins."""
    shapes = dict(row.shapes)
    count = len(row.series)
    if count and len(values) == 2 * count:  # one amplitude, and a phase in each series
        sines, cosines = values[:count], values[count:]
        del shapes[PHASE]
        phases = np.arctan2(cosines, sines).tolist()
        shapes |= {f"{PHASE}@{name}": p for name, p in zip(row.series, phases, strict=True)}
        values = np.array([np.mean(np.hypot(sines, cosines))])
    elif len(values) == 2:  # sin(x + phase) = cos(phase) sin(x) + sin(phase) cos(x)
        shapes[PHASE] = math.atan2(values[1], values[0]) + shapes.get(PHASE, 0.0)
    size = float(np.hypot(*values)) if len(values) == 2 else float(values[0])
    neutral = row.candidate.neutral
    values_to_begin = {row.candidate.parameter: neutral + row.options.trust * size, **shapes}
    return replace(row, values=values_to_begin)


def _on_bound(unknown: Unknown, value: float) -> bool:
    """Whether a fitted value sits on a bound."""
    near = ROUNDING.on_bound * unknown.scale
    return value - unknown.low < near or unknown.high - value < near


def _has_possible_sign(candidate: Candidate, values: Vector) -> bool:
    """Whether a coefficient has a physical sign."""
    return candidate.sign == 0 or len(values) > 1 or float(values[0]) * candidate.sign > 0


def _count(candidate: Candidate, shapes: Mapping[str, float], series: Sequence[str]) -> int:
    """How many numbers an effect takes: a shape that keeps its default is none. The screen takes an
    amplitude and a phase in each series that has a phase of its own."""
    more = 2 * (len(series) - 1) if series else 0
    free = {
        name: value
        for name, value in shapes.items()
        if name not in candidate.fixed or name in candidate.scanned
    }
    return 1 + more + sum(not is_default(candidate, name, value) for name, value in free.items())


def _squares(rows: Matrix) -> Vector:
    """The sum of squares of each row."""
    return np.asarray(np.einsum("ij,ij->i", rows, rows))
