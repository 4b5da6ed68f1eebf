"""The method multistart: points all over the bounds, and least squares from the best of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.errors import OptionError, Problem
from tracewire.fit.limits import MULTISTART
from tracewire.fit.methods.parallel import evaluate_parallel
from tracewire.fit.search import MethodResult, Search
from tracewire.residual import solve_least_squares


def by_multistart(search: Search) -> MethodResult:
    """The best minimum that least squares finds from the best of many points within the bounds.

    The points are those of a Sobol sequence, shifted by a random vector; the begin is one more. An
    unknown whose bounds are positive and span more than a decade is spread evenly in its logarithm.
    Free start values stay at what the data tell, until least squares moves them, too.

    Raises OptionError: an unknown without bounds.
    """
    _refuse_unbounded(search)
    points = [search.begin, *_points(search)]
    kept: Mapping[str, Any] = search.resumed
    values: list[float] = list(kept.get("values", []))
    ends: list[tuple[float, list[float]]] = [(v, z) for v, z in kept.get("ends", [])]
    each = MULTISTART.steps * (search.size + 2)  # evaluations of least squares, at most
    total = len(points) + MULTISTART.polished * each

    def report(stage: str) -> None:
        done = min(len(values), len(points)) + len(ends) * each
        search.set_stage(done / total, stage)
        search.checkpoint({"values": values, "ends": [list(end) for end in ends]})

    while len(values) < len(points):
        report(f"{len(values)} of {len(points)} points")
        values += evaluate_parallel(search, points[len(values) : len(values) + MULTISTART.batch])
    starts = _best(search, points, values)
    for number in range(len(ends), len(starts)):
        report(f"least squares from point {number + 1} of {len(starts)}")
        result = solve_least_squares(
            search,
            starts[number],
            steps=MULTISTART.steps,
            tolerance=MULTISTART.ftol,
            callback=search.count_iteration,
        )
        ends.append((result.cost, (result.z * search.criterion.scales).tolist()))
    report("done")
    value, best = min(ends)
    same = sum(end <= value + MULTISTART.same * abs(value) for end, _ in ends)
    message = (
        f"{same} of the {len(ends)} best of {len(points)} points led to the best minimum"
        if same > 1
        else f"only one of the {len(ends)} best of {len(points)} points led to the best minimum: "
        "there may be a better one"
    )
    return MethodResult(np.array(best) / search.criterion.scales, search.iterations, 1, message)


def _refuse_unbounded(search: Search) -> None:
    """Raises OptionError: parameters or sensors that are free without bounds."""
    unknowns = search.criterion.unknowns
    without = [u.name for u in unknowns if not np.isfinite(u.high - u.low)]
    if without:
        what = f"multistart needs bounds, and there are none of {', '.join(without)}"
        hint = "Write them as in k: {value: 1, fit: [0.1, 10]}, or take another method."
        raise OptionError([Problem(what, hint=hint)])


def _points(search: Search) -> Matrix:
    """Scaled unknowns all over the bounds, shape (points, unknowns)."""
    count = len(search.criterion.unknowns)
    if not count:
        return np.empty((0, search.size))
    from scipy.stats import qmc  # half a second: only this method pays for it

    exponent = int(np.ceil(np.log2(min(MULTISTART.points * count, MULTISTART.most_points))))
    cube = qmc.Sobol(count, scramble=False).random_base2(exponent)
    cube = (cube + search.rng().uniform(size=count)) % 1.0
    low, high = search.low[:count], search.high[:count]
    wide = (low > 0) & (high > 10 * low)
    safe = np.where(wide, low, 1.0)
    ratio = np.where(wide, high / safe, 1.0)
    inside = np.where(wide, safe * ratio**cube, low + (high - low) * cube)
    starts = np.broadcast_to(search.begin[count:], (len(cube), search.size - count))
    return np.hstack([inside, starts])


def _best(search: Search, points: list[Vector], values: list[float]) -> list[Vector]:
    """The points from which least squares begins, the best first, none near a better one."""
    count = len(search.criterion.unknowns)
    width = np.maximum((search.high - search.low)[:count], 1e-300)
    chosen: list[Vector] = []
    for number in np.argsort(values, kind="stable"):
        point = points[number]
        near = [
            np.all(np.abs(point - other)[:count] < MULTISTART.apart * width) for other in chosen
        ]
        if not any(near):
            chosen.append(point)
        if len(chosen) == MULTISTART.polished:
            break
    return chosen
