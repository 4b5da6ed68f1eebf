"""`periodic_orbit`: a motion that closes, by shooting with Newton's method on the period map."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from tracewire.analyse.drive import is_driven, number, period_of
from tracewire.analyse.floquet_multipliers import Floquet
from tracewire.analyse.limits import ORBIT
from tracewire.analyse.turns import units_of, within_a_turn
from tracewire.arguments import checked
from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import AnalysisError, OptionError, Problem, SimulationError
from tracewire.result import Result
from tracewire.solve import Passage, parameter_values


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicOrbit(Result):
    """A periodic orbit: it is at `x` (n,) in SI at `begin` in s, and there again after `period`.

    `t` (N,) and `motion` (N, n) are one period of it. `closure` is what it lacks to close, as a
    part of its size; `floquet` tells whether it is stable; `steps` are those of Newton's method.
    """

    states: tuple[str, ...]
    begin: float
    period: float
    x: Vector
    t: Vector
    motion: Matrix
    closure: float
    steps: int
    floquet: Floquet
    title: str = ""
    units: Mapping[str, str] = field(default_factory=dict)

    def __getitem__(self, name: str) -> float:
        return float(self.x[self.states.index(name)])


@checked
def periodic_orbit(
    model: Model,
    period: float | str,
    *,
    begin: float | str = 0.0,
    skip: int = 0,
    guess: Mapping[str, float] | None = None,
    modulo: Mapping[str, float] | None = None,
    parameters: Mapping[str, float] | None = None,
    preset: str = "",
    method: str = "auto",
    rtol: float = 1e-10,
) -> PeriodicOrbit:
    """Find a periodic orbit by shooting: Newton's method on x(T; x0) = x0.

    `period` in s, or a formula of the parameters ("2*pi/omega"): of a model that is driven that of
    the orbit, k times that of the drive for an orbit of period k; of one that is not, a guess
    within a half, as T is free then, and the correction of x0 has no part along the motion. `begin`
    in s, or such a formula, is when the orbit passes x. The search begins at the start values, or
    at `guess` by state, after `skip` periods of simulation. States of `modulo` need to close up to
    a multiple of that only, as an angle that turns: {"phi": 6.283185307179586}.

    Raises AnalysisError where the search does not end, with what is left; OptionError.
    """
    values = parameter_values(model, parameters or {}, preset)
    length = period_of(model, period, values)
    since = number(model, begin, values, "begin")
    unit = units_of(model, modulo or {})
    if skip < 0:
        raise OptionError([Problem(f"{skip} periods cannot be skipped", hint="Give 0 or more.")])
    make = partial(
        Passage,
        model,
        length=length,
        begin=since,
        parameters=parameters,
        start=guess,
        preset=preset,
        method=method,
        rtol=rtol,
    )
    passage = make(tangents=True, inner=ORBIT.points)
    driven = is_driven(passage, length)
    x = passage.x
    if skip:
        before = make()
        before.go_to(since + skip * length)
        x = within_a_turn(before.x, unit)
    if not driven:
        length = _return(passage, since, length, x, unit)
    shot = _shoot(passage, since, length, x, unit)
    extent = np.ptp(shot.motion, axis=0)
    steps, tolerance = 0, ORBIT.loose * rtol
    noise = 10 * rtol ** (2 / 3)  # of the monodromy, whose own tolerance is rtol^(2/3)
    while steps < ORBIT.most_steps and shot.closure > 0.01 * tolerance:
        steps += 1
        better = _along(passage, since, shot, driven, unit, noise)
        if better is None:
            break
        shot = better
    if not driven and np.all(np.ptp(shot.motion, axis=0) <= ORBIT.still * (extent + 1e-12)):
        what = "the search has ended at a steady state, which is no orbit"
        raise AnalysisError([Problem(what, hint="Give a guess farther from it, or skip= periods.")])
    if not shot.closure <= tolerance:
        what = (
            f"no periodic orbit was found: after {steps} steps of Newton's method "
            f"{shot.closure:.2g} of its size is missing to close"
        )
        hint = "Begin nearer (guess=, skip= more periods), or give another period."
        raise AnalysisError([Problem(what, hint=hint)])
    found = Floquet(
        model.states, shot.period, shot.monodromy, shot.closure, not driven, passage.warnings
    )
    return PeriodicOrbit(
        model.states,
        since,
        shot.period,
        shot.x,
        np.concatenate([[since], shot.t]),
        np.vstack([shot.x, shot.motion]),
        shot.closure,
        steps,
        found,
        model.flat.title,
        {state.name: state.unit for state in model.flat.states},
    )


def _return(passage: Passage, since: float, length: float, x: Vector, unit: Vector) -> float:
    """The time within half of the guess from it when the motion is nearest to where it was."""
    t = length * (0.5 + np.arange(1, ORBIT.points + 1) / ORBIT.points)
    passage.begin_at(since, x)
    passage.go_to(since + 1.5 * length, since + t)
    away = within_a_turn(passage.inside - x, unit)
    size = np.ptp(passage.inside, axis=0) + 1e-12
    return float(t[np.argmin(np.sum((away / size) ** 2, axis=1))])


@dataclass(frozen=True, eq=False)
class _Shot:
    """A motion over one period: from x, with what is missing at its end, and its derivatives."""

    x: Vector
    period: float
    missing: Vector
    closure: float
    monodromy: Matrix
    rates: Vector
    rates_end: Vector
    t: Vector
    motion: Matrix


def _shoot(passage: Passage, since: float, period: float, x: Vector, unit: Vector) -> _Shot:
    t = since + period * np.arange(1, ORBIT.points + 1) / ORBIT.points
    passage.begin_at(since, x)
    rates = passage.rates()
    passage.go_to(since + period, t)
    motion = passage.inside
    missing = within_a_turn(passage.x - x, unit)
    size = np.ptp(motion, axis=0) + 1e-6 * np.abs(motion).max(axis=0, initial=0.0) + 1e-12
    closure = float((np.abs(missing) / size).max(initial=0.0))
    monodromy = passage.tangents
    if not (np.isfinite(missing).all() and np.isfinite(monodromy).all()):
        closure = np.inf
    return _Shot(x, period, missing, closure, monodromy, rates, passage.rates(), t, motion)


def _newton(shot: _Shot, driven: bool, missing: Vector, noise: float) -> tuple[Vector, float]:
    """The correction of x (n,) and of the period by which a linear map would make up for it."""
    n = len(shot.x)
    matrix = shot.monodromy - np.eye(n)
    right = -missing
    if not driven:
        speed = float(np.linalg.norm(shot.rates)) or 1.0
        along = np.append(shot.rates / speed, 0.0)
        matrix = np.vstack([np.column_stack([matrix, shot.rates_end]), along])
        right = np.append(right, 0.0)
    # a family of orbits, as of an energy that is kept, has many corrections: the smallest one
    found = np.linalg.lstsq(matrix, right, rcond=noise)[0]
    return np.asarray(found[:n], dtype=float), 0.0 if driven else float(found[n])


def _along(
    passage: Passage, since: float, shot: _Shot, driven: bool, unit: Vector, noise: float
) -> _Shot | None:
    """The motion after a step of Newton's method, or a part of one; None where none is nearer.

    A step is nearer when the correction that is left, by the same linear map, is smaller: the
    missing part itself may grow at first on the way to an unstable orbit (P. Deuflhard, Newton
    Methods for Nonlinear Problems, section 3.3).
    """
    way, longer = _newton(shot, driven, shot.missing, noise)
    size = float(np.hypot(np.linalg.norm(way), longer))
    part = min(1.0, 0.3 * shot.period / abs(longer)) if longer else 1.0
    for _ in range(ORBIT.most_halvings):
        try:
            x, period = shot.x + part * way, shot.period + part * longer
            found = _shoot(passage, since, period, x, unit)
        except SimulationError:
            part /= 4
            continue
        if np.isfinite(found.closure):
            left, rest = _newton(shot, driven, found.missing, noise)
            if np.hypot(np.linalg.norm(left), rest) < (1.0 - part / 4) * size:
                return found
        part /= 2
    return None
