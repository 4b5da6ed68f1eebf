"""Each method on the kind of record that it is for, and what only it can do."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from residual.models import OSCILLATOR, T, made, oscillation, series
from scipy.integrate import solve_ivp
from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.errors import FitError, OptionError
from tracewire.fit import Fit, fit, optimset
from tracewire.residual import Measured

TRUE = {"k": 4.0, "c": 0.3}
LONG = np.linspace(0.0, 60.0, 1201)

LORENZ = """\
title: A chaotic system
span: [0, 12]
record: [x, y, z]
parameters:
  s: {value: 12, fit: [3, 30]}
  r: {value: 24, fit: [9, 80]}
  b: {value: 3.2, fit: [1, 8]}
blocks:
  x: {type: integrator, of: dx, start: 1}
  y: {type: integrator, of: dy, start: 1}
  z: {type: integrator, of: dz, start: 20}
  dx: {type: expression, formula: s*(y - x)}
  dy: {type: expression, formula: x*(r - z) - y}
  dz: {type: expression, formula: x*y - b*z}
"""
CHAOTIC = {"s": 10.0, "r": 28.0, "b": 8 / 3}

STEPPED = """\
title: A level that is found on one side of a jump only
span: [0, 1]
parameters:
  a: {value: 0.80, fit: [0.2, 3]}
  b: {value: 1.3, fit: [0.2, 3]}
blocks:
  x: {type: integrator, of: rate, start: 0}
  rate: {type: expression, formula: "a*b + (0 if a >= 0.82 else 3) + 0.1*a"}
