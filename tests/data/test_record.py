"""Records: units, and the steps that clean them, each told in words and checked by what it does."""

from __future__ import annotations

import inspect
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import make_smoothing_spline
from tracewire.data import STEPS, Record, read_record
from tracewire.data.filters import smooth, white_noise
from tracewire.errors import DataError, OptionError

patient = settings(deadline=None)  # the first run may load scipy
T = np.arange(0, 10, 0.01)
WAVE = np.sin(2 * math.pi * T)


def record(**columns: np.ndarray) -> Record:
    return Record(T, columns or {"a": WAVE, "b": 2 * WAVE})


def refused(step: str, made: Record | None = None, **options: Any) -> str:
    with pytest.raises(OptionError) as caught:
        (made or record()).clean(step, options)
    return str(caught.value)


# --- units --------------------------------------------------------------------------------------


def file_of(folder: Path, header: str, rows: str = "0,180\n500,90\n") -> Path:
    path = folder / "run.csv"
    path.write_text(f"{header}\n{rows}", encoding="utf-8")
    return path


def test_units_of_the_header_are_used_and_told(tmp_path: Path) -> None:
    made = read_record(file_of(tmp_path, "t [ms],angle [deg]"), {"theta": "angle"}, "t")
    assert made.t.tolist() == [0, 0.5]
    assert made.columns["theta"] == pytest.approx([math.pi, math.pi / 2])
    assert made.steps == (
        "time: from ms to s, as the header says",
        "theta: from deg to rad, as the header says",
    )
    assert made.unit("theta").text == "rad"


def test_units_that_are_declared_need_no_words(tmp_path: Path) -> None:
    path = file_of(tmp_path, "t,angle [°]")
    made = read_record(path, {"theta": "angle"}, "t", units={"theta": "deg"}, time_unit="ms")
    assert made.t.tolist() == [0, 0.5]
    assert made.columns["theta"] == pytest.approx([math.pi, math.pi / 2])
    assert made.steps == made.remarks == ()


def test_brackets_without_a_unit_are_told_and_not_used(tmp_path: Path) -> None:
    made = read_record(file_of(tmp_path, "t (clock),angle (raw data)"), {"theta": "angle"}, "t")
    assert made.columns["theta"].tolist() == [180, 90]
    assert made.remarks == (
        "the time: the header has 'clock', which is no unit",
        "'theta': the header has 'raw data', which is no unit",
    )


def test_a_temperature_in_degrees_celsius_is_told_what_to_say(tmp_path: Path) -> None:
    made = read_record(file_of(tmp_path, "t,T [degC]"), {"T": "T"}, "t")
    assert made.columns["T"].tolist() == [180, 90]
    assert made.remarks == (
        "'T': the header has 'degC', which is no unit: a temperature is in K; say unit: K where"
        " only differences count",
    )


def test_a_torque_in_newton_metres_is_no_number_of_metres(tmp_path: Path) -> None:
    made = read_record(file_of(tmp_path, "t,M [mNm]"), {"M": "M"}, "t")
    assert made.columns["M"] == pytest.approx([0.18, 0.09])


@pytest.mark.parametrize(
    ("header", "options", "said"),
    [
        ("t,angle [deg]", {"units": {"theta": "rad"}}, "'theta' is declared in 'rad', and in "
         "'deg' by its header in 'run.csv'. Correct the one that is wrong; without `unit:` that of "
         "the header holds."),
        ("t,angle [m]", {"units": {"theta": "rad"}}, "'theta' is declared in 'rad', and in "
         "'m' by its header"),
        ("t [s],angle", {"time_unit": "ms"}, "the time is declared in 'ms', and in 's' by"),
        ("t [V],angle", {}, "the time of 'run.csv' is in 'V', which is no unit of time. Name the"),
    ],
)  # fmt: skip
def test_units_that_contradict(
    header: str, options: dict[str, Any], said: str, tmp_path: Path
) -> None:
    path = file_of(tmp_path, header)
    with pytest.raises(DataError) as caught:
        read_record(path, {"theta": "angle"}, "t", **options)
    assert said in str(caught.value).replace(str(path), "run.csv")


