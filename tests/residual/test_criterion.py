"""The criterion is what the paper's appendix says, and its derivatives are those of the model."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from subprocess import run
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from residual.models import LINE, OSCILLATOR, C, K, T, criterion_of, made, oscillation, series
from tracewire.errors import DataError, OptionError, SimulationError
from tracewire.residual import Criterion, Measured, Segment, Sensor, Unknown
from tracewire.solve.spans import SpanProblem

LINE_MODEL = made(LINE)


def at(criterion: Criterion, **values: float) -> np.ndarray:
    """The scaled unknowns with some values by name."""
    z = criterion.initial_unknowns()
    for n, unknown in enumerate(criterion.unknowns):
        z[n] = values.get(unknown.name, unknown.value) / criterion.scales[n]
    return z


@given(
    st.floats(-3, 3),
    st.floats(-3, 3),
    st.lists(st.floats(-10, 10), min_size=2, max_size=20),
)
@settings(max_examples=30, deadline=None)
def test_the_criterion_is_the_mean_square_over_two(a: float, b: float, y: list[float]) -> None:
    t = np.arange(len(y)) * 0.25
    criterion = criterion_of(LINE_MODEL, series(y, t=t))
    by_hand = np.mean((np.array(y) - (a * t + b)) ** 2) / 2
    assert criterion.value(at(criterion, a=a, b=b)) == pytest.approx(by_hand, rel=1e-6, abs=1e-12)


def test_series_and_signals_add_up_each_with_its_own_mean() -> None:
    short = T[:31]
    first = Measured("both", "train", T, {"x": 0 * T + 1, "slope": 0 * T + 3})
    second = series(0 * short - 2, "short", t=short)
    criterion = criterion_of(made(LINE, ("x", "slope")), first, second)
    by_hand = np.mean((1 - T) ** 2) / 2 + (3 - 1) ** 2 / 2 + np.mean((-2 - short) ** 2) / 2
    assert criterion.value(at(criterion, a=1, b=0)) == pytest.approx(by_hand)


def test_some_segments_are_as_they_are_among_all() -> None:
    criterion = criterion_of(LINE_MODEL, series(T), series(2 * T, "other"), series(3 * T, "third"))
    named = {"a": 0.5, "b": 0.25}
    asked: list[tuple[int, ...]] = [(0, 1, 2), (1,), (2,), (0, 2), (0, 1, 2)]
    for numbers in asked:  # one after the other: what is kept of the last must not be mistaken
        found = criterion.linearise(named, {n: {} for n in numbers}, slopes=False)
        for n in numbers:
            assert found[n].residual[:, 0] == pytest.approx(0.5 * T + 0.25 - (n + 1) * T, abs=1e-9)


def test_residuals_are_in_units_of_the_noise_of_their_own_series() -> None:
    first = series(0 * T + 1, "first", sigma={"x": 0.5})
    second = series(0 * T + 1, "second", sigma={"x": 0.1})
    criterion = criterion_of(LINE_MODEL, first, second)
    residuals = criterion.residuals(at(criterion, a=0, b=0))
    assert residuals[0] == pytest.approx(np.full((121, 1), -2.0))
    assert residuals[1] == pytest.approx(np.full((121, 1), -10.0))


def test_a_given_sigma_counts_instead_of_the_declared_one() -> None:
    declared = criterion_of(LINE_MODEL, series(0 * T + 1, sigma={"x": 0.5}))
    given_ = Criterion(LINE_MODEL, declared.segments, declared.unknowns, {}, sigma={"x": 0.25})
    assert given_.residuals(at(given_, a=0, b=0))[0] == pytest.approx(np.full((121, 1), -4.0))


def test_a_given_sigma_must_name_every_signal() -> None:
    whole = criterion_of(LINE_MODEL, series(T))
    with pytest.raises(DataError, match="no sigma is known of x in run, but of others"):
        Criterion(LINE_MODEL, whole.segments, whole.unknowns, {}, sigma={"slope": 1.0})


def test_sigma_of_some_signals_only_is_told() -> None:
    model = made(LINE, ("x", "slope"))
    both = {"x": 0 * T, "slope": 0 * T}
    with pytest.raises(DataError) as caught:
        criterion_of(model, Measured("run", "train", T, both, sigma={"x": 0.1, "slope": None}))
    assert str(caught.value) == (
        "no sigma is known of slope in run, but of others. "
        "Give every measured signal a sigma, or none."
    )
    with pytest.raises(DataError, match="no sigma is known of x in second, but of others"):
        criterion_of(model, series(0 * T, sigma={"x": 0.1}), series(0 * T, "second"))


def test_a_declared_offset_is_added_to_the_model() -> None:
    criterion = criterion_of(LINE_MODEL, series(T + 0.25, sensors={"x": Sensor(offset=0.25)}))
    assert criterion.value(at(criterion, a=1, b=0)) == pytest.approx(0, abs=1e-15)


def test_a_free_offset_is_an_unknown_of_all_series() -> None:
    bounds = {"x": Sensor(free={"offset": (-1.0, 1.0)})}
    criterion = criterion_of(
        LINE_MODEL, series(T, sensors=bounds), series(T, "other", sensors=bounds)
    )
    assert [u.name for u in criterion.unknowns] == ["a", "b", "offset.x"]
    z = at(criterion, a=1, b=0, **{"offset.x": 0.5})
    assert criterion.value(z) == pytest.approx(2 * 0.5**2 / 2)
    named, _ = criterion.unpack(z)
    assert named == pytest.approx({"a": 1, "b": 0, "offset.x": 0.5})


def test_what_is_fixed_may_be_a_parameter_or_an_offset() -> None:
    segments = criterion_of(LINE_MODEL, series(T)).segments
    fixed = {"a": 1.0, "b": 0.5, "offset.x": -0.5}
    assert Criterion(LINE_MODEL, segments, [], fixed).value(np.empty(0)) == pytest.approx(0)


def test_the_preset_and_the_inputs_of_a_series_count() -> None:
    text = """\
