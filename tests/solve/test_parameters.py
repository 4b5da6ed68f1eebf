"""The values of parameters: those that follow others do so each time."""

from __future__ import annotations

import pytest
from solve.models import made
from tracewire.errors import OptionError
from tracewire.solve import parameter_values

MODEL = made("""
span: [0, 1]
parameters: {area: width*height, width: 2, height: 3, double: 2*area, other: 7}
record: [x]
blocks:
  x: {type: integrator, of: rate}
  rate: {type: gain, of: x, k: -double*other}
""")


def test_what_follows_a_given_value_follows_each_of_them() -> None:
    for width in (5.0, 4.0, 5.0):  # the second time it is known what follows
        values = parameter_values(MODEL, {"width": width})
        assert values["area"] == 3 * width
        assert values["double"] == 6 * width
        assert values["other"] == 7.0
        assert list(values) == list(MODEL.parameters)
    assert parameter_values(MODEL, {"area": 1.0})["double"] == 2.0
    assert parameter_values(MODEL, {})["area"] == 6.0


def test_values_that_cannot_be_are_told_together() -> None:
    with pytest.raises(OptionError) as caught:
        parameter_values(MODEL, {"widht": 1.0, "height": float("nan")})
    said = [problem.what for problem in caught.value.problems]
    assert len(said) == 2
    assert "widht" in said[0]
    assert said[1] == "the parameter 'height' is given as nan, which is not a finite number"