def test_a_raw_column_has_no_unit_until_it_is_calibrated(tmp_path: Path) -> None:
    path = file_of(tmp_path, "t [ms],u [V]")
    made = read_record(path, {"theta": "u"}, "t", raw=["theta"])
    assert made.columns["theta"].tolist() == [180, 90]
    made = made.calibrate("theta", gain=0.5, offset=-45, unit="deg")
    assert made.columns["theta"] == pytest.approx([math.pi / 4, 0])
    assert made.unit("theta").text == "rad"
    assert made.steps[-1] == "theta: calibrated, 0.5*value - 45 in deg"


# --- steps --------------------------------------------------------------------------------------


def test_the_table_of_steps_is_that_of_the_methods() -> None:
    for step, options in STEPS.items():
        taken = list(inspect.signature(getattr(Record, step)).parameters.values())[1:]
        names = {option.argument or name for name, option in options.items()}
        own = {p.name for p in taken} - ({"unit"} if step == "calibrate" else set())
        assert names == own
        needed = {p.name for p in taken if p.default is inspect.Parameter.empty}
        assert {o.argument or n for n, o in options.items() if o.required} == needed


def test_a_step_leaves_the_record_before_it_as_it_was() -> None:
    first = record()
    before = first.columns["a"].copy()
    first.lowpass("a", cutoff=5).detrend("a").calibrate("a", 2)
    assert np.array_equal(first.columns["a"], before)
    assert first.steps == ()


def test_trim_keeps_both_ends() -> None:
    made = record().clean("trim", {"from": 1.0, "to": 2.0})
    assert (made.t[0], made.t[-1], len(made.t)) == (1.0, 2.0, 101)
    assert made.steps == ("trimmed to 1 ... 2 s: 101 of 1000 samples",)
    assert refused("trim", begin=3) == "unknown option of trim 'begin'; there are: from, to."
    assert "0 samples between 20 and inf s. The record covers 0 to 9.99 s." in refused(
        "trim", **{"from": 20}
    )


def test_shift_puts_the_begin() -> None:
    made = record().shift(0.5)
    assert made.t[50] == pytest.approx(0)
    assert made.steps == ("time: t = 0 is 0.5 s of the file",)
    assert record().shift(0.0).steps == ()


@patient
@given(every=st.floats(0.003, 2.0), slope=st.floats(-5, 5))
def test_resampling_keeps_a_straight_line(every: float, slope: float) -> None:
    uneven = T + 0.004 * np.sin(7 * T)
    for method in ("linear", "spline"):
        made = Record(uneven, {"a": slope * uneven}).resample(every, method)
        assert np.diff(made.t) == pytest.approx(every)
        assert made.columns["a"] == pytest.approx(slope * made.t, abs=1e-9)
        assert made.t[-1] <= uneven[-1] < made.t[-1] + every * 1.001


def test_resampling_by_a_spline_is_nearer_to_a_wave() -> None:
    coarse = Record(T[::10], {"a": WAVE[::10]})
    errors = [
        np.max(np.abs(made.columns["a"] - np.sin(2 * math.pi * made.t)))
        for made in (coarse.resample(0.01), coarse.resample(0.01, "spline"))
    ]
    assert errors[1] < 0.01 < errors[0]
    assert coarse.resample(0.01).steps == (
        "resampled every 0.01 s (linear): 991 samples, 100 before",
    )


@patient
@given(order=st.integers(0, 4), seed=st.integers(0, 1000))
def test_detrending_takes_exactly_its_polynomial(order: int, seed: int) -> None:
    coefficients = np.random.default_rng(seed).uniform(-1, 1, order + 1)
    trend = np.polynomial.Polynomial(coefficients)(T / 10)
    made = record(a=WAVE + trend, b=WAVE).detrend(["a", "b"], order)
    assert made.columns["a"] == pytest.approx(made.columns["b"], abs=1e-9)
    assert made.detrend("a", order).columns["a"] == pytest.approx(made.columns["a"], abs=1e-9)