span: [0, 6]
inputs: {drive: {default: 0}}
parameters: {b: {value: 0, fit: free}, c: 0}
blocks: {x: {type: integrator, of: rate}, rate: {type: sum, of: [drive, level]},
  level: {type: constant, value: c}}
presets: {rising: {c: 2}}
"""
    driven = series(T + T**2 / 2, "driven", inputs={"drive": (T, 1 + T)})
    preset = series(2 * T, "preset", preset="rising")
    criterion = criterion_of(made(text), driven, preset)
    assert criterion.value(criterion.initial_unknowns()) == pytest.approx(0, abs=1e-12)


def test_derivatives_are_those_of_the_exact_solution() -> None:
    measured = series(oscillation(T, x0=0.9))
    criterion = criterion_of(made(OSCILLATOR), measured, rtol=1e-10)
    z = at(criterion, k=K, c=C)
    h = 1e-6
    exact = np.stack(
        [
            (oscillation(T, 0.9, k=K + h) - oscillation(T, 0.9, k=K - h)) / (2 * h),
            (oscillation(T, 0.9, c=C + h) - oscillation(T, 0.9, c=C - h)) / (2 * h),
        ],
        axis=1,
    )
    (matrix,) = criterion.residuals_and_jacobians(z)[1]
    assert matrix / criterion.scales == pytest.approx(exact, abs=1e-7)


@pytest.mark.parametrize("value", [0.0, 1.0])
def test_differences_stand_in_where_sensitivities_fail(
    value: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    tried: list[float] = []
    plain = SpanProblem.run

    def failing(spans: SpanProblem, *arguments: Any) -> Any:
        runs = plain(spans, *arguments)
        if spans.problem.sensitivities:
            return replace(runs, errors={0: SimulationError.one("no sensitivities today")})
        tried.append(spans.problem.parameters["a"])
        return runs

    monkeypatch.setattr(SpanProblem, "run", failing)
    whole = criterion_of(LINE_MODEL, series(T))
    criterion = Criterion(LINE_MODEL, whole.segments, [Unknown("a", value, 0.0, 1.0)], {"b": 0.0})
    (matrix,) = criterion.residuals_and_jacobians(criterion.initial_unknowns())[1]
    assert matrix[:, 0] == pytest.approx(T, abs=1e-6)
    assert all(0 <= a <= 1 for a in tried)  # they stay inside the bounds


def test_derivatives_whose_squares_are_no_numbers_are_taken_by_differences() -> None:
    model = made("""