"""


def quiet(evaluations: float | str = "1000*numberofvariables", **more: Any) -> Any:
    return optimset(
        Display="off", MaxIter="1000*numberofvariables", MaxFunEvals=evaluations, **more
    )


def long_series(x0: float = 1.0) -> Measured:
    return series(oscillation(LONG, x0, c=0.05), t=LONG, start={"x": x0, "v": 0.0})


def lorenz(noise: float = 0.0, end: float = 12.0) -> Measured:
    t = np.linspace(0.0, end, round(50 * end) + 1)

    def rates(_: float, u: Any) -> list[float]:
        x, y, z = u
        s, r, b = CHAOTIC.values()
        return [s * (y - x), x * (r - z) - y, x * y - b * z]

    run = solve_ivp(rates, (0, end), [1, 1, 20], t_eval=t, rtol=1e-11, atol=1e-11, method="DOP853")
    values = run.y + noise * np.random.default_rng(3).standard_normal(run.y.shape)
    return Measured("lorenz", "train", t, dict(zip("xyz", values, strict=True)))


@pytest.fixture(scope="module")
def oscillator() -> Model:
    return made(OSCILLATOR)


@pytest.fixture(scope="module")
def chaotic() -> Model:
    return compile(read_text(LORENZ))


# --- growing windows ------------------------------------------------------------------------------


def test_on_a_long_record_growing_windows_find_what_least_squares_does_not(
    oscillator: Model,
) -> None:
    """20 swings: from another frequency the criterion has a minimum for each swing."""
    options: Any = {"parameters": {"k": 8.0, "c": 0.05}, "free": ["k"]}
    direct = fit(oscillator, [long_series()], method="least_squares", **options)
    grown = fit(oscillator, [long_series()], method="growing_windows", **options)
    assert abs(direct.values["k"] - 4) > 0.5
    assert grown.values == pytest.approx({"k": 4.0}, rel=1e-4)
    assert grown.exitflag == 1


@settings(max_examples=10, deadline=None)
@given(st.floats(1.5, 12.0), st.floats(0.0, 0.5))
def test_growing_windows_find_the_parameters_from_far_away(k: float, c: float) -> None:
    model = made(OSCILLATOR)
    begin = {"k": k, "c": c}
    found = fit(model, [long_series()], method="growing_windows", parameters=begin)
    assert found.values == pytest.approx({"k": 4.0, "c": 0.05}, rel=1e-3)


def test_growing_windows_grow_every_series_by_itself(oscillator: Model) -> None:
    short = series(oscillation(T, 1.0, c=0.05), name="short", start={"x": 1.0, "v": 0.0})
    begin = {"k": 8.0, "c": 0.3}
    found = fit(oscillator, [long_series(), short], method="growing_windows", parameters=begin)
    assert found.values == pytest.approx({"k": 4.0, "c": 0.05}, rel=1e-4)


def test_growing_windows_find_free_start_values_with_noise(oscillator: Model) -> None:
    noise = 0.02 * np.random.default_rng(1).standard_normal(len(LONG))
    measured = series(oscillation(LONG, 1.2, c=0.05) + noise, t=LONG, start={"x": None, "v": None})
    found = fit(oscillator, [measured], method="growing_windows", parameters={"k": 7.0})
    assert found.values == pytest.approx({"k": 4.0, "c": 0.05}, rel=0.02)
    assert found.starts["run"]["x"] == pytest.approx(1.2, abs=0.02)


def test_limits_hold_on_parts_of_a_series(oscillator: Model) -> None:
    begin = {"k": 8.0, "c": 0.3}
    found = fit(
        oscillator, [long_series()], method="growing_windows", parameters=begin, options=quiet(20)
    )
    assert found.exitflag == 0
    assert "MaxFunEvals is 20" in found.message


# --- shooting -------------------------------------------------------------------------------------


def stepped(evaluations: int, method: str, seed: int = 0) -> Fit:
    """From a = 0.8 every minimum lies behind a jump of the criterion."""
    model = made(STEPPED)
    t = np.linspace(0, 1, 21)
    measured = series(1.1 * t, t=t, start={"x": 0.0})
    return fit(model, [measured], method=method, options=quiet(evaluations), seed=seed)


@pytest.mark.parametrize("seed", range(3))
def test_shots_land_on_the_other_side_of_a_jump(seed: int) -> None:
    stuck = stepped(400, "least_squares")
    found = stepped(400, "shooting", seed)
    assert stuck.values["a"] < 0.82
    assert found.values["a"] >= 0.82
    assert found.criterion < 1e-8


def test_the_seed_decides_where_shots_go() -> None:
    one, again, other = (stepped(60, "shooting", seed) for seed in (1, 1, 2))
    assert one.values == again.values
    assert one.history[-1].evaluations == again.history[-1].evaluations
    assert one.values != other.values


# --- multistart -----------------------------------------------------------------------------------


def test_multistart_finds_the_lowest_of_many_minima(oscillator: Model) -> None:
    options: Any = {"parameters": {"k": 18.0, "c": 0.05}, "free": ["k"]}
    one = fit(oscillator, [long_series()], method="least_squares", **options)
    found = fit(oscillator, [long_series()], method="multistart", seed=3, **options)
    assert one.criterion > 1e-3
    assert found.values == pytest.approx({"k": 4.0}, rel=1e-4)
    assert "of 33 points led to the best minimum" in found.message


def test_multistart_refuses_parameters_without_bounds(oscillator: Model) -> None:
    with pytest.raises(OptionError) as caught:
        fit(oscillator, [long_series()], method="multistart", free=["k", "x0"])
    told = str(caught.value)
    assert "multistart needs bounds, and there are none of x0" in told
    assert "k: {value: 1, fit: [0.1, 10]}" in told


# --- multiple shooting ----------------------------------------------------------------------------


@pytest.mark.parametrize("noise", [0.0, 0.2])
def test_multiple_shooting_finds_the_parameters_of_a_chaotic_record(
    chaotic: Model, noise: float
) -> None:
    measured = [lorenz(noise)]
    one = fit(chaotic, measured, method="least_squares", options=quiet(300))
    found = fit(chaotic, measured, method="multiple_shooting")
    assert abs(one.values["r"] - 28) > 1
    assert found.values == pytest.approx(CHAOTIC, rel=1e-5 if noise == 0 else 0.01)


@pytest.mark.slow
def test_multiple_shooting_says_how_far_segments_are_apart(chaotic: Model) -> None:
    found = fit(chaotic, [lorenz(0.2, 25.0)], method="multiple_shooting")
    assert found.values == pytest.approx(CHAOTIC, rel=0.01)
    assert "segments" in found.message
    assert all(np.isfinite(c.after).all() for c in found.comparisons)


def test_segments_of_a_record_that_is_not_chaotic_grow_together(oscillator: Model) -> None:
    measured = series(oscillation(T), start={"x": 1.0, "v": 0.0})
    found = fit(oscillator, [measured], method="multiple_shooting", parameters={"k": 8.0})
    assert found.values == pytest.approx(TRUE, rel=1e-4)
    assert "have grown together" in found.message
    assert len(found.starts["run"]) == 0


def test_multiple_shooting_tells_a_segment_that_does_not_run() -> None:
    """The run comes to 1; where the data are at 3, a segment begins where there is no rate."""
    model = made("""
span: [0, 6]
parameters: {a: {value: 1, fit: [0.1, 10]}}
blocks:
  x: {type: integrator, of: rate, start: 0}
  rate: {type: expression, formula: a*log(2 - x)}
""")
    measured = series(np.where(T[-1] > 2 * T, 1 - np.exp(-T), 3.0), start={"x": 0.0})
    with pytest.raises(FitError) as caught:
        fit(model, [measured], method="multiple_shooting")
    assert "a segment does not run: " in str(caught.value)
