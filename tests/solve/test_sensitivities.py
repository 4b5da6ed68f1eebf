"""Forward sensitivities: closed solutions, and central differences of exact runs.

The differences are taken over a small part of the parameter at rtol 1e-11, where they are good to
about 1e-8. A sample near an event lies before it in one of the two runs and behind it in the other,
so that samples as near as that are left out, and the event's own time is compared instead.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tracewire as tw
from numpy.typing import NDArray
from solve.models import BALL, made, one
from tracewire.compile import Model
from tracewire.errors import OptionError
from tracewire.solve import Run, simulate

SERVO = Path(__file__).parents[2] / "diagrams/gallery/servo_with_play.yaml"
PENDULUM = Path(__file__).parents[2] / "diagrams/papers/a_torsion/pendulum.yaml"
TIGHT = {"rtol": 1e-11}
PART = 1e-5
Vector = NDArray[np.float64]

SPRING = """
span: [0, 10]
parameters: {k: 2, c: 0.1, force: 0}
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: expression, formula: force - k*x - c*v}
"""
RUBBED = """
span: [0, 20]
parameters: {level: 0.1, k: 1, begin: 1.05}
blocks:
  x: {type: integrator, of: v, start: begin}
  v: {type: integrator, of: a}
  spring: {type: stiffness, of: x, k: k}
  friction: {type: coulomb, rate: v, level: level}
  a: {type: sum, of: [spring, friction]}
"""
BREAKAWAY = """
span: [0, 12]
parameters: {slip: 0.3, stick: 0.5, omega: 0.7, force: 1}
blocks:
  x: {type: integrator, of: v, start: 0.2}
  v: {type: integrator, of: a}
  friction: {type: dry_friction, rate: v, slip: slip, stick: stick}
  a: {type: expression, formula: force*sin(omega*t) - x + friction}
"""
SQUARE = """
span: [0, 3]
parameters: {f: 1.3, height: 2, shift: 0.3}
blocks:
  x: {type: integrator, of: rate, start: 0.2}
  wave: {type: square, amplitude: height, frequency: f, phase: shift}
  rate: {type: expression, formula: wave - x*x}
"""
RESETS = """
span: [0, 6]
parameters: {p: 0.9, q: 0.3}
blocks:
  x: {type: integrator, of: v, start: 0.05}
  v: {type: integrator, of: a, start: 1}
  a: {type: expression, formula: -x + p*cos(t)}
events:
  - {when: x - q*t, crosses: down, set: {x: x + p*q + 0.1*t, v: 0.5*v + q*x}}
"""
LIMITED = """
span: [0, 3]
parameters: {m: 1.3, k: 4*m**2, omega: sqrt(k/m)}
blocks:
  x: {type: integrator, of: v, start: k/10}
  v: {type: integrator, of: a}
  a: {type: expression, formula: -omega*omega*x + k}
  y: {type: saturation, of: x, low: -m, high: m}
"""
PRESSED = """
span: [0, 7]
parameters: {g: 9.81, push: 14, mass: 2}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  w: {type: integrator, of: b}
  a: {type: expression, formula: "push*sin(0.5*t) - g"}
  b: {type: expression, formula: -w}
events:
  - {when: x, crosses: down, set: {v: -0.5*v, w: w - mass*v}}
"""
CAM = """
span: [0, 3]
parameters: {late: 0.1371, tall: 2}
blocks:
  x: {type: integrator, of: rate}
  time: {type: expression, formula: t - late}
  cam: {type: table, of: time, points: [[0, 0], [0.7, 1], [0.9, 2], [1.7, -1], [2.2, 3]]}
  rate: {type: expression, formula: tall*cam - x}
"""
STIFF = """
span: [0, 3]
parameters: {mu: 4, b: 0.5}
blocks:
  x: {type: integrator, of: v, start: 2}
  v: {type: integrator, of: a}
  a: {type: expression, formula: mu*(1 - x*x)*v - b*x}
