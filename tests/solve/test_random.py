"""Random diagrams: both methods agree, nothing hangs, and nothing but our own errors comes out."""

from __future__ import annotations

import numpy as np
import pytest
from compile.formulas import JUMPING, SMOOTH
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from solve.models import made
from tracewire.errors import SimulationError, TracewireError
from tracewire.solve import Limits, Run, simulate

START = st.floats(-2, 2).map(lambda value: round(value, 3))
SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much]


def diagram(x: str, y: str, start: tuple[float, float]) -> str:
    return f"""
span: [0, 2]
blocks:
  x: {{type: integrator, of: f, start: {start[0]}}}
  y: {{type: integrator, of: g, start: {start[1]}}}
  f: {{type: expression, formula: "{x}"}}
  g: {{type: expression, formula: "{y}"}}
"""


@given(x=SMOOTH, y=SMOOTH, start=st.tuples(START, START))
@settings(max_examples=40, deadline=None, suppress_health_check=SLOW)
def test_both_methods_agree_on_smooth_diagrams(x: str, y: str, start: tuple[float, float]) -> None:
    model = made(diagram(x, y, start))
    runs: list[Run] = []
    for method in ("dormand_prince", "rosenbrock"):
        try:
            runs.append(simulate(model, method=method, rtol=1e-8, limits=Limits(steps=2_000_000)))
        except SimulationError as error:  # it runs away: for both methods, then
            assume("steps" not in str(error))  # but one of them may be too slow
            with pytest.raises(SimulationError):
                simulate(model, rtol=1e-6, limits=Limits(steps=2_000_000))
            return
    tall = max(float(np.abs(run[name]).max()) for run in runs for name in "xy")
    near = simulate(model, rtol=1e-8, limits=Limits(steps=2_000_000), start={"x": start[0] + 1e-7})
    stretch = max(float(np.abs(near[name] - runs[0][name]).max()) for name in "xy") / 1e-7
    for name in "xy":
        assert runs[0][name] == pytest.approx(runs[1][name], abs=1e-6 * (1 + tall) * (1 + stretch))


@given(x=JUMPING, y=JUMPING, start=st.tuples(START, START))
@settings(max_examples=120, deadline=None, suppress_health_check=SLOW)
def test_nothing_but_our_errors_comes_out(x: str, y: str, start: tuple[float, float]) -> None:
    limits = Limits(steps=5_000, seconds=20.0)
    try:
        result = simulate(made(diagram(x, y, start)), limits=limits)
    except TracewireError:
        return
    assert np.isfinite(result["x"]).all()
    assert np.isfinite(result["y"]).all()
    times = [event.time for event in result.events]
    assert times == sorted(times)
    assert set(result.final) == {"x", "y"}


@given(
    levels=st.tuples(*[st.floats(0.05, 1).map(lambda v: round(v, 2))] * 2),
    drive=st.floats(0.1, 2).map(lambda v: round(v, 2)),
    start=st.tuples(START, START),
)
@settings(max_examples=30, deadline=None)
def test_friction_never_gives_energy(
    levels: tuple[float, float], drive: float, start: tuple[float, float]
) -> None:
    """Two bodies on springs with friction between them and on the ground: both methods agree."""
    text = f"""
span: [0, 8]
blocks:
  x: {{type: integrator, of: v, start: {start[0]}}}
  v: {{type: integrator, of: a}}
  y: {{type: integrator, of: w, start: {start[1]}}}
  w: {{type: integrator, of: b}}
  slip: {{type: sum, of: [v, -w]}}
  between: {{type: coulomb, rate: slip, level: {levels[0]}}}
  ground: {{type: coulomb, rate: w, level: {levels[1]}}}
  a: {{type: expression, formula: between - x}}
  b: {{type: expression, formula: ground - between - {drive}*y}}
"""
    model = made(text)
    runs = [
        simulate(model, method=method, rtol=1e-8, limits=Limits(steps=2_000_000))
        for method in ("dormand_prince", "rosenbrock")
    ]
    for name in ("x", "y"):
        assert runs[0][name] == pytest.approx(runs[1][name], abs=1e-5)
    for run in runs:
        energy = run["x"] ** 2 + run["v"] ** 2 + drive * run["y"] ** 2 + run["w"] ** 2
        assert np.diff(energy).max() < 1e-6
    assume(runs[0].events)
    assert {event.kind for event in runs[0].events} <= {"crossing", "stick", "slip"}
