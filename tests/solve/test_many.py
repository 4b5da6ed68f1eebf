"""Rows of parameters side by side: each is the single run, bit for bit."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from solve.models import BALL, made, one
from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.errors import OptionError, SimulationError
from tracewire.solve import Run, Runs, Section, simulate, simulate_many

PENDULUM = Path(__file__).parents[2] / "diagrams/papers/a_torsion/pendulum.yaml"
ROOT = one("-p*sqrt(x)", 1.0) + "parameters: {p: 1}\n"  # it ends where x falls below zero
FORCED = """
span: [0, 50]
parameters: {omega: 1.3}
record: [x]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: expression, formula: cos(omega*t) - x - 0.2*v}
  side: {type: expression, formula: sign(x)}
"""
BALL_MODEL, PENDULUM_MODEL = made(BALL), compile(read(PENDULUM))


def single(model: Model, row: dict[str, float], **options: Any) -> Run:
    parameters = {n: v for n, v in row.items() if not n.startswith("start.")}
    start = {n.removeprefix("start."): v for n, v in row.items() if n.startswith("start.")}
    return simulate(model, parameters=parameters, start=start, **options)


def the_same(runs: Runs, model: Model, rows: list[dict[str, float]], **options: Any) -> None:
    assert runs.errors == {}
    for number, row in enumerate(rows):
        alone = single(model, row, **options)
        assert np.array_equal(runs.t, alone.t)
        for name in model.recorded:
            assert np.array_equal(runs[name][number], alone[name])
        assert runs.final[number].tolist() == list(alone.final.values())
        assert runs.event_counts[number] == len(alone.events)


BALLS = st.fixed_dictionaries(
    {
        "restitution": st.floats(0.1, 0.95),
        "start.x": st.floats(0.5, 20),
        "start.v": st.floats(-3, 3),
    }
)


@given(st.lists(BALLS, min_size=1, max_size=6), st.integers(1, 4))
@settings(max_examples=15, deadline=None)
def test_each_ball_is_that_of_its_own_run(rows: list[dict[str, float]], workers: int) -> None:
    the_same(simulate_many(BALL_MODEL, rows, workers=workers), BALL_MODEL, rows)


TORSION = st.fixed_dictionaries({"c1": st.floats(1.2, 120), "start.phi2_dot": st.floats(-1, 1)})


@given(st.lists(TORSION, min_size=2, max_size=4))
@settings(max_examples=5, deadline=None)
def test_each_double_pendulum_is_that_of_its_own_run(rows: list[dict[str, float]]) -> None:
    options = {"span": (0.0, 0.4), "rtol": 1e-7}
    the_same(
        simulate_many(PENDULUM_MODEL, rows, workers=3, **options),  # type: ignore[arg-type]
        PENDULUM_MODEL,
        rows,
        **options,
    )


def test_columns_and_common_values_are_as_rows() -> None:
    heights = np.array([1.0, 2.0, 3.0])
    common = {"parameters": {"restitution": 0.5}, "start": {"x": 9.0}}
    runs = simulate_many(BALL_MODEL, {"start.x": heights}, **common)  # type: ignore[arg-type]
    assert len(runs) == 3
    assert runs.parameters["start.x"].tolist() == heights.tolist()
    rows = [{"restitution": 0.5, "start.x": height} for height in heights.tolist()]
    the_same(runs, BALL_MODEL, rows)


def test_a_row_that_fails_does_not_end_the_others() -> None:
    rows: list[dict[str, float]] = [{"p": 1.0}, {"p": 9.0}, {"p": math.nan}, {"p": -1.0}]
    runs = simulate_many(made(ROOT), rows, workers=2, observe=["samples", lambda run: run["x"][-1]])
    assert set(runs.errors) == {1, 2}
    assert "'x' is not finite" in runs.errors[1]
    assert "'p' is given as nan" in runs.errors[2]
    assert np.isnan(runs.samples[1:3]).all()
    assert np.isnan(runs.final[1:3]).all()
    assert np.isnan(runs.event_counts[1:3]).all()
    assert np.isnan(runs.criterion[1:3]).all()
    # x = (1 - p t/2)^2
    assert runs["x"][[0, 3], -1] == pytest.approx([0.25, 2.25], rel=1e-5)
    assert runs.criterion[[0, 3]].tolist() == runs["x"][[0, 3], -1].tolist()


def test_where_all_rows_fail_the_first_says_why() -> None:
    with pytest.raises(SimulationError, match=r"'x' is not finite.*root of a negative"):
        simulate_many(made(ROOT), [{"p": 9.0}, {"p": 8.0}])


def test_what_is_not_observed_is_not_kept() -> None:
    runs = simulate_many(BALL_MODEL, [{}], observe=[])
    assert runs.samples.shape == (1, 0, 2)
    assert runs.final[0].tolist() == list(simulate(BALL_MODEL).final.values())
    with pytest.raises(OptionError, match=r"were not kept. Add 'samples' to `observe`"):
        runs["x"]
    with pytest.raises(OptionError, match=r"unknown recorded signal 'y'"):
        runs["y"]


def test_the_section_of_a_guard_is_where_it_crosses() -> None:
    """The ball leaves its n-th impact with restitution^n times the first speed."""
    section = Section(guard="x", direction="down", after=True)
    runs = simulate_many(BALL_MODEL, {"restitution": [0.8, 0.9]}, span=(0, 5), observe=section)
    first = math.sqrt(2 * 9.81 * 10)
    for restitution, points in zip((0.8, 0.9), runs.points, strict=True):
        speeds = first * restitution ** np.arange(1, len(points) + 1)
        assert len(points) >= 2
        assert points[:, 1] == pytest.approx(0.0, abs=1e-5)
        assert points[:, 2] == pytest.approx(speeds, rel=1e-5)
    before = simulate_many(BALL_MODEL, [{}], span=(0, 5), observe=Section(guard="x")).points[0]
    assert before[0, 1:] == pytest.approx([0.0, -first], abs=1e-5)


def test_a_section_may_be_named_by_its_block_and_leave_out_the_beginning() -> None:
    model = made(FORCED)
    up = simulate_many(model, [{}], observe=Section(guard="side", direction="up", since="30"))
    run = simulate(model)
    times = [event.time for event in run.events if event.direction == "up" and event.time >= 30]
    assert up.points[0][:, 0].tolist() == times
    assert len(times) > 3


@pytest.mark.parametrize("kept", [["samples"], []])
def test_the_section_of_a_period_may_be_a_formula_of_the_row(kept: list[Any]) -> None:
    model, rows = made(FORCED), [{"omega": 1.3}, {"omega": 0.7}]
    section = Section(period="2*pi/omega", since="4*pi/omega")
    runs = simulate_many(model, rows, observe=[*kept, section], rtol=1e-9)
    for row, points in zip(rows, runs.points, strict=True):
        period = 2 * math.pi / row["omega"]
        times = period * np.arange(2, math.floor(50 / period) + 1)
        alone = simulate(compile(model.diagram, ["v"]), parameters=row, times=times, rtol=1e-9)
        states = np.column_stack((alone["x"], alone["v"]))
        assert points[:, 0] == pytest.approx(times, rel=1e-14)
        assert points[:, 1:] == pytest.approx(states, abs=1e-7)
    if kept:
        the_same(runs, model, rows, rtol=1e-9)


def test_a_criterion_sees_the_whole_run() -> None:
    def criterion(run: Run) -> tuple[float, float]:
        return float(run["x"].max()), len(run.events)

    rows = [{"start.x": 3.0}, {"start.x": 7.0}]
    runs = simulate_many(BALL_MODEL, rows, observe=[criterion, Section(period=1.0)])
    assert runs.criterion.shape == (2, 2)
    for row, values in zip(rows, runs.criterion.tolist(), strict=True):
        assert tuple(values) == criterion(single(BALL_MODEL, row))


def test_a_criterion_that_fails_fails_for_its_row() -> None:
    def criterion(run: Run) -> float:
        if run.parameters["restitution"] > 0.5:
            raise ValueError("too lively")
        return 1.0

    runs = simulate_many(BALL_MODEL, {"restitution": [0.4, 0.6]}, observe=criterion)
    assert runs.criterion[0] == 1.0
    assert runs.errors == {1: "the criterion failed: ValueError: too lively."}


def test_a_criterion_has_one_shape() -> None:
    def criterion(run: Run) -> np.ndarray[Any, np.dtype[np.float64]]:
        return np.zeros(1 if run.parameters["restitution"] < 0.5 else 2)

    runs = simulate_many(BALL_MODEL, {"restitution": [0.4, 0.6]}, observe=criterion)
    assert "the criterion has the shape (2,) here, before (1,)" in runs.errors[1]


def test_progress_ends_with_all() -> None:
    told: list[tuple[float, float]] = []
    rows = {"restitution": np.linspace(0.1, 0.5, 8)}
    simulate_many(BALL_MODEL, rows, progress=lambda part, left: told.append((part, left)))
    assert told[-1] == (1.0, 0.0)
    parts = [part for part, _ in told]
    assert parts == sorted(parts)


def test_a_callback_that_fails_ends_the_work() -> None:
    def refuse(part: float, left: float) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        simulate_many(BALL_MODEL, {"restitution": np.full(20, 0.5)}, progress=refuse, workers=2)


@pytest.mark.parametrize(
    ("rows", "options", "message"),
    [
        ([], {}, "there are no rows"),
        ([{"restitutio": 1}], {}, r"unknown parameter or start 'restitutio'.*'restitution'"),
        ([{"start.z": 1}], {}, r"unknown parameter or start 'start.z'"),
        ({"restitution": [1, 2], "start.x": [1]}, {}, r"do not have one length: rest.*\(2,\)"),
        ([{}], {"observe": "sample"}, r"unknown observer 'sample'"),
        ([{}], {"observe": Section()}, "a section needs either a guard or a period"),
        ([{}], {"observe": Section("x", period=1)}, "a section needs either"),
        ([{}], {"observe": Section("y")}, r"unknown guard 'y'; there are: events\[0\], x"),
        ([{}], {"observe": Section("x", "sideways")}, "unknown direction 'sideways'"),  # type: ignore[arg-type]
        ([{}], {"observe": Section(period="1/q")}, "unknown parameter 'q'"),
        ([{}], {"observe": Section(period=0)}, "a period of 0 s from 0 to 12 s has no use"),
        ([{}], {"observe": [len, len]}, "2 observers are a criterion. Give one"),
        ([{}], {"observe": [Section("x")] * 2}, "2 observers are a section"),
        ([{}], {"workers": 0}, "0 workers cannot work"),
        ([{}], {"tolerance": 1}, "unknown option 'tolerance'"),
        ([{}], {"method": "euler"}, "unknown method 'euler'"),
    ],
)
def test_what_does_not_fit_is_refused(rows: Any, options: dict[str, Any], message: str) -> None:
    with pytest.raises(OptionError, match=message):
        simulate_many(BALL_MODEL, rows, **options)


def test_sample_times_that_differ_are_refused_before_the_first_run() -> None:
    model = made(BALL.replace("span: [0, 12]", "span: [0, 10*restitution]"))
    rows = {"restitution": [0.5, 0.6]}
    with pytest.raises(OptionError, match=r"row 1 has other sample times .* Give span= and times="):
        simulate_many(model, rows)
    runs = simulate_many(model, rows, observe=Section(period="restitution"))
    assert [len(points) for points in runs.points] == [11, 11]
    assert simulate_many(model, rows, span=(0, 2)).errors == {}


def test_a_table_that_follows_a_parameter_follows_the_row() -> None:
    text = """
span: [0, 1]
parameters: {level: 2}
inputs: {u: {default: level}}
blocks:
  x: {type: integrator, of: u}
"""
    runs = simulate_many(made(text), {"level": [1.0, 5.0]})
    assert runs.final[:, 0] == pytest.approx([1.0, 5.0])


def test_the_python_back_end_runs_in_threads_too() -> None:
    model = compile(BALL_MODEL.diagram, backend="python")
    rows = [{"restitution": value} for value in (0.3, 0.5, 0.7)]
    the_same(simulate_many(model, rows, workers=3), model, rows)