"""


def moved(model: Model, run: Run, name: str, by: float, **options: Any) -> Run:
    """The run with another value of what a sensitivity is asked for."""
    state = name.removeprefix("start.")
    if state != name:
        options["start"] = {**options.get("start", {}), state: run.start[state] + by}
    else:
        given = options.get("parameters", {})
        options["parameters"] = {**given, name: run.parameters[name] + by}
    return simulate(model, **options)


def base(run: Run, name: str) -> float:
    """The value of what a sensitivity is asked for."""
    state = name.removeprefix("start.")
    return run.start[state] if state != name else run.parameters[name]


def agree(
    model: Model, names: list[str], tolerance: float = 1e-6, part: float = PART, **options: Any
) -> Run:
    """Compare samples and event times with central differences; the run with sensitivities."""
    options = {**TIGHT, **options}
    run = simulate(model, sensitivities=names, **options)
    for name in names:
        step = part * (abs(base(run, name)) + 1.0)
        up, down = (moved(model, run, name, by, **options) for by in (step, -step))
        assert len(up.events) == len(down.events) == len(run.events)
        times = np.array([[event.time for event in some.events] for some in (up, down)])
        clear = np.ones(len(run.t), dtype=bool)
        for later, sooner in times.T:
            low, high = min(later, sooner), max(later, sooner)
            clear &= (run.t < low - 1e-9) | (run.t > high + 1e-9)
        for signal in run.signals:
            differences = (up[signal] - down[signal])[clear] / (2 * step)
            found = run.sensitivities[name][signal]
            assert np.isfinite(found).all()
            size = np.max(np.abs(found[clear])) + 1e-3
            assert found[clear] == pytest.approx(differences, abs=tolerance * size), (name, signal)
        if run.events:
            wanted = (times[0] - times[1]) / (2 * step)
            given = np.array([event.sensitivity[name] for event in run.events])
            size = np.max(np.abs(given)) + 1e-2
            assert given == pytest.approx(wanted, abs=tolerance * size), name
    return run


@pytest.mark.parametrize("method", ["auto", "dormand_prince", "dop853", "rosenbrock"])
def test_an_oscillator_has_its_closed_sensitivities(method: str) -> None:
    """x = cos(w t): dx/dk = -t sin(w t)/(2 w), dx/d force = (1 - cos(w t))/k."""
    names = ["k", "force", "start.x", "start.v"]
    run = simulate(made(SPRING), parameters={"c": 0.0}, method=method, sensitivities=names, **TIGHT)
    w, t, found = math.sqrt(2.0), run.t, run.sensitivities
    assert found["k"]["x"] == pytest.approx(-t * np.sin(w * t) / (2 * w), abs=1e-7)
    assert found["force"]["x"] == pytest.approx((1 - np.cos(w * t)) / 2, abs=1e-7)
    assert found["start.x"]["v"] == pytest.approx(-w * np.sin(w * t), abs=1e-7)
    assert found["start.v"]["x"] == pytest.approx(np.sin(w * t) / w, abs=1e-7)


@pytest.mark.parametrize("method", ["auto", "dop853", "rosenbrock"])
def test_the_points_of_an_input_are_kinks_and_jumps_stay_jumps(method: str) -> None:
    """x = 1.5 exp(-k U) with U the integral of u, and y = jump (U(t) - U(instant)) behind the
    instant, which is a point of u, too: dx/dk = -U x, dy/d instant = -jump u(instant)."""
    text = """
span: [0, 2]
inputs: {u: {default: 0}}
parameters: {k: 0.8, jump: 0.5, instant: 1}
blocks:
  x: {type: integrator, of: slope, start: 1.5}
  slope: {type: expression, formula: -k*u*x}
  y: {type: integrator, of: gust, start: 0}
  gust: {type: expression, formula: jump*u*floor(t/instant)}
