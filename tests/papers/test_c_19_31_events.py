"""Paper C, C22, C23, C29, C30: the diagrams with events against independent solutions."""

from __future__ import annotations

from functools import cache
from math import atan2, cos, log, pi, sin, sqrt
from pathlib import Path

import numpy as np
import pytest
from oracles import c_common
from oracles.c_19_31_events import CASES
from oracles.piecewise import stick_slip
from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.solve import Run, simulate

REVIEW = Path(__file__).parents[2] / "diagrams/papers/c_review"
FILES = {
    "C22": "c22_step_length",
    "C23": "c23_harvester_flywheel",
    "C29": "c29_liquid_tank",
    "C30": "c30_solid_tank",
}


@cache
def model(system: str) -> Model:
    return compile(read(REVIEW / f"{FILES[system]}.yaml"))


@cache
def run(case: str) -> Run:
    return simulate(model(case[:3]), preset=case, rtol=1e-9)


@cache
def known(case: str) -> c_common.Path:
    return CASES[case][0](run(case).t)


def times(case: str, *kinds: str) -> list[float]:
    """When our run has events of these kinds."""
    return [event.time for event in run(case).events if event.kind in kinds]


def entries(case: str, mode: str, before: str = "") -> list[float]:
    """When the independent solution goes into a mode."""
    return [
        change.time
        for change in known(case).changes
        if change.after == mode and before in ("", change.before)
    ]


@pytest.mark.parametrize("case", CASES)
def test_every_state_is_that_of_the_independent_solution(case: str) -> None:
    ours, (_, states, end) = run(case), CASES[case]
    assert ours.t[-1] == end
    assert tuple(ours.final) == states
    assert ours.warnings == ()
    for name, values in zip(states, known(case).states, strict=True):
        assert np.max(np.abs(ours[name] - values)) < 1e-6 * np.max(np.abs(values)), name


@pytest.mark.parametrize("system", FILES)
def test_without_a_preset_a_diagram_is_its_first_case(system: str) -> None:
    first = next(case for case in CASES if case.startswith(system))
    assert simulate(model(system), rtol=1e-9).final == run(first).final


# --- C22


@pytest.mark.parametrize(("case", "keeps"), [("C22_l2w", True), ("C22_w", False)])
def test_a_jump_of_the_length_keeps_the_angular_momentum_or_the_rate(
    case: str, keeps: bool
) -> None:
    """At each n pi/Omega, and only there."""
    events = run(case).events
    assert [event.time for event in events] == pytest.approx(np.arange(1, 39) * pi / 6, abs=1e-12)
    lengths = (1.1, 0.9)
    for n, event in enumerate(events):
        before, after = event.before["phi_dot"], event.after["phi_dot"]
        old, new = lengths[n % 2], lengths[1 - n % 2]
        assert after == pytest.approx(before * (old / new) ** 2 if keeps else before, rel=1e-12)
        assert event.after["phi"] == event.before["phi"]


@pytest.mark.parametrize("case", ["C22_l2w", "C22_w"])
def test_only_the_kept_momentum_makes_the_hanging_position_unstable(case: str) -> None:
    """The trace over a period: two swings of small angle, and the two jumps between them."""
    ours = np.empty((2, 2))
    for column, start in enumerate(({"phi": 1e-5, "phi_dot": 0.0}, {"phi": 0.0, "phi_dot": 1e-5})):
        last = simulate(
            model("C22"), preset=case, start=start, span=(0.1, 0.1 + pi / 3), rtol=1e-11
        ).final
        ours[:, column] = np.array([last["phi"], last["phi_dot"]]) / 1e-5
    half, factor = pi / 6, (1.1 / 0.9) ** 2 if case == "C22_l2w" else 1.0
    (c1, s1, w1), (c2, s2, w2) = (
        (cos(w * half), sin(w * half), w) for w in (sqrt(9.81 / 1.1), sqrt(9.81 / 0.9))
    )
    exact = 2 * c1 * c2 - s1 * s2 * (factor * w1 / w2 + w2 / (factor * w1))
    assert np.trace(ours) == pytest.approx(exact, abs=1e-6)
    assert (abs(exact) > 2) == (case == "C22_l2w")


# --- C23


def test_the_printed_flywheel_stops_at_its_time_and_stays() -> None:
    ours = run("C23a")
    stop = 10 * log(1 + 0.002 * 10 / 0.05)
    assert times("C23a", "stick") == pytest.approx([stop], abs=1e-9)
    assert times("C23a", "slip") == []
    after = ours.t > stop
    assert set(ours["theta_dot"][after]) == {0.0}
    assert len(set(ours["theta"][after])) == 1
    assert ours["theta_dot"][~after] == pytest.approx(
        35 * np.exp(-ours.t[~after] / 10) - 25, abs=1e-8
    )


