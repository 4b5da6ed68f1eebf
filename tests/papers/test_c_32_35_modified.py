"""Paper C: the Modified SAM (C34) with its barrier and its rope, and as it is printed (C35)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from oracles import c_32_35 as oracle
from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.solve import Event, Run, simulate

FOLDER = Path(__file__).parents[2] / "diagrams/papers/c_review"
STATES = ("l1", "l1_dot", "l2", "l2_dot", "phi1", "phi1_dot", "phi2", "phi2_dot")
# the case: its machine, l1 at the start, its end, the part of the largest value that is allowed
FREE = {
    "C34a": (oracle.Modified(k=400), 2.0, 10.0, 2e-4),
    "C34b": (oracle.Modified(k=100), 3.0, 8.0, 1e-6),
    "C34c": (oracle.Modified(k=100, c=5), 2.0, 3.0, 1e-6),
}
PRINTED = {
    "C35a": (oracle.Modified(k=100, inertia=0), 3.0, 10.0, 1e-5),
    "C35b": (oracle.Modified(k=100, c=5, inertia=0), 2.0, 0.5, 1e-6),
}
DAMPED = oracle.Modified(k=100, c=5)


@pytest.fixture(scope="module")
def corrected() -> Model:
    return compile(read(FOLDER / "c34_modified_atwood_machine.yaml"))


@pytest.fixture(scope="module")
def as_printed() -> Model:
    return compile(read(FOLDER / "c35_modified_atwood_machine_as_printed.yaml"))


def agree(run: Run, states: np.ndarray, part: float = 1e-6) -> None:
    """Each state within `part` of its largest value."""
    for name, exact in zip(STATES, states, strict=True):
        assert np.max(np.abs(run[name] - exact)) < part * np.max(np.abs(exact)), name


def drift(signal: np.ndarray) -> float:
    return float(np.max(np.abs(signal - signal[0])))


def resets(run: Run, block: str) -> list[Event]:
    return [event for event in run.events if event.block == block and event.kind == "reset"]


@pytest.mark.parametrize("case", FREE)
def test_every_case_is_that_of_the_independent_solution(corrected: Model, case: str) -> None:
    machine, l1_0, end, part = FREE[case]
    run = simulate(corrected, preset=case, rtol=1e-9)
    assert run.t[-1] == end
    agree(run, oracle.modified(machine, l1_0, run.t), part)
    assert not resets(run, "events[0]"), "l1 never comes to zero"


@pytest.mark.parametrize("case", PRINTED)
def test_every_case_as_printed_is_that_of_the_independent_solution(
    as_printed: Model, case: str
) -> None:
    machine, l1_0, end, part = PRINTED[case]
    run = simulate(as_printed, preset=case, rtol=1e-9)
    assert run.t[-1] == end
    agree(run, oracle.modified(machine, l1_0, run.t), part)


def test_the_printed_terms_are_the_short_lines_without_inertia() -> None:
    """Eqs 77 to 80: all terms with g m2 cancel, and N is M g."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        x = rng.uniform(0.2, 2.0, 8) * rng.choice([1, 1, 1, -1], 8)
        x[0] = abs(x[0])
        machine = oracle.Modified(k=100, c=5, inertia=0)
        short, printed = machine.rates(x), oracle.printed_rates(machine, x)
        assert short == pytest.approx(printed, rel=1e-9, abs=1e-9)
        inert = machine._replace(inertia=1.0).rates(x)
        assert abs(inert[1] - printed[1]) > 1e-3


@pytest.mark.parametrize("case", ["C34a", "C34b"])
def test_the_corrected_form_keeps_its_energy(corrected: Model, case: str) -> None:
    run = simulate(corrected, preset=case, rtol=1e-9)
    assert drift(run["energy"]) < 1e-7 * run["energy"][0]
    machine = FREE[case][0]
    states = np.array([run[name] for name in STATES])
    assert run["energy"] == pytest.approx(machine.energy(states), rel=1e-9)


def test_the_printed_form_keeps_what_lacks_the_counterweight(as_printed: Model) -> None:
    run = simulate(as_printed, preset="C35a", rtol=1e-9)
    assert drift(run["energy_printed"]) < 1e-7 * run["energy"][0]
    assert drift(run["energy"]) > run["energy"][0]


def test_the_two_diagrams_agree_on_what_is_printed(corrected: Model, as_printed: Model) -> None:
    values = {"k": 100.0, "l1_0": 3.0}
    ours = simulate(corrected, preset="as_printed", parameters=values, rtol=1e-9, span=(0, 4))
    theirs = simulate(as_printed, rtol=1e-9, span=(0, 4))
    for name in STATES:
        assert ours[name] == pytest.approx(theirs[name], abs=1e-5)
    assert ours["tension"] == pytest.approx(15 * 9.81)


