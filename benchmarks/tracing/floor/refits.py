"""Refits of a plant with some laws to windows with free starts: Gauss and Newton, numpy alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.tracing.floor.windows import Array, Indices, System, Trajectory, cut, run
from benchmarks.tracing.laws import Hidden

ROUNDS = 5
STEP = 1e-5


@dataclass(frozen=True, eq=False)
class Refit:
    """What a model leaves: the sum of squares, the residuals (windows, samples), the values and
    starts that it ends at, and an orthonormal basis of what its starts and parameters reach."""

    rss: float
    residual: Array
    values: dict[str, float]
    starts: Array
    lanes: Indices
    samples: int
    basis: list[Array]  # of the starts, by window
    columns: Array  # (windows, samples, parameters), starts projected out
    slopes: Array  # (2 + parameters, windows, samples)


def refit(
    system: System, terms: Sequence[Hidden], data: Trajectory, horizon: float, rounds: int = ROUNDS
) -> Refit:
    """Least squares over free parameters, coefficients of the terms and every window's start."""
    lanes, samples = cut(data, horizon)
    values = dict(system.values)
    for number, h in enumerate(terms):
        values |= {f"{number}.c": h.coefficient}
        values |= {f"{number}.{key}": value for key, value in h.shapes.items()}
    free = [*system.free, *(f"{n}.c" for n in range(len(terms)))]
    target = np.stack([data.shown[b : b + samples * data.every : data.every] for b in lanes])
    starts = np.stack([data.q[lanes], data.v[lanes]])
    size = np.array([np.max(np.abs(data.q)), np.max(np.abs(data.v))])
    best: Refit | None = None
    shrink, guess, near = 1.0, (values, starts), (values, starts)
    step: tuple[Array, Array] | None = None
    for _ in range(2 * rounds):
        values, starts = guess
        found = _evaluated(system, terms, data, lanes, samples, values, starts, free, target, size)
        if best is None or found.rss < best.rss:
            small = best is not None and found.rss > (1 - 1e-3) * best.rss
            best, near, shrink = found, guess, 1.0
            if small:
                break
            step = _step(found)
        else:
            shrink /= 4
            if shrink < 0.02:
                break
        assert step is not None
        moved = {n: near[0][n] * (1 + shrink * d) for n, d in zip(free, step[0], strict=True)}
        guess = ({**near[0], **moved}, near[1] + shrink * step[1].T * size[:, None])
    assert best is not None
    return best


def _evaluated(
    system: System,
    terms: Sequence[Hidden],
    data: Trajectory,
    lanes: Indices,
    samples: int,
    values: dict[str, float],
    starts: Array,
    free: Sequence[str],
    target: Array,
    size: Array,
) -> Refit:
    count, kinds = len(lanes), 3 + len(free)
    many = {n: np.full((kinds, count), x) for n, x in values.items()}
    begun = np.repeat(starts[:, None, :], kinds, axis=1)
    begun[0, 1] += STEP * size[0]
    begun[1, 2] += STEP * size[1]
    for row, name in enumerate(free):
        many[name][3 + row] *= 1 + STEP
    with np.errstate(all="ignore"):
        shown = run(
            system,
            terms,
            data,
            np.tile(lanes, kinds),
            samples,
            {n: x.ravel() for n, x in many.items()},
            begun.reshape(2, -1),
        ).reshape(kinds, count, samples)
    residual = target - shown[0]
    if not np.all(np.isfinite(shown)):
        residual = np.full_like(residual, np.inf)
        shown = np.zeros_like(shown)
    slopes = (shown[1:] - shown[0]) / STEP
    basis, columns = [], np.empty((count, samples, len(free)))
    for w in range(count):
        q, _ = np.linalg.qr(slopes[:2, w].T)
        basis.append(q)
        shared = slopes[2:, w].T
        columns[w] = shared - q @ (q.T @ shared)
    with np.errstate(all="ignore"):
        rss = float(np.sum(residual**2))
    return Refit(rss, residual, values, starts, lanes, samples, basis, columns, slopes)


def _step(found: Refit) -> tuple[Array, Array]:
    """Gauss and Newton: relative steps of the parameters, and of starts (windows, 2) in sizes."""
    slopes = found.slopes
    left = np.einsum("wni,wnj->ij", found.columns, found.columns)
    right = np.einsum("wni,wn->i", found.columns, found.residual)
    shared = np.linalg.lstsq(left, right, rcond=1e-10)[0]
    shared = np.clip(shared, -0.5, 0.5)
    starts = np.empty((len(found.lanes), 2))
    for w in range(len(found.lanes)):
        rest = found.residual[w] - shared @ slopes[2:, w]
        starts[w] = np.linalg.lstsq(slopes[:2, w].T, rest, rcond=None)[0]
    return shared, starts


def model_path(
    system: System, terms: Sequence[Hidden], data: Trajectory, found: Refit
) -> tuple[Trajectory, Indices]:
    """The motion of a refitted model, its windows end to end, and the data's points of the same
    times."""
    path: list[Array] = []
    values = {n: np.full(len(found.lanes), x) for n, x in found.values.items()}
    run(system, terms, data, found.lanes, found.samples, values, found.starts, path=path)
    q, v = np.stack(path, axis=1).transpose(0, 2, 1)  # (windows, steps)
    h, steps = 2 * data.half, q.shape[1]
    ends = [np.empty((len(q), 2 * steps - 1)) for _ in range(2)]
    for full, at in zip(ends, (q, v), strict=True):
        full[:, ::2] = at
    ends[0][:, 1::2] = (q[:, 1:] + q[:, :-1]) / 2 + h / 8 * (v[:, :-1] - v[:, 1:])
    ends[1][:, 1::2] = 1.5 * np.diff(q) / h - (v[:, 1:] + v[:, :-1]) / 4
    rows = (found.lanes[:, None] + np.arange(2 * steps - 1)).ravel()
    model = Trajectory(
        data.t[rows], ends[0].ravel(), ends[1].ravel(), data.u[rows], data.z[rows],
        data.shown[rows], data.phase[rows], data.own[rows], data.tone[rows], data.half, data.every,
        tuple(int(x) for x in np.arange(len(q)) * (2 * steps - 1)), (found.samples,) * len(q),
    )  # fmt: skip
    return model, rows