"""
    points = np.linspace(0, 2, 41)
    u = 1.3 + np.sin(2 * points) + 0.4 * np.random.default_rng(5).standard_normal(41)
    whole = np.concatenate(([0.0], np.cumsum((u[1:] + u[:-1]) / 2 * np.diff(points))))[:-1]
    t = points[:-1]
    names = ["k", "jump", "instant", "start.x"]
    inputs = {"u": (points, u)}
    run = simulate(
        made(text), method=method, times=t, inputs=inputs, sensitivities=names, rtol=1e-10
    )
    x, found, elsewhere = 1.5 * np.exp(-0.8 * whole), run.sensitivities, t != t[20]
    assert found["k"]["x"] == pytest.approx(-whole * x, abs=1e-7)
    assert found["start.x"]["x"] == pytest.approx(x / 1.5, abs=1e-7)
    behind = np.where(t < t[20], 0.0, whole - whole[20])
    assert found["jump"]["y"] == pytest.approx(behind, abs=1e-7)
    moved = np.where(t > t[20], -0.5 * u[20], 0.0)
    assert found["instant"]["y"][elsewhere] == pytest.approx(moved[elsewhere], abs=1e-7)


@pytest.mark.parametrize("method", ["auto", "dormand_prince", "dop853", "rosenbrock"])
@pytest.mark.parametrize("rtol", [1e-5, 1e-8])
def test_samples_inside_of_steps_are_as_good_as_those_at_their_ends(
    method: str, rtol: float
) -> None:
    """x = cos(w t): dx/dk = -t sin(w t)/(2 w); many samples lie in each step."""
    w, t = math.sqrt(2.0), np.linspace(0, 10, 4001)
    options: dict[str, Any] = {"parameters": {"c": 0.0}, "method": method, "rtol": rtol}
    run = simulate(made(SPRING), sensitivities=["k"], times=t, **options)
    assert run.statistics.steps < 800
    apart = run.sensitivities["k"]["x"] + t * np.sin(w * t) / (2 * w)
    coarse = simulate(made(SPRING), sensitivities=["k"], times=t[::400], **options)
    least = np.max(np.abs(coarse.sensitivities["k"]["x"] + (t * np.sin(w * t))[::400] / (2 * w)))
    assert np.max(np.abs(apart)) < 3 * least + 20 * rtol


@pytest.mark.parametrize("method", ["dormand_prince", "dop853", "rosenbrock"])
@pytest.mark.parametrize("count", [4, 333])
def test_sensitivities_go_over_many_short_steps(method: str, count: int) -> None:
    """x = cos(w t): dx/dk = -t sin(w t)/(2 w); each of their intervals has several steps inside."""
    w, t = math.sqrt(2.0), np.linspace(0, 10, count)
    options: dict[str, Any] = {"parameters": {"c": 0.0}, "times": t}
    options["limits"] = {"max_step": 2e-3}
    run = simulate(made(SPRING), sensitivities=["k", "start.v"], method=method, **options, **TIGHT)
    assert run.statistics.steps > 4999
    found = run.sensitivities
    assert found["k"]["x"] == pytest.approx(-t * np.sin(w * t) / (2 * w), abs=1e-8)
    assert found["start.v"]["v"] == pytest.approx(np.cos(w * t), abs=1e-8)


def test_a_step_that_failed_is_not_followed() -> None:
    """x' = -1 - p sqrt(x) is no number below zero, where an event is found: no step goes there."""
    text = one("-1 - (p*sqrt(x) if x >= 0 else 0)", 1.0, "parameters: {p: 0.7}")
    model, part = made(text), 1e-4
    times = np.append(np.linspace(0, 0.6, 31), np.linspace(0.69, 1, 31))
    run = simulate(model, times=times, sensitivities=["p"], rtol=1e-9)
    assert len(run.events) == 1
    above, below = (
        simulate(model, times=times, parameters={"p": 0.7 + change}, **TIGHT)
        for change in (part, -part)
    )
    wanted = (above["x"] - below["x"]) / (2 * part)
    assert run.sensitivities["p"]["x"] == pytest.approx(wanted, abs=1e-6)
    moved = (above.events[0].time - below.events[0].time) / (2 * part)
    assert run.events[0].sensitivity["p"] == pytest.approx(moved, abs=1e-6)


