"""Records with other units or a shifted drive are told, and records with an effect are not."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import DataError
from tracewire.residual import Measured
from tracewire.trace.check.mistakes import likely_lags, refuse_mistakes, shift_inputs
from tracewire.trace.options import TraceOptions

OPTIONS = TraceOptions()

DRIVEN = """\
span: [0, 8]
inputs: {u: {unit: rad/s^2}}
parameters: {k: {value: 8, fit: [1, 30]}, c: {value: 0.3, fit: [0, 3]}}
blocks:
  theta: {type: integrator, of: omega, unit: rad}
  omega: {type: integrator, of: torque, unit: rad/s}
  height: {type: sin, of: theta}
  weight: {type: gain, of: height, k: -k}
  damper: {type: gain, of: omega, k: -c}
  torque: {type: sum, of: [u, weight, damper]}
"""
MODEL = compile(read_text(DRIVEN), record=("theta",))
NOISE = 1e-3
T = np.arange(0.0, 5.0, 0.01)


def drive(t: np.ndarray) -> np.ndarray:
    return np.asarray(3 * np.sin(4.1 * t) + 2 * np.sin(7.3 * t + 1))


def record(law: Callable[[float, float], float] = lambda q, v: 0.0, late: float = 0.0) -> Measured:
    """A pendulum with a further torque law(q, v), whose drive is written down `late` s late."""

    def rates(t: float, x: np.ndarray) -> list[float]:
        return [x[1], float(drive(np.array(t))) - 9 * np.sin(x[0]) - 0.2 * x[1] + law(*x)]

    theta = solve_ivp(rates, (0, 5), [0.6, 0.0], t_eval=T, rtol=1e-9, atol=1e-9).y[0]
    noisy = theta + NOISE * np.random.default_rng(3).standard_normal(len(T))
    start = {"theta": None, "omega": None}
    return Measured(
        "run", "train", T, {"theta": noisy}, inputs={"u": (T, drive(T - late))}, start=start
    )


def refused(m: Measured) -> str:
    with pytest.raises(DataError) as caught:
        refuse_mistakes(MODEL, [m], OPTIONS.check)
    return str(caught.value)


def test_a_drive_that_comes_after_its_response() -> None:
    text = refused(record(late=0.3))
    assert re.search(r"times better if its signals come about 0\.3\d? s before its drive\. A", text)


def test_angles_in_degrees() -> None:
    m = record()
    text = refused(replace(m, values={"theta": np.degrees(m.values["theta"])}))
    assert "times better if 'theta' is in degrees, and not radians. Say the unit" in text


def test_an_input_in_thousandths() -> None:
    m = record()
    text = refused(replace(m, inputs={"u": (T, 1000 * drive(T))}))
    assert "times better if the input 'u' is in thousandths of its unit" in text


@pytest.mark.parametrize(
    "law",
    [
        lambda q, v: 0.0,
        lambda q, v: -1.5 * np.tanh(v / 0.05),
        lambda q, v: -6.0 * q**3,
        lambda q, v: -0.5 * v * abs(v),
        lambda q, v: 2.0,
    ],
)
def test_a_missing_effect_is_no_mistake(law: Callable[[float, float], float]) -> None:
    refuse_mistakes(MODEL, [record(law)], OPTIONS.check)


def test_lags_are_found_and_undone() -> None:
    for late in (-0.4, 0.0, 0.25):
        m = record(late=late)
        lag = likely_lags(MODEL, m, OPTIONS.check)[0]
        assert lag == pytest.approx(-late, abs=0.011)
        t, u = shift_inputs(m, lag).inputs["u"]
        assert np.interp(2.0, t, u) == pytest.approx(drive(np.array([2.0]))[0], abs=0.3)


def test_nothing_is_tried_near_the_noise() -> None:
    refuse_mistakes(MODEL, [record(late=0.3)], OPTIONS.check, reduced_chi2=1.2)
