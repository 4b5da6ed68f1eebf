"""The methods: their orders, what stands inside a step, stiffness, fixed steps up to events."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from solve.models import BALL, LIMITS, kinds, made, one, run
from tracewire.compile import Model
from tracewire.errors import OptionError, SimulationError
from tracewire.solve import simulate
from tracewire.solve.core import methods

Vector = NDArray[np.float64]
ADAPTIVE = ["dormand_prince", "dop853", "rosenbrock"]
ALL: list[dict[str, Any]] = [*({"method": name} for name in ADAPTIVE)]
ALL += [{"method": "rk4", "step": 0.01}, {"method": "auto"}]
SAMPLES = np.linspace(0, 6, 1201)  # nearly all of them lie inside steps


def test_the_core_knows_each_method_by_its_place_in_the_table() -> None:
    numbers = {"dormand_prince": methods.DORMAND_PRINCE, "rosenbrock": methods.ROSENBROCK}
    numbers |= {"dop853": methods.DOP853, "rk4": methods.RK4}
    assert numbers == {name: number for number, name in enumerate(methods.NAMES)}


@cache
def twisted() -> Model:
    """x = exp(sin(t)) and y = t**2: nonlinear, coupled, and it reads the time."""
    return made("""
span: [0, 6]
blocks:
  x: {type: integrator, of: a, start: 1}
  a: {type: expression, formula: x*cos(t)}
  y: {type: integrator, of: b}
  b: {type: expression, formula: "2*t*(x*exp(-sin(t)))**2 + (t*t - y)/(1 + t)"}
""")


def worst(**options: Any) -> tuple[int, float]:
    """Steps, and the largest error of all samples."""
    result = simulate(twisted(), times=SAMPLES, limits=LIMITS, **options)
    off = [result["x"] - np.exp(np.sin(SAMPLES)), result["y"] - SAMPLES**2]
    return result.statistics.steps, float(np.abs(off).max())


def order(coarse: tuple[int, float], fine: tuple[int, float]) -> float:
    """The power of the number of steps with which the error falls."""
    return math.log(coarse[1] / fine[1]) / math.log(fine[0] / coarse[0])


@pytest.mark.parametrize(
    ("method", "rtol", "exact"),
    [("dormand_prince", 1e-7, 5), ("rosenbrock", 1e-7, 5), ("dop853", 1e-10, 8)],
)
def test_the_order_of_a_method_at_and_inside_its_steps(
    method: str, rtol: float, exact: int
) -> None:
    coarse, fine = (worst(method=method, rtol=r, atol=r * 1e-3) for r in (rtol, rtol / 1000))
    assert exact - 0.3 < order(coarse, fine) < exact + 0.7


def test_the_order_of_the_classical_method_is_four() -> None:
    coarse, fine = (worst(method="rk4", step=h) for h in (0.04, 0.02))
    assert fine[0] == 2 * coarse[0] == 300
    assert order(coarse, fine) == pytest.approx(4, abs=0.2)


@pytest.mark.parametrize("method", ["auto", *ADAPTIVE])
def test_the_error_is_of_the_size_of_the_tolerance(method: str) -> None:
    exact = {"x": math.exp(math.sin(6)), "y": 36}
    for rtol in (1e-4, 1e-7, 1e-10):
        result = simulate(twisted(), method=method, rtol=rtol)
        assert result.final == pytest.approx(exact, rel=30 * rtol)


@pytest.mark.parametrize(
    ("options", "degree"),
    [
        ({"method": "dormand_prince"}, 4),
        ({"method": "dop853"}, 7),
        ({"method": "rosenbrock"}, 4),
        ({"method": "rk4", "step": 0.5}, 3),
    ],
)
def test_a_polynomial_stands_inside_a_step(options: dict[str, Any], degree: int) -> None:
    """x = t**n is met at every sample up to the degree, and not much beyond it."""
    found = {}
    for power in (degree, degree + 2):
        result = run(one(f"{power}*t**{power - 1}"), rtol=0.5, **options)
        assert result.statistics.steps < 40
        found[power] = float(np.abs(result["x"] - result.t**power).max())
    assert found[degree] < 1e-13
    assert found[degree + 2] > 1e-12


@pytest.mark.parametrize("options", ALL)
def test_samples_do_not_change_the_steps(options: dict[str, Any]) -> None:
    many = simulate(twisted(), times=SAMPLES, **options)
    few = simulate(twisted(), times=[1.0, 6.0], **options)
    assert few.statistics.steps == many.statistics.steps
    assert few.final == many.final
    assert few["x"].tolist() == many["x"][[200, 1200]].tolist()


DECAY = one("-k*(x - cos(t)) - sin(t)", 1.5).replace("blocks:", "parameters: {k: 1e8}\nblocks:")


def test_the_stiff_method_swallows_a_fast_decay() -> None:
    result = run(DECAY, method="rosenbrock", rtol=1e-8)
    assert result.statistics.stiff_steps == result.statistics.steps < 500
    assert result["x"][1:] == pytest.approx(np.cos(result.t[1:]), abs=1e-7)


@pytest.mark.parametrize("method", ["dormand_prince", "dop853"])
def test_an_explicit_method_pays_for_stiffness(method: str) -> None:
    """Stability asks for steps of some 3/k."""
    result = run(DECAY, method=method, parameters={"k": 3000.0}, span=(0, 3))
    assert result.statistics.stiff_steps == 0
    assert 1000 < result.statistics.steps < 9000
    swift = run(DECAY, method="rosenbrock", parameters={"k": 3000.0}, span=(0, 3))
    assert swift.statistics.steps < 100


def test_auto_is_stiff_in_the_stiff_mode_only() -> None:
    text = """
