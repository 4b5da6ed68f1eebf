"""The same record in other units has the same answer."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.trace import Found, trace

DIAGRAM = """\
span: [0, {end}]
inputs: {{u: {{default: 0}}}}
parameters:
  k: {{value: {k}, fit: [{k_low}, {k_high}]}}
  c: {{value: {c}, fit: [0, {c_high}]}}
  g: {{value: {g}, fit: [0, {g_high}]}}
blocks:
  x: {{type: integrator, of: v, start: 0}}
  v: {{type: integrator, of: force}}
  spring: {{type: gain, of: x, k: -k}}
  damper: {{type: viscous, rate: v, c: c}}
  push: {{type: gain, of: u, k: g}}
  force: {{type: sum, of: [spring, damper, push]}}
measured:
  swing:
    file: swing.csv
    time: t
    signals: {{x: x}}
    inputs: {{u: u}}
    start: {{x: free, v: free}}
"""
CUBIC, STEP, NOISE = 4000.0, 0.03, 2e-5


@cache
def signals() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x'' = -25 x - 0.2 x' + 0.3 u - 4000 x^3 in V and s, x of about 0.05 V; t, x, u."""
    t = np.arange(0.0, 12.0, STEP)

    def drive(t: float | np.ndarray) -> np.ndarray:
        return np.asarray(np.sin(3.3 * t) + 0.7 * np.sin(5.7 * t + 1))

    def rates(t: float, state: np.ndarray) -> list[float]:
        x, v = state.tolist()
        return [v, -25 * x - 0.2 * v + 0.3 * float(drive(t)) - CUBIC * x**3]

    run = solve_ivp(rates, (0, 12), [0.03, 0], t_eval=t, rtol=1e-9, atol=1e-12, max_step=STEP)
    x = run.y[0] + NOISE * np.random.default_rng(0).standard_normal(len(t))
    return t, x, drive(t)


@cache
def found_in(size: float, slow: float, drive: float) -> Found:
    """The trace of the record with x, t and u multiplied by these factors."""
    t, x, u = signals()
    rate = 1 / slow**2
    push = rate * size / drive
    text = DIAGRAM.format(
        end=12 * slow, k=22 * rate, k_low=5 * rate, k_high=80 * rate, c=0.3 / slow,
        c_high=2 / slow, g=0.25 * push, g_high=3 * push,
    )  # fmt: skip
    with TemporaryDirectory() as folder:
        rows = np.column_stack((t * slow, x * size, u * drive))
        file = Path(folder) / "swing.csv"
        np.savetxt(file, rows, delimiter=",", header="t,x,u", comments="", fmt="%.15g")
        (Path(folder) / "swing.yaml").write_text(text)
        return trace(compile(read(Path(folder) / "swing.yaml")))


def test_a_small_signal_does_not_hide_its_cubic_spring() -> None:
    found = found_in(1.0, 1.0, 1.0)
    assert [(e.name, e.place) for e in found.effects] == [("cubic_stiffness", "force")]
    assert found.effects[0].params["k"] == pytest.approx(CUBIC, rel=0.01)


@pytest.mark.parametrize(
    ("size", "slow", "drive"),
    [(1e-6, 1e3, 1e3), (1e3, 1e-3, 1e-6), (np.pi / 180, 60.0, 0.3048)],
)
def test_the_answer_is_the_same_in_other_units(size: float, slow: float, drive: float) -> None:
    first, other = found_in(1.0, 1.0, 1.0), found_in(size, slow, drive)
    assert other.verdict == first.verdict
    assert [(e.name, e.place) for e in other.effects] == [(e.name, e.place) for e in first.effects]
    scaled = other.effects[0].params["k"] * (size * slow) ** 2
    assert scaled == pytest.approx(first.effects[0].params["k"], rel=1e-5)
    assert other.s2_after == pytest.approx(first.s2_after, rel=1e-4)
    promised = [row.promised for row in first.steps[0].tried[:5]]
    assert [row.promised for row in other.steps[0].tried[:5]] == pytest.approx(promised, rel=1e-3)