span: [0, 1]
blocks:
  x: {type: integrator, of: rate, start: 0}
  rate: {type: gain, of: x, k: 600}
""")
    measured = series(np.zeros(3), t=np.array([0.0, 0.5, 1.0]), sigma={"x": 1e-3})
    whole = Segment(measured, 0.0, np.arange(3), {"x": 0.0}, ("x",))
    near = Criterion(model, [whole], [], {}).linearise({}, {0: {"x": 0.0}})[0]
    assert np.isfinite(near.slopes**2).all(), "exp(600) = 4e260"


def test_segments_of_a_series_run_together_as_each_alone() -> None:
    """Their starts are free in an order of their own, and one has no free start of v at all."""
    model = made(OSCILLATOR, ("x", "v"))
    measured = Measured("one", "train", T, {"x": np.cos(T), "v": -np.sin(T)})
    start = {"x": 0.9, "v": 0.1}
    segments = [
        Segment(measured, float(T[a]), np.arange(a, a + 30), start, free)
        for a, free in ((0, ("v", "x")), (30, ("x", "v")), (60, ("x",)))
    ]
    together = Criterion(model, segments, [Unknown("k", 1.2)], {})
    near = together.linearise(
        {"k": 1.2}, {n: {x: start[x] for x in s.free} for n, s in enumerate(segments)}
    )
    for n, segment in enumerate(segments):
        alone = Criterion(model, [segment], together.unknowns, {})
        other = alone.linearise({"k": 1.2}, {0: {x: start[x] for x in segment.free}})[0]
        np.testing.assert_array_equal(near[n].residual, other.residual)
        np.testing.assert_array_equal(near[n].slopes, other.slopes)
        assert near[n].final == other.final


def test_without_unknowns_there_are_residuals_and_no_slopes() -> None:
    criterion = criterion_of(LINE_MODEL, series(0 * T))
    alone = Criterion(LINE_MODEL, criterion.segments, [], {"a": 1.0, "b": 0.0})
    near = alone.linearise({}, {0: {}})[0]
    assert near.slopes.shape == (len(T), 0)
    assert near.residual[:, 0] == pytest.approx(T)


def test_chained_segments_hand_on_what_is_not_free() -> None:
    model = made(
        """
span: [0, 4]
blocks:
  x: {type: integrator, of: one, start: 0}
  one: {type: constant, value: 1}
  memory: {type: integrator, of: change, start: 0}
  change: {type: expression, formula: x - memory}
