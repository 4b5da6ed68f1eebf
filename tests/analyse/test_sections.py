"""Sections, the count of clusters, bifurcation diagrams and sweeps."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from analyse.models import DUFFING, IMPACTS, LORENZ, OSCILLATOR, SAW, made
from hypothesis import given
from hypothesis import strategies as st
from tracewire.analyse import Plane, bifurcation, section, sweep
from tracewire.analyse.clusters import count_clusters, is_irregular
from tracewire.errors import AnalysisError, OptionError, SimulationError, TracewireError
from tracewire.solve import simulate

LOGISTIC = """
title: Logistic map on a clock
span: [0, 10]
record: [x]
parameters: {r: 2.5}
blocks:
  x: {type: integrator, of: still, start: 0.3}
  still: {type: expression, formula: 0*x}
  wave: {type: square, amplitude: 1, frequency: 1}
events:
  - {every: 1, set: {x: r*x*(1 - x)}}
"""
TWO_WELLS = """
title: Hysteresis
span: [0, 10]
record: [x]
parameters: {p: 0}
blocks:
  x: {type: integrator, of: r, start: -1}
  r: {type: expression, formula: p + x - x**3}
"""
EACH_SECOND = Plane(period=1.0, phase=0.5)
LOGISTIC_MODEL, HYSTERESIS = made(LOGISTIC), made(TWO_WELLS)


@given(st.integers(1, 20), st.integers(0, 1000))
def test_a_motion_of_period_p_has_p_clusters(period: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    centres = np.column_stack([np.arange(period), random.uniform(-1, 1, period)])
    points = centres[np.arange(100) % period] + random.uniform(-1e-4, 1e-4, (100, 2))
    extent = np.array([1.0, 2.0])
    assert count_clusters(points, extent) == period
    # the same where one coordinate turns: whole turns do not count
    turned = points + np.outer(random.integers(-9, 9, 100), [0.0, 7.0])
    assert count_clusters(turned, extent, np.array([np.inf, 7.0])) == period


def test_the_rule_of_irregular_motion() -> None:
    # a slow approach is one cluster, however far it began; scattered points are all their own
    line = np.column_stack([0.05 * 0.97 ** np.arange(100)] * 2)
    extent = np.array([1.0, 1.0])
    assert count_clusters(line, extent, near=2e-3) == 1
    scattered = np.random.default_rng(1).uniform(-1, 1, (100, 2))
    assert count_clusters(scattered, extent) == 100
    assert not is_irregular(25, 100)
    assert is_irregular(26, 100)
    assert count_clusters(np.empty((0, 2)), extent) == 0
    # a coordinate that does not move tells nothing
    assert count_clusters(np.zeros((10, 1)), np.zeros(1)) == 1


def test_many_points_are_counted_by_the_same_rule() -> None:
    """More points than their pairs fit the memory, on seven places and scattered."""
    rng = np.random.default_rng(5)
    extent, unit = np.array([1.0, 1.0]), np.array([np.inf, 1.0])
    orbit = np.repeat(rng.uniform(0.0, 1.0, (7, 2)), 400, axis=0)
    assert count_clusters(orbit + 1e-5 * rng.uniform(size=orbit.shape), extent, unit) == 7
    scattered = rng.uniform(0.0, 1.0, (2001, 2))
    few = count_clusters(scattered[:2000], extent, unit, near=5e-3)
    many = count_clusters(np.vstack([scattered[:2000], scattered[:1]]), extent, unit, near=5e-3)
    assert many == few < 2000


def test_points_of_a_period_are_those_of_a_run() -> None:
    model = made(DUFFING)
    found = section(model, Plane(period="2*pi/omega", phase="0.5/omega"), skip=3, keep=6, rtol=1e-9)
    period = 2 * math.pi / 1.2
    assert found.t == pytest.approx(0.5 / 1.2 + period * np.arange(3, 9))
    run = simulate(model, span=(0, 50), times=found.t, rtol=1e-9)
    assert found["x"] == pytest.approx(run["x"], abs=1e-6)
    with pytest.raises(OptionError, match="unknown state 'y'"):
        found["y"]


def test_points_of_a_guard_are_where_it_crosses() -> None:
    """At the wall the ball arrives with restitution^k times its first speed."""
    found = section(made(IMPACTS), Plane(guard="x", direction="down"), skip=2, keep=5)
    speeds = -0.5 * 2 * 0.8 ** np.arange(2, 7)
    assert found.points[:, 0] == pytest.approx(0, abs=1e-6)
    assert found["v"] == pytest.approx(speeds, rel=1e-4)
    assert np.diff(found.t) == pytest.approx(math.pi / 2, rel=1e-5)


def test_a_guard_that_does_not_cross_ends_the_search() -> None:
    calm = made(CALM)
    with pytest.raises(AnalysisError, match=r"'x' crosses 0 times in .*, and 5 points are asked"):
        section(calm, Plane(guard="x"), keep=5)


def test_points_at_the_rising_edge_of_a_source() -> None:
    found = section(made(SQUARED), Plane(edge="torque"), skip=0, keep=4)
    assert found.t == pytest.approx([0.25, 0.75, 1.25, 1.75])


CALM = """
span: [0, 1]
blocks:
  x: {type: integrator, of: r, start: 1}
  r: {type: expression, formula: -x}
  side: {type: expression, formula: sign(x)}
