"""Delays: exact solutions by the method of steps, jumps that come later, and what is refused."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from solve.delays import BALL, LINEAR, RELAY, VARIABLE
from solve.models import LIMITS, made
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import DiagramError, OptionError, SimulationError
from tracewire.solve import (
    Passage,
    Span,
    history,
    integrator,
    simulate,
    simulate_many,
    simulate_spans,
)
from tracewire.solve.core import history as core_history
from tracewire.solve.core import integrate
from tracewire.solve.core_library import library

Vector = NDArray[np.float64]
METHODS = ("auto", "dormand_prince", "dop853", "rosenbrock")

STEPS = """
span: [0, 4]
record: [x, late]
blocks:
  x: {type: integrator, of: rate, start: 1}
  late: {type: delay, of: x, time: 1, before: 1}
  rate: {type: gain, of: late, k: -1}
"""
MOTOR = """
span: [0, 2]
record: [angle, u]
parameters: {T: {value: 10, unit: ms}}
blocks:
  angle: {type: integrator, of: rate}
  rate: {type: integrator, of: torque}
  torque: {type: expression, formula: 40*u - 8*rate}
  late: {type: delay, of: angle, time: T}
  error: {type: expression, formula: sin(3*t) - late}
  u: {type: pid, of: error, kp: 12, ki: 20, kd: 0.6, n: 200}
"""


def by_steps(t: Vector) -> Vector:
    """x of x' = -x(t - 1), x = 1 before: a polynomial in each second."""
    terms = [(-1) ** j * np.maximum(t - (j - 1), 0) ** j / math.factorial(j) for j in range(1, 7)]
    return np.asarray(1 + np.sum(terms, axis=0))


def series(a: float, b: float, delay: float, t: Vector) -> Vector:
    """x of x' = a x + b x(t - T), x = 1 before: in each piece a constant and exp(a s) p(s)."""
    found, constant, poly = np.ones(len(t)), 1.0, np.polynomial.Polynomial([0.0])
    end = 1.0
    for n in range(int(t[-1] / delay) + 1):
        inside = (t >= n * delay) & (t <= (n + 1) * delay)
        constant = -b / a * constant
        poly = (b * poly).integ() + (end - constant)
        s = t[inside] - n * delay
        found[inside] = constant + np.exp(a * s) * poly(s)
        end = constant + math.exp(a * delay) * float(poly(delay))
    return found


@pytest.mark.parametrize("method", METHODS)
def test_the_method_of_steps_gives_polynomials(method: str) -> None:
    run = simulate(made(STEPS), method=method, rtol=1e-10)
    assert np.max(np.abs(run["x"] - by_steps(run.t))) < 1e-12
    assert np.max(np.abs(run["late"] - by_steps(run.t - 1))) < 1e-12


@pytest.mark.parametrize(("method", "rtol", "off"), [
    ("dormand_prince", 1e-6, 1e-6), ("dormand_prince", 1e-10, 5e-10), ("dop853", 1e-10, 2e-10),
    ("rosenbrock", 1e-6, 1e-6), ("rosenbrock", 1e-10, 2e-10),
])  # fmt: skip
def test_a_linear_equation_with_delay(method: str, rtol: float, off: float) -> None:
    run = simulate(made(LINEAR), method=method, rtol=rtol)
    assert np.max(np.abs(run["x"] - series(-0.5, -1.2, 0.7, run.t))) < off


def test_steps_of_a_fixed_length_keep_their_order() -> None:
    errors = []
    for step in (0.04, 0.02, 0.01):
        run = simulate(made(LINEAR), method="rk4", step=step)
        errors.append(np.max(np.abs(run["x"] - series(-0.5, -1.2, 0.7, run.t))))
    assert np.all(np.array(errors[:-1]) / errors[1:] > 14)


@pytest.mark.parametrize("method", METHODS)
def test_a_relay_with_a_delay_swings_with_four_delays_and_one_amplitude(method: str) -> None:
    run = simulate(made(RELAY), method=method)
    times = [event.time for event in run.events]
    assert times == pytest.approx(1.0 + 1.4 * np.arange(len(times)), abs=1e-10)
    assert len(times) == 21
    assert np.max(np.abs(simulate(made(RELAY), times=[1.0, 2.4])["x"])) == pytest.approx(0.7)


def test_an_impact_is_heard_later_and_once() -> None:
    run = simulate(made(BALL), times=np.linspace(0, 3, 3001))
    struck, heard = (
        [e.time for e in run.events if e.block == name] for name in ("events[0]", "heard")
    )
    assert len(heard) == 5
    assert heard == pytest.approx([t + 0.21 for t in struck][: len(heard)], abs=1e-12)
    assert np.max(np.abs(run["late"][210:] - run["v"][:-210])) < 1e-10


