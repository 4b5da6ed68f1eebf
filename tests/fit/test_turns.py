"""An encoder that begins again after each turn: a fit follows the turns."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.fit import fit
from tracewire.residual import Measured, load_measured, wrap_to_period

COAST = """\
title: Coasting wheel
span: [0, 10]
parameters:
  c: {value: 0.6, unit: 1/s, fit: [0, 5]}
blocks:
  q: {type: integrator, of: w, start: 0, unit: rad}
  w: {type: integrator, of: drag, start: 30, unit: rad/s}
  drag: {type: gain, of: w, k: -c}
"""
TURN = 2 * np.pi
RATE, C = 30.0, 0.21


def coast(t: np.ndarray) -> Measured:
    angle = 1.0 + RATE / C * (1 - np.exp(-C * t))
    noise = 1e-3 * np.random.default_rng(4).standard_normal(len(t))
    return Measured(
        "coast", "train", t, {"q": np.mod(angle + noise, TURN)}, sigma={"q": 1e-3},
        periods={"q": TURN}, start={"q": None, "w": None},
    )  # fmt: skip


LOST = slice(200, 215)


@pytest.mark.parametrize(
    ("method", "lost"),
    [
        ("least_squares", slice(0)),
        ("least_squares", LOST),
        ("fminsearch", slice(0)),
        ("fminsearch", LOST),
        ("multiple_shooting", slice(0)),
    ],
)
def test_a_drag_is_found_behind_many_turns(method: str, lost: slice) -> None:
    """The run from the first values is behind by fourteen turns; and where samples are lost, nobody
    knows how many turns there were."""
    found = fit(
        compile(read_text(COAST, Path("coast.yaml"))),
        [coast(np.delete(np.linspace(0, 10, 501), lost))],
        method=method,
    )
    assert found.values["c"] == pytest.approx(C, rel=1e-3)
    one = found.comparisons[0]
    assert one.rmse_after < 1.2e-3
    assert one.after == pytest.approx(one.measured, abs=0.01), "on the same turns"


@given(st.integers(-5, 5), st.floats(-3.0, 3.0), st.floats(-20, 20))
def test_differences_modulo_a_period_follow_each_other(
    turns: int, first: float, slope: float
) -> None:
    off = turns * TURN + first + slope * np.linspace(0, 1, 60)
    assert wrap_to_period(np.mod(off, TURN), TURN) == pytest.approx(off - turns * TURN, abs=1e-9)


@given(st.integers(0, 59), st.floats(-20, 20))
def test_the_shortest_way_is_that_of_the_first_sample_that_counts(first: int, slope: float) -> None:
    """A criterion begins there; a table of errors that began earlier told turns that it had not."""
    off = slope * np.linspace(0, 1, 60)
    counted = off - TURN * np.round(off[first] / TURN)
    assert wrap_to_period(np.mod(off, TURN), TURN, first) == pytest.approx(counted, abs=1e-9)


def test_a_sample_that_is_not_finite_breaks_no_differences() -> None:
    off = np.array([0.1, np.nan, 0.2 + TURN, 0.3])
    assert wrap_to_period(off, TURN) == pytest.approx([0.1, np.nan, 0.2, 0.3], nan_ok=True)


@pytest.mark.parametrize(
    "step",
    [
        "resample: 0.01",
        "lowpass: {signals: q, cutoff: 10}",
        "outliers: q",
        "differentiate: {signal: q, to: w}",
    ],
)
def test_a_step_of_cleaning_goes_on_from_turn_to_turn(tmp_path: Path, step: str) -> None:
    """Between 359 and 1 degree there is 0, and no 180."""
    rng = np.random.default_rng(1)
    t = 0.01 * np.arange(1000) + rng.uniform(0, 1e-3, 1000) * (step[0] == "r")
    shown = np.mod(20 + 100 * t + 30 * np.sin(2 * t), 360)
    rows = "\n".join(f"{a:.6f},{b:.4f}" for a, b in zip(t, shown, strict=True))
    (tmp_path / "encoder.csv").write_text(f"t,q\n{rows}\n")
    text = f"""{COAST}measured:
  run:
    file: encoder.csv
    time: t
    signals: {{q: {{column: q, unit: deg, modulo: 360}}}}
    clean: [{{{step}}}]
    start: {{q: free, w: free}}
"""
    (series,) = load_measured(compile(read_text(text, tmp_path / "wheel.yaml")))
    assert len(series.t) > 990
    s = series.t
    true = np.radians(20 + 100 * s + 30 * np.sin(2 * s))
    assert wrap_to_period(series.values["q"] - true, TURN) == pytest.approx(0 * s, abs=0.02)
    if "w" in series.values:
        rate = np.radians(100 + 60 * np.cos(2 * s))
        assert series.values["w"] == pytest.approx(rate, abs=0.1)