"""
SQUARED = """
span: [0, 10]
parameters: {f: 2}
blocks:
  x: {type: integrator, of: torque}
  torque: {type: square, amplitude: 1, frequency: f, phase: pi}
"""


@pytest.mark.parametrize(
    ("plane", "said"),
    [
        (Plane(), "a section needs one of a period, an edge and a guard"),
        (Plane(period=1, guard="x"), "a section needs one of"),
        (Plane(period=-1), "a period of -1 s has no use"),
        (Plane(period="1/g"), "unknown parameter 'g'"),
        (Plane(period=1, phase="1/0"), "the phase|division"),
        (Plane(edge="x"), "unknown signal 'x'"),
        (Plane(guard="y"), "unknown guard 'y'"),
        (Plane(period=1, direction="side"), "unknown direction 'side'"),  # type: ignore[arg-type]
    ],
)
def test_a_plane_that_does_not_fit(plane: Plane, said: str) -> None:
    with pytest.raises((OptionError, SimulationError, Exception), match=said) as caught:
        section(made(SQUARED), plane)
    assert "Error" in type(caught.value).__name__


def test_a_section_keeps_one_point_at_least() -> None:
    for skip, keep in ((-1, 5), (0, 0)):
        with pytest.raises(OptionError, match=f"{skip} points skipped and {keep} kept"):
            section(made(SQUARED), Plane(period=1.0), skip=skip, keep=keep)
        with pytest.raises(OptionError, match=f"{skip} points skipped and {keep} kept"):
            bifurcation(made(SQUARED), "f", [1.0], Plane(period=1.0), skip=skip, keep=keep)


def test_the_logistic_map_doubles_its_periods() -> None:
    r = [2.8, 3.2, 3.5, 3.55, 3.7, 3.83, 4 - 1e-9]
    found = bifurcation(LOGISTIC_MODEL, "r", r, EACH_SECOND, direction="apart", skip=500, keep=64)
    branch = found["apart"]
    assert branch.clusters[[0, 1, 2, 3, 5]].tolist() == [1, 2, 4, 8, 3]
    assert branch.irregular.tolist() == [False, False, False, False, True, False, True]
    assert branch.bands == ((3.7, 3.7), (4 - 1e-9, 4 - 1e-9))
    assert branch.points[0, :, 0] == pytest.approx(1 - 1 / 2.8, abs=1e-9)


def test_the_state_is_carried_from_value_to_value() -> None:
    """Of p + x - x^3 each branch stays in its well up to the fold at |p| = 2/sqrt(27) = 0.385."""
    p = np.linspace(-0.6, 0.6, 25)
    found = bifurcation(HYSTERESIS, "p", p, Plane(period=1.0), direction="up_down", skip=60, keep=2)
    up, down = found["up"].points[:, -1, 0], found["down"].points[:, -1, 0]
    fold = 2 / math.sqrt(27)
    assert ((up < 0) == (p < fold)).all()
    assert ((down > 0) == (p > -fold)).all()
    apart = bifurcation(HYSTERESIS, "p", p, Plane(period=1.0), direction="apart", skip=60, keep=2)
    assert np.allclose(apart["apart"].points[:, -1, 0], up, atol=1e-4)  # all begin at -1
    # each from the start: at p = 0.2 the start in the right well stays there down to the fold
    options: Any = {"start": {"x": 1.0}, "skip": 60, "keep": 2}
    low = p[p <= 0.2]
    both = bifurcation(HYSTERESIS, "p", low, Plane(period=1.0), direction="both", **options)
    chained = bifurcation(HYSTERESIS, "p", low, Plane(period=1.0), direction="up_down", **options)
    assert ((both["down"].points[:, -1, 0] > 0) == (low > -fold)).all()
    assert (chained["down"].points[:, -1, 0] < 0).all()
    with pytest.raises(OptionError, match="unknown branch 'down'; there are: apart"):
        apart["down"]


def test_an_interrupted_diagram_goes_on_with_the_carried_state(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tracewire.solve.progress.PAUSE.told_every", 0.0)
    file = tmp_path / "hysteresis.npz"
    p = np.linspace(-0.6, 0.6, 13)
    options: Any = {"direction": "up_down", "skip": 40, "keep": 3}
    whole = bifurcation(HYSTERESIS, "p", p, Plane(period=1.0), **options)

    def stop(part: float, left: float) -> None:
        if part > 0.6:
            raise RuntimeError("stop")

    with pytest.raises(RuntimeError):
        bifurcation(HYSTERESIS, "p", p, Plane(period=1.0), partial=file, progress=stop, **options)
    with np.load(file) as kept:
        assert 13 < kept["done"].sum() < 26
    again = bifurcation(HYSTERESIS, "p", p, Plane(period=1.0), partial=file, **options)
    for name in ("up", "down"):
        assert np.array_equal(again[name].points, whole[name].points)
    with pytest.raises(OptionError, match="another sweep: it differs in section"):
        bifurcation(HYSTERESIS, "p", p, Plane(period=2.0), partial=file, **options)


def test_a_value_that_fails_leaves_the_others() -> None:
    model = made("span: [0, 1]\nparameters: {p: 1}\nblocks:\n"
                 "  x: {type: integrator, of: r, start: 1}\n"
                 "  r: {type: expression, formula: p*x*x - x}\n")  # fmt: skip
    found = bifurcation(
        model, "p", [0.2, 0.5, 3.0], Plane(period=1.0), direction="apart", skip=3, keep=2
    )
    branch = found["apart"]
    assert list(branch.errors) == [2]
    assert np.isnan(branch.points[2]).all()
    assert (branch.clusters[2], branch.irregular[2]) == (0, False)
    with pytest.raises(SimulationError):
        bifurcation(model, "p", [3.0, 4.0], Plane(period=1.0), direction="apart")


@pytest.mark.parametrize(
    ("parameter", "options", "said"),
    [
        ("q", {}, "unknown parameter 'q'"),
        ("p", {"direction": "left"}, "unknown direction 'left'; there are: apart, both, down"),
        ("p", {"modulo": {"y": 1}}, "unknown state 'y'"),
        ("p", {"modulo": {"x": -1}}, "'x' modulo -1 has no use"),
    ],
)
def test_a_diagram_refuses_what_does_not_fit(parameter: str, options: Any, said: str) -> None:
    with pytest.raises(OptionError, match=said):
        bifurcation(HYSTERESIS, parameter, [0.0], Plane(period=1.0), **options)


def test_a_section_of_lorenz_is_irregular_and_one_of_a_saw_is_too() -> None:
    lorenz = made(LORENZ.replace("span: [0, 50]", "span: [0, 5]") + SIDE)
    assert section(lorenz, Plane(guard="z - 27"), skip=5, keep=60).irregular
    saw = section(made(SAW), Plane(period=1.0, phase=0.5), skip=5, keep=40, rtol=1e-6)
    assert saw.irregular


SIDE = '  side: {type: expression, formula: "sign(z - 27)"}\n'


ROW = """
span: [0, 1]
parameters: {k: 1}
record: [chain.all]
blocks:
  one: {type: constant, value: k}
  chain: {type: integrator, of: previous, replicate: {count: 3, first: {of: one}}}
