"""The period of a motion: passages of the mean, turns, moves of what sticks and slips."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from oracles.oscillator import DIAGRAM
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Measured, Section
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.period import passing_period, period_of, time_between_moves

Vector = NDArray[np.float64]
OPTIONS = TraceOptions()
COUNT = 2000
T = np.linspace(0.0, 20.0, COUNT)


def stairs(count: int = COUNT, every: float = 1.0, slip: float = 0.15) -> Vector:
    """What rests and moves on by 1 in turns, as a slider behind a spring that is pulled along."""
    phase = T[:count] / every
    return np.asarray(np.floor(phase) + np.clip((phase % 1.0) / slip, 0.0, 1.0))


def between_moves(y: Vector) -> float:
    return time_between_moves(y, OPTIONS.period)


@pytest.mark.parametrize("noise", [0.0, 0.002, 0.01])
def test_the_moves_of_what_sticks_and_slips_are_counted(noise: float) -> None:
    y = stairs() / 20 + noise * np.random.default_rng(1).normal(size=COUNT)
    assert between_moves(y) == pytest.approx(100, rel=OPTIONS.period.moves_alike)


@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.002, 0.01, 0.05, 1.0]))
def test_noise_on_a_smooth_course_makes_no_moves(seed: int, noise: float) -> None:
    disturbance = noise * np.random.default_rng(seed).normal(size=COUNT)
    for course in (np.exp(-T / 5), (T / 20) ** 2, T / 20):
        assert between_moves(course + disturbance) == math.inf


def test_a_random_path_has_no_moves() -> None:
    steps = np.random.default_rng(2).normal(size=COUNT)
    assert between_moves(np.cumsum(steps)) == math.inf
    assert between_moves(np.cumsum(np.cumsum(steps))) == math.inf


@pytest.mark.parametrize("count", [1, 2, 8, 40])
def test_few_samples_have_no_moves(count: int) -> None:
    assert between_moves(stairs(count)) == math.inf


@given(st.floats(1e-6, 1e6), st.floats(-1e3, 1e3))
def test_moves_do_not_depend_on_units(size: float, zero: float) -> None:
    assert between_moves(size * (stairs() + zero)) == pytest.approx(between_moves(stairs()))


def periods(y: Vector, signal: str = "x", diagram: str = DIAGRAM) -> tuple[float, float]:
    """Of a signal of the oscillator: by passages, and the dominant one."""
    model = compile(read_text(diagram))
    section = Section(Measured("run", "train", T[: len(y)], {signal: y}), 0, len(y))
    return passing_period(model, signal, section, OPTIONS), period_of(model, section, OPTIONS)


def test_the_moves_of_a_body_are_its_period() -> None:
    assert periods(stairs()) == pytest.approx((100, 100), rel=0.06)
    back = np.concatenate((stairs(1000), stairs(1000)[::-1]))
    assert periods(back)[0] == pytest.approx(100, rel=0.06)


def test_moves_without_a_spring_are_no_period() -> None:
    """A motor that pulses drive on and on: its runs lose no phase."""
    free = DIAGRAM.replace("{type: gain, of: x, k: -k}", "{type: gain, of: v, k: -k}")
    assert free != DIAGRAM
    assert periods(stairs(), diagram=free)[0] == math.inf


def test_a_level_that_rises_in_steps_has_no_period() -> None:
    assert periods(stairs(), "v")[0] == math.inf, "a rate is no place"


def test_a_swing_has_the_period_of_its_passages() -> None:
    swing = np.cos(2 * np.pi * T / 1.0)
    assert periods(swing) == pytest.approx((100, 100), rel=0.06)
    few = np.cos(2 * np.pi * T / 8.0)
    assert periods(few)[0] == pytest.approx(800, rel=0.06), "not the time between its moves"