""",
        ("x", "memory"),
    )
    t = np.linspace(0.0, 4.0, 81)
    measured = Measured("one", "train", t, {"memory": t - 1 + np.exp(-t)})
    segments = [
        Segment(measured, float(t[a]), np.arange(a, a + 27), {"x": float(t[a])}, ("x",))
        for a in (0, 27, 54)
    ]
    starts = {n: dict(s.start) for n, s in enumerate(segments)}
    chained = Criterion(model, segments, [], {}, chained=True)
    assert chained.remembers and [chained.follows(n) for n in range(3)] == [False, True, True]
    found = chained.linearise({}, starts)
    # a segment begins at its first sample, the one before ends at the sample before that
    assert max(float(np.abs(near.residual).max()) for near in found.values()) < 0.06
    alone = Criterion(model, segments, [], {}).linearise({}, starts)
    assert float(np.abs(alone[2].residual).max()) > 1


def test_gain_delay_and_offset_of_a_sensor_and_their_derivatives() -> None:
    """A sensor of x = a t + b shows gain*(a (t - delay) + b) + offset, b before the begin."""
    bounds = {"gain": (0.5, 2.0), "delay": (-1.0, 1.0), "offset": (-1.0, 1.0)}
    sensor = Sensor(offset=0.3, gain=1.5, delay=0.2, free=bounds)
    shown = 1.5 * (np.maximum(T - 0.2, 0)) + 0.3
    criterion = criterion_of(LINE_MODEL, series(shown, sensors={"x": sensor}))
    z = at(criterion, a=1, b=0)
    assert criterion.residuals(z)[0] == pytest.approx(np.zeros((121, 1)), abs=1e-9)
    (matrix,) = criterion.residuals_and_jacobians(z)[1]
    names = [u.name for u in criterion.unknowns]
    columns = dict(zip(names, (matrix / criterion.scales).T, strict=True))
    late = T > 0.25
    assert columns["a"][late] == pytest.approx(1.5 * (T - 0.2)[late])
    assert columns["b"] == pytest.approx(1.5)
    assert columns["offset.x"] == pytest.approx(1.0)
    assert columns["gain.x"][late] == pytest.approx((T - 0.2)[late])
    assert columns["delay.x"][late] == pytest.approx(-1.5)
    assert columns["delay.x"][T < 0.15] == pytest.approx(0.0)


def test_a_square_and_a_drift_of_a_sensor_and_their_derivatives() -> None:
    """Of x = a t + b it shows 1.5 z + 0.2 z^2 + 0.1 (t - 1) from t = 1 on, z = x(t - 0.2)."""
    t = T + 1.0
    free = {"quad": (-1.0, 1.0), "drift": (-1.0, 1.0), "delay": (-1.0, 1.0), "gain": (0.5, 2.0)}
    sensor = Sensor(gain=1.5, delay=0.2, quad=0.2, drift=0.1, free=free)
    z = t - 0.2
    shown = 1.5 * z + 0.2 * z**2 + 0.1 * (t - 1)
    criterion = criterion_of(LINE_MODEL, series(shown, t=t, sensors={"x": sensor}))
    at_truth = at(criterion, a=1, b=0)
    assert criterion.residuals(at_truth)[0] == pytest.approx(np.zeros((121, 1)), abs=1e-9)
    (matrix,) = criterion.residuals_and_jacobians(at_truth)[1]
    columns = dict(
        zip((u.name for u in criterion.unknowns), (matrix / criterion.scales).T, strict=True)
    )
    assert columns["quad.x"] == pytest.approx(z**2)
    assert columns["drift.x"] == pytest.approx(t - 1)
    assert columns["gain.x"] == pytest.approx(z)
    assert columns["delay.x"] == pytest.approx(-(1.5 + 0.4 * z), rel=1e-6)
    assert columns["a"] == pytest.approx((1.5 + 0.4 * z) * z)
    assert columns["b"] == pytest.approx(1.5 + 0.4 * z)


def test_a_drift_may_count_from_another_time() -> None:
    criterion = criterion_of(
        LINE_MODEL,
        series(T + 0.1 * (T + 2), sensors={"x": Sensor(drift=0.1)}, drift_from=-2.0),
    )
    assert criterion.value(at(criterion, a=1, b=0)) == pytest.approx(0, abs=1e-18)


@given(
    st.floats(-2, 2).filter(lambda gain: abs(gain) > 0.1),
    st.floats(-0.02, 0.02),
    st.floats(-1, 1),
    st.floats(-1, 1),
)
def test_the_signal_of_a_sensor_is_found_from_what_it_shows(
    gain: float, quad: float, offset: float, drift: float
) -> None:
    sensor = Sensor(offset=offset, gain=gain, quad=quad, drift=drift)
    signal = np.linspace(-2, 2, 50)
    since = np.linspace(0, 3, 50)
    assert sensor.signal(sensor.observe(signal, since), since) == pytest.approx(signal, abs=1e-9)


def test_what_no_signal_can_show_is_the_nearest_that_one_can() -> None:
    """z - z^2/4 is at most 1, at z = 2."""
    assert Sensor(quad=-0.25).signal(np.array([5.0]), np.zeros(1)) == pytest.approx(2.0)


def test_a_signal_with_a_period_is_compared_the_shortest_way_around() -> None:
    turned = T + 2 * np.pi * np.round(T)
    criterion = criterion_of(LINE_MODEL, series(turned, periods={"x": 2 * np.pi}))
    assert criterion.value(at(criterion, a=1, b=0)) == pytest.approx(0, abs=1e-18)
    assert criterion.residuals(at(criterion, a=1, b=3.5))[0] == pytest.approx(3.5 - 2 * np.pi)


def test_weights_count_series_and_signals() -> None:
    both = {"x": 0 * T, "slope": 0 * T}
    measured = Measured("run", "train", T, both, weight=3.0, weights={"slope": 0.5})
    criterion = criterion_of(made(LINE, ("x", "slope")), measured)
    assert criterion.value(at(criterion, a=0, b=1)) == pytest.approx(3 * 1 / 2)
    assert criterion.value(at(criterion, a=1, b=0)) == pytest.approx(
        3 * np.mean(T**2) / 2 + 3 * 0.5 * 1 / 2
    )


def test_samples_of_the_burn_in_do_not_count() -> None:
    burnt = series(np.where(T < 2, 99.0, T), counts_from=2.0)
    criterion = criterion_of(LINE_MODEL, burnt)
    assert len(criterion.segments[0].rows) == np.sum(T >= 2)
    assert criterion.value(at(criterion, a=1, b=0)) == pytest.approx(0, abs=1e-18)


@pytest.mark.parametrize(
    ("loss", "value"), [("linear", 12.5), ("huber", 5.820487), ("cauchy", 4.798)]
)
def test_a_robust_loss_counts_outliers_less(loss: str, value: float) -> None:
    """By hand at r = 5: huber 1.345*5 - 1.345^2/2, cauchy 2.385^2/2 log(1 + (5/2.385)^2)."""
    segments = criterion_of(LINE_MODEL, series(0 * T - 0.5, sigma={"x": 0.1})).segments
    criterion = Criterion(LINE_MODEL, segments, [], {"a": 0.0, "b": 0.0}, loss=loss)
    assert criterion.value(np.empty(0)) == pytest.approx(value, rel=1e-3)


@pytest.mark.parametrize("loss", ["linear", "huber", "cauchy"])
def test_the_derivatives_of_the_vector_are_its_own(loss: str) -> None:
    measured = series(np.sin(3 * T) + T, sigma={"x": 0.3})
    whole = criterion_of(LINE_MODEL, measured)
    criterion = Criterion(LINE_MODEL, whole.segments, whole.unknowns, {}, 1e-10, loss=loss)
    z = at(criterion, a=1.1, b=0.2)
    vector, matrix = criterion.vector_and_jacobian(z)
    assert vector == pytest.approx(criterion.vector(z), abs=1e-9)
    for j in range(2):
        h = np.zeros(2)
        h[j] = 1e-6
        by_hand = (criterion.vector(z + h) - criterion.vector(z - h)) / 2e-6
        assert matrix[:, j] == pytest.approx(by_hand, abs=1e-5)


def test_a_robust_loss_needs_the_noise() -> None:
    whole = criterion_of(LINE_MODEL, series(T))
    with pytest.raises(DataError, match="a robust loss needs the noise, and no sigma is known of"):
        Criterion(LINE_MODEL, whole.segments, whole.unknowns, {}, loss="huber")
    with pytest.raises(OptionError, match=r"unknown loss 'hubert'.*Did you mean 'huber'"):
        Criterion(LINE_MODEL, whole.segments, whole.unknowns, {}, loss="hubert")


def test_a_free_start_touches_its_own_segment_only() -> None:
    model = made(OSCILLATOR)
    free = {"x": None, "v": 0.0}
    measured = [series(oscillation(T), f"run_{n}", start=free) for n in (1, 2)]
    criterion = criterion_of(model, *measured)
    z = criterion.initial_unknowns()
    assert len(z) == 2 + 2
    matrices = criterion.residuals_and_jacobians(z)[1]
    # the solution is linear in its start: d x / d x0 is the free oscillation itself
    named, _ = criterion.unpack(z)
    own = oscillation(T, k=named["k"], c=named["c"])
    for n, matrix in enumerate(matrices):
        assert matrix[:, 2 + n] / criterion.scales[2 + n] == pytest.approx(own, abs=1e-5)
        assert np.all(matrix[:, 3 - n] == 0)
    _, starts = criterion.unpack(z)
    assert starts == [{"x": pytest.approx(1, abs=1e-3)}] * 2


def test_moved_puts_the_values_back() -> None:
    criterion = criterion_of(made(OSCILLATOR), series(oscillation(T), start={"x": None, "v": 0.0}))
    z = criterion.initial_unknowns() * 1.5
    unknowns, segments = criterion.with_values(z)
    again = Criterion(criterion.model, segments, unknowns, {})
    assert again.initial_unknowns() * again.scales == pytest.approx(z * criterion.scales)


def test_the_criterion_on_other_segments_keeps_everything_else() -> None:
    criterion = criterion_of(LINE_MODEL, series(T, sigma={"x": 0.5}))
    (whole,) = criterion.segments
    half = Segment(whole.measured, whole.begin, whole.rows[:60])
    short = criterion.on_segments([half])
    assert short.initial_unknowns() == pytest.approx(criterion.initial_unknowns())
    assert short.residuals(short.initial_unknowns())[0].shape == (60, 1)
    assert short.value(at(short, a=1, b=1)) == pytest.approx((1 / 0.5) ** 2 / 2)


def test_a_failed_run_counts_as_far_away() -> None:
    blow_up = """\