"""


def test_a_sweep_knows_the_ends_of_a_row() -> None:
    """The chain integrates k once, twice and three times: k t, k t^2/2, k t^3/6."""
    keep = ["end(chain.first)", "end(chain.last) - end(chain_2)"]
    found = sweep(made(ROW), {"k": [1.0, 6.0]}, keep)
    assert found[keep[0]] == pytest.approx([1.0, 6.0], abs=1e-9)
    assert found[keep[1]] == pytest.approx([1 / 6 - 1 / 2, -2.0], abs=1e-9)
    run = simulate(made(ROW))
    assert np.array_equal(run["chain.last"], run["chain_3"])
    with pytest.raises(TracewireError, match=r"unknown signal or parameter 'other\.last'"):
        sweep(made(ROW), {"k": [1.0]}, ["end(other.last)"])


def test_a_sweep_has_the_shape_of_its_grid() -> None:
    """Of a free oscillator: x(t) = cos(sqrt(k) t) from 1, so that rms^2 is a half."""
    found = sweep(
        made(OSCILLATOR),
        {"k": [1.0, 4.0, 9.0], "start.x": [1.0, 2.0]},
        ["max(x)", "min(x)", "range(x)", "rms(x)", "mean(x)", "end(x)", "count()"],
        parameters={"c": 0.0},
        span=(0, 20 * math.pi),
        rtol=1e-9,
    )
    assert found["max(x)"] == pytest.approx(np.tile([1.0, 2.0], (3, 1)), abs=1e-6)
    assert found["range(x)"] == pytest.approx(np.tile([2.0, 4.0], (3, 1)), rel=1e-2)
    assert found["rms(x)"] == pytest.approx(np.tile([1.0, 2.0], (3, 1)) / math.sqrt(2), rel=1e-3)
    assert found["mean(x)"] == pytest.approx(np.zeros((3, 2)), abs=1e-2)
    assert found["end(x)"] == pytest.approx(np.tile([1.0, 2.0], (3, 1)), abs=1e-5)
    assert (found["count()"] == 0).all()
    with pytest.raises(OptionError, match="unknown output 'max'"):
        found["max"]


def test_a_number_that_a_run_does_not_have_costs_no_other_number() -> None:
    found = sweep(
        made(OSCILLATOR), {"k": [0.01, 9.0]}, ["max(x)", "period(x)"], parameters={"c": 0.0}
    )
    assert found["max(x)"] == pytest.approx([1.0, 1.0], abs=1e-3)
    assert found["period(x)"] == pytest.approx([np.nan, 2 * np.pi / 3], nan_ok=True, rel=1e-3)
    ((number, why),) = found.errors.items()
    assert number == (0,) and "A period needs two" in why


def test_a_sweep_goes_on_where_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tracewire.solve.progress.PAUSE.told_every", 0.0)
    file, grid = tmp_path / "sweep.npz", {"k": np.linspace(1, 4, 12)}

    def stop(part: float, left: float) -> None:
        if part > 0.3:
            raise RuntimeError("stop")

    model = made(OSCILLATOR)
    with pytest.raises(RuntimeError):
        sweep(model, grid, ["end(x)"], partial=file, progress=stop, workers=1)
    parts: list[float] = []
    found = sweep(model, grid, ["end(x)"], partial=file, progress=lambda p, _: parts.append(p))
    assert len(parts) < 12
    assert np.array_equal(found["end(x)"], sweep(model, grid, ["end(x)"])["end(x)"])
    for changed in ({"since": 3.0}, {"rtol": 1e-9}):
        with pytest.raises(OptionError, match="it differs in options"):
            sweep(model, grid, ["end(x)"], partial=file, **changed)  # type: ignore[arg-type]
    with pytest.raises(OptionError, match="it differs in outputs"):
        sweep(model, grid, ["max(x)"], partial=file)


@pytest.mark.parametrize(
    ("grid", "outputs", "options", "said"),
    [
        ({}, ["count()"], {}, "there is no parameter to sweep"),
        ({"k": [1]}, [], {}, "a sweep without outputs keeps nothing"),
        ({"k": [1]}, ["most(x)"], {}, "unknown function 'most'"),
        ({"k": [1]}, ["max x"], {}, "does not parse"),
        ({"k": [1]}, ["x"], {}, "'x' is a signal, and a quantity is one number"),
        ({"k": [1]}, ["multiplier(1)"], {}, "no number of a run"),
        ({"k": [1]}, ["max(w)"], {}, "unknown signal or parameter 'w'"),
        ({"K": [1]}, ["count()"], {}, "unknown parameter or start 'K'"),
        ({"k": [1]}, ["count()"], {"tolerance": 1}, "unknown option 'tolerance'"),
        ({"k": [1]}, ["max(x)"], {"since": 99}, "fewer than two samples from 99 s on"),
    ],
)
def test_a_sweep_refuses_what_does_not_fit(
    grid: Any, outputs: Any, options: Any, said: str
) -> None:
    with pytest.raises(TracewireError, match=said):
        sweep(made(OSCILLATOR), grid, outputs, **options)