def delayed_twice(source: str, first: float, second: float) -> str:
    return f"""
span: [0, 8]
record: [u, once, twice, total]
blocks:
  u: {{type: expression, formula: "{source}"}}
  once: {{type: delay, of: u, time: {first!r}, before: 3}}
  twice: {{type: delay, of: once, time: {second!r}, before: 3}}
  total: {{type: delay, of: u, time: {first + second!r}, before: 3}}
"""


SOURCES = (
    "sin({w}*t)", "exp(-t)*cos({w}*t)", "t**3 - {w}*t", "abs(sin({w}*t))", "floor({w}*t)",
    "1 if sin({w}*t) > 0.3 else -1", "max(sin(t), cos({w}*t))", "{w}", "sin({w}*t*t)",
)  # fmt: skip


@settings(max_examples=25, deadline=None)
@given(st.sampled_from(SOURCES), st.floats(0.3, 12.0), st.floats(0.05, 3.0), st.floats(0.05, 3.0))
def test_the_delay_of_a_source_is_the_source_shifted(
    source: str, w: float, first: float, second: float
) -> None:
    text = source.format(w=repr(w))
    times = np.sort(np.random.default_rng(3).uniform(0, 8, 400))
    run = simulate(made(delayed_twice(text, first, second)), times=times, rtol=1e-8)
    largest = np.max(np.abs(run["u"]))
    for name, delay in (("once", first), ("twice", first + second), ("total", first + second)):
        late = times - delay
        rows = (late >= 0) & (late <= 8)
        shifted = simulate(
            made(delayed_twice(text, first, second)), times=np.unique([0.0, *late[rows]])
        )["u"][-int(rows.sum()) :]
        assert np.all(np.abs(run[name][rows] - shifted) <= 1e-7 * largest)
        assert np.all(run[name][late < 0] == 3)


def test_a_jump_comes_exactly_later_also_through_two_delays() -> None:
    text = """
    span: [0, 10]
    record: [w, once, twice, total, n, area]
    blocks:
      w: {type: square, amplitude: 1, frequency: 1}
      once: {type: delay, of: w, time: 0.3}
      twice: {type: delay, of: once, time: 0.45}
      total: {type: delay, of: w, time: 0.75}
      n: {type: counter, of: once}
      area: {type: integrator, of: twice}
    """
    run = simulate(made(text), times=np.linspace(0, 10, 2001))
    ticks = [event.time for event in run.events if event.block == "n"]
    assert ticks == pytest.approx(0.3 + np.arange(10), abs=1e-12)
    assert np.array_equal(run["twice"], run["total"])
    assert np.array_equal(run["once"][60:], run["w"][:-60])
    assert run["area"][::200] == pytest.approx([0.0, *[0.25] * 10], abs=1e-12)


def test_a_loop_through_a_delay_is_no_algebraic_loop() -> None:
    text = """
    span: [0, 5]
    record: [y]
    blocks:
      u: {type: step, height: 1, at: 0.5}
      y: {type: expression, formula: u + 0.5*late}
      late: {type: delay, of: y, time: 1}
    """
    run = simulate(made(text), times=[0.2, 0.6, 1.4, 1.5, 2.6, 3.6, 4.6])
    assert run["y"] == pytest.approx([0, 1, 1, 1.5, 1.75, 1.875, 1.9375], abs=1e-12)


def test_the_past_may_be_a_formula_of_the_time() -> None:
    text = """
    span: [0, 20]
    record: [x]
    parameters: {T: {value: pi/2, unit: s}}
    blocks:
      x: {type: integrator, of: rate}
      late: {type: delay, of: x, time: T, past: before}
      rate: {type: gain, of: late, k: -1}
      before: {type: expression, formula: sin(t)}
    """
    run = simulate(made(text), rtol=1e-9)
    assert np.max(np.abs(run["x"] - np.sin(run.t))) < 5e-9


def test_a_delayed_guard_that_turns_fast_misses_nothing() -> None:
    text = """
    span: [0, 3]
    record: [n]
    blocks:
      u: {type: expression, formula: sin(2*pi*40*t)}
      late: {type: delay, of: u, time: 1}
      n: {type: counter, of: late, threshold: 0.3}
    """
    run = simulate(made(text))
    first = math.asin(0.3) / (2 * math.pi * 40)
    times = [event.time for event in run.events]
    assert times == pytest.approx(1 + first + np.arange(80) / 40, abs=1e-8)