span: [0, 4]
blocks:
  x: {type: integrator, of: rate, start: 1}
  k: {type: expression, formula: 1e6 if t >= 1 and t < 2 else 1}
  rate: {type: expression, formula: -k*(x - cos(t)) - sin(t)}
"""
    for calm in ((0, 1), (2, 4)):
        assert run(text, span=calm).statistics.stiff_steps == 0
    whole = run(text).statistics
    assert 0 < whole.stiff_steps < whole.steps / 2
    assert whole.steps < 100
    again = run(text, rtol=1e-9)
    assert again["x"] == pytest.approx(np.cos(again.t), abs=1e-6)


def test_a_measured_input_is_found_stiff_once_and_not_at_each_of_its_points() -> None:
    model = made("""
span: [0, 1]
inputs: {u: {default: 0}}
blocks:
  x: {type: integrator, of: a}
  a: {type: expression, formula: "-1e5*(x - u)"}
""")
    t = np.linspace(0, 1, 101)
    result = simulate(model, inputs={"u": (t, np.sin(6 * t))}, times=t)
    assert result.statistics.stiff_steps > 0.7 * result.statistics.steps
    assert result["x"] == pytest.approx(np.sin(6 * t), abs=1e-4)


def test_auto_never_takes_a_stiff_step_where_nothing_is_stiff() -> None:
    free = simulate(twisted())
    assert free.statistics.stiff_steps == 0
    assert free.final == simulate(twisted(), method="dormand_prince").final


def test_fixed_steps_are_as_long_as_asked_for() -> None:
    assert run(one("cos(t)"), method="rk4", step=0.1).statistics.steps == 10
    assert run(one("cos(t)"), method="rk4", step=0.3).statistics.steps == 4
    assert run(one("cos(t)"), method="rk4", step=1.0).statistics.steps == 1
    assert run(one("cos(t)"), method="rk4", step=0.1).statistics.rejected == 0


def test_fixed_steps_end_on_events() -> None:
    """The cubic of a step is exact for a ball in flight."""
    result = simulate(made(BALL), method="rk4", step=0.25, span=(0, 4))
    fall = math.sqrt(2 * 10 / 9.81)
    assert kinds(result) == ["reset"] * 2
    times = [event.time for event in result.events]
    assert times == pytest.approx([fall, fall * 2.6], abs=1e-12)
    since = 4 - fall * 2.6
    exact = 0.64 * 9.81 * fall * since - 9.81 / 2 * since**2
    assert result.final["x"] == pytest.approx(exact, abs=1e-11)


def test_fixed_steps_end_on_known_times() -> None:
    """x is |t - 1/3| at every sample, although no whole number of steps reaches 1/3."""
    result = run(one("-1 if t < 1/3 else 1", 1 / 3), method="rk4", step=0.25)
    assert [event.time for event in result.events] == [1 / 3]
    assert result["x"] == pytest.approx(np.abs(result.t - 1 / 3), abs=1e-15)


def test_fixed_steps_stick() -> None:
    result = run(one("0.5*t - 0.25 - sign(x)", 0.25), method="rk4", step=0.1, span=(0, 4))
    assert kinds(result) == ["stick", "slip"]
    assert result.events[1].time == pytest.approx(2.5, abs=1e-12)
    assert result.final["x"] == pytest.approx(0.25 * 1.5**2, abs=1e-12)


@pytest.mark.parametrize("options", ALL)
def test_every_method_says_where_the_rates_end_to_be_defined(options: dict[str, Any]) -> None:
    with pytest.raises(SimulationError, match=r"t = 0\.61\d* s: 'x' is not finite \(nan\)"):
        run(one("-1 - sqrt(x)", 1.0), **options)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"method": "rk5"},
            r"'rk5'; there are: auto, dop853, dormand_prince, rk4, rosenbrock.*mean 'rk4'",
        ),
        ({"method": ""}, r"unknown method ''; there are: auto"),
        ({"method": "rk4"}, r"the method rk4 needs a step.*method='rk4' and step= in s together"),
        ({"step": 0.1}, r"only the method rk4 takes a step.*method='rk4' and step= in s together"),
        ({"method": "rosenbrock", "step": 0.1}, r"only the method rk4 takes a step"),
        ({"method": "rk4", "step": 0.0}, r"steps of 0 s do not fit into a span of 1 s"),
        ({"method": "rk4", "step": -0.1}, r"steps of -0.1 s do not fit"),
        ({"method": "rk4", "step": 1.5}, r"steps of 1.5 s do not fit.*above 0 and below the span"),
        ({"method": "rk4", "step": math.nan}, r"steps of nan s do not fit"),
    ],
)
def test_a_method_that_does_not_go_is_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(OptionError, match=message):
        run(one("1"), **options)