def test_the_words_of_a_trend() -> None:
    made = record(a=1 + 0.1 * T).detrend("a").detrend("a", 0).detrend("a", 2)
    assert made.steps[0] == "a: a straight line taken away, 1 ... 1.999"
    assert made.steps[1].startswith("a: the mean taken away, ")
    assert made.steps[2].startswith("a: a polynomial of order 2 taken away, ")


def test_a_low_pass_keeps_the_phase_and_halves_at_its_cutoff() -> None:
    middle = slice(300, 700)
    for hertz, gain in ((0.5, 1.0), (5.0, 0.5), (30.0, 0.0)):
        wave = np.sin(2 * math.pi * hertz * T)
        made = record(a=wave).lowpass("a", cutoff=5.0)
        assert made.columns["a"][middle] == pytest.approx(gain * wave[middle], abs=2e-3)
    assert made.steps[0].startswith(
        "a: low pass 5 Hz, Butterworth of order 4 forward and backward; it took 0.7"
    )


def test_a_derivative_is_near_the_exact_one_and_says_what_was_left_out() -> None:
    rng = np.random.default_rng(1)
    noisy = record(a=WAVE + 0.01 * rng.standard_normal(len(T)))
    exact = 2 * math.pi * np.cos(2 * math.pi * T)
    for noise in (0.01, None):
        made = noisy.differentiate("a", "rate", noise)
        error = made.columns["rate"] - exact
        assert np.std(error[20:-20]) < 0.15
        assert np.std(np.gradient(noisy.columns["a"], T) - exact) > 0.5
        assert made.unit("rate").text == "1/s"
        assert made.steps[0].startswith("rate: derivative of a, from a smoothing spline that left")
    assert made.columns["a"] is noisy.columns["a"]