def test_the_clutch_engages_and_leaves_when_the_independent_solution_does() -> None:
    ours = run("C23b").events
    engaged = [e.time for e in ours if (e.kind, e.block) == ("stick", "clutch")]
    left = [e.time for e in ours if (e.kind, e.block) == ("slip", "clutch")]
    assert engaged == pytest.approx(entries("C23b", "engaged"), abs=1e-8)
    assert left == pytest.approx(entries("C23b", "free"), abs=1e-8)
    assert (len(engaged), len(left)) == (5, 5)
    # the pendulum drags the flywheel out of its rest at the first engagement, and it turns on
    assert [e.time for e in ours if e.block == "friction"] == engaged[:1]


def test_the_clutch_never_lets_the_pendulum_overtake() -> None:
    ours = run("C23b")
    assert np.max(ours["phi_dot"] - ours["theta_dot"]) < 1e-9
    assert np.min(ours["clutch"]) >= -1e-9
    held = ours["phi_dot"] > ours["theta_dot"] - 1e-10
    assert np.max(np.abs(ours["clutch"][~held])) == 0


# --- C29 and C30


@pytest.mark.parametrize(("case", "cycles"), [("C29", 3), ("C30", 3), ("C30k", 3)])
def test_the_tank_slips_and_sticks_when_the_independent_solution_does(
    case: str, cycles: int
) -> None:
    assert times(case, "slip") == pytest.approx(entries(case, "slip"), abs=1e-7)
    assert times(case, "stick") == pytest.approx(entries(case, "stick"), abs=1e-7)
    assert len(times(case, "slip")) == cycles
    kinds = [event.kind for event in run(case).events]
    assert kinds == ["slip", "stick"] * (len(kinds) // 2) + ["slip"] * (len(kinds) % 2)


@pytest.mark.parametrize("case", ["C29", "C30", "C30k"])
def test_while_it_sticks_the_tank_has_the_speed_of_the_belt(case: str) -> None:
    ours = run(case)
    slips, sticks = [*times(case, "slip"), np.inf], [0.0, *times(case, "stick")]
    for begin, end in zip(sticks, slips, strict=False):
        inside = (ours.t > begin) & (ours.t < end)
        assert ours["x_dot"][inside] == pytest.approx(0.2, abs=1e-14)
    for begin, end in zip(slips, [*sticks[1:], 10.0], strict=False):
        inside = (ours.t > begin + 0.1) & (ours.t < end - 0.1)
        assert np.all(ours["x_dot"][inside] < 0.2)


def test_the_limit_cycle_of_the_solid_tank_returns() -> None:
    """From the first slip on: it breaks away where the spring pulls with mus Mt g."""
    slips = times("C30", "slip")
    assert slips[0] == pytest.approx(0.4 * 10 * 9.81 / 100 / 0.2, abs=1e-10)
    assert np.diff(slips) == pytest.approx(slips[1] - slips[0], abs=1e-8)
    period = slips[1] - slips[0]
    ours, cycle = run("C30"), np.linspace(slips[0], slips[1], 50)
    again = simulate(model("C30"), preset="C30", times=cycle + period, rtol=1e-9)
    assert again["x"] == pytest.approx(
        simulate(model("C30"), preset="C30", times=cycle, rtol=1e-9)["x"], abs=1e-8
    )
    assert np.ptp(ours["x"]) > 0.4


def test_slipping_at_one_coefficient_is_the_closed_form() -> None:
    """C30k in the time and length of the piecewise solution: w = sqrt(10)/s, F/k."""
    w = sqrt(10)
    expected = stick_slip(0.2 / w, 0.2 * 98.1 / 100, 0.4 * 98.1 / 100, 3)
    found = zip(times("C30k", "slip"), times("C30k", "stick"), strict=True)
    assert np.array(list(found)) == pytest.approx(np.array(expected) / w, abs=1e-8)
    # the first slip in words: an arc about the steady slip, from stick to stick
    lasting = 2 * (pi - atan2(0.2 * 98.1 / 100 * w, 0.2)) / w
    assert times("C30k", "stick")[0] - times("C30k", "slip")[0] == pytest.approx(lasting, abs=1e-9)


def test_the_liquid_loads_and_unloads_the_belt() -> None:
    """N varies around Mt g, and the friction is never more than mus N."""
    ours = run("C29")
    assert ours["N"].min() < 0.95 * 98.1 < 1.05 * 98.1 < ours["N"].max()
    assert np.max(np.abs(ours["friction"]) / ours["N"]) < 0.4 + 1e-9


def test_without_sloshing_mass_the_liquid_tank_is_the_solid_one() -> None:
    solid = run("C30")
    light = simulate(model("C29"), parameters={"m1": 1e-9, "c1": 0.0}, rtol=1e-9)
    assert light["x"] == pytest.approx(solid["x"], abs=1e-6)


def test_without_friction_the_liquid_tank_keeps_its_energy() -> None:
    slippery = {"mus": 0.0, "mud": 0.0, "c1": 0.0}
    free = simulate(model("C29"), parameters=slippery, start={"x": 0.2}, rtol=1e-9)
    assert np.ptp(free["energy"]) < 1e-7 * np.ptp(free["kinetic"])
    assert np.ptp(run("C29")["energy"]) > 1
