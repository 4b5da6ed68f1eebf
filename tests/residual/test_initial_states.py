"""Starts of windows that went astray, and are found again from the data."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Criterion, Measured
from tracewire.residual.initial_states import fit_initial_states, restart_from_others
from tracewire.residual.windows import Section, Windows, cut_windows, evaluate_windows
from tracewire.solve import simulate

BLOCK = """\
span: [0, 4]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: force}
  drive: {type: sine, amplitude: 3, omega: 3}
  friction: {type: coulomb, rate: v, level: 1}
  force: {type: sum, of: [drive, friction]}
"""


@pytest.fixture
def astray() -> tuple[Windows, int, float]:
    """Windows of a block that slides, one of which begins wrong; its number, and the rate there."""
    model = compile(read_text(BLOCK, Path("block.yaml")), record=["x", "v"])
    t = np.linspace(0, 4, 401)
    run = simulate(model, times=t, rtol=1e-10)
    measured = Measured("slide", "train", t, {"x": run["x"]}, start={"x": None, "v": None})
    windows = cut_windows(model, Section(measured, 0, 401), 20, ("x", "v"))
    moving = [n for n, w in enumerate(windows) if abs(run["v"][w.rows[0]]) > 0.5]
    held = moving[len(moving) // 2]
    wrong = {"x": float(run["x"][windows[held].rows[10]]), "v": 0.0}
    windows[held] = replace(windows[held], start={**windows[held].start, **wrong})
    seen = compile(model.diagram, record=["x"])
    criterion = Criterion(seen, windows, [], {}, 1e-8, {"x": 1e-4}, weighting="sum", chained=False)
    begun = evaluate_windows(criterion)
    assert begun.linearisations[held].square > 1e4 * np.median(begun.squares)
    return begun, held, float(run["v"][windows[held].rows[0] - 1])


def test_a_window_that_friction_holds_begins_where_the_data_say(
    astray: tuple[Windows, int, float],
) -> None:
    begun, held, rate = astray
    found = fit_initial_states(begun)
    assert found.linearisations[held].square < 20
    assert found.starts[held]["v"] == pytest.approx(rate, abs=1e-2)


def test_a_window_that_is_astray_begins_where_another_model_does(
    astray: tuple[Windows, int, float],
) -> None:
    begun, held, rate = astray
    other = fit_initial_states(begun)
    found = restart_from_others(begun, other)
    assert found.linearisations[held].square < 20
    assert found.starts[held]["v"] == pytest.approx(rate, abs=1e-2)
    assert restart_from_others(other, begun).starts == other.starts, "what is right stays"