def test_states_inside_of_steps_are_the_same_with_sensitivities() -> None:
    """These look again into steps that are over, and leave them as they were."""
    model, times = made(RUBBED), np.linspace(0, 20, 1501)
    for rtol in (1e-4, 1e-9):
        plain = simulate(model, times=times, rtol=rtol)
        run = simulate(model, times=times, rtol=rtol, sensitivities=["level", "k", "begin"])
        assert run.statistics.steps == plain.statistics.steps
        assert np.array_equal(plain["x"], run["x"])
        assert np.array_equal(plain["v"], run["v"])


@pytest.mark.parametrize("names", [["p"], ["p", "q"], ["p", "q", "start.x"]])
def test_what_fades_at_once_is_known_inside_of_a_step(names: list[str]) -> None:
    """x' = -1e6 (x - p - q t): x is p + q (t - 1e-6) as soon as what it began with has faded."""
    text = """
span: [0, 1]
parameters: {p: 2, q: 3}
blocks:
  x: {type: integrator, of: rate, start: 5}
  rate: {type: expression, formula: -1000000*(x - p - q*t)}
"""
    t = np.linspace(0, 1, 1001)
    run = simulate(made(text), sensitivities=names, times=t, rtol=1e-6)
    exact = {"p": 1 - np.exp(-1e6 * t), "start.x": np.exp(-1e6 * t)}
    exact["q"] = t - 1e-6 * exact["p"]
    for name in names:
        assert run.sensitivities[name]["x"] == pytest.approx(exact[name], abs=1e-5)


def test_what_rests_still_has_sensitivities_that_swing() -> None:
    """The steps of the states are as long as they may be; those of S follow S."""
    run = simulate(
        made(SPRING),
        parameters={"c": 0.0, "k": 9.0},
        start={"x": 0.0},
        span=(0, 100),
        sensitivities=["force", "k"],
        **TIGHT,
    )
    assert run.statistics.steps < 50
    expected = (1 - np.cos(3 * run.t)) / 9
    assert run.sensitivities["force"]["x"] == pytest.approx(expected, abs=1e-6)
    assert np.all(run.sensitivities["k"]["x"] == 0.0)


@pytest.mark.parametrize(
    ("text", "names"),
    [
        (SPRING, ["k", "c", "force", "start.x", "start.v"]),
        (RUBBED, ["level", "k", "begin", "start.x"]),
        (BREAKAWAY, ["slip", "stick", "omega", "force", "start.x"]),
        (SQUARE, ["f", "height", "shift", "start.x"]),
        (RESETS, ["p", "q", "start.x", "start.v"]),
        (LIMITED, ["m", "k", "omega"]),
        (BALL.replace("12]", "6]"), ["restitution", "start.x"]),
        (STIFF, ["mu", "b", "start.v"]),
        (CAM, ["late", "tall"]),
    ],
    ids=["spring", "stick", "breakaway", "square", "reset", "limit", "ball", "stiff", "cam"],
)
@pytest.mark.parametrize("method", ["auto", "dop853", "rosenbrock"])
def test_sensitivities_are_those_of_differences(text: str, names: list[str], method: str) -> None:
    record = {RUBBED: ("friction",), LIMITED: ("y",)}.get(text, ())
    run = agree(made(text, record), names, method=method)
    assert run.warnings == ()


def test_stick_loses_the_rank_that_it_takes() -> None:
    """On the slide v = 0, so that nothing moves v any more, and x does not move either."""
    run = simulate(made(RUBBED), sensitivities=["level", "begin"], **TIGHT)
    rest = run.events[-1].time
    assert rest == pytest.approx(5 * math.pi, abs=1e-8)
    held = run.t > rest
    for name, value in (("level", 10.0), ("begin", -1.0)):
        assert run.sensitivities[name]["v"][held] == pytest.approx(0.0, abs=1e-9)
        assert run.sensitivities[name]["x"][held] == pytest.approx(value, abs=1e-6)


