"""Paper B's analyses on the shipped diagram: orbits, the irregular band, Lyapunov exponents.

The full sweep of 800 frequencies and the spectrum over 4e4 s are benchmarks.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from tracewire.analyse import Plane, bifurcation, lyapunov, periodic_orbit, section
from tracewire.compile import Model, compile
from tracewire.diagram import read

PENDULUM = Path(__file__).parents[2] / "diagrams/papers/b_triple/pendulum.yaml"
ANGLES = ("psi1", "psi2", "psi3")
TURN = dict.fromkeys(ANGLES, 2 * math.pi)
ORBIT = (-0.055665312, 0.047142808, -0.049394203, 1.132779645, -0.519203789, 5.482316558)


@pytest.fixture(scope="module")
def model() -> Model:
    return compile(read(PENDULUM))


def test_the_orbit_at_three_fifths_of_a_hertz_is_the_known_one(model: Model) -> None:
    found = periodic_orbit(model, "1/f", begin="0.5/f", skip=20, parameters={"f": 0.6})
    assert found.x == pytest.approx(ORBIT, abs=1e-8)
    assert found.floquet.verdict == "stable"


@pytest.mark.parametrize("frequency", [0.3, 0.45, 0.5, 0.69, 0.81])
def test_the_answer_has_the_period_of_the_torque(model: Model, frequency: float) -> None:
    """At the other frequencies for which the paper or the full sweep sees a periodic motion."""
    found = periodic_orbit(
        model, "1/f", begin="0.5/f", skip=200, modulo=TURN, parameters={"f": frequency}
    )
    assert found.closure < 1e-9
    assert found.floquet.verdict == "stable"
    assert abs(np.prod(found.floquet.multipliers)) < 1  # friction takes volume away


def test_forty_frequencies_see_the_irregular_band(model: Model) -> None:
    """The paper: irregular for f in (0.700, 0.768) Hz; the step here is 0.0064 Hz."""
    f = np.linspace(0.6, 0.85, 40)
    found = bifurcation(
        model, "f", f, Plane(edge="torque"), direction="down", skip=200, keep=60, modulo=TURN
    )
    branch = found["down"]
    assert branch.errors == {}
    inside = (f > 0.703) & (f < 0.765)
    outside = ((f > 0.64) & (f < 0.697)) | (f > 0.773)
    assert branch.irregular[inside].all()
    assert not branch.irregular[outside].any()
    assert (branch.clusters[f > 0.78] == 1).all()


def test_at_0_73_hertz_the_section_is_irregular(model: Model) -> None:
    found = section(model, Plane(edge="torque"), preset="chaotic", skip=50, keep=100, modulo=TURN)
    assert found.irregular
    assert found.t[0] == pytest.approx(50.5 / 0.73)


@pytest.mark.slow
def test_three_exponents_are_positive_and_their_sum_is_the_divergence(model: Model) -> None:
    found = lyapunov(model, 2000.0, transient=500.0, preset="chaotic")
    assert found.positive == 3
    assert found.divergence is not None
    assert found.total == pytest.approx(found.divergence, rel=5e-3)
