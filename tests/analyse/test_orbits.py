"""Floquet multipliers, periodic orbits and stability charts against exact results."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from analyse.models import (
    DRY,
    DUFFING,
    IMPACTS,
    MATHIEU,
    MEISSNER,
    OSCILLATOR,
    PENDULUM,
    VAN_DER_POL,
    made,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import ellipk, mathieu_a, mathieu_b
from tracewire.analyse import floquet, periodic_orbit, stability_chart
from tracewire.analyse.drive import rising_edges
from tracewire.errors import AnalysisError, OptionError
from tracewire.solve import Passage

MATHIEU_MODEL, MEISSNER_MODEL = made(MATHIEU), made(MEISSNER)


@given(st.floats(0.5, 9), st.floats(0.0, 1), st.floats(0.5, 3))
@settings(max_examples=15, deadline=None)
def test_the_multipliers_of_an_oscillator(k: float, c: float, period: float) -> None:
    found = floquet(made(OSCILLATOR), period, parameters={"k": k, "c": c})
    exponents = np.roots([1, c, k])
    expected = np.exp(exponents * period)
    for multiplier in expected:
        assert np.abs(found.multipliers - multiplier).min() < 1e-6
    assert np.linalg.det(found.monodromy) == pytest.approx(math.exp(-c * period), rel=1e-8)
    largest = float(np.abs(expected).max())
    if abs(1 - largest - 1e-4) > 1e-5:  # within 1e-4 of the circle nothing is decided
        assert found.verdict == ("stable" if largest < 1 - 1e-4 else "neutral")


@given(st.floats(0.05, 1.6), st.floats(0.7, 6))
@settings(max_examples=25, deadline=None)
def test_the_trace_of_meissner_is_exact(r: float, omega: float) -> None:
    """Of two stretches of constant stiffness p^2 = 1 + r, s^2 = 1 - r over pi/omega each."""
    found = floquet(MEISSNER_MODEL, "2*pi/omega", parameters={"r": r, "omega": omega})
    half = math.pi / omega
    p, s = complex(1 + r) ** 0.5, complex(1 - r) ** 0.5
    both = 2 * np.cos(p * half) * np.cos(s * half)
    s = s if abs(s) > 1e-7 else 1e-7  # the limit at r = 1
    both -= (p / s + s / p) * np.sin(p * half) * np.sin(s * half)
    size = 1 + np.abs(found.monodromy).max()
    assert np.trace(found.monodromy) == pytest.approx(both.real, abs=1e-7 * size)
    assert np.linalg.det(found.monodromy) == pytest.approx(1.0, abs=1e-7 * size**2)


def test_the_verdicts_of_the_known_cases() -> None:
    for r, omega, verdict in ((0.5, 2.0, "unstable"), (0.2, 1.8, "neutral"), (1.5, 6.0, "neutral")):
        found = floquet(MEISSNER_MODEL, "2*pi/omega", parameters={"r": r, "omega": omega})
        assert found.verdict == verdict


def test_the_chart_of_mathieu_has_its_edges_at_the_characteristic_values() -> None:
    a, q = np.linspace(-0.6, 5, 113), np.array([0.3, 1.0])
    told: list[tuple[float, float]] = []
    chart = stability_chart(
        *(MATHIEU_MODEL, ("a", a), ("q", q), "pi"),
        progress=lambda part, left: told.append((part, left)),
    )
    assert chart.radius.shape == (2, 113)
    for row, value in enumerate(q):
        edges = [mathieu_a(n, value) for n in range(3)] + [mathieu_b(n, value) for n in (1, 2)]
        # between a_n and b_n+1 it is stable, below a_0 and between b_n and a_n it is not
        b1, a1, b2, a2 = edges[3], edges[1], edges[4], edges[2]
        stable = ((a > edges[0]) & (a < b1)) | ((a > a1) & (a < b2)) | (a > a2)
        near = np.min(np.abs(a[:, None] - np.array(edges)), axis=1) < 1e-3
        assert (chart.unstable[row] == ~stable)[~near].all()
        assert (chart.radius[row] > 1 - 1e-6).all()
    assert told[-1] == (1.0, 0.0)
    assert chart.errors == {}


def test_an_interrupted_chart_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tracewire.solve.progress.PAUSE.told_every", 0.0)  # each point is told
    file = tmp_path / "chart.npz"
    axes: Any = (("a", np.linspace(0, 3, 7)), ("q", np.linspace(0, 1, 5)))
    whole = stability_chart(MATHIEU_MODEL, *axes, "pi")
    count = 0

    class Stop(Exception):
        pass

    def stop(part: float, left: float) -> None:
        nonlocal count
        count += 1
        if part > 0.4:
            raise Stop

    with pytest.raises(Stop):
        stability_chart(MATHIEU_MODEL, *axes, "pi", partial=file, progress=stop, workers=1)
    with np.load(file) as kept:
        done = int(kept["done"].sum())
    assert 0 < done < 35
    parts: list[float] = []
    again = stability_chart(
        MATHIEU_MODEL, *axes, "pi", partial=file, progress=lambda p, left: parts.append(p)
    )
    assert parts[0] > done / 35  # what was done is not done again
    assert np.array_equal(again.radius, whole.radius)
    with pytest.raises(OptionError, match="partial file of another sweep: it differs in grid"):
        stability_chart(MATHIEU_MODEL, axes[1], axes[0], "pi", partial=file)
    with pytest.raises(OptionError, match="it differs in diagram"):
        stability_chart(made(MATHIEU.replace("cos", "sin")), *axes, "pi", partial=file)
    with pytest.raises(OptionError, match="it differs in options"):
        stability_chart(MATHIEU_MODEL, *axes, "2*pi", partial=file)


def test_a_file_that_is_no_partial_file_is_refused(tmp_path: Path) -> None:
    axes: Any = (("a", [1.0]), ("q", [0.0]))
    for content in (b"", b"abc", b"PK"):
        (tmp_path / "x.npz").write_bytes(content)
        with pytest.raises(OptionError, match="this is no partial file of a sweep"):
            stability_chart(MATHIEU_MODEL, *axes, "pi", partial=tmp_path / "x.npz")
    np.savez(tmp_path / "y.npz", t=np.zeros(3))
    with pytest.raises(OptionError, match="this is no partial file of a sweep"):
        stability_chart(MATHIEU_MODEL, *axes, "pi", partial=tmp_path / "y.npz")
    with pytest.raises(OptionError, match=r"cannot be called 'x.csv'. End its name in .npz"):
        stability_chart(MATHIEU_MODEL, *axes, "pi", partial=tmp_path / "x.csv")
    with pytest.raises(OptionError, match="there is no folder"):
        stability_chart(MATHIEU_MODEL, *axes, "pi", partial=tmp_path / "no" / "x.npz")


@pytest.mark.parametrize(
    ("x", "y", "options", "said"),
    [
        (("a", [1]), ("a", [1]), {}, "has one axis only"),
        (("b", [1]), ("q", [1]), {}, "unknown parameter or start 'b'"),
        (("a", []), ("q", [1]), {}, "the axis 'a' has no values"),
        (("a", [1, math.nan]), ("q", [1]), {}, "the axis 'a' has no values"),
        (("a", [1]), ("q", [1]), {"period": 0}, "a period of 0 s has no use"),
        (("a", [1]), ("q", [1]), {"period": "2*b"}, "unknown parameter 'b'"),
        (("a", [1]), ("q", [1]), {"workers": 0}, "0 workers cannot work"),
        (("a", np.zeros(2000)), ("q", np.zeros(2000)), {}, "a grid of 4000000 points is too large"),
    ],
)
def test_a_chart_refuses_what_does_not_fit(
    x: Any, y: Any, options: dict[str, Any], said: str
) -> None:
    with pytest.raises(OptionError, match=said):
        stability_chart(MATHIEU_MODEL, x, y, **{"period": "pi", **options})


def test_a_motion_that_does_not_close_has_no_multipliers() -> None:
    with pytest.raises(AnalysisError, match="the motion is not back at its start") as caught:
        floquet(made(PENDULUM), 1.0)
    assert "Find the periodic orbit first" in str(caught.value)
    at_rest = floquet(made(PENDULUM), 1.0, start={"phi": 0.0})
    assert at_rest.closure == 0.0
    assert np.abs(at_rest.multipliers) == pytest.approx([1, 1], abs=1e-6)


def test_the_forced_oscillator_answers_at_its_exact_amplitude() -> None:
    values = {"force": 0.7, "omega": 1.7, "c": 0.3}
    found = periodic_orbit(made(OSCILLATOR), "2*pi/omega", parameters=values)
    answer = 0.7 / (4 - 1.7**2 + 0.3j * 1.7)  # of exp(i omega t)
    assert found.x == pytest.approx([answer.real, -1.7 * answer.imag], abs=1e-8)
    assert found.motion[:, 0].max() == pytest.approx(abs(answer), rel=1e-4)
    assert found.steps <= 2
    assert found.floquet.verdict == "stable"


def test_the_limit_cycle_of_van_der_pol() -> None:
    """Its period at mu = 1 is 6.66328686, its multipliers are 1 and exp(integral of 1 - x^2)."""
    found = periodic_orbit(made(VAN_DER_POL), 6.0, skip=2)
    assert found.period == pytest.approx(6.663286859, abs=1e-7)
    assert found.motion[:, 0].max() == pytest.approx(2.00861986, abs=2e-4)
    integral = np.trapezoid(1 - found.motion[:, 0] ** 2, found.t)
    assert found.floquet.multipliers == pytest.approx([1, math.exp(integral)], abs=1e-5)
    assert found.floquet.radius == pytest.approx(math.exp(integral), abs=1e-5)
    assert found.floquet.verdict == "stable"


def test_a_pendulum_swings_with_the_period_of_the_elliptic_integral() -> None:
    """Of a family of orbits, one through each amplitude, the nearest one is found."""
    found = periodic_orbit(made(PENDULUM), 2.0, guess={"phi": 1.2})
    amplitude = np.abs(found.motion[:, 0]).max()
    exact = 4 / math.sqrt(9.81) * ellipk(math.sin(amplitude / 2) ** 2)
    assert found.period == pytest.approx(exact, rel=1e-5)
    assert found.floquet.multipliers == pytest.approx([1, 1], abs=1e-3)


def test_a_pendulum_that_turns_closes_up_to_a_turn() -> None:
    found = periodic_orbit(
        made(PENDULUM), 0.7, guess={"phi": 0.0, "w": 9.0}, modulo={"phi": 2 * math.pi}
    )
    assert found.motion[-1, 0] - found.x[0] == pytest.approx(2 * math.pi, abs=1e-6)
    with pytest.raises(OptionError, match="unknown state 'psi'"):
        periodic_orbit(made(PENDULUM), 1.0, modulo={"psi": 1.0})
    with pytest.raises(OptionError, match="'phi' modulo 0 has no use"):
        periodic_orbit(made(PENDULUM), 1.0, modulo={"phi": 0.0})


@given(st.floats(0.3, 0.95), st.floats(0.5, 2))
@settings(max_examples=10, deadline=None)
def test_an_impact_multiplies_by_its_restitution(restitution: float, height: float) -> None:
    """A spring throws the ball at a wall, half a swing of pi/sqrt(k) = pi/2 lies between impacts.

    The swing turns a deviation by pi, and the impact turns it back: restitution is what is left.
    """
    passage = Passage(
        made(IMPACTS),
        length=math.pi / 2,
        start={"x": height},
        parameters={"restitution": restitution},
        tangents=True,
    )
    passage.go_to(math.pi / 2)
    assert passage.kinds == {"reset"} or passage.kinds == {"impact"}
    assert passage.x == pytest.approx([restitution * height, 0], abs=1e-7)
    assert passage.tangents == pytest.approx(restitution * np.eye(2), abs=1e-6)


def test_a_motion_that_sticks_has_a_multiplier_of_zero() -> None:
    found = floquet(made(DRY), 1.0)
    assert sorted(np.abs(found.multipliers)) == pytest.approx([0, 1])
    assert found.exponents[-1] == -np.inf


def test_a_steady_state_is_no_orbit() -> None:
    with pytest.raises(AnalysisError, match="ended at a steady state, which is no orbit"):
        periodic_orbit(made(VAN_DER_POL.replace("(1 - x*x)", "(-1 + x*x)")), 6.0, skip=1,
                       guess={"x": 0.1})  # fmt: skip


def test_where_newton_does_not_end_it_says_what_is_left() -> None:
    runaway = made("span: [0, 1]\nblocks:\n  x: {type: integrator, of: r, start: 1}\n"
                   "  r: {type: expression, formula: 1 + 0.1*sin(t)}\n")  # fmt: skip
    with pytest.raises(AnalysisError, match=r"no periodic orbit was found: after .* steps"):
        periodic_orbit(runaway, "2*pi")
    with pytest.raises(OptionError, match="-1 periods cannot be skipped"):
        periodic_orbit(runaway, "2*pi", skip=-1)


def test_an_unstable_orbit_of_duffing_is_found_too() -> None:
    """Around the saddle at zero, which no simulation shows."""
    answer = 0.1 / (-1 - 1.2**2 + 0.3j * 1.2)  # of the linear saddle
    near = {"x": answer.real, "v": -1.2 * answer.imag}
    found = periodic_orbit(made(DUFFING), "2*pi/omega", guess=near, parameters={"f": 0.1})
    assert found.x == pytest.approx(list(near.values()), abs=1e-3)
    assert found.floquet.verdict == "unstable"


def test_the_rising_edges_of_a_square_wave() -> None:
    text = MEISSNER.replace("frequency: omega/(2*pi)", "frequency: omega/(2*pi), phase: PHASE")
    for phase, first in (("0", 0.0), ("pi", math.pi), ("pi/2", 1.5 * math.pi)):
        edge, period = rising_edges(made(text.replace("PHASE", phase)), "wave", {"omega": 1})
        assert period == pytest.approx(2 * math.pi)
        assert edge % period == pytest.approx(first, abs=1e-9)
    with pytest.raises(OptionError, match="'a' is no source that jumps at known times"):
        rising_edges(MEISSNER_MODEL, "a", {})
    with pytest.raises(OptionError, match="unknown signal 'wav'"):
        rising_edges(MEISSNER_MODEL, "wav", {})
    with pytest.raises(OptionError, match="'wave' does not rise periodically"):
        rising_edges(MEISSNER_MODEL, "wave", {"r": 0.0})


def test_a_chart_of_points_that_all_fail_says_why() -> None:
    with pytest.raises(AnalysisError, match="not back at its start"):
        stability_chart(made(DUFFING), ("f", [0.1, 0.2]), ("c", [0.1]), "2*pi/omega")


def test_a_source_inside_of_a_subsystem_has_edges_too() -> None:
    model = made("""
span: [0, 1]
blocks:
  motor: {type: drive}
  x: {type: integrator, of: motor.torque}
subsystems:
  drive:
    inputs: []
    outputs: {torque: wave}
    blocks:
      wave: {type: square, amplitude: 2, frequency: 4}
""")
    for name in ("motor.torque", "motor.wave"):
        edge, period = rising_edges(model, name, {})
        assert (edge, period) == pytest.approx((0.0, 0.25))
