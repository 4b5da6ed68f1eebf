"""The search: windows that grow, what is worth a refit, and one step after the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from oracles.oscillator import DIAGRAM, candidates_of, problem_of, record, search_of
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Measured
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.places import Place
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.screening import Screen, ScreenRow
from tracewire.trace.screen.shortlist import shortlist
from tracewire.trace.search.search import Search
from tracewire.trace.trials.data_split import shortest_window, split_data
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.statistics import CandidateColumns
from tracewire.trace.trials.trial import Trial

OPTIONS = TraceOptions()

N = 1000
FORCE = Place("force", "sum", "force")


def screen_of(truth: Mapping[str, float], sign: int = 0, count: int = 10) -> Screen:
    """A screen of white columns named c0, c1, ..., of which `truth` is in the residual."""
    rng = np.random.default_rng(5)
    names = [f"c{n}" for n in range(count)]
    matrix = rng.normal(size=(N, count))
    residual = rng.normal(size=N)
    for name, coefficient in truth.items():
        residual = residual - coefficient * matrix[:, names.index(name)]
    columns = CandidateColumns(residual, matrix, np.zeros(count), 1.0, N)
    rows = []
    for n, name in enumerate(names):
        fall, values = columns.score([n])
        candidate = Candidate(name, FORCE, name, {}, f"{name}.size", sign)
        possible = sign == 0 or values[0] * sign > 0
        start = {"size": float(values[0])}
        gain = columns.gain(fall, 1)
        rows.append(ScreenRow(candidate, {}, (n,), fall, gain, start, 0.0, possible))
    return Screen(columns, tuple(rows), np.arange(len(columns.residual)))


def proposed(screen: Screen, room: int = 3) -> list[set[str]]:
    return [
        {row.candidate.effect for row in p.rows}
        for p in shortlist(screen, room, OPTIONS.screen.singles)
    ]


def test_a_single_effect_is_proposed_alone() -> None:
    assert proposed(screen_of({"c2": 0.5})) == [{"c2"}]


def test_two_effects_are_proposed_alone_and_together() -> None:
    found = proposed(screen_of({"c2": 0.5, "c4": -0.4}))
    assert found[0] == {"c2"}
    assert {"c4"} in found
    assert {"c2", "c4"} in found


def test_where_one_effect_has_room_no_pair_is_proposed() -> None:
    screen = screen_of({"c2": 0.5, "c4": -0.4})
    assert all(len(names) == 1 for names in proposed(screen, room=1))


def test_a_coefficient_of_the_wrong_sign_is_not_proposed() -> None:
    assert proposed(screen_of({"c2": -0.5}, sign=1)) == []
    assert proposed(screen_of({"c2": 0.5}, sign=1)) == [{"c2"}]


def test_nothing_is_proposed_where_nothing_is() -> None:
    assert proposed(screen_of({})) == []


def test_the_list_stays_short_where_everything_stands_out() -> None:
    found = proposed(screen_of({f"c{n}": 0.5 for n in range(10)}))
    assert sum(len(names) == 1 for names in found) == OPTIONS.screen.singles
    assert sum(len(names) == 2 for names in found) == OPTIONS.screen.pairs


def shortest_of(series: Measured, unit: str = "m") -> int:
    model = compile(read_text(DIAGRAM.replace("unit: m}", f"unit: {unit}}}")))
    return shortest_window(model, split_data([series], OPTIONS.split), OPTIONS)


def test_the_shortest_window_is_a_fifth_of_a_period() -> None:
    t = np.arange(0, 30, 0.03)
    slow = replace(record(end=12.0), t=t, values={"x": np.cos(2 * np.pi * t / 6.0)})
    assert shortest_of(slow) == pytest.approx(40, abs=6), "of 200 samples"
    fast = replace(slow, values={"x": np.cos(2 * np.pi * t / 0.3)})
    assert shortest_of(fast) == 16, "never below that"


def test_a_turn_is_the_period_of_an_angle_that_goes_round() -> None:
    t = np.arange(0, 30, 0.03)
    turning = replace(record(end=12.0), t=t, values={"x": 2 * np.pi * 10 * t / 30})
    assert shortest_of(turning, "rad") == 20, "of 100 samples a turn"
    assert shortest_of(turning, "m") > 100, "a way has no turns"
    speed = replace(turning, values={"x": np.full_like(t, 2 * np.pi * 10 / 30)})
    assert shortest_of(speed, "rad/s") == 20, "by its speed alone"
    fast = replace(turning, values={"x": 2 * np.pi * 100 * t / 30})
    assert shortest_of(fast, "rad") > 100, "ten samples show no turn"
    slow = replace(turning, values={"x": 2 * np.pi * 4 * t / 30})
    assert shortest_of(slow, "rad") > 100, "too few turns"


def test_windows_grow_threefold_up_to_the_whole_section() -> None:
    search = search_of(problem_of(record(end=30.0), record(use="gate", name="gate")), shortest=20)
    longest = search.data_split.longest
    assert search.lengths == [20, 60, 180, 540, longest]
    short = search_of(problem_of(record(end=3.0), record(use="gate", name="gate")), shortest=200)
    assert short.lengths == [short.data_split.longest]


def rubbed(x: float, v: float) -> float:
    return -0.4 * float(np.tanh(v / 1e-3))


def test_a_model_that_is_right_climbs_to_whole_sections() -> None:
    search = search_of(problem_of(record(), record(use="gate", name="gate")))
    declared = search.fit_declared()
    assert declared.length == 20
    climbed = search.lengthen_windows(declared)
    assert climbed.length == search.data_split.longest
    assert climbed.reduced_chi2 == pytest.approx(1.0, abs=0.2)


def test_a_model_that_is_far_off_stays_on_short_windows() -> None:
    far = record(lambda x, v: -6.0 * float(np.tanh(v / 0.05)) - 30 * x**3)
    search = search_of(problem_of(far, record(use="gate", name="gate")))
    climbed = search.lengthen_windows(search.fit_declared())
    assert climbed.length < search.data_split.longest


def test_an_effect_that_cannot_be_run_is_left_out_with_a_reason() -> None:
    search = search_of(problem_of(record(end=6.0), record(use="gate", name="gate")))
    now = search.fit_declared()
    coulomb = candidates_of(search.problem)["coulomb @ force"]
    nowhere = replace(coulomb, signals={"rate": "nowhere"})
    added = [PlacedEffect(nowhere, {"level": 0.1})]
    refit = search.refits.prepare(now, added, now.windows.segments)
    assert search.refits.run(now, [refit]) == [None]
    (told,) = search.words
    assert told.startswith("coulomb @ force was not tried: ") and "'nowhere'" in told


@pytest.fixture(scope="module")
def step() -> tuple[Search, Trial | None]:
    """The first step of a search where dry friction is missing."""
    search = search_of(
        problem_of(
            record(rubbed, end=7.0), record(rubbed, end=7.0, use="gate", name="gate", seed=1)
        )
    )
    declared = search.fit_declared()
    search.first = search.best = search.lengthen_windows(declared)
    after = search.add_effect(search.best)
    return search, after


def test_a_step_accepts_what_is_missing(step: tuple[Search, Trial]) -> None:
    search, after = step
    assert [str(effect) for effect in after.effects] == ["coulomb @ force"]
    (told,) = search.steps
    assert told.after is after
    assert told.words == "accepted: coulomb @ force"
    assert told.p_value < 1e-3
    winner = next(one for one in told.refits if one.trial is after)
    assert winner.delta_bic < -10 and "passed" in winner.remark
    assert sum(one.weight for one in told.refits) == pytest.approx(1.0)
    rises = [one.delta_bic for one in told.refits]
    assert rises == sorted(rises)


def test_with_it_the_next_step_finds_nothing(step: tuple[Search, Trial]) -> None:
    search, after = step
    assert search.add_effect(search.lengthen_windows(after)) is None
    words = search.steps[-1].words
    assert words == "no effect passes" or words.startswith("nothing stands out (p = ")
