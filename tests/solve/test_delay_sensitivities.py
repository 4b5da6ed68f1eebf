"""How runs move with their parameters, a delay too: by differences of exact runs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import tracewire as tw
from solve.delays import BALL, LINEAR, RELAY, VARIABLE
from solve.models import made
from tracewire.compile import Model
from tracewire.solve import simulate


def fast(model: Model, **options: Any) -> tw.Run:
    return simulate(model, rtol=1e-12, method="dop853", **options)


@pytest.mark.parametrize(
    ("text", "names"),
    [
        (LINEAR, ("a", "b", "T", "start.x")),
        (RELAY, ("T", "start.x")),
        (BALL, ("e", "T", "start.x")),
        (VARIABLE, ("start.x",)),
        (
            """
            span: [0, 8]
            record: [x, y, late]
            parameters: {T: {value: 0.4, unit: s}, level: 0.2, F: 0.3, f: 0.71}
            blocks:
              x: {type: integrator, of: v, start: 0.55}
              v: {type: integrator, of: a}
              friction: {type: coulomb, rate: v, level: level}
              late: {type: delay, of: friction, time: T}
              push: {type: sine, amplitude: F, omega: 0.8}
              wave: {type: square, amplitude: 0.1, frequency: f}
              later: {type: delay, of: wave, time: T}
              a: {type: expression, formula: -x + friction + push + later}
              y: {type: integrator, of: late}
            """,
            ("T", "level", "F", "f", "start.x"),
        ),
        (
            """
            span: [0, 6]
            record: [x, late]
            parameters: {d: 0.6, A: 0.3, w: 1.3}
            blocks:
              x: {type: integrator, of: rate, start: 1}
              tau: {type: expression, formula: d + A*sin(w*t) + 0.05*x, unit: s}
              wave: {type: square, amplitude: 1, frequency: 0.4}
              late: {type: variable_delay, of: wave, time: tau, shortest: 0.05, longest: 2}
              old: {type: variable_delay, of: x, time: tau, before: 1, shortest: 0.05, longest: 2}
              rate: {type: expression, formula: late - old}
            """,
            ("d", "A", "w", "start.x"),
        ),
    ],
)
def test_sensitivities_are_those_of_differences(text: str, names: tuple[str, ...]) -> None:
    model = made(text)
    run = simulate(model, rtol=1e-9, sensitivities=names)
    part = 1e-6
    for name in names:
        state = name.removeprefix("start.")
        given = "start" if state != name else "parameters"
        value = run.start[state] if state != name else run.parameters[name]
        up, down = (fast(model, **{given: {state: value + d}}) for d in (part, -part))
        for signal, own in run.sensitivities[name].items():
            differences = (up[signal] - down[signal]) / (2 * part)
            off = np.abs(own - differences) / np.max(np.abs(own), initial=1.0)
            near = off > 1e-6  # a sample at an event, or at a jump that comes later
            assert np.mean(near) < 0.012, (name, signal)


def test_a_time_of_an_event_moves_with_the_delay() -> None:
    run = simulate(made(RELAY), span=(0, 8), sensitivities=["T"])
    assert [e.sensitivity["T"] for e in run.events] == pytest.approx([1, 3, 5, 7, 9], abs=1e-9)
