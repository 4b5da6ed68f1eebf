"""Signals of different units are weighed against each other by their noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from residual.models import T, made
from tracewire.fit import fit
from tracewire.residual import Measured


def test_signals_of_different_units_count_in_their_noise_where_none_is_declared() -> None:
    """In Pa, whose noise is large in SI, and in m: the sum of both would be that of Pa alone."""
    text = """\
span: [0, 6]
parameters: {a: {value: 1, fit: free}, b: {value: 1, fit: free}}
blocks:
  x: {type: integrator, of: rate, unit: m}
  rate: {type: constant, value: a + b/1000}
  p: {type: integrator, of: rise, unit: Pa}
  rise: {type: constant, value: 2000*b + a}
"""
    rng = np.random.default_rng(8)
    values = {
        "x": 2.001 * T + 1e-3 * rng.standard_normal(T.size),
        "p": 2002 * T + 50 * rng.standard_normal(T.size),
    }
    model = made(text, ("x", "p"))
    found = fit(model, [Measured("run", "train", T, values)], method="least_squares")
    (words,) = [text for text in found.remarks if "have different units" in text]
    assert found.values == pytest.approx({"a": 2, "b": 1}, rel=5e-3)
    assert 0.2 < found.criterion < 2
    assert "x 0.00" in words and "write a `sigma:`" in words
    declared = Measured("run", "train", T, values, {"x": 1e-3, "p": 50.0})
    known = fit(model, [declared], method="least_squares")
    assert found.errors["a"] == pytest.approx(known.errors["a"], rel=0.2)
    weighed = replace(Measured("run", "train", T, values), weights={"p": 1e-9})
    assert not any("units" in text for text in fit(model, [weighed]).remarks)
