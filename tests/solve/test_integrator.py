"""An integrator goes to a stop and on: what it says there, and what a stop leaves as it is."""

from __future__ import annotations

import numpy as np
import pytest
from solve.models import BALL, OSCILLATOR, made
from tracewire.errors import OptionError
from tracewire.solve import Integrator, Interrupted, StopFlag, initial_value_problem, simulate

TURNING = """
span: [0, 6.5]
record: [x]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: gain, of: x, k: -1}
"""
LATE = """
span: [0, 5]
record: [x, late]
blocks:
  x: {type: integrator, of: one}
  one: {type: constant, value: 1}
  late: {type: delay, of: x, time: 0.3, past: zero}
  zero: {type: constant, value: 0}
"""


def test_a_stop_is_at_the_time_and_has_the_states_there() -> None:
    integrator = Integrator(initial_value_problem(made(TURNING), rtol=1e-10))
    for stop in (0.5, 2.25, 6.0):
        integrator.go_to(stop)
        assert integrator.t == stop
        assert integrator.x == pytest.approx([np.cos(stop), -np.sin(stop)], abs=1e-8)


def test_without_a_stop_it_is_the_run_of_simulate() -> None:
    model = made(BALL)
    integrator = Integrator(initial_value_problem(model))
    integrator.go_to()
    alone = simulate(model)
    assert integrator.run["x"].tolist() == alone["x"].tolist()
    assert integrator.run.events == alone.events
    assert integrator.run.final == alone.final


@pytest.mark.parametrize("text", [BALL, OSCILLATOR, TURNING, LATE])
def test_stops_do_not_change_the_motion(text: str) -> None:
    model = made(text)
    whole = simulate(model, rtol=1e-10)
    integrator = Integrator(initial_value_problem(model, rtol=1e-10))
    end = whole.t[-1]
    for stop in (0.11, 0.11 + 0.3 * end, 0.7 * end):
        integrator.go_to(stop)
    integrator.go_to()
    run = integrator.run
    assert run.t.tolist() == whole.t.tolist()
    assert [event.kind for event in run.events] == [event.kind for event in whole.events]
    for name in whole.signals:
        assert run[name] == pytest.approx(whole[name], rel=1e-6, abs=1e-6)


def test_a_run_up_to_a_stop_stays_as_it_was() -> None:
    integrator = Integrator(initial_value_problem(made(BALL)))
    integrator.go_to(2.0)  # the ball has hit the ground once, at sqrt(2*10/9.81) s
    part = integrator.run
    integrator.go_to()
    assert len(part.events) == 1
    assert part.t[-1] == pytest.approx(2.0, abs=0.012)
    assert part.final["x"] == pytest.approx(part["x"][-1], abs=0.2)
    assert len(integrator.run.events) > 1


def test_an_event_at_a_stop_has_happened_there() -> None:
    step = "  jump: {type: step, height: 1, at: 2.0}\n"
    text = TURNING + step + "events: [{when: jump - 0.5, set: {v: 5}}]\n"
    integrator = Integrator(initial_value_problem(made(text)))
    integrator.go_to(2.0)
    assert integrator.x[1] == 5.0


@pytest.mark.parametrize("end", [0.5, np.nan, np.inf])
def test_a_stop_that_cannot_be_reached_is_refused(end: float) -> None:
    integrator = Integrator(initial_value_problem(made(TURNING)))
    integrator.go_to(1.0)
    with pytest.raises(OptionError, match=r"that is at t = 1 s cannot go to .* Give a later time"):
        integrator.go_to(end)


def test_arrays_that_are_given_back_serve_the_next_run() -> None:
    model = made(BALL)
    first = Integrator(initial_value_problem(model))
    first.go_to()
    final = first.x
    first.give_back()
    second = Integrator(initial_value_problem(model))
    assert second.arrays is first.arrays
    second.go_to()
    assert second.x.tolist() == final.tolist()


def test_a_halt_that_is_asked_for_stops_it() -> None:
    integrator = Integrator(initial_value_problem(made(BALL)), stop_flag=StopFlag(asked=True))
    with pytest.raises(Interrupted, match="interrupted at t = 0 s, on the way from 0 to 12 s"):
        integrator.go_to()
