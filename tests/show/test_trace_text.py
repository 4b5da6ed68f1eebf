"""What a terminal shows of a trace: the short answer first, then the way to it, then tables."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from show.traces import FOUND, NULL, TRIED, UNEXPLAINED, errors
from tracewire.show.trace_tables import (
    effects_table,
    errors_table,
    experiments_table,
    moved_table,
    power_table,
    ties_table,
    trace_tables,
    tried_table,
    where_table,
)
from tracewire.show.trace_text import answer_lines, step_lines
from tracewire.trace import Found, TraceOptions
from tracewire.trace.found import Dependence, Remainder


def test_the_answer_to_an_effect() -> None:
    assert answer_lines(FOUND) == (
        "VERDICT effect: coulomb @ torque is missing",
        "  coulomb @ torque: level = 0.2500 N m (95 %: 0.2430 to 0.2570), width = 0.0110 rad/s "
        "(95 %: 0.0040 to 0.0180)",
        "    dry friction of one level, which holds the body at rest up to that level",
        "    these data cannot tell it from 'bias' at the sum 'torque' (1 fitted number fewer), "
        "'sensor_offset' in the sensor of 'theta' (1 fitted number fewer)",
        "  free runs on unseen data: 46 σ -> 1.02 σ (theta from 0.184 to 0.00408 rad)",
        "  had absorbed part of the missing effect: 'c' moves from 0.3 to 0.051 N m s/rad",
        "  To decide between coulomb @ torque and bias @ torque: release it from rest at theta = "
        "0.2 rad and omega = 0 rad/s. The predictions then differ by 6.9 times the sensor noise "
        "(by less than 0.1 to 7 at the settings that were searched).",
    )


def test_an_interval_says_what_it_does_not_count() -> None:
    worse = tuple(replace(e, after=1.4 * e.sigma) for e in FOUND.errors)
    said = (
        "  something small is missing still, up to 1.4 σ in free runs: it may move a value farther"
    )
    assert [line.startswith(said) for line in answer_lines(replace(FOUND, errors=worse))].count(
        True
    )
    assert not any(line.startswith(said) for line in answer_lines(FOUND))


def test_a_null_says_where_whole_runs_are_off_by_more_than_the_noise() -> None:
    worse = replace(NULL, errors=tuple(replace(e, after=1.5 * e.sigma) for e in NULL.errors))
    assert answer_lines(worse)[-1] == (
        "  On unseen data a free run is off by 1.5 σ, and in windows of "
        f"{NULL.steps[-1].window:.3g} s the residual is the noise: what is missing is small and "
        "slow, or noise of an input adds up in a run."
    )


def test_three_effects_are_a_list() -> None:
    (one,) = FOUND.effects
    three = replace(FOUND, effects=(one, replace(one, name="bias"), replace(one, name="cogging")))
    assert answer_lines(three)[0] == (
        "VERDICT effect: coulomb @ torque, bias @ torque and cogging @ torque are missing"
    )


def test_the_answer_where_nothing_is_missing() -> None:
    assert answer_lines(NULL) == (
        "VERDICT null: nothing is missing that these data could show",
        "  free runs on unseen data: 1.02 σ (0.00408 rad in theta)",
        "  smallest coefficients that these data would show: coulomb @ torque level = 0.0021 N m, "
        "sensor_offset @ sensor.theta offset = 0.0004 rad, bias @ torque level = 0.0013 N m",
    )


def test_the_answer_where_nothing_explains_it() -> None:
    assert answer_lines(UNEXPLAINED)[0] == (
        "VERDICT unexplained: something is missing at the sum 'torque'; it depends on the "
        "coordinate theta (97 % of the excess; theta, omega @ torque 74 %; theta @ sensor.theta "
        "62 %), and no effect of the library explains it"
    )
    assert UNEXPLAINED.missing is not None
    alike = [Dependence("torque", (name,), 0.96) for name in ("v", "t", "history")]
    found = replace(UNEXPLAINED, dependences=(*UNEXPLAINED.dependences, *alike))
    assert (
        "depends on the coordinate theta, the rate omega or the time t, which this record cannot "
        "tell apart (97 % of the excess"
    ) in answer_lines(found)[0]
    nowhere = answer_lines(replace(UNEXPLAINED, missing=None))[0]
    assert nowhere.endswith("something is missing, and no effect of the library explains it")
    why = "a model with drive_lag @ drive.u multiplies the error on unseen windows by 2"
    refused = answer_lines(replace(UNEXPLAINED, reason=why))[0]
    assert refused.endswith(f"and no effect of the library explains it: {why}")
    cut = answer_lines(replace(UNEXPLAINED, interrupted=True))[0]
    assert cut.startswith("VERDICT unexplained (interrupted: what was known by then): something")
    assert cut.endswith("and no effect was accepted by then")


def test_a_partial_approximation_is_called_so() -> None:
    line = answer_lines(replace(UNEXPLAINED, effects=FOUND.effects))[1]
    assert line.startswith("  best approximation, not enough: coulomb @ torque: level = 0.2500 N m")


def test_what_an_unexplained_residual_may_be_and_limits_of_the_search_are_told() -> None:
    nowhere = answer_lines(replace(UNEXPLAINED, missing=None))
    assert nowhere[-1].startswith("  The residual depends on nothing that was tried: it may be a ")
    limited = replace(NULL, options=TraceOptions(without=("bias",)))
    assert answer_lines(limited)[-1] == "  Limits of this search: 'bias' was not tried."
    far = answer_lines(replace(NULL, s2_before=25.0))
    assert far[-1].startswith("  It is more than the noise that was assumed")


def test_on_what_the_rest_depends_stands_below_its_size() -> None:
    rest = (Dependence("torque", ("theta",), 0.4),)
    left = (Remainder("theta", "rad", 0.1, 6.0, 0.58, 0.1),)
    lines = answer_lines(replace(FOUND, remainder=left, remainder_depends=rest))
    at = next(n for n, line in enumerate(lines) if line.startswith("  left on held-out blocks"))
    assert lines[at + 1] == (
        "    a smooth function of theta at the sum 'torque' explains 40 % of that"
    )


def test_errors_of_data_that_chose_the_effects_are_not_called_unseen() -> None:
    lines = answer_lines(replace(FOUND, errors=errors(validated=False)))
    assert "  no data were kept back: these errors are of data that chose the effects" in lines
    assert not any("unseen" in line for line in lines)


def test_an_unknown_noise_is_not_divided_by() -> None:
    blind = replace(FOUND, errors=tuple(replace(e, sigma=0.0) for e in FOUND.errors))
    assert not any("free runs" in line for line in answer_lines(blind))
    assert {row[-1] for row in errors_table(blind).rows} == {""}


def test_the_steps_have_window_probability_and_what_the_gate_said() -> None:
    assert step_lines(FOUND) == (
        "noise (σ)       theta 0.004 rad",
        "declared model  s2 = 81: rms 9 σ on the fitted windows; 1 is the noise",
        "step 1          windows of 0.5 s, s2 = 81, p < 1e-12: accepted: coulomb @ torque",
        "                coulomb @ torque: masked 62 %, s2 -> 1.01, weight 0.97, gate: squared "
        "error falls by 99 %, passed",
        "step 2          windows of 1.5 s, s2 = 1.01: nothing stands out (p = 0.4)",
    )


def test_effects_have_a_row_for_each_parameter() -> None:
    assert effects_table(FOUND).rows == (
        ("coulomb", "torque", "level", "0.2500", "0.2430 to 0.2570", "N m", "62 %", "905.3"),
        ("", "", "width", "0.0110", "0.0040 to 0.0180", "rad/s", "", ""),
    )
    assert effects_table(replace(FOUND, verdict="unexplained")).title == "best approximations"


def test_ties_have_likeness_and_refitted_parameters() -> None:
    first, second = ties_table(FOUND).rows
    assert first == (
        "coulomb @ torque", "bias @ torque", "0.991", "-1", "level = -0.21", "+4.2"
    )  # fmt: skip
    assert second[-1] == "+11.8"


def test_errors_begin_with_free_runs_on_data_that_played_no_part() -> None:
    rows = errors_table(FOUND).rows
    assert rows[0] == (
        "free run", "validate", "swing_3", "theta", "rad", "0.184", "0.00408", "46", "1.02"
    )  # fmt: skip
    assert [row[0] for row in rows] == ["free run"] * 3 + ["windowed"] * 3


def test_what_moved_is_marked() -> None:
    k, c = moved_table(FOUND).rows
    assert (k[0], k[3], k[-1]) == ("k", "-0.25 %", "")
    assert (c[0], c[3], c[-1]) == ("c", "-83 %", "had absorbed part of the effect")


def test_all_that_was_tried_is_in_its_table() -> None:
    assert len(tried_table(FOUND).rows) == len(TRIED)


def test_a_long_list_ends_with_the_number_of_what_is_left_out() -> None:
    assert power_table(NULL, 1).rows == (
        ("coulomb", "torque", "level", "0.0021", "N m"),
        ("and 2 more", "", "", "", ""),
    )


def test_what_would_have_been_seen_is_told_where_nothing_is_missing() -> None:
    title = "what would have been seen"
    assert title in [table.title for table in trace_tables(NULL)]
    powers = replace(FOUND, power=NULL.power)
    assert title not in [table.title for table in trace_tables(powers)]


def test_what_was_only_screened_has_no_numbers_of_a_refit() -> None:
    row = tried_table(FOUND).rows[4]
    assert row[1:7] == ("sensor_offset @ sensor.theta", "30", "", "", "12 %", "")


def test_where_and_on_what_is_sorted_and_never_below_nothing() -> None:
    rows = where_table(UNEXPLAINED).rows
    assert [row[1] for row in rows[:3]] == ["theta", "theta, omega", "theta"]
    assert rows[-1][-1] == "0 %"


def test_experiments_have_their_settings() -> None:
    assert experiments_table(FOUND).rows == (
        (
            "coulomb @ torque or bias @ torque",
            "start.theta = 0.2 rad, start.omega = 0 rad/s",
            "6.9",
        ),
    )


@pytest.mark.parametrize("found", [FOUND, NULL, UNEXPLAINED], ids=lambda found: found.verdict)
def test_tables_are_rectangular_and_not_empty(found: Found) -> None:
    tables = trace_tables(found)
    assert tables
    for table in tables:
        assert table.rows
        assert {len(row) for row in table.rows} == {len(table.header)}
        assert not any("nan" in cell for row in table.rows for cell in row)


def test_a_step_that_tried_nothing_that_is_known_has_no_nan() -> None:
    step = replace(
        FOUND.steps[0], tried=(replace(TRIED[4], remark="did not run", masked=math.nan),)
    )
    assert "nan" not in "\n".join(step_lines(replace(FOUND, steps=(step,))))
