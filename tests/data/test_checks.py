"""Remarks on a record: each tells what was put there, and clean signals get none."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tracewire.data import signal_remarks, time_remarks

patient = settings(deadline=None)  # the first run may load scipy
T = np.arange(2000) * 0.01
RNG = np.random.default_rng(4)
WAVE = np.sin(3 * T) * np.exp(-0.05 * T) + 0.001 * RNG.standard_normal(len(T))


def test_equal_steps_need_no_remark() -> None:
    assert time_remarks(T) == []
    assert time_remarks(np.round(np.arange(100) / 15, 6)) == []
    assert time_remarks(1.7e9 + np.arange(100) * 1e-4) == [], "the last digit is not a jitter"
    assert time_remarks(np.array([0.0, 1.0])) == []


def test_unequal_steps_are_told() -> None:
    t = T.copy()
    t[100:] += 0.005
    assert time_remarks(t) == [
        "the time step is not regular: 0.01 to 0.015 s, median 0.01 s; 1 of 1999 are more than "
        "1% off; each sample counts at its own time"
    ]


def test_gaps_are_told_with_their_places() -> None:
    assert time_remarks(np.delete(T, np.s_[500:600])) == [
        "a gap in the time, where the step is 0.01 s: 1.01 s after t = 4.99 s"
    ]
    t = np.delete(T, [100, 101, 102, 300, 301, 302, 500, 501, 502, 700, 701, 702])
    assert time_remarks(t) == [
        "4 gaps in the time, where the step is 0.01 s: 0.04 s after t = 0.99 s, 0.04 s after "
        "t = 2.99 s, 0.04 s after t = 4.99 s and 1 more"
    ]


def test_times_are_told_so_that_they_differ() -> None:
    """Of a time of day in s, and of a long record with fine steps."""
    t = np.delete(1700012.345 + T, np.s_[500:600])
    assert time_remarks(t) == [
        "a gap in the time, where the step is 0.01 s: 1.01 s after t = 4.99 s (t counts from "
        "the first sample)"
    ]
    long = np.delete(np.arange(2_000_000) * 1e-3, [1_234_567, 1_234_568, 1_234_569])
    assert time_remarks(long)[0].endswith("0.004 s after t = 1234.566 s")
    spiked = WAVE.copy()
    spiked[500] = 50.0
    assert "at t = 5 s (t counts from the first sample)" in signal_remarks("y", 2e6 + T, spiked)[0]


@pytest.mark.parametrize(
    "y",
    [
        WAVE,
        np.sin(3 * T),
        np.sign(np.sin(3 * T)),
        np.where(np.arange(len(T)) % 20 < 10, 1.0, -1.0),
        np.round(WAVE, 3),
        T,
        np.where(T < 3, 0.0, T - 3),
        np.abs(np.mod(T, 4) - 2),
        np.exp(-T),
        np.cumsum(RNG.standard_normal(len(T))),
    ],
    ids=["swing", "sine", "square", "clock", "fine", "ramp", "rest", "triangle", "decay", "walk"],
)
def test_signals_that_are_in_order(y: np.ndarray) -> None:
    assert signal_remarks("y", T, y) == []


def test_a_constant() -> None:
    assert signal_remarks("y", T, np.full(len(T), 0.5), "rad") == [
        "y is constant: 0.5 rad in every sample"
    ]


def test_a_clipped_signal() -> None:
    noisy = np.sin(3 * T) + 0.01 * RNG.standard_normal(len(T))
    (told,) = signal_remarks("y", T, np.minimum(noisy, 0.8), "V")
    assert told.startswith("y stays at exactly its largest value, 0.8 V, in 1")
    assert told.endswith("samples: is the sensor at the end of its range?")
    low, high = signal_remarks("y", T, np.clip(noisy, -0.7, 0.8))[::-1]
    assert "its smallest value, -0.7, in" in low and "its largest value" in high
    assert signal_remarks("u", T, np.clip(noisy, -0.7, 0.8), exact=True) == [], "a command"


@patient
@given(k=st.integers(2, 20), seed=st.integers(0, 100))
def test_a_signal_from_a_lower_rate(k: int, seed: int) -> None:
    t = np.arange(4000) * 0.001
    rough = np.random.default_rng(seed).standard_normal(len(t)) + np.sin(t)
    between = np.interp(t, t[::k], rough[::k])[: 4000 - k]  # behind the last point it is held
    (lines,) = signal_remarks("y", t[: 4000 - k], between)
    assert f"y lies on straight lines between samples {k} apart" in lines
    assert lines.endswith(f"it was taken at {1000 / k:.4g} Hz")
    held = np.repeat(rough[::k], k)[:4000]
    (told,) = signal_remarks("y", t, held)
    assert f"y changes only every {k} samples: it was taken at {1000 / k:.4g} Hz" in told
    assert signal_remarks("u", t, held, exact=True) == [], "set points of a command"


def test_samples_far_from_all_others() -> None:
    """A hammer's blow, of several samples, is none."""
    y = np.sin(3 * T) + 0.01 * RNG.standard_normal(len(T))
    y[70] = 1e6
    (told,) = signal_remarks("y", T, y, "rad")
    assert told.startswith(
        f"y has samples far from all others, each alone: 1e+06 rad at t = {T[70]:.6g}"
    )
    assert told.endswith("leave them out by clean: [outliers: y]")
    assert signal_remarks("y", T, y, exact=True) == []
    blow = 0.01 * RNG.standard_normal(len(T))
    blow[70:74] = [40, 90, 60, 20]
    assert signal_remarks("y", T, blow) == []


def test_a_coarse_reading() -> None:
    step = 2 * math.pi / 100
    (told,) = signal_remarks("y", T, np.round(np.sin(3 * T) / step) * step, "rad")
    assert told == (
        "y is read in steps of 0.0628 rad (32 over its range): the rounding alone has a standard "
        "deviation of 0.0181 rad"
    )
    coarse = np.round(np.sin(3 * T) / step) * step
    assert signal_remarks("y", T, coarse, "rad", noise=0.02) == []
    assert signal_remarks("y", T, coarse, "rad", noise=0.01) == [told]


def test_a_command_in_steps_is_not_rounded() -> None:
    command = np.round(np.sin(3 * T), 1)
    assert "is read in steps of 0.1" in signal_remarks("F", T, command)[0]
    assert signal_remarks("F", T, command, exact=True) == []
