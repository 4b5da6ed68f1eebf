"""What delayed signals were before a window, as the record tells it."""

from __future__ import annotations

import numpy as np
import pytest
import tracewire as tw
from tracewire.errors import OptionError
from tracewire.residual import Measured, Section, Sensor, cut_windows, longest_delay, with_past
from tracewire.solve import values_at

T = np.linspace(0, 10, 501)
TEXT = """
span: [0, 10]
record: [x]
inputs: {u: {default: 0}}
parameters:
  k: {value: 3}
  free: {value: 2, fit: [0, 9]}
blocks:
  x: {type: integrator, of: v, start: 0}
  v: {type: integrator, of: force, start: 1}
  hidden: {type: integrator, of: x, start: 0}
  relay: {type: relay, of: x, off_at: -0.1, on_at: 0.1}
  seen: {type: expression, formula: SEEN}
  late: {type: delay, of: seen, time: 0.5}
  force: {type: expression, formula: -x - late/10}
"""


def record(signal: str = "x") -> Measured:
    drive = {"u": (T, np.cos(T))}
    return Measured("run", "train", T, {signal: np.sin(T)}, inputs=drive, start={signal: None})


def told(seen: str, measured: Measured) -> Measured:
    return with_past(tw.compile(tw.read_text(TEXT.replace("SEEN", seen))), measured, "a window")


def test_a_measured_signal_is_its_channel_without_its_sensor() -> None:
    sensor = Sensor(offset=0.25, gain=2.0, delay=0.1)
    shown = {"seen": 2 * np.sin(T - 0.1) + 0.25}
    m = Measured("run", "train", T, shown, sensors={"seen": sensor})
    past = told("x + hidden", m).past["seen"]
    at = np.linspace(1, 9, 77)
    assert values_at(past, at) == pytest.approx(np.sin(at), abs=1e-4)


def test_a_formula_of_what_the_data_tell_is_computed() -> None:
    past = told("k*v + u + abs(x)", record()).past["seen"]
    at = np.linspace(1, 9, 77)
    right = 4 * np.cos(at) + np.abs(np.sin(at))
    assert values_at(past, at) == pytest.approx(right, abs=1e-2)  # straight lines at the corners


@pytest.mark.parametrize(
    ("seen", "why"),
    [
        ("x + hidden", "it reads the state 'hidden'. Measure 'seen': give its column"),
        ("x*relay", "it reads the memory of 'relay'"),
        ("free*x", "it reads 'free', which a fit changes. Measure 'seen'"),
    ],
)
def test_what_the_record_does_not_tell_is_refused(seen: str, why: str) -> None:
    with pytest.raises(OptionError) as error:
        told(seen, record())
    said = "block 'late': a window begins within the record, which must tell what 'seen' was before"
    assert said in str(error.value)
    assert why in str(error.value)


def test_a_past_that_is_given_stays() -> None:
    given = (T, np.zeros(len(T)))
    m = record()
    own = Measured("run", "train", T, m.values, past={"seen": given})
    assert told("x + hidden", own).past["seen"] is given


def test_the_first_window_is_as_long_as_the_longest_delay() -> None:
    model = tw.compile(tw.read_text(TEXT.replace("SEEN", "x").replace("0.5}", "2.5}")))
    assert longest_delay(model, record()) == 2.5
    windows = cut_windows(model, Section(record(), 0, len(T)), 50, ["x", "v"])
    assert windows[0].begin == 0.0
    assert windows[1].begin >= 2.5
    rows = np.concatenate([window.rows for window in windows])
    assert rows.tolist() == list(range(len(T)))
