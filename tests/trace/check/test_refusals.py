"""Series that nothing can be traced in are refused with all that is wrong, each with a hint."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import DataError
from tracewire.residual import Measured, Sensor
from tracewire.trace.check.refusals import check_series, rate_ratio, remarks, without_still
from tracewire.trace.options import TraceOptions

OPTIONS = TraceOptions()

MODEL = compile(
    read_text("""\
span: [0, 6]
inputs: {u: {default: 0}}
blocks:
  theta: {type: integrator, of: omega, unit: rad}
  omega: {type: integrator, of: torque, unit: rad/s}
  pull: {type: gain, of: theta, k: -9}
  torque: {type: sum, of: [pull, u]}
"""),
    record=("theta", "omega"),
)
T = np.arange(0.0, 6.0, 0.01)
RNG = np.random.default_rng(5)
NOISE = RNG.standard_normal((2, len(T)))


def swing(**changed: Any) -> Measured:
    """cos(3 t) with noise, and its rate; with other columns or attributes."""
    values = {
        "theta": np.cos(3 * T) + 1e-3 * NOISE[0],
        "omega": -3 * np.sin(3 * T) + 0.1 * NOISE[1],
    }
    given: Mapping[str, Any] = {"name": "run", "use": "train", "t": T, "values": values}
    return Measured(**{**given, **changed})


def theta(values: Any, **changed: Any) -> Measured:
    return swing(values={"theta": np.asarray(values, dtype=float)}, **changed)


def refused(*measured: Measured) -> str:
    with pytest.raises(DataError) as caught:
        check_series(MODEL, measured, OPTIONS.check)
    return str(caught.value)


def test_good_series_pass() -> None:
    check_series(MODEL, [swing(), theta(np.exp(-T) + 0.1 * NOISE[0])], OPTIONS.check)
    check_series(MODEL, [swing(inputs={"u": (T, 0 * T)})], OPTIONS.check)  # a free swing


def test_no_series_to_train_on() -> None:
    assert "no series is for training: run (gate). Give one `use: train`" in refused(
        swing(use="gate")
    )
    assert refused().startswith("no series is for training. ")


def test_too_short() -> None:
    m = theta(np.cos(T[:30]), t=T[:30])
    assert "the series 'run' has 30 samples, too few to trace anything. At least 40" in refused(m)


def test_constant() -> None:
    text = refused(theta(0.3 + 0 * T))
    assert "'theta' of 'run' is constant: 0.3 in every sample. Is the sensor connected?" in text
    assert "noise" not in text


def test_noise_alone() -> None:
    message = "the series 'run' shows nothing above the noise of 'theta'. Nothing moves in it"
    assert message in refused(theta(0.3 + 1e-3 * NOISE[0]))
    assert message in refused(theta(np.where(NOISE[0] > 1, 0.3, 0.301)))  # two steps of a reading
    assert message in refused(theta(np.cos(3 * T), sigma={"theta": 1.0}))


def test_a_series_in_which_nothing_moves_is_left_out_beside_others() -> None:
    still = theta(0.3 + 1e-3 * NOISE[0], name="held")
    constant = theta(0.3 + 0 * T, name="stuck", use="gate")
    moving = swing()
    series, words = without_still([still, moving, constant], OPTIONS.check)
    assert series == (moving,)
    assert words == (
        "held is left out: nothing in it moves beyond the noise of theta. "
        "Say `sigma:` where the noise is smaller.",
        "stuck is left out: nothing in it moves beyond the noise of theta. "
        "Say `sigma:` where the noise is smaller.",
    )


def test_series_in_which_nothing_moves_stay_where_no_other_is_for_training() -> None:
    still, gate = theta(0.3 + 1e-3 * NOISE[0]), swing(use="gate")
    assert without_still([still, gate], OPTIONS.check) == ((still, gate), ())
    broken = replace(swing(), t=T[:5], values={"theta": np.zeros(5), "omega": np.zeros(5)})
    assert without_still([broken, swing()], OPTIONS.check)[1] == ()  # it is refused for its length


@pytest.mark.parametrize("seed", range(20))
def test_noise_is_taken_for_noise_and_a_weak_signal_not(seed: int) -> None:
    noise = np.random.default_rng(seed).standard_normal(len(T))
    assert "shows nothing above" in refused(theta(noise))
    check_series(MODEL, [theta(noise + 2 * np.cos(3 * T))], OPTIONS.check)


def test_a_channel_that_is_noise_in_every_series() -> None:
    values = {**swing().values, "omega": NOISE[1]}
    text = refused(swing(values=values), swing(values=values, name="two"))
    assert text.startswith("'omega' shows nothing above its noise in any series. Is the sensor")
    check_series(MODEL, [swing(), swing(values=values)], OPTIONS.check)
    assert remarks([swing(values=values)], OPTIONS.check) == (
        "run: omega shows nothing above its noise",
    )


def test_inputs_of_another_time() -> None:
    text = refused(theta(np.cos(3 * T), inputs={"u": (T + 100, np.sin(T))}))
    assert "the input 'u' of 'run' is known from 100 to 105.99 s, and its signals are mea" in text


@pytest.mark.parametrize(
    ("factor", "message"),
    [
        (
            np.pi / 180,
            " times 'omega'. Are their units, or that of time, mixed up: degrees beside radians?",
        ),
        (1000.0, "a unit and its thousandth, such as m and mm or s and ms?"),
        (-1.0, "times 'omega'. One of them has the wrong sign: gain: -1 turns it round."),
    ],
)
def test_a_signal_and_its_rate_in_units_that_do_not_match(factor: float, message: str) -> None:
    values = {"theta": np.cos(3 * T), "omega": (-3 * np.sin(3 * T) + 0.1 * NOISE[1]) / factor}
    text = refused(swing(values=values))
    assert "in 'run' the rate of 'theta' is " in text
    assert message in text


def test_a_gain_that_is_near_one_or_free_is_no_mistake() -> None:
    values = swing().values
    check_series(MODEL, [swing(values={**values, "omega": 1.1 * values["omega"]})], OPTIONS.check)
    free = {"omega": Sensor(free={"gain": (-100.0, 100.0)})}
    check_series(
        MODEL, [swing(values={**values, "omega": -values["omega"]}, sensors=free)], OPTIONS.check
    )


def test_the_ratio_needs_signals_that_belong_together() -> None:
    assert rate_ratio(T, np.cos(3 * T), NOISE[0], OPTIONS.check.sure_rate) is None
    assert rate_ratio(T, np.cos(3 * T), 0 * T, OPTIONS.check.sure_rate) is None
    drifting = np.cos(3 * T) + 5 + 0.3 * T
    assert rate_ratio(T, drifting, -1.5 * np.sin(3 * T), OPTIONS.check.sure_rate) == pytest.approx(
        2, rel=1e-3
    )


def test_all_problems_are_told_at_once() -> None:
    text = refused(theta(np.cos(T[:20]), t=T[:20]), theta(0 * T, name="two"))
    assert "'run' has 20 samples" in text
    assert "'theta' of 'two' is constant" in text


def test_remarks_of_the_file_are_passed_on() -> None:
    assert remarks([swing(remarks=("the time step is not regular",))], OPTIONS.check) == (
        "run: the time step is not regular",
    )
