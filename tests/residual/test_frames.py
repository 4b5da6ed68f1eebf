"""Series from frames and arrays in memory, and what is said of those that cannot be used."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np
import pytest
import tracewire as tw
from tracewire.errors import DataError

T = np.linspace(0.0, 2.0, 41)
X = np.cos(3 * T)
ARRAYS = {"t [ms]": 1e3 * T, "angle [deg]": 90 * X, "force": np.sin(T), "note": ["a"] * 41}
FRAMES = ("arrays", "pandas", "polars", "pyarrow", "numpy")


def frame_of(kind: str, arrays: dict[str, Any]) -> Any:
    if kind == "pandas":
        return pytest.importorskip("pandas").DataFrame(arrays)
    if kind == "polars":
        return pytest.importorskip("polars").DataFrame(arrays)
    if kind == "pyarrow":
        return pytest.importorskip("pyarrow").table(arrays)
    if kind == "numpy":
        columns = {name: np.asarray(values) for name, values in arrays.items()}
        table = np.zeros(41, dtype=[(name, v.dtype) for name, v in columns.items()])
        for name, values in columns.items():
            table[name] = values
        return table
    return arrays


@pytest.mark.parametrize("kind", FRAMES)
def test_a_frame_becomes_a_series_in_si(kind: str) -> None:
    series = tw.Measured.from_frame(
        frame_of(kind, ARRAYS),
        {"x": "angle"},
        inputs={"u": "force"},
        sigma={"x": 0.5, "u": 0.02},
        hold={"u": "previous"},
        start={"x": None},
    )
    assert series.t == pytest.approx(T)
    assert series.values["x"] == pytest.approx(np.pi / 2 * X)
    assert series.sigma == {"x": pytest.approx(np.radians(0.5))}
    assert series.input_sigma == {"u": 0.02}
    assert isinstance(series.inputs["u"], tw.Held)
    assert (series.name, series.use, series.start) == ("frame", "train", {"x": None})
    assert "x: from deg to rad, as the header says" in series.steps


@pytest.mark.parametrize("kind", FRAMES)
def test_what_a_frame_lacks_is_told_with_what_it_has(kind: str) -> None:
    with pytest.raises(DataError, match=r"frame: unknown column 'angel' .* Did you mean 'angle'"):
        tw.Measured.from_frame(frame_of(kind, ARRAYS), {"x": "angel"})
    with pytest.raises(DataError, match="'note' of 'frame' is text, and not numbers"):
        tw.Measured.from_frame(frame_of(kind, ARRAYS), ["note"])


@pytest.mark.parametrize("kind", ["arrays", "pandas", "polars", "pyarrow"])
def test_dates_with_a_zone_are_times(kind: str) -> None:
    begin = datetime(2024, 3, 12, 12, tzinfo=UTC)
    when: Any = [begin + timedelta(seconds=float(t)) for t in T]
    if kind == "arrays":
        when = [moment.isoformat() for moment in when]
    series = tw.Measured.from_frame(frame_of(kind, {"when": when, "x": X}), "x")
    assert series.t == pytest.approx(T, abs=1e-9)
    assert "time: t = 0 is 2024-03-12T12:00:00Z, the earliest of the file" in series.steps


def test_the_index_of_pandas_is_the_time_where_it_can_be() -> None:
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"x": X}, index=pandas.Index(1e3 * T, name="time [ms]"))
    assert tw.Measured.from_frame(frame, "x").t == pytest.approx(T)
    frame.index = pandas.to_timedelta(T, unit="s")
    assert tw.Measured.from_frame(frame, "x").t == pytest.approx(T)
    whole = frame_of("pandas", ARRAYS)
    part = whole[whole["t [ms]"] > 500]  # its index has whole numbers, and no name
    assert tw.Measured.from_frame(part, {"x": "angle"}).t[0] == pytest.approx(0.55)


def test_a_row_that_lacks_a_signal_is_left_out_and_its_input_kept() -> None:
    pandas = pytest.importorskip("pandas")
    column = pandas.array([1, None, *range(39)], dtype="Int64")
    frame = pandas.DataFrame({"t": T, "x": column, "u": T**2})
    found = tw.Measured.from_frame(frame, "x", inputs="u")
    assert found.t.tolist() == [T[0], *T[2:]]
    assert found.values["x"].tolist() == [1, *range(39)]
    assert found.inputs["u"][0].tolist() == T.tolist()
    words = "x has no value in 1 of 41 rows, which count for no signal, the first at t = 0.05 s"
    assert words in found.steps


def test_values_of_an_input_that_pandas_misses_are_told() -> None:
    pandas = pytest.importorskip("pandas")
    column = pandas.array([1, None, *range(39)], dtype="Int64")
    frame = pandas.DataFrame({"t": T, "x": T, "u": column})
    with pytest.raises(DataError, match=r"'u' is not finite in this row \(row 2\)"):
        tw.Measured.from_frame(frame, "x", inputs="u")


def test_rows_that_are_not_in_order_are_one_problem() -> None:
    frame = {"t": [0, 2, 1, 3, 3, *range(4, 400)], "x": np.zeros(401)}
    with pytest.raises(DataError) as caught:
        tw.Measured.from_frame(frame, "x", name="bench")
    assert [problem.what for problem in caught.value.problems] == [
        "time goes back to 1, from 2 in row 2 (row 3)",
        "time 3 stands twice, also in row 4 (row 5)",
    ]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"signals": []}, "the series 'frame' has no signals. Name columns of the frame"),
        ({"sigma": {"y": 1}}, "sigma of the series 'frame': unknown signal or input 'y'; there"),
        ({"hold": {"x": "linear"}}, "hold of the series 'frame': unknown input 'x'; there is no"),
        ({"units": {"x": "rod"}}, "'rod'"),
        ({"units": {"x": "m"}}, "'x' is declared in 'm', and in 'deg' by its header"),
        ({"inputs": {"x": "force"}}, "'x' is a signal and an input, too"),
        ({"use": "trian"}, "unknown use 'trian'; there are: gate, train, validate. Did you mean"),
    ],
)
def test_options_of_a_frame_that_have_no_meaning(options: dict[str, Any], message: str) -> None:
    with pytest.raises(tw.TracewireError) as caught:
        tw.Measured.from_frame(ARRAYS, **{"signals": {"x": "angle"}, **options})
    assert message in str(caught.value)


def test_what_is_no_frame_is_told() -> None:
    with pytest.raises(DataError, match=r"a builtins\.list is no table with named columns"):
        tw.Measured.from_frame([1, 2], "x")
    lazy = frame_of("polars", {"t": T, "x": X}).lazy()
    with pytest.raises(DataError, match=r"Collect it first: frame\.collect\(\)"):
        tw.Measured.from_frame(lazy, "x")


def test_columns_and_slices_of_pandas_are_arrays() -> None:
    frame = pytest.importorskip("pandas").DataFrame({"t": T, "x": X})[10:30]
    series = tw.Measured("bench", "train", frame["t"], {"x": frame["x"]})
    assert series.t.tolist() == T[10:30].tolist()
    assert type(series.values["x"]) is np.ndarray


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"values": {"x": X[1:]}}, "'x' of the series 'bench' has 40 values, and t has 41."),
        ({"values": {"x": np.where(T == 0.1, np.nan, X)}},
         "'x' of the series 'bench' has a value not finite, first at index 2. Leave out"),
        ({"t": T[::-1]}, "t of the series 'bench' does not increase at index 1, and at 39 more: "
         "1.95 after 2. Sort the rows by t"),
        ({"values": {"x": ["a"] * 41}}, "'x' of the series 'bench' is not an array of numbers"),
        ({"t": np.datetime64("2024-03-12") + np.arange(41)}, "Dates and texts are read by"),
        ({"values": {"x": np.stack([X, X])}}, "is not one column of numbers: 2 x 41"),
        ({"values": {"x": 1.0}}, "is not one column of numbers: a single number"),
        ({"inputs": {"u": (T, X[:3])}}, "the input 'u' of the series 'bench' has 3 values, and its "
         "time has 41."),
        ({"sigma": {"y": 0.1}}, "sigma of the series 'bench': unknown signal 'y'; there are: x."),
        ({"input_sigma": {"v": 0.1}}, "input_sigma of the series 'bench': unknown input 'v'"),
    ],
)  # fmt: skip
def test_arrays_that_are_no_series(change: dict[str, Any], message: str) -> None:
    given: dict[str, Any] = {"t": T, "values": {"x": X}, **change}
    with pytest.raises(DataError) as caught:
        tw.Measured("bench", "train", **given)
    assert message in str(caught.value)


def test_all_that_is_wrong_with_arrays_is_told_at_once() -> None:
    with pytest.raises(DataError) as caught:
        tw.Measured("bench", "train", T[::-1], {"x": X[1:], "y": [np.nan] * 41})
    assert len(caught.value.problems) == 3


def test_lists_are_arrays() -> None:
    series = tw.Measured("bench", "train", [0, 1, 2], {"x": [1, 2, 3]}, inputs={"u": ([0], [1])})
    assert series.values["x"].tolist() == [1.0, 2.0, 3.0]