def test_a_damper_takes_the_energy_that_is_lost(corrected: Model) -> None:
    run = simulate(corrected, preset="C34c", rtol=1e-9, times=np.arange(3001) / 1000)
    power = 5 * run["l2_dot"] ** 2
    work = np.sum((power[1:] + power[:-1]) / 2 * np.diff(run.t))
    assert run["energy"][0] - run["energy"][-1] == pytest.approx(work, rel=1e-5)
    assert work > 50


@pytest.mark.parametrize("case", FREE)
def test_a_rope_that_would_have_to_push_is_an_event(corrected: Model, case: str) -> None:
    machine, l1_0, end, _ = FREE[case]
    run = simulate(corrected, preset=case, rtol=1e-9)
    slack = resets(run, "slack")
    times = oracle.slack_times(machine, l1_0, end)
    assert [event.time for event in slack] == pytest.approx(times, abs=1e-6)
    assert run["slack"][-1] == len(times) > 0
    assert np.min(run["tension"]) < 0
    after = np.searchsorted(run.t, times[0])
    assert run["tension"][after - 1] > 0 > run["tension"][after + 1]


LAWS = {"C34bar_consistent": False, "C34bar_paper": True}


@pytest.mark.parametrize("case", LAWS)
def test_the_barrier_stops_holds_and_lets_go(corrected: Model, case: str) -> None:
    run = simulate(corrected, preset=case, rtol=1e-9)
    exact = oracle.modified_stopped(DAMPED, 2.0, run.t, 0.1, LAWS[case])
    assert run.t[-1] == 4.0
    agree(run, exact.states)
    impacts = [change for change in exact.changes if change.before == "free"]
    releases = [change.time for change in exact.changes if change.before == "held"]
    ours = resets(run, "events[0]")
    assert [event.time for event in ours] == pytest.approx([c.time for c in impacts], abs=1e-8)
    held = [event.after["held"] for event in ours]
    assert held == pytest.approx([float(change.after == "held") for change in impacts])
    assert {0.0, 1.0} == set(np.round(held))
    assert [e.time for e in resets(run, "events[1]")] == pytest.approx(releases, abs=1e-8)
    assert np.min(run["l1"]) == pytest.approx(0.1, abs=1e-9)


def test_while_it_is_held_the_pull_on_the_mass_is_less_than_the_rope(corrected: Model) -> None:
    run = simulate(corrected, preset="C34bar_consistent", rtol=1e-9)
    held = run["held"] > 0.5
    assert 50 < np.count_nonzero(held) < 200
    assert run["l1"][held] == pytest.approx(0.1, abs=1e-9)
    assert run["tension"][held] == pytest.approx(15 * 9.81)
    assert np.all(run["N"][held] < run["tension"][held])
    assert run["N"][~held] == pytest.approx(run["tension"][~held])


def velocity(x: dict[str, float]) -> np.ndarray:
    """Of m2, by the rates of the four coordinates."""
    r = 1.0 + x["l2"]
    one, two = x["phi1"], x["phi2"]
    u = x["l1_dot"] * np.sin(one) + x["l1"] * x["phi1_dot"] * np.cos(one)
    v = -x["l1_dot"] * np.cos(one) + x["l1"] * x["phi1_dot"] * np.sin(one)
    u += x["l2_dot"] * np.sin(two) + r * x["phi2_dot"] * np.cos(two)
    v += -x["l2_dot"] * np.cos(two) + r * x["phi2_dot"] * np.sin(two)
    return np.array([u, v])


@pytest.mark.parametrize("case", LAWS)
def test_only_the_consistent_impact_leaves_the_second_mass_alone(
    corrected: Model, case: str
) -> None:
    """Only a spring acts on m2, so that its velocity cannot jump; the lost energy is known then."""
    run = simulate(corrected, preset=case, rtol=1e-9)
    for event in resets(run, "events[0]"):
        jump = velocity(dict(event.after)) - velocity(dict(event.before))
        lost = [
            DAMPED.energy(np.array([x[name] for name in STATES]))
            for x in (event.before, event.after)
        ]
        speed = event.before["l1_dot"]
        if LAWS[case]:
            assert np.hypot(*jump) == pytest.approx(abs(speed))
        else:
            assert np.hypot(*jump) < 1e-9
            assert lost[0] - lost[1] == pytest.approx((15 + 3.5) * speed**2 / 2)
