"""Paper A: the stages S1 to S5 of its identification, each against an independent solution."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from oracles import a_stages, double_torsion
from oracles.double_torsion import Solution
from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.solve import Run, simulate

FOLDER = Path(__file__).parents[2] / "diagrams/papers/a_torsion"
FILES = {
    "S1": "s1_symmetric.yaml",
    "S2": "s2_sided_contact.yaml",
    "S3": "s3_sided_column.yaml",
    "S4": "pendulum.yaml",
    "S5": "s5_restitution.yaml",
}
PIN = ("S1", "S2", "S3", "S4")
STATES = ("phi1", "phi1_dot", "phi2", "phi2_dot")
ANGLES = 1e-6
TIMES = 1e-6
SHORT = (0.0, 1.6)  # s, about a period of the drive


@cache
def model(stage: str, record: tuple[str, ...] = ()) -> Model:
    return compile(read(FOLDER / FILES[stage]), record=record)


def agree(run: Run, exact: Solution) -> None:
    """The angles at every sample, and the times of contacts and of sticking."""
    assert np.max(np.abs(run["phi1"] - exact.states[0])) < ANGLES
    assert np.max(np.abs(run["phi2"] - exact.states[2])) < ANGLES
    assert np.max(np.abs(run["phi1_dot"] - exact.states[1])) < 1e-5 * np.max(exact.states[1])
    column = [e.time for e in exact.events if e.kind.startswith("column contact")]
    guards = ("phi1 - pin.limit", "phi1 - -pin.limit", "phi1 - phi1_s", "phi1 + phi1_s")
    ours = [
        event.time
        for event in run.events
        if event.guard in guards and event.kind in ("crossing", "reset")
    ]
    assert len(column) > 1
    assert ours == pytest.approx(column, abs=TIMES)
    disk = [e.time for e in exact.events if e.kind.startswith("disk contact")]
    guards = ("phi2 - springs.limit", "phi2 - -springs.limit")
    ours = [event.time for event in run.events if event.guard in guards]
    assert ours == pytest.approx(disk, abs=TIMES)
    held = [
        e.time for e in exact.events if e.kind.startswith("stick") or e.kind in ("rest", "release")
    ]
    ours = [event.time for event in run.events if event.kind in ("stick", "slip", "rest")]
    assert ours == pytest.approx(held, abs=TIMES)


def test_the_oracle_of_the_stages_is_that_of_the_final_model_where_they_meet() -> None:
    times = np.arange(201) / 100
    one, other = a_stages.solve("S4", times), double_torsion.solve(times=times)
    assert np.max(np.abs(one.states - other.states)) < 1e-6
    assert [e.time for e in one.events] == pytest.approx([e.time for e in other.events], abs=1e-9)


@pytest.mark.parametrize("stage", FILES)
def test_every_stage_is_that_of_the_independent_solution(stage: str) -> None:
    run = simulate(model(stage), rtol=1e-9)
    assert run.t[-1] == 4.0
    agree(run, a_stages.solve(stage, run.t))


@pytest.mark.parametrize("stage", FILES)
def test_every_stage_as_printed(stage: str) -> None:
    run = simulate(model(stage), preset="as_printed", rtol=1e-9, span=SHORT)
    agree(run, a_stages.solve(stage, run.t, as_printed=True))


@pytest.mark.parametrize("stage", FILES)
def test_every_stage_with_barriers_that_never_pull(stage: str) -> None:
    run = simulate(model(stage), preset="not_adhesive", rtol=1e-9, span=SHORT)
    agree(run, a_stages.solve(stage, run.t, adhesive=False))


@pytest.mark.parametrize("stage", PIN)
def test_every_stage_with_the_soft_pin_of_a_lesson(stage: str) -> None:
    run = simulate(model(stage), preset="teaching", rtol=1e-9, span=SHORT)
    agree(run, a_stages.solve(stage, run.t, {"c1": 1.2}))
    if stage == "S4":
        assert all(event.kind != "stick" for event in run.events)


@pytest.mark.parametrize("stage", FILES)
def test_the_default_is_the_consistent_preset(stage: str) -> None:
    plain = simulate(model(stage), span=(0, 1))
    named = simulate(model(stage), preset="consistent", span=(0, 1))
    assert np.array_equal(plain["phi2"], named["phi2"])


@pytest.mark.parametrize("stage", PIN)
def test_only_an_adhesive_barrier_pulls(stage: str) -> None:
    """R = k d + c v acts against d; where it has the other sign it pulls the body back."""
    ours = model(stage, ("phi1", "phi2", "pin.torque", "springs.torque"))
    pulls = {}
    for preset in ("consistent", "not_adhesive"):
        run = simulate(ours, preset=preset, rtol=1e-9)
        pulls[preset] = [
            float(np.min(run[torque] * np.sign(run[angle])))
            for torque, angle in (("pin.torque", "phi1"), ("springs.torque", "phi2"))
        ]
    assert min(pulls["consistent"]) < -1e-4
    assert min(pulls["not_adhesive"]) >= 0.0


OFF = {
    **dict.fromkeys(("kappa1", "kappa2", "kappa1_l", "kappa1_r", "kappa2_l", "kappa2_r"), 0.0),
    **dict.fromkeys(("T_v1", "T_v1_l", "T_v1_r", "T_s1", "mu", "k1", "c1"), 0.0),
}


@pytest.mark.parametrize("stage", FILES)
def test_without_torque_on_the_column_momentum_is_kept(stage: str) -> None:
    """Erratum (i): with f_s = M_L = R1 = 0, (B1 + B2) v1 + B2 v2 is constant for nT = 1 only."""
    ours = model(stage)
    off = {name: 0.0 for name in OFF if name in ours.parameters}
    start = {"phi1": 0.0, "phi1_dot": 0.5, "phi2_dot": -2.0}
    drift = {}
    for nT in (1.0, 2.0):
        given = off | {"nT": nT}
        times = np.arange(301) / 1000
        run = simulate(ours, parameters=given, start=start, times=times, rtol=1e-10)
        momentum = (0.00135 + 0.0003) * run["phi1_dot"] + 0.0003 * run["phi2_dot"]
        assert np.ptp(run["phi2_dot"]) > 0.1
        drift[nT] = np.max(np.abs(momentum - momentum[0])) / abs(momentum[0])
    assert drift[1.0] < 1e-9
    assert drift[2.0] > 1e-2


@pytest.mark.parametrize(("stage", "mirrored"), [("S1", True), ("S2", False), ("S3", False)])
def test_only_the_first_model_moves_alike_to_either_side(stage: str, mirrored: bool) -> None:
    """Half a period later, everything is turned round; the measured motion is not so."""
    period = 2 * np.pi / 3.9
    times = np.concatenate([[0.0], 8 * period + np.arange(100) * period / 100])
    phi2 = simulate(model(stage), times=times)["phi2"][1:]
    now, later = phi2[:50], phi2[50:]
    apart = np.max(np.abs(now + later)) / np.max(np.abs(now))
    assert (apart < 1e-2) == mirrored


@pytest.mark.parametrize("stage", PIN)
def test_the_column_dwells_on_its_pin_and_the_disk_goes_beyond_its_springs(stage: str) -> None:
    run = simulate(model(stage))
    dwells = np.abs(np.degrees(np.abs(run["phi1"])) - 13.6) < 0.2
    assert 0.3 < np.mean(dwells) < 0.8
    assert 1.1 < np.degrees(np.max(np.abs(run["phi2"]))) < 5.0


def test_a_column_that_bounces_never_sticks_and_dwells_less() -> None:
    run, real = simulate(model("S5")), simulate(model("S4"))
    assert {event.kind for event in run.events} == {"crossing", "reset"}

    def dwelling(run: Run) -> float:
        return float(np.mean(np.abs(np.degrees(np.abs(run["phi1"])) - 13.6) < 0.2))

    assert dwelling(run) < dwelling(real) / 2


@pytest.mark.parametrize("preset", ["consistent", "printed_reset"])
def test_only_the_consistent_impact_leaves_the_disk_alone(preset: str) -> None:
    """Erratum (vi): phi2 is relative, so that its rate jumps where that of the column does."""
    run = simulate(model("S5"), preset=preset, rtol=1e-9)
    impacts = [event for event in run.events if event.kind == "reset"]
    assert len(impacts) > 5
    for event in impacts:
        before, after = event.before, event.after
        assert after["phi1_dot"] == pytest.approx(-0.5 * before["phi1_dot"])
        jump = sum(after[name] - before[name] for name in ("phi1_dot", "phi2_dot"))
        lost = 0.0 if preset == "consistent" else -1.5 * before["phi1_dot"]
        assert jump == pytest.approx(lost, abs=1e-12)
    exact = a_stages.solve("S5", run.t, {"consistent": float(preset == "consistent")})
    agree(run, exact)


def test_the_literal_fifth_stage_is_the_printed_one() -> None:
    one = simulate(model("S5"), preset="literal")
    other = simulate(model("S5"), preset="as_printed")
    assert np.array_equal(one["phi1"], other["phi1"])


def test_a_softer_bounce_ends_at_rest_until_the_spring_overcomes_the_friction() -> None:
    run = simulate(model("S5"), parameters={"c_r": 0.1}, rtol=1e-9)
    exact = a_stages.solve("S5", run.t, {"c_r": 0.1})
    for row, name in enumerate(("phi1", "phi1_dot", "phi2", "phi2_dot")):
        assert np.max(np.abs(run[name] - exact.states[row])) < 1e-6
    rests = [e.time for e in exact.events if e.kind in ("rest", "release")]
    times = [event.time for event in run.events if event.kind in ("rest", "slip")]
    # friction and contact may let go one after the other, within nanoseconds
    ours = [t for before, t in pairwise([-1.0, *times]) if t - before > TIMES]
    assert len(rests) == 9
    assert ours == pytest.approx(rests, abs=TIMES)