@patient
@given(lam=st.floats(1e-4, 1e5), seed=st.integers(0, 1000))
def test_the_spline_is_that_of_scipy(lam: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    u, y = np.cumsum(rng.uniform(0.3, 2, 40)), rng.standard_normal(40)
    assert smooth(u, y, lam) == pytest.approx(make_smoothing_spline(u, y, lam=lam)(u), abs=1e-8)


def test_white_noise_is_found_beside_a_slow_signal() -> None:
    noise = 0.02 * np.random.default_rng(3).standard_normal(len(T))
    assert white_noise(5 * np.sin(T) + noise) == pytest.approx(0.02, rel=0.1)


def test_outliers_are_left_out_and_counted() -> None:
    spiky = WAVE + 0.01 * np.random.default_rng(2).standard_normal(len(T))
    spiky[[100, 500, 501]] += [3, -2, -2]
    made = record(a=spiky, b=WAVE).outliers("a", limit=4)
    assert sorted(set(T) - set(made.t)) == pytest.approx([1.0, 5.0, 5.01])
    assert len(made.columns["b"]) == len(T) - 3
    assert made.steps == (
        "a: 3 of 1000 samples left out as outliers (width 11, limit 4), first at t = 1 s",
    )


@pytest.mark.parametrize(
    "clean", [WAVE, np.round(WAVE, 2), np.sign(WAVE + 0.5), np.zeros(len(T)), T]
)
def test_a_clean_signal_has_no_outliers(clean: np.ndarray) -> None:
    assert record(a=clean).outliers("a").steps == (
        "a: 0 of 1000 samples left out as outliers (width 11, limit 5)",
    )


@pytest.mark.parametrize(
    ("step", "options", "said"),
    [
        ("smooth", {}, "unknown step 'smooth'; there are: calibrate, detrend, differentiate,"),
        ("detrend", {"signals": "c"}, "unknown column 'c'; there are: a, b."),
        (
            "detrend",
            {"signals": "a", "order": -1},
            "'order' must be a whole number from 0 to 20, not -1",
        ),
        ("detrend", {"signals": "a", "order": 21}, "a whole number from 0 to 20, not 21"),
        ("detrend", {"signal": "a"}, "unknown option of detrend 'signal'; there are: order, sig"),
        ("resample", {"every": 0}, "'every' must be above zero, not 0."),
        ("resample", {"every": 20}, "the interval 20 s does not fit into a record of 9.99 s."),
        ("resample", {"every": 1e-12}, "the interval 1e-12 s does not fit into a record"),
        ("resample", {"every": 0.1, "method": "cubic"}, "unknown method of resampling 'cubic'"),
        ("calibrate", {"signal": "a", "gain": 0}, "the calibration 0*value + 0 has no meaning"),
        ("lowpass", {"signals": "a", "cutoff": -1}, "'cutoff' must be above zero, not -1"),
        ("lowpass", {"signals": "a", "cutoff": 50}, "the cutoff 50 Hz is not below 50 Hz, half"),
        ("lowpass", {"signals": "a", "cutoff": 5, "order": 0}, "'order' must be a whole number"),
        ("differentiate", {"signal": "a", "to": "b"}, "there is a column 'b' already. Choose"),
        ("differentiate", {"signal": "a", "to": "c", "noise": 0}, "'noise' must be above zero"),
        ("outliers", {"signals": "a", "width": 4}, "the width must be odd and at most 1000, not 4"),
        ("outliers", {"signals": "a", "limit": 0}, "'limit' must be above zero, not 0"),
    ],
)
def test_messages(step: str, options: dict[str, Any], said: str) -> None:
    assert said in refused(step, **options)


def test_a_filter_asks_for_equal_intervals_and_enough_samples() -> None:
    t = np.concatenate([T[:500], T[600:]])
    assert refused("lowpass", Record(t, {"a": t}), signals="a", cutoff=5) == (
        "a filter needs equal intervals; these are up to 10000% off 0.01 s. "
        "Resample first: resample: {every: 0.01}."
    )
    short = Record(T[:10], {"a": T[:10]})
    assert "a low pass of order 4 takes at least 16 samples, not 10" in refused(
        "lowpass", short, signals="a", cutoff=5
    )
    least = Record(T[:16], {"a": T[:16]})
    assert least.lowpass("a", cutoff=5).steps
    assert "a trend of order 4 takes more than 3 samples" in refused(
        "detrend", Record(T[:3], {"a": T[:3]}), signals="a", order=4
    )
    assert "a spline takes at least 5 samples" in refused(
        "differentiate", Record(T[:4], {"a": T[:4]}), signal="a", to="b"
    )


# --- order --------------------------------------------------------------------------------------

MIXED = Record(np.array([0.0, 2.0, 1.0, 2.0, 3.0]), {"a": np.array([1.0, 2.0, 3.0, 4.0, 5.0])})


@pytest.mark.parametrize(
    ("duplicates", "values"),
    [("first", [1, 3, 2, 5]), ("last", [1, 3, 4, 5]), ("mean", [1, 3, 3, 5])],
)
def test_sort(duplicates: str, values: list[float]) -> None:
    made = MIXED.clean("sort", {"duplicates": duplicates})
    assert made.t.tolist() == [0, 1, 2, 3]
    assert made.columns["a"].tolist() == values
    assert made.steps == (
        "sorted by time: 1 of 5 rows stood behind a later one",
        f"1 of 5 rows repeat a time: of each the {duplicates} is kept, at t = 2 s",
    )


def test_rows_of_one_time_are_one_message() -> None:
    assert "1 of 5 rows repeat a time of another row: t = 2 s. Say which row" in refused(
        "sort", MIXED
    )
    many = Record(np.repeat(np.arange(100.0), 2), {"a": np.arange(200.0)})
    assert "100 of 200 rows repeat a time of another row: t = 0, 1, 2, ... s." in refused(
        "sort", many
    )
    same = Record(np.zeros(3), {"a": np.arange(3.0)})
    assert "all rows have the same time" in refused("sort", same, duplicates="first")
    assert "unknown word for 'duplicates' 'any'" in refused("sort", MIXED, duplicates="any")
