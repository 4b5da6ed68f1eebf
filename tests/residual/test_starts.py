"""A run begins where the series says, else at what the data tell, else where the diagram does."""

from __future__ import annotations

import numpy as np
import pytest
from residual.models import OSCILLATOR, T, made, oscillation, series
from tracewire.errors import OptionError
from tracewire.residual import Measured, Sensor
from tracewire.residual.starts import start_from_data, whole_segment


@pytest.mark.parametrize("row", [0, 60, 120])
def test_a_quartic_is_read_off_exactly(row: int) -> None:
    t = T - 2.0
    x = 1 - 2 * t + 0.5 * t**2 - 0.1 * t**3 + 0.03 * t**4
    v = -2 + t - 0.3 * t**2 + 0.12 * t**3
    found = start_from_data(made(OSCILLATOR), series(x), row)
    assert found == pytest.approx({"x": x[row], "v": v[row]}, abs=1e-9)


def test_a_known_offset_is_taken_off() -> None:
    found = start_from_data(
        made(OSCILLATOR), series(0 * T + 1.2, sensors={"x": Sensor(offset=0.2)}), 0
    )
    assert found == pytest.approx({"x": 1.0, "v": 0.0}, abs=1e-9)


def test_a_measured_rate_is_not_differentiated() -> None:
    measured = Measured("run", "train", T, {"x": 0 * T, "v": 0 * T + 5.0})
    assert start_from_data(made(OSCILLATOR), measured, 3)["v"] == pytest.approx(5.0)


def test_a_signal_that_is_no_state_tells_no_start() -> None:
    measured = Measured("run", "train", T, {"a": 0 * T})
    assert start_from_data(made(OSCILLATOR), measured, 0) == {}


@pytest.mark.parametrize("row", [0, 3, 60, 120])
def test_few_samples_a_period_tell_a_start_through_fewer_of_them(row: int) -> None:
    rate = 2 * np.pi / (12 * (T[1] - T[0]))  # 12 samples a period
    coarse = series(np.cos(rate * T))
    assert coarse.quartic_points == {"x": 7}
    found = start_from_data(made(OSCILLATOR), coarse, row)
    assert found["x"] == pytest.approx(np.cos(rate * T[row]), abs=0.01)
    assert found["v"] == pytest.approx(-rate * np.sin(rate * T[row]), abs=0.1 * rate)


def test_noise_alone_makes_no_signal_bend() -> None:
    noise = np.random.default_rng(5).normal(0, 0.01, (50, len(T)))
    points = [series(oscillation(T) + one).quartic_points["x"] for one in noise]
    assert points == [17] * 50


@pytest.mark.parametrize("count", [2, 3, 5])
def test_few_samples_give_a_lower_degree(count: int) -> None:
    t = np.arange(count) * 0.1
    found = start_from_data(made(OSCILLATOR), series(3 - 2 * t, t=t), 0)
    assert found == pytest.approx({"x": 3.0, "v": -2.0})


def test_without_start_values_the_run_begins_where_the_diagram_does() -> None:
    late = T[20:]
    segment = whole_segment(made(OSCILLATOR), series(oscillation(late), t=late))
    assert (segment.begin, dict(segment.start), segment.free) == (0.0, {}, ())
    early = T - 1.0
    assert whole_segment(made(OSCILLATOR), series(oscillation(T), t=early)).begin == -1.0


def test_with_start_values_it_begins_at_the_first_sample() -> None:
    late = T[20:]
    measured = series(oscillation(late), t=late, start={"x": 0.25, "v": None})
    segment = whole_segment(made(OSCILLATOR), measured)
    assert segment.begin == late[0]
    assert segment.free == ("v",)
    assert segment.start["x"] == 0.25
    h = 1e-6
    rate = (oscillation(late[0] + h) - oscillation(late[0] - h)) / (2 * h)
    assert segment.start["v"] == pytest.approx(rate, abs=0.02)


def test_a_free_start_that_the_data_do_not_tell_begins_where_the_diagram_does() -> None:
    measured = Measured("run", "train", T, {"v": 0 * T}, start={"x": None}, preset="pulled")
    assert whole_segment(made(OSCILLATOR), measured).start == {"x": 1.5}


def test_a_start_of_an_unknown_state_is_told() -> None:
    with pytest.raises(OptionError, match="unknown state 'y'; there are: v, x"):
        whole_segment(made(OSCILLATOR), series(0 * T, start={"y": 1.0}))
