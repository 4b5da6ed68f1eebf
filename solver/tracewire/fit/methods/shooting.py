"""The method shooting: random shots round the best point, and the simplex from there.

Source: paper B, section 5: "a combination of the simplex method and stochastic shooting near the
current value of p". Where the criterion jumps, because the model comes to another of its motions, a
simplex stays on the side where it began; a shot may land on the other.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from tracewire.array_types import Vector
from tracewire.fit.fminsearch import CONVERGED, fminsearch
from tracewire.fit.limits import SHOOTING
from tracewire.fit.methods.parallel import evaluate_parallel
from tracewire.fit.optimset import OptimValues, Options
from tracewire.fit.search import MethodResult, Search
from tracewire.residual import solve_least_squares

KEPT = ("vertices", "values", "iteration", "procedure", "evaluations")


@dataclass(frozen=True)
class _State:
    """Where a round begins: its number, the unknowns in SI and their criterion, the radius of the
    shots, rounds without gain so far, the simplex where the last round has left it, and whether
    least squares have come to their end there."""

    z: tuple[float, ...]
    value: float
    number: int = 0
    radius: float = SHOOTING.first_radius
    lost: int = 0
    simplex: Mapping[str, Any] | None = None
    is_polished: bool = False


def by_shooting(search: Search) -> MethodResult:
    """The minimum by rounds of shots round the best point, and of the simplex.

    Shots are normally distributed in each unknown. From a better one a new simplex begins; else
    more shots go along the simplex as it lies, the best of them join it, and it moves on. It is
    left where it comes forward slowly. The radius of a round follows the best shot; without a good
    one it gets smaller, and in the end begins anew. Where the simplex is left, a few steps of least
    squares go down to the bottom of the valley that it is in: these are not in the paper.
    """
    scales = search.criterion.scales
    if search.resumed:
        state = _State(**search.resumed)
    else:
        state = _State(tuple(search.begin * scales), search.value(search.begin))
    while state.lost < SHOOTING.lost:
        before = state.value
        search.set_stage(0.0, f"round {state.number + 1}, shots of {100 * state.radius:.2g} %")
        state = _with_shots(search, state)
        search.set_stage(0.0, f"round {state.number + 1}, simplex")
        state = _with_simplex(search, state)
        if not state.is_polished:
            search.set_stage(0.0, f"round {state.number + 1}, least squares")
            state = _with_least_squares(search, state)
        lost = 0 if state.value < (1 - SHOOTING.gain) * before else state.lost + 1
        state = replace(state, number=state.number + 1, lost=lost)
        search.checkpoint(asdict(state))
        search.count_iteration(np.array(state.z) / scales, state.value, f"round {state.number}")
    message = f"converged: {SHOOTING.lost} rounds of shots and of the simplex have gained nothing"
    return MethodResult(np.array(state.z) / scales, search.iterations, 1, message)


def _with_shots(search: Search, state: _State) -> _State:
    """The state after shots: the best point of them and of before, and the radius that follows."""
    rng, scales = search.rng(state.number), search.criterion.scales
    z = np.array(state.z) / scales
    count = max(SHOOTING.shots * search.size, SHOOTING.least_shots)
    count *= 2 if state.simplex is None else 1
    radii = state.radius * SHOOTING.nearest ** rng.uniform(0.0, 1.0, count)
    moves = rng.standard_normal((count, search.size)) * radii[:, None] * _sizes(z)
    points = [search.reflect(z + move) for move in moves]
    values = np.array(list(evaluate_parallel(search, points)))
    best = int(np.argmin(values))
    if values[best] < state.value:  # another motion, or far from the end: a new simplex
        radius = float(np.clip(2 * radii[best], state.radius / 2, 2 * SHOOTING.first_radius))
        there = tuple((points[best] * scales).tolist())
        value = float(values[best])
        return replace(state, z=there, value=value, radius=radius, simplex=None, is_polished=False)
    radius = state.radius / 2 if state.radius > 2 * SHOOTING.least_radius else SHOOTING.first_radius
    state = replace(state, radius=radius)
    return state if state.simplex is None else _with_long_shots(search, state, state.simplex, rng)


def _with_long_shots(
    search: Search, state: _State, simplex: Mapping[str, Any], rng: np.random.Generator
) -> _State:
    """The state after shots along the simplex, and beyond it; the best join it for its worst."""
    vertices, known = np.array(simplex["vertices"]), np.array(simplex["values"])
    spread = (vertices - vertices.mean(axis=0)) / np.sqrt(search.size)
    stretch = SHOOTING.longest ** rng.uniform(0.0, 1.0, (search.size, 1))
    shots = vertices[0] + stretch * rng.standard_normal((search.size, len(vertices))) @ spread
    values = np.array(list(evaluate_parallel(search, [_point(search, simplex, x) for x in shots])))
    vertices, known = np.vstack([vertices, shots]), np.concatenate([known, values])
    kept = np.argsort(known, kind="stable")[: search.size + 1]
    joined = {**simplex, "vertices": vertices[kept].tolist(), "values": known[kept].tolist()}
    if known[kept[0]] < state.value:
        there = _point(search, simplex, vertices[kept[0]]) * search.criterion.scales
        state = replace(state, z=tuple(there.tolist()), value=float(known[kept[0]]))
    return replace(state, simplex=joined)


def _point(search: Search, kept: Mapping[str, Any], x: Vector) -> Vector:
    """The scaled unknowns of a vertex. fminsearch moves in unknowns that are all 1 at the centre of
    a simplex, so that its edges are a radius."""
    return search.reflect(np.array(kept["centre"]) + (x - 1.0) * np.array(kept["unit"]))


def _with_simplex(search: Search, state: _State) -> _State:
    """The state after moves of the simplex, the kept one or a new one, until it stalls."""
    scales = search.criterion.scales
    z = np.array(state.z) / scales
    unit = state.radius / SHOOTING.edge * _sizes(z)
    kept = state.simplex or {"centre": z.tolist(), "unit": unit.tolist()}
    last = {key: kept[key] for key in KEPT if key in kept}
    values_so_far: list[tuple[int, float]] = []

    def stalls(x: Vector, values: OptimValues, when: str) -> bool:
        values_so_far.append((values.funccount, values.fval))
        since = values.funccount - SHOOTING.patience * search.size
        old = [value for count, value in values_so_far if count <= since]
        return when == "iter" and bool(old) and values.fval > SHOOTING.stalled * old[-1]

    found = fminsearch(
        lambda x: search.value(_point(search, kept, x)),
        np.ones(search.size),
        Options(
            Display="off",
            MaxIter=np.inf,
            MaxFunEvals=np.inf,
            TolX=SHOOTING.least_edge * SHOOTING.edge,
            TolFun=SHOOTING.least_edge * state.value,
            OutputFcn=stalls,
        ),
        resumed=last,
        keep=last.update,
    )
    simplex = None if found.exitflag == CONVERGED else {**kept, **last}
    if found.fval < state.value:
        there = _point(search, kept, found.x) * scales
        state = replace(state, z=tuple(there.tolist()), value=float(found.fval))
    return replace(state, simplex=simplex)


def _with_least_squares(search: Search, state: _State) -> _State:
    """The state after some steps of least squares."""
    scales = search.criterion.scales
    result = solve_least_squares(
        search, np.array(state.z) / scales, steps=SHOOTING.polishing, tolerance=SHOOTING.polish_ftol
    )
    is_polished = result.cost > SHOOTING.polished * state.value
    if result.cost >= state.value:
        return replace(state, is_polished=is_polished)
    there = tuple((result.z * scales).tolist())
    return replace(state, z=there, value=result.cost, simplex=None, is_polished=is_polished)


def _sizes(z: Vector) -> Vector:
    """The size of each unknown: its value, or a part of what it is scaled by where that is more."""
    return np.maximum(np.abs(z), SHOOTING.zero)