def test_the_edges_of_a_square_wave_move_with_its_frequency() -> None:
    run = simulate(made(SQUARE), parameters={"shift": 0.0}, sensitivities=["f"], **TIGHT)
    assert len(run.events) > 5
    for event in run.events:
        assert event.sensitivity["f"] == pytest.approx(-event.time / 1.3, rel=1e-12)


def test_two_scheduled_changes_at_one_instant_each_move_on_their_own() -> None:
    """Both waves fall at t = 0.5; only the frequency of one moves."""
    text = """
span: [0, 0.9]
parameters: {f: 1, h: 1}
blocks:
  x: {type: integrator, of: rate}
  one: {type: square, amplitude: 1, frequency: f, phase: 0}
  two: {type: square, amplitude: 3, frequency: h, phase: 0}
  rate: {type: sum, of: [one, two]}
"""
    run = simulate(made(text), sensitivities=["f", "h"], **TIGHT)
    after = run.t > 0.5
    # x grows by 2 A per second of delay of the edge, which moves by -t/f
    assert run.sensitivities["f"]["x"][after] == pytest.approx(-1.0, abs=1e-12)
    assert run.sensitivities["h"]["x"][after] == pytest.approx(-3.0, abs=1e-12)


def test_a_ball_that_comes_to_rest_is_flagged_and_then_moves_with_nothing() -> None:
    """The rest comes at t0 (1 + e)/(1 - e), t0 = sqrt(2 h/g)."""
    run = simulate(made(BALL), span=(0, 14), sensitivities=["restitution", "start.x"], **TIGHT)
    last = run.events[-1]
    assert last.kind == "rest"
    fall = math.sqrt(20 / 9.81)
    assert last.sensitivity["start.x"] == pytest.approx(fall * 9 / 20, rel=1e-6)
    # the impacts that are not seen any more bring the last 2e-6
    assert last.sensitivity["restitution"] == pytest.approx(fall * 2 / 0.2**2, rel=1e-5)
    assert any("'x'" in warning and "rest" in warning for warning in run.warnings)
    for found in run.sensitivities.values():
        assert np.isfinite(found["x"]).all()
        assert np.all(found["x"][run.t > last.time] == 0.0)
        assert np.all(found["v"][run.t > last.time] == 0.0)


def test_a_contact_that_is_pressed_lets_go_when_its_force_ends() -> None:
    run = agree(made(PRESSED), ["g", "push"], span=(0, 3))
    (start, *_) = run.t
    release = 2 * math.asin(9.81 / 14)
    lying = (run.t > start) & (run.t < release - 1e-3)
    assert np.all(run.sensitivities["g"]["x"][lying] == 0.0)
    assert run.sensitivities["g"]["v"][-1] < 0


def test_a_graze_is_flagged_and_finite() -> None:
    text = """
span: [0, 2]
parameters: {p: 0}
blocks:
  x: {type: integrator, of: rate, start: 1}
  rate: {type: expression, formula: 2*(t - 1)}
  y: {type: integrator, of: jump}
  jump: {type: expression, formula: "1 if x + p > 0 else 2"}
"""
    run = simulate(made(text), sensitivities=["p", "start.x"])
    assert all(np.isfinite(found["y"]).all() for found in run.sensitivities.values())
    if run.events:  # the double zero may be seen or not
        assert any("graze" in warning for warning in run.warnings)


def test_start_values_follow_the_parameters_they_read() -> None:
    model = made(LIMITED)
    run = simulate(model, sensitivities=["m"], **TIGHT)
    assert run.sensitivities["m"]["x"][0] == pytest.approx(0.8 * 1.3, rel=1e-10)
    given = simulate(model, start={"x": 0.5}, sensitivities=["m"], **TIGHT)
    assert given.sensitivities["m"]["x"][0] == 0.0


