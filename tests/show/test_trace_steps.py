"""Which step of a trace decides, and which of its numbers belong to the result."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from show.traces import FOUND, NULL
from tracewire.options import options_of
from tracewire.show import report
from tracewire.show.style import saved_figures
from tracewire.show.trace_figures import plot_candidates
from tracewire.show.trace_steps import compares, decided_words, own_gain
from tracewire.show.trace_tables import compared_table, effects_table, power_table, tried_table
from tracewire.show.trace_text import remarks_of, step_lines
from tracewire.show.trace_untried import untried
from tracewire.trace import CandidateScore, SearchStep, TraceOptions

BOTH = "coulomb @ torque + cogging @ torque"
SEARCHED = (
    SearchStep(
        0.5, 81.0, 0.0, (CandidateScore(BOTH, 90.0, 120.0), CandidateScore("bias @ torque", 3.0)),
        "accepted: coulomb @ torque and cogging @ torque",
    ),
    SearchStep(
        1.5, 7.0, 0.0, (CandidateScore("stribeck @ torque", 50.0, 60.0),), "no effect passes",
    ),
)  # fmt: skip
COMPARED = SearchStep(
    3.0, 900.0, math.nan,
    (CandidateScore("coulomb @ torque + stribeck @ torque", math.nan, 15.6, remark="6 numbers"),
     CandidateScore("the declared model", math.nan, 0.0, remark="3 numbers")),
    "held-out blocks choose coulomb @ torque + stribeck @ torque (z = 32.2)",
)  # fmt: skip
COULOMB = replace(FOUND.effects[0], gain=120.0)
STRIBECK = replace(COULOMB, name="stribeck", gain=math.nan, ties=())
TWO = replace(FOUND, steps=(*SEARCHED, COMPARED), effects=(COULOMB, STRIBECK))
DECIDED = (
    "Step 3 decides, whatever the steps before accepted or refused. It fits models to longer "
    "windows, and takes the one of fewest numbers that predicts held-out blocks as well as the "
    "best. It leaves out cogging @ torque, which step 1 accepted, and takes stribeck @ torque, "
    "which no step before accepted."
)


def test_the_step_that_decides_says_what_it_overrides() -> None:
    assert [compares(step) for step in TWO.steps] == [False, False, True]
    assert decided_words(TWO) == DECIDED
    assert step_lines(TWO)[-1] == DECIDED
    assert DECIDED in report(TWO).markdown().replace("\\_", "_")


def test_where_the_steps_agree_nothing_is_overridden() -> None:
    accepted = replace(
        SEARCHED[0], tried=(CandidateScore("coulomb @ torque", 90.0, 120.0),),
        words="accepted: coulomb @ torque",
    )  # fmt: skip
    assert decided_words(replace(FOUND, steps=(accepted, COMPARED))) == ""
    # what was refused is no part of the name of what was accepted
    oulomb = CandidateScore("oulomb @ torque", 9.0, 12.0)
    both = replace(accepted, tried=(*accepted.tried, oulomb))
    assert decided_words(replace(FOUND, steps=(both, COMPARED))) == ""
    assert decided_words(replace(FOUND, steps=SEARCHED)) == ""  # nothing was compared


def test_the_gain_of_another_combination_is_not_that_of_an_effect() -> None:
    assert math.isnan(own_gain(TWO, COULOMB))
    assert effects_table(TWO).rows[0][-1] == ""
    cogging = replace(COULOMB, name="cogging")
    assert own_gain(replace(TWO, effects=(COULOMB, cogging)), COULOMB) == 120.0


def test_the_gain_of_a_prediction_has_a_name_of_its_own(tmp_path: Path) -> None:
    assert {row[0] for row in tried_table(TWO).rows} == {"1", "2"}
    table = compared_table(TWO)
    assert table.header[2] == "gain of prediction"
    assert [row[2] for row in table.rows] == ["15.6", "0"]
    with saved_figures() as figures:
        plot_candidates(TWO, tmp_path / "a.png")
    labels = [panel.get_xlabel() for panel in figures[0].axes if panel.get_visible()]
    assert "gain: half the fall of BIC" in labels
    assert "gain of prediction on held-out blocks" in labels


@pytest.mark.parametrize(("found", "told"), [(TWO, True), (replace(TWO, steps=SEARCHED), False)])
def test_effects_named_together_are_said_to_do_better_together(found: object, told: bool) -> None:
    page = report(found).markdown()  # type: ignore[arg-type]
    assert "cannot be told apart by any analysis" not in page
    assert ("The effects that are named together may be alike, too" in page) is told


def test_what_was_not_tried_would_not_have_been_shown() -> None:
    skipped = replace(NULL, words=("coulomb @ torque was not tried: the run stops",))
    assert {row[0] for row in power_table(skipped).rows} == {"bias", "sensor_offset"}
    assert "Not among them: coulomb @ torque, which was not tried." in report(skipped).markdown()
    pair = replace(NULL, words=("play @ torque and coulomb @ torque was not tried: it stops",))
    assert len(power_table(pair).rows) == len(NULL.power)


LONG = "the model takes more than 61217 steps in all"


def test_what_was_not_tried_is_told_once_with_what_to_do() -> None:
    skipped = replace(
        FOUND,
        words=(
            f"coulomb @ torque was not tried: {LONG}",  # the verdict names it
            f"play @ torque was not tried: {LONG}",
            f"play @ torque and bias @ torque was not tried: {LONG}",
            f"coupling_q @ left (of right) was not tried: {LONG}",
            f"dahl @ torque and bias @ torque was not tried: {LONG}",
            "cogging @ torque was not tried: parameter 'pitch' must be above 0",
            "lugre @ torque was not tried: the run stopped at t = 2 s: nan",
            "another remark",
        ),
    )
    assert remarks_of(skipped) == (
        "another remark",
        "cogging @ torque was not tried: parameter 'pitch' must be above 0",
        "play @ torque, coupling_q @ left (of right), dahl @ torque with bias @ torque and 1 more "
        "were not tried: with them a run takes more than 6 times as many steps, or does not end, "
        "as the model is stiff, switches often or runs away; to try one, add it to the diagram and "
        "`fit` that, or allow more in Python: "
        '`tw.trace(model, options={"search": {"slower": 30}})`',
    )
    assert untried(skipped) == {
        "coulomb @ torque", "play @ torque", "coupling_q @ left", "cogging @ torque",
        "lugre @ torque",
    }  # fmt: skip


def test_what_was_refitted_in_a_step_was_tried() -> None:
    tried = CandidateScore("dahl @ torque + bias @ torque", 3.0, s2=1.5)
    step = SearchStep(1.0, 2.0, 0.0, (tried,), "")
    words = (f"dahl @ torque was not tried: {LONG}",)
    assert remarks_of(replace(FOUND, steps=(step,), words=words)) == ()
    promised = replace(step, tried=(replace(tried, s2=math.nan),))
    assert remarks_of(replace(FOUND, steps=(promised,), words=words)) != ()


def test_the_options_that_a_remark_names_are_options() -> None:
    options = options_of(TraceOptions, {"search": {"slower": 30}}, "a trace")
    assert options.search.slower == 30