def test_a_motor_with_a_delayed_sensor_is_that_of_scipy() -> None:
    """The method of steps by hand: each piece of 10 ms has the one before as its input."""
    delay, lag, kp, ki, kd = 0.01, 0.005, 12.0, 20.0, 0.6
    model = made(MOTOR)
    names = list(model.states)
    assert len(names) == 4
    times = np.linspace(0, 2, 201)
    run = simulate(model, times=times, rtol=1e-9)
    past: Callable[[float], float] = lambda t: 0.0  # noqa: E731
    state = np.zeros(4)  # angle, rate, integral, filtered error
    found = [0.0]
    for n in range(200):
        begin = n * delay

        def field(t: float, x: Vector, past: Callable[[float], float] = past) -> list[float]:
            error = math.sin(3 * t) - past(t - delay)
            slope = (error - x[3]) / lag
            u = kp * error + x[2] + kd * slope
            return [x[1], 40 * u - 8 * x[1], ki * error, slope]

        piece = solve_ivp(
            field, (begin, begin + delay), state, rtol=1e-10, atol=1e-13, dense_output=True
        )
        past = lambda t, piece=piece: float(piece.sol(t)[0])  # type: ignore[misc]  # noqa: E731
        state = piece.y[:, -1]
        found.append(state[0])
    assert np.max(np.abs(run["angle"] - found)) < 1e-6


def test_back_ends_and_python_give_the_same_bits(monkeypatch: pytest.MonkeyPatch) -> None:
    for text in (LINEAR.replace("10", "3"), RELAY.replace("30", "4"), VARIABLE):
        run = simulate(made(text))
        slow = simulate(compile(read_text(text), backend="python"))
        for name in run.signals:
            assert np.array_equal(run[name], slow[name])

    def by_python(core: int) -> int:
        with np.errstate(all="ignore"):
            return int(integrate.advance(core))

    options: dict[str, Any] = {"times": [0, 1.1, 1.5], "rtol": 1e-3, "sensitivities": ["start.x"]}
    run = simulate(made(STEPS), **options)
    monkeypatch.setattr(integrator, "library", lambda: replace(library(), advance=by_python))
    slow = simulate(made(STEPS), **options)
    assert np.array_equal(run["x"], slow["x"])
    assert np.array_equal(run.sensitivities["start.x"]["x"], slow.sensitivities["start.x"]["x"])


def test_many_runs_are_each_as_alone_and_long_ones_forget() -> None:
    model = made(LINEAR)
    delays = np.linspace(0.3, 1.0, 5)
    rows = simulate_many(model, {"T": delays}, workers=2)
    for row, delay in enumerate(delays.tolist()):
        assert np.array_equal(
            rows.samples[row, :, 0], simulate(model, parameters={"T": delay})["x"]
        )
    spans = [Span(0.0, 10.0, np.linspace(0, 10, 101), {}), Span(0.0, 3.0, np.array([3.0]), {})]
    both = simulate_spans(model, spans, sensitivities=["T"])
    alone = simulate(model, times=np.linspace(0, 10, 101), sensitivities=["T"])
    assert np.array_equal(both["x"][:101], alone["x"])
    assert np.array_equal(both.sensitivities["T"]["x"][:101], alone.sensitivities["T"]["x"])


def test_a_history_that_is_full_grows_or_is_forgotten() -> None:
    """A pure oscillation x' = -pi/2 x(t - 1): after 3000 s it is where it was."""
    text = """
    span: [0, 3000]
    record: [x]
    blocks:
      x: {type: integrator, of: rate}
      late: {type: delay, of: x, time: 1, past: before}
      rate: {type: expression, formula: -pi/2*late}
      before: {type: expression, formula: sin(pi/2*t)}
    """
    run = simulate(made(text), times=[2999.0], rtol=1e-10, span=(0, 3000))
    assert run.statistics.steps > core_history.ROOM
    assert run["x"][0] == pytest.approx(math.sin(math.pi / 2 * 2999), abs=1e-5)
    held = text.replace("time: 1,", "time: 2997,").replace("-pi/2*late", "cos(t) + 0*late")
    run = simulate(made(held + "  y: {type: delay, of: x, time: 2996}\n", record=["y"]),
                   times=[2999.0], rtol=1e-10)  # fmt: skip
    assert run.statistics.steps > 3 * core_history.ROOM
    assert run["y"][0] == pytest.approx(math.sin(3), abs=1e-7)


def test_a_clock_reads_what_was_and_its_samples_come_later() -> None:
    text = """
    span: [0, 2]
    record: [late, again]
    blocks:
      u: {type: expression, formula: t}
      held: {type: zero_order_hold, of: u, period: 0.1}
      late: {type: delay, of: held, time: 0.05}
      both: {type: sum, of: [late, -last]}
      again: {type: unit_delay, of: both, period: 0.1}
      last: {type: constant, value: 0}
    """
    run = simulate(made(text), times=[0.02, 0.12, 0.17, 1.12, 1.17])
    assert run["late"] == pytest.approx([0, 0, 0.1, 1.0, 1.1], abs=1e-12)
    assert run["again"] == pytest.approx([0, 0, 0, 0.9, 0.9], abs=1e-12)