def test_a_parameter_that_is_set_follows_no_other() -> None:
    run = simulate(made(LIMITED), parameters={"k": 5.0}, sensitivities=["m"], **TIGHT)
    assert run.sensitivities["m"]["x"][0] == 0.0
    agree(made(LIMITED), ["m"], parameters={"k": 5.0})


@pytest.mark.parametrize("preset", ["consistent", "teaching"])
def test_sensitivities_of_paper_a(preset: str) -> None:
    """Stiff contact, stick on the pin, Stribeck friction.

    Differences of two runs are noisy while the column lies on its pin and near impacts, by some
    1e-4 at this step and more at smaller ones; there a run of other tolerances tells how exact the
    sensitivities are.
    """
    model = tw.compile(tw.read(PENDULUM))
    names = ["T_s2_l", "beta", "k2", "c1", "B1", "phi1_s"]
    options: dict[str, Any] = {"preset": preset, "span": (0, 1.6), "rtol": 1e-12}
    options["limits"] = tw.Limits(steps=1_000_000, seconds=60)
    run = simulate(model, sensitivities=names, **options)
    loose = simulate(model, sensitivities=names, **(options | {"rtol": 1e-8}))
    assert run.warnings == ()
    for name in names:
        step = 1e-4 * run.parameters[name]
        up, down = (moved(model, run, name, by, **options) for by in (step, -step))
        for signal in ("phi1", "phi2"):
            differences = (up[signal] - down[signal]) / (2 * step)
            found = run.sensitivities[name][signal]
            error = np.abs(found - differences) / np.max(np.abs(differences))
            assert np.median(error) < 1e-6, (name, signal)
            assert np.quantile(error, 0.9) < 1e-3, (name, signal)
            error = np.abs(loose.sensitivities[name][signal] - found) / np.max(np.abs(found))
            assert np.max(error) < 1e-5, (name, signal)


def test_the_run_itself_is_the_same_with_sensitivities() -> None:
    for text in (RUBBED, SQUARE, RESETS, PRESSED):
        model = made(text)
        plain, run = simulate(model), simulate(model, sensitivities=["start.x"])
        assert [event.time for event in run.events] == [event.time for event in plain.events]
        for name in plain.signals:
            assert np.array_equal(plain[name], run[name])
        assert plain.sensitivities == {}
        assert all(event.sensitivity == {} for event in plain.events)


def test_unknown_names_say_what_exists() -> None:
    with pytest.raises(OptionError, match=r"unknown sensitivity 'kk'; there are: .*start\.x"):
        simulate(made(SPRING), sensitivities=["kk"])


def test_a_guard_that_passes_by_between_steps_moves_its_instant() -> None:
    """A seal that slips goes by its level so slowly, once, that only the next step finds it: how
    its instant moves was read from memory that nobody had written."""
    model = tw.compile(tw.read(SERVO))
    value = simulate(model).parameters["driving.kp"]
    times = np.arange(0.0, 6.01, 0.25)
    runs = []
    for size in (10, 3000, 70, 900):  # other memory for each run
        junk = [np.full(size + n, 1e9) for n in range(100)]
        del junk
        runs.append(simulate(model, rtol=1e-8, times=times, sensitivities=["driving.kp"]))
    first, *others = (run.sensitivities.array for run in runs)
    for other in others:
        np.testing.assert_array_equal(other, first)
    part = PART * value
    above, below = (
        simulate(model, rtol=1e-10, times=times, parameters={"driving.kp": value + change})
        for change in (part, -part)
    )
    for signal in ("turned", "load.angle"):
        row = runs[0].sensitivities.signals.index(signal)
        wanted = (above[signal] - below[signal]) / (2 * part)
        np.testing.assert_allclose(first[0, row], wanted, atol=1e-5 * np.abs(wanted).max())
