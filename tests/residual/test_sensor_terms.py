"""The table of what a sensor may do agrees with the formula of the sensor."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from tracewire.diagram import Channel
from tracewire.formula import evaluate, parse
from tracewire.library import SENSOR_TERMS
from tracewire.residual import Sensor

Z = np.array([0.3, -1.2, 2.0])
SINCE = np.array([0.0, 0.5, 1.5])


def test_a_sensor_and_a_channel_have_each_term_and_a_plain_sensor_does_nothing() -> None:
    neutral = {name: term.neutral for name, term in SENSOR_TERMS.items()}
    assert {f.name: f.default for f in fields(Sensor) if f.name != "free"} == neutral
    assert neutral.keys() < {f.name for f in fields(Channel)}
    assert np.array_equal(Sensor().observe(Z, SINCE), Z)


@pytest.mark.parametrize("name", [name for name, term in SENSOR_TERMS.items() if term.slope])
def test_a_slope_is_the_derivative_of_what_is_shown(name: str) -> None:
    slope = SENSOR_TERMS[name].slope
    assert slope is not None
    sensor = Sensor(offset=0.2, gain=1.1, quad=0.3, drift=0.4)
    moved: dict[str, Any] = {name: getattr(sensor, name) + 1.0}  # each number enters linearly
    change = replace(sensor, **moved).observe(Z, SINCE) - sensor.observe(Z, SINCE)
    np.testing.assert_allclose(change, np.broadcast_to(slope(Z, SINCE), 3), rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("name", SENSOR_TERMS)
def test_the_formula_that_is_told_is_what_a_sensor_shows(name: str) -> None:
    known = SENSOR_TERMS[name]
    formula = parse(known.shown)
    sensor = Sensor(**{name: 0.7})  # type: ignore[arg-type]
    for z, since, shown in zip(Z, SINCE, sensor.observe(Z, SINCE), strict=True):
        values = {"z": z, "t": 3 + since, "t0": 3.0, name: 0.7}
        assert evaluate(formula, values) == pytest.approx(shown)


def test_a_number_is_scaled_as_its_unit_says() -> None:
    factors = {name: term.factor(0.01) for name, term in SENSOR_TERMS.items()}
    assert factors == {"offset": 0.01, "gain": 1.0, "delay": 1.0, "quad": 100.0, "drift": 0.01}
