"""Numbers of a series that have no meaning are refused where it is made, in words."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import DataError, OptionError
from tracewire.fit import fit
from tracewire.residual import Measured

T = np.linspace(0, 1, 30)
ANY: Any = Measured
"""The same without types: what a user may write."""
FRAME = {"t": T, "x": np.cos(3 * T)}
MODEL = """\
span: [0, 1]
parameters: {k: {value: 9, unit: 1/s^2, fit: [1, 20]}}
inputs: {F: {unit: N, default: 0}}
blocks:
  x: {type: integrator, of: v, start: 1, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  a: {type: gain, of: x, k: -k}
"""


@pytest.mark.parametrize("sigma", [0, -1e-4, float("nan"), float("inf"), True])
def test_a_sigma_that_is_not_above_zero_is_refused(sigma: float) -> None:
    words = "sigma of 'x' of the series .* must be a number above zero, not .*noise is estimated"
    with pytest.raises(DataError, match=words):
        ANY.from_frame(FRAME, ["x"], sigma={"x": sigma})
    with pytest.raises(DataError, match=words):
        ANY("one", "train", T, {"x": FRAME["x"]}, sigma={"x": sigma})


def test_a_sigma_that_is_a_text_is_refused() -> None:
    with pytest.raises(OptionError, match=r"sigma\['x'\] is 'a', and not a number"):
        ANY.from_frame(FRAME, ["x"], sigma={"x": "a"})
    with pytest.raises(DataError, match="must be a number above zero, not 'a'"):
        ANY("one", "train", T, {"x": FRAME["x"]}, sigma={"x": "a"})


@pytest.mark.parametrize("weight", [0, -1, float("nan"), "2"])
def test_a_weight_that_is_not_above_zero_is_refused(weight: Any) -> None:
    with pytest.raises(DataError, match="weight of the series 'one' must be a number above zero"):
        ANY("one", "train", T, {"x": FRAME["x"]}, weight=weight)
    with pytest.raises(DataError, match="weight of 'x' of the series 'one' must be a number above"):
        ANY("one", "train", T, {"x": FRAME["x"]}, weights={"x": weight})


def test_values_that_are_no_dictionary_are_refused() -> None:
    words = r'values of the series \'one\' is no dictionary. Write values={"x": ...}'
    with pytest.raises(DataError, match=words):
        ANY("one", "train", T, FRAME["x"])


def test_a_use_of_the_yaml_is_refused() -> None:
    with pytest.raises(OptionError, match=r"use is {'train': .*, and not a text"):
        ANY.from_frame(FRAME, ["x"], use={"train": [0, 0.5], "validate": [0.5, 1]})


def test_a_free_start_is_none() -> None:
    with pytest.raises(OptionError, match=r"start\['x'\] is 'free', and not a number. .*None"):
        ANY.from_frame(FRAME, ["x"], start={"x": "free"})
    with pytest.raises(DataError, match=r"the start of 'x' .* not 'free'. None is a free start"):
        ANY("one", "train", T, {"x": FRAME["x"]}, start={"x": "free"})


@pytest.mark.parametrize(
    ("frame", "units"),
    [({"t": T, "x [g]": FRAME["x"]}, {}), (FRAME, {"x": "g"})],
)
def test_a_column_of_another_quantity_is_refused(
    frame: dict[str, Any], units: dict[str, str]
) -> None:
    model = compile(read_text(MODEL))
    start = {"x": None, "v": None}
    series = Measured.from_frame(frame, {"x": "x"}, start=start, units=units)
    with pytest.raises(DataError, match="'x' is in m in the diagram, and in g in the series"):
        fit(model, [series])


def test_an_input_of_another_quantity_is_refused() -> None:
    frame = {**FRAME, "F [V]": np.zeros(30)}
    series = Measured.from_frame(frame, ["x"], inputs=["F"], start={"x": 1.0, "v": 0.0})
    with pytest.raises(DataError, match="'F' is in N in the diagram, and in V in the series"):
        fit(compile(read_text(MODEL)), [series])