def test_a_delay_in_other_units_is_the_same() -> None:
    other = LINEAR.replace("{value: 0.7, unit: s}", "{value: 700, unit: ms}")
    assert simulate(made(other))["x"] == pytest.approx(simulate(made(LINEAR))["x"], abs=1e-12)
    tiny = LINEAR.replace("[0, 10]", "[0, 1e-8]").replace("0.7", "0.7e-9")
    tiny = tiny.replace("a: -0.5, b: -1.2", "a: -0.5e9, b: -1.2e9")
    assert simulate(made(tiny))["x"] == pytest.approx(simulate(made(LINEAR))["x"], abs=1e-6)


def test_a_vector_is_delayed_element_by_element() -> None:
    text = """
    span: [0, 3]
    record: [q]
    blocks:
      q: {type: integrator, of: rate, start: [1, 2]}
      late: {type: delay, of: q, time: 1, before: 1}
      rate: {type: gain, of: late, k: -1}
    """
    run = simulate(made(text))
    assert run["q[0]"] == pytest.approx(by_steps(run.t), abs=1e-9)
    assert run["q[1]"] == pytest.approx(by_steps(run.t) + 1 - np.maximum(run.t - 1, 0)
        + np.maximum(run.t - 2, 0) ** 2 / 2, abs=1e-9)  # fmt: skip


def test_what_fails_is_told_with_its_block() -> None:
    text = (
        STEPS
        + """
  bad: {type: expression, formula: log(x) + late}
  y: {type: integrator, of: bad}
events:
  - {every: 1, offset: 1, set: {x: 0*x}}
"""
    )
    with pytest.raises(SimulationError, match="at t = 1 s: 'bad' is not finite"):
        simulate(made(text.replace("start: 1", "start: 9")))


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        (("before: 1}", "past: rate}"), "'rate' is given as the past of 'x', and reads more than"),
        (("time: 1,", "time: 0,"), "parameter 'time' must be above 0 s, not 0."),
        (("{type: delay", "{type: expression, formula: 'delayed(x, 1, 0)'} #"), "Use a block of"),
        (("time: 1,", "time: x,"), "'x' is a signal, and a value is fixed"),
    ],
)
def test_what_is_wrong_in_a_diagram_is_refused(changed: tuple[str, str], told: str) -> None:
    with pytest.raises(DiagramError) as caught:
        made(STEPS.replace(*changed))
    assert told in str(caught.value)


def test_a_delay_that_a_run_makes_zero_is_refused() -> None:
    with pytest.raises(SimulationError, match="the parameters do not meet 'T > 0': T = 0"):
        simulate(made(LINEAR), parameters={"T": 0.0})


def test_what_needs_states_alone_is_refused_in_words() -> None:
    model = made(STEPS)
    with pytest.raises(OptionError) as caught:
        Passage(model, length=1.0)
    assert "an analysis begins at states, and the delay needs what 'x' was" in str(caught.value)
    assert "pade_delay" in str(caught.value)
    assert "block 'late'" in str(caught.value)
    spans = [Span(0.0, 1.0, np.array([1.0]), {}), Span(1.0, 2.0, np.array([2.0]), {}, True)]
    with pytest.raises(OptionError, match="a span that follows another begins at states"):
        simulate_spans(model, spans)


def test_steps_that_follow_the_past_of_a_guard_do_not_become_nothing() -> None:
    """Steps that end where old ones did met them again one rounding too early, for ever."""
    text = """
    span: [0, 8]
    blocks:
      x0: {type: integrator, of: r0, start: 0.47}
      r0: {type: expression, formula: "-0.3*x0 - 0.17*tanh(l2) + 0.04*sin(x1) + 2.49*x1"}
      x1: {type: integrator, of: r1, start: 0.72}
      r1: {type: expression, formula: "-0.3*x1 - 0.3*max(l2, 0.2) + 0.57*x0 + 0.76*sign(l1)"}
      l0: {type: delay, of: l2, time: 0.525, before: 0.3}
      u1: {type: expression, formula: "0.5*x1 - 1.95*max(x1, 0.2)"}
      l1: {type: delay, of: u1, time: 0.989, before: 0.3}
      u2: {type: expression, formula: 0.5*l0 + 0.6*sin(l0)}
      l2: {type: delay, of: u2, time: 0.104, before: 0.3}
    """
    run = simulate(made(text), rtol=1e-9, limits=LIMITS)
    assert run.statistics.steps < 3000


def test_a_past_that_takes_too_much_memory_ends_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history.MEMORY, "past", 200_000)
    text = LINEAR.replace("[0, 10]", "[0, 3000]").replace("0.7", "2999")
    text = text.replace("a*x + b*late", "cos(9*t) + 0*late")
    with pytest.raises(SimulationError, match=r"the past of what is delayed takes more than 0 GB"):
        simulate(made(text), rtol=1e-10)
