"""Delays that change while they act: where they read, and within which bounds."""

from __future__ import annotations

import math

import numpy as np
import pytest
from solve.models import made
from tracewire.solve import simulate


def test_a_variable_delay_of_a_source_reads_it_where_it_says() -> None:
    text = """
    span: [0, 10]
    record: [tau, late, wave, n]
    blocks:
      tau: {type: expression, formula: 1 + 0.8*sin(2*t), unit: s}
      u: {type: expression, formula: sin(5*t)}
      late: {type: variable_delay, of: u, time: tau, before: 7, shortest: 0.1, longest: 3}
      w: {type: square, amplitude: 1, frequency: 0.5}
      wave: {type: variable_delay, of: w, time: tau, shortest: 0.1, longest: 3}
      n: {type: counter, of: wave, threshold: 0.5}
    """
    times = np.linspace(0, 10, 2001)[1:]  # no sample at a jump
    run = simulate(made(text), times=times + 1e-4 * math.pi, span=(0, 10.1), rtol=1e-9)
    s = run.t - run["tau"]
    assert np.max(np.abs(run["late"] - np.where(s >= 0, np.sin(5 * s), 7))) < 1e-7
    square = np.where(np.floor(s) % 2 == 0, 1.0, -1.0)
    assert np.array_equal(run["wave"], np.where(s >= 0, square, 0))
    for event in run.events:
        if event.block == "n":
            where = event.time - 1 - 0.8 * math.sin(2 * event.time)
            assert where == pytest.approx(round(where), abs=1e-9)


def test_the_delay_of_a_variable_one_stays_between_its_bounds() -> None:
    text = """
    span: [0, 10]
    record: [late]
    blocks:
      tau: {type: expression, formula: t - 2, unit: s}
      late: {type: variable_delay, of: u, time: tau, shortest: 0.5, longest: 3, before: 9}
      u: {type: time}
    """
    run = simulate(made(text), times=[0.2, 1.0, 2.0, 4.0, 5.0, 7.0, 10.0])
    assert run["late"] == pytest.approx([9, 0.5, 1.5, 2, 2, 4, 7], abs=1e-9)


def test_a_delay_that_follows_a_state() -> None:
    """x = exp(t): x(t - 0.5 - 0.3 ln(x)) is exp(0.7 t - 0.5)."""
    text = """
    span: [0, 2]
    record: [x, late]
    blocks:
      x: {type: integrator, of: rate, start: 1}
      tau: {type: expression, formula: 0.5 + 0.3*log(x), unit: s}
      late: {type: variable_delay, of: x, time: tau, past: before, shortest: 0.4, longest: 2}
      before: {type: expression, formula: exp(t)}
      rate: {type: expression, formula: late*exp(0.5)*x**0.3}
    """
    run = simulate(made(text), rtol=1e-9)
    assert run["x"] == pytest.approx(np.exp(run.t), rel=1e-7)
    assert run["late"] == pytest.approx(np.exp(0.7 * run.t - 0.5), rel=1e-7)
