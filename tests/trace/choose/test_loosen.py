"""A deflection far below the stroke is found where the record shows it, and only there."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from oracles.oscillator import DAMPING, STEP, STIFFNESS, candidates_of, problem_of
from scipy.integrate import solve_ivp
from tracewire.residual import Measured
from tracewire.residual.windows import Section
from tracewire.trace.choose.heldout import Finalist
from tracewire.trace.choose.horizons import horizons_of
from tracewire.trace.choose.loosen import _loosened, loosen_bounds
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import TraceProblem

OPTIONS = TraceOptions()
NOISE = 1e-4
LEAST = 0.02
"""The hundredth of a stroke of 2 m, below which no deflection is sought at first."""


@cache
def swing(deflection: float) -> TraceProblem:
    """A spring with Dahl friction of 2 m/s^2, whose swing dies out within a stroke of 2 m."""

    def rates(_: float, state: np.ndarray) -> list[float]:
        x, v, z = state.tolist()
        return [v, -STIFFNESS * x - DAMPING * v - 2.0 * z, (v - abs(v) * z) / deflection]

    t = np.arange(0.0, 12.0, STEP)
    run = solve_ivp(
        rates, (0, 12), [1.0, 0.0, 0.0], "LSODA", t, rtol=1e-9, atol=1e-10, max_step=STEP
    )
    x = run.y[0] + NOISE * np.random.default_rng(1).standard_normal(len(t))
    series = Measured("swing", "train", t, {"x": x}, start={"x": None, "v": None})
    return problem_of(series, sigma=NOISE)


def fitted(problem: TraceProblem) -> Finalist:
    (series,) = problem.measured
    sections = [Section(series, 0, len(series.t))]
    at = horizons_of(problem.declared, sections, [], problem.states, problem.sigma, OPTIONS)
    candidate = candidates_of(problem)["hysteresis @ force"]
    assert candidate.limits["deflection"][0] == pytest.approx(LEAST)
    effect = PlacedEffect(candidate, {"level": 2.0, "deflection": 0.05})
    return Finalist(tuple(problem.fit([effect], [*h.segments], h.length, {}) for h in at.each))


def test_a_deflection_on_its_bound_is_freed_below_it() -> None:
    problem = swing(0.004)
    model = fitted(problem)
    assert model.trials[-1].effects[0].values["deflection"] == pytest.approx(LEAST, rel=0.01)
    found = loosen_bounds(problem, model, OPTIONS)
    assert found is not None
    assert found.trials[-1].effects[0].values["deflection"] == pytest.approx(0.004, rel=0.05)
    assert found.trials[-1].effects[0].candidate.limits["deflection"][0] == pytest.approx(0.002)


def test_one_inside_its_bounds_stays() -> None:
    problem = swing(0.06)
    model = fitted(problem)
    assert model.trials[-1].effects[0].values["deflection"] == pytest.approx(0.06, rel=0.02)
    assert loosen_bounds(problem, model, OPTIONS) is None


def test_a_small_gain_frees_none() -> None:
    """A deflection that is hardly below its bound fits nearly as well on it."""
    problem = swing(0.0199)
    assert loosen_bounds(problem, fitted(problem), OPTIONS) is None


def test_a_wave_is_not_freed_below_what_its_samples_show() -> None:
    candidate = candidates_of(swing(0.06))["cogging @ force"]
    low, _ = candidate.limits["pitch"]
    effect = PlacedEffect(candidate, {"amplitude": 1.0, "pitch": low, "phase": 0.0})
    assert _loosened(effect, {effect.unknown("pitch")}, 0.1) is effect
