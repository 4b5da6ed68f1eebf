"""The smooth functions of which a missing torque is made."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tracewire.trace.candidates.places import Place
from tracewire.trace.candidates.signal_scales import Trajectory
from tracewire.trace.missing.bases import apply_stop, bases_of, drive_phase, low_pass
from tracewire.trace.options import TraceOptions

OPTIONS = TraceOptions()

T = np.arange(0.0, 8.0, 0.01)
Q = 0.3 * np.sin(4 * T) + 0.1 * np.sin(9 * T)
V = np.gradient(Q, T)
PLACE = Place("torque", "sum", "torque", "q", "v", "a", (("q2", "v2"),), ("u",))


def runs(count: int = 2) -> list[Trajectory]:
    signals = {"q": Q, "v": V, "a": np.gradient(V, T), "u": np.sin(3 * T), "q2": Q**2, "v2": V * Q}
    return [Trajectory(T, {name: (n + 1) * x for name, x in signals.items()}) for n in range(count)]


def test_all_variables_of_a_place_are_tried() -> None:
    found = {basis.variables for basis in bases_of(PLACE, runs(), OPTIONS.map)}
    assert found == {
        ("q",),
        ("v",),
        ("q", "v"),
        ("a",),
        ("t",),
        ("history",),
        ("u",),
        ("q", "u"),
        ("v", "u"),
        ("drive phase",),
        ("other_q",),
        ("other_v",),
        ("q", "other_q"),
        ("v", "other_v"),
    }


def test_drives_and_bodies_are_told_apart_where_there_are_several() -> None:
    signals = {**runs(1)[0].signals, "w": np.cos(T), "q3": Q, "v3": V}
    place = Place("torque", "sum", "torque", "q", "v", "", (("q2", "v2"), ("q3", "v3")), ("u", "w"))
    found = {basis.variables for basis in bases_of(place, [Trajectory(T, signals)], OPTIONS.map)}
    assert {("u of u",), ("u of w",), ("other_q of v2",), ("other_q of v3",)} <= found


def test_bumps_sum_to_one_on_and_off_the_data() -> None:
    for basis in bases_of(PLACE, runs(), OPTIONS.map):
        if basis.axes and basis.variables != ("t",):
            assert all(np.allclose(c.sum(axis=1), 1.0) for c in basis.columns), basis.variables
            far = [np.array([-100.0, 0.0, 100.0]) for _ in basis.axes]
            assert np.allclose(basis.at(*far).sum(axis=1), 1.0)


def test_a_fast_ripple_needs_the_fine_functions_of_q() -> None:
    left = []
    for basis in bases_of(PLACE, runs(1), OPTIONS.map):
        if basis.variables == ("q",):
            ripple = np.sin(40 * Q)
            values, *_ = np.linalg.lstsq(basis.columns[0], ripple, rcond=1e-8)
            left.append(float(np.std(ripple - basis.columns[0] @ values)))
    assert left[0] > 0.1 > 0.02 > left[1]


def test_a_constant_signal_has_no_functions() -> None:
    signals = {"q": Q, "v": V, "u": np.ones(len(T))}
    place = Place("torque", "sum", "torque", "q", "v", "", (), ("u",))
    found = {basis.variables for basis in bases_of(place, [Trajectory(T, signals)], OPTIONS.map)}
    assert ("u",) not in found
    assert ("drive phase",) not in found


@pytest.mark.parametrize("omega", [0.9, 3.0, 11.3])
def test_the_phase_of_a_sine(omega: float) -> None:
    phase = drive_phase(T, 2.0 + 0.7 * np.sin(omega * T + 0.8), OPTIONS.map.tonal)
    assert phase is not None
    assert np.allclose(np.sin(phase), np.sin(omega * T + 0.8), atol=0.02)


def test_a_drive_that_is_no_sine_has_no_phase() -> None:
    assert (
        drive_phase(T, np.random.default_rng(1).standard_normal(len(T)), OPTIONS.map.tonal) is None
    )
    assert drive_phase(T, np.zeros(len(T)), OPTIONS.map.tonal) is None


def test_a_low_pass_answers_a_step_exponentially() -> None:
    step = np.where(T > 1.0, 1.0, 0.0)
    expected = np.where(T > 1.0, 1 - np.exp(-(T - 1.0) / 0.25), 0.0)
    assert np.allclose(low_pass(T, step, 0.25), expected, atol=0.04)


@given(st.lists(st.floats(-5, 5), min_size=2, max_size=50), st.floats(0.01, 3))
def test_a_stop_holds_no_more_than_its_width_and_follows_inside(
    q: list[float], width: float
) -> None:
    held = apply_stop(np.array(q), width)
    assert np.all(np.abs(held) <= width)
    steps, own = np.diff(q), np.diff(held)
    inside = np.abs(held[1:]) < width
    assert np.allclose(own[inside], steps[inside], atol=1e-9)