span: [0, 6]
parameters: {a: {value: 1, fit: free}}
blocks: {x: {type: integrator, of: r, start: 1}, r: {type: expression, formula: a*x**2}}
"""
    criterion = criterion_of(made(blow_up), series(0.1 * np.sin(T)))
    assert criterion.failure is None
    failed = criterion.value(at(criterion, a=1))  # 1/(1 - t) has no value at t = 1
    assert np.isfinite(failed)
    assert "x" in str(criterion.failure)
    assert failed > criterion.value(at(criterion, a=0.1)) > 0
    z = at(criterion, a=1)
    assert np.isfinite(criterion.residuals_and_jacobians(z)[1][0]).all()


def test_beyond_its_budget_nothing_is_run_and_nothing_counted() -> None:
    """A run that was not begun costs nothing: what others may still take is not used up."""
    criterion = criterion_of(LINE_MODEL, series(0 * T + 1))
    criterion.budget, criterion.steps = 100, 101
    residuals, slopes = criterion.residuals_and_jacobians(at(criterion, a=0, b=0))
    assert criterion.steps == 101
    assert np.abs(residuals[0]).min() > 1 and not slopes[0].any()
    assert criterion.failure is not None
    (problem,) = criterion.failure.problems
    assert problem.what == "the model takes more than 100 steps in all"


FORKED = """
import os
from tracewire.residual.criterion import _threads
assert _threads().submit(int, 1).result() == 1
if os.fork() == 0:
    os._exit(_threads().submit(int, 2).result(30) - 2)
_, status = os.wait()
assert status == 0
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no forks here")
def test_a_forked_process_has_threads_of_its_own() -> None:
    """A pool of processes that begins after a trace: its workers waited for threads for ever."""
    done = run([sys.executable, "-W", "ignore", "-c", FORKED], capture_output=True, timeout=120)
    assert done.returncode == 0, done.stderr.decode()
