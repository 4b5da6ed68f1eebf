"""What a fit does where there is nothing to gain: no effect on the data, and an exact record."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tracewire.array_types import Vector
from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.fit import Fit, fit
from tracewire.fit.kept import is_exact
from tracewire.fit.methods import METHODS
from tracewire.residual import Measured
from tracewire.solve import simulate

MODEL = """\
span: [0, 8]
parameters: {k: {value: 20, fit: [1, 100]}, c: {value: 0.6, fit: [0, 5]}}
blocks:
  x: {type: integrator, of: v, start: 0.1}
  v: {type: integrator, of: a}
  a: {type: expression, formula: -k*x - c*v}
"""
BESIDE = MODEL.replace("blocks:\n", "blocks:\n  other: {type: integrator, of: dq, start: 1}\n")
BESIDE = BESIDE.replace("}}\n", "}, q: {value: 7, fit: [1, 100]}}\n") + (
    "  dq: {type: gain, of: other, k: -q}\n"
)
T = np.linspace(0, 8, 161)
START = {"x": 0.1, "v": 0.0}


def made(text: str) -> Model:
    return compile(read_text(text))


def record(model: Model, noise: float = 0.0, **values: float) -> Measured:
    run = simulate(model, parameters=values, times=T)
    drawn = np.random.default_rng(1).normal(0, noise, len(T)) if noise else 0.0
    return Measured("one", "train", T, {"x": run["x"] + drawn}, start=START)


@pytest.mark.parametrize("method", METHODS)
def test_a_parameter_without_effect_keeps_its_value(method: str) -> None:
    model = made(BESIDE)
    options = {"MaxFunEvals": 400}
    found = fit(model, [record(model, 1e-3, k=22)], method=method, options=options)
    assert found.values["q"] == 7
    assert abs(found.values["k"] - 22) < 0.5
    assert sorted(found.found) == ["c", "k"]
    assert "q keeps the value with which the search began, and is not written" in found.remarks


def test_a_record_that_the_model_reproduces_exactly_has_nothing_to_gain() -> None:
    model = made(MODEL)
    found = fit(model, [record(model)], rtol=1e-6)
    assert found.criterion_before == 0
    assert found.values == {"k": 20, "c": 0.6}
    assert found.message == "the criterion is 0 at the start: nothing is to gain"


def test_a_perfect_fit_is_not_said_to_have_failed() -> None:
    model = made(MODEL)
    found = fit(model, [record(model)], parameters={"k": 18, "c": 0.1})
    assert found.values == pytest.approx({"k": 20, "c": 0.6})
    assert found.unfinished == ""
    assert "nothing is left that could be noise" in " ".join(found.remarks)


def test_a_fit_to_noise_is_not_said_to_be_exact() -> None:
    model = made(MODEL)
    found: Fit = fit(model, [record(model, 1e-3)])
    assert "nothing is left that could be noise" not in " ".join(found.remarks)


def test_noise_that_is_small_beside_an_offset_is_noise() -> None:
    """0.1 mK on 300 K is below a relative tolerance of 1e-6, and not below what it moves by."""
    t = np.linspace(0, 20, 400)
    noise = 1e-4 * np.random.default_rng(1).standard_normal(len(t))

    def one(measured: Vector, left: Vector) -> Any:
        counts = np.ones(len(t), dtype=bool)
        return SimpleNamespace(use="train", counts=counts, measured=measured, residual_after=left)

    warm = 300 + 2 * np.exp(-0.3 * t)
    assert not is_exact([one(warm + noise, noise)], 1e-6)
    assert is_exact([one(warm, 1e-3 * noise)], 1e-6)
    assert is_exact([one(np.full(len(t), 300.0), noise)], 1e-6)  # of what does not move: its size
