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
from tracewire.trace import Found


def test_the_answer_to_an_effect() -> None:
    assert answer_lines(FOUND) == (
        "VERDICT effect: coulomb @ torque is missing",
        "  coulomb @ torque: level = 0.25 N m (95 %: 0.243 to 0.257), width = 0.011 rad/s "
        "(95 %: 0.004 to 0.018)",
        "    cannot be told apart on these data: bias @ torque (0.991), "
        "sensor_offset @ sensor.theta (0.987)",
        "  free runs on unseen data: 46 σ -> 1.02 σ (theta 0.184 -> 0.00408 rad)",
        "  had stood in for what was missing: c 0.3 -> 0.051 N m s/rad",
        "  A swing that begins at theta = 0.2 rad would tell coulomb from bias by 6.9 σ",
    )


def test_the_answer_where_nothing_is_missing() -> None:
    assert answer_lines(NULL) == (
        "VERDICT null: nothing is missing beyond the noise",
        "  free runs on unseen data: 1.02 σ",
        "  smallest coefficients that would have been seen: coulomb 0.0021, sensor_offset 0.0004, "
        "bias 0.0013 (SI)",
    )


def test_the_answer_where_nothing_explains_it() -> None:
    assert answer_lines(UNEXPLAINED)[0] == (
        "VERDICT unexplained: something is missing at the sum 'torque'; it depends on the "
        "coordinate q (97 % of the excess; q, v @ torque 74 %; y @ sensor.theta 62 %), and no "
        "effect of the library explains it"
    )
    nowhere = answer_lines(replace(UNEXPLAINED, missing=None))[0]
    assert nowhere.endswith("something is missing, and no effect of the library explains it")
    cut = answer_lines(replace(UNEXPLAINED, interrupted=True))[0]
    assert cut.startswith("VERDICT unexplained (interrupted: what was known by then): something")
    assert cut.endswith("and no effect was accepted by then")


def test_a_partial_approximation_is_called_so() -> None:
    line = answer_lines(replace(UNEXPLAINED, effects=FOUND.effects))[1]
    assert line.startswith("  best approximation, not enough: coulomb @ torque: level = 0.25 N m")


def test_errors_of_data_that_chose_the_effects_are_not_called_unseen() -> None:
    lines = answer_lines(replace(FOUND, errors=errors(validated=False)))
    assert "  no data played no part: these errors are of data that chose the effects" in lines
    assert not any("unseen" in line for line in lines)


def test_an_unknown_noise_is_not_divided_by() -> None:
    blind = replace(FOUND, errors=tuple(replace(e, sigma=0.0) for e in FOUND.errors))
    assert not any("free runs" in line for line in answer_lines(blind))
    assert {row[-1] for row in errors_table(blind).rows} == {""}


def test_the_steps_have_window_probability_and_what_the_gate_said() -> None:
    assert step_lines(FOUND) == (
        "noise (σ)       theta 0.004 rad",
        "declared model  s2 = 81: rms 9 σ on short windows; 1 is the noise",
        "step 1          windows of 0.5 s, s2 = 81, p < 1e-12: accepted: coulomb @ torque",
        "                coulomb @ torque: masked 62 %, s2 -> 1.01, weight 0.97, gate: squared "
        "error falls by 99 %, passed",
        "step 2          windows of 1.5 s, s2 = 1.01: nothing stands out (p = 0.4)",
    )


def test_effects_have_a_row_for_each_parameter() -> None:
    assert effects_table(FOUND).rows == (
        ("coulomb", "torque", "level", "0.25", "0.243 to 0.257", "N m", "905.3", "62 %", "0.97"),
        ("", "", "width", "0.011", "0.004 to 0.018", "rad/s", "", "", ""),
    )
    assert effects_table(replace(FOUND, verdict="unexplained")).title == "best approximations"


def test_ties_have_likeness_and_refitted_parameters() -> None:
    first, second = ties_table(FOUND).rows
    assert first == ("coulomb @ torque", "bias @ torque", "0.991", "torque = -0.21", "+4.2")
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
    assert (c[0], c[3], c[-1]) == ("c", "-83 %", "had stood in for what was missing")


def test_a_terminal_leaves_out_what_was_only_screened_and_long_lists() -> None:
    assert len(tried_table(FOUND).rows) == len(TRIED)
    assert [row[1] for row in tried_table(FOUND, screened=False).rows] == [
        row.effects for row in TRIED[:4]
    ]
    assert power_table(NULL, 1).rows == (
        ("coulomb", "torque", "level", "0.0021"),
        ("and 2 more", "", "", ""),
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
    assert [row[1] for row in rows[:3]] == ["q", "q, v", "y"]
    assert rows[-1][-1] == "0 %"


def test_experiments_have_their_settings() -> None:
    assert experiments_table(FOUND).rows == (
        ("coulomb @ torque or bias @ torque", "start.theta = 0.2, start.omega = 0", "6.9"),
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
