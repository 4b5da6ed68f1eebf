"""The gate: whether a trial does better than another on windows that no fit saw."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.judge import judge_on_gate

WINDOWS = 10


def judged(
    before: list[float], after: list[float], s2: float = 1.0, fall: float = 20.0
) -> tuple[bool, str]:
    """The gate on windows with these squared errors: whether the trial passes, and words."""
    now: Any = SimpleNamespace(reduced_chi2=9.0)
    trial: Any = SimpleNamespace(reduced_chi2=s2)
    squares = {id(now): before, id(trial): after}

    def windows_on(one: Any, windows: Any) -> Any:
        """Windows of one residual each, whose starts are not free."""
        residuals = [np.sqrt([[x]]) for x in squares[id(one)]]
        starts = [{}] * len(residuals)
        return SimpleNamespace(
            squares=np.array(squares[id(one)]), residuals=residuals, starts=starts
        )

    problem: Any = SimpleNamespace(windows_on=windows_on, options=TraceOptions())
    return judge_on_gate(problem, now, trial, [], fall)


def passes(before: list[float], after: list[float], s2: float = 1.0, fall: float = 20.0) -> bool:
    """Whether the gate lets the trial pass."""
    return judged(before, after, s2, fall)[0]


def test_what_halves_the_error_everywhere_passes() -> None:
    verdict = judged([10.0] * WINDOWS, [5.0] * WINDOWS)
    assert verdict == (True, "gate: squared error falls by 50%, passed")


def test_what_takes_nearly_all_of_the_error_is_not_said_to_take_all() -> None:
    _, words = judged([1000.0] * WINDOWS, [1.0] * WINDOWS)
    assert words == "gate: squared error falls by more than 99.5%, passed"


def test_what_does_worse_is_refused() -> None:
    verdict = judged([10.0] * WINDOWS, [11.0] * WINDOWS)
    assert verdict == (False, "gate: squared error rises by 10%, refused")


def test_less_than_two_percent_is_nothing() -> None:
    assert not passes([10.0] * WINDOWS, [9.85] * WINDOWS)
    assert passes([10.0] * WINDOWS, [9.75] * WINDOWS)


def test_far_above_the_noise_a_third_is_asked_for() -> None:
    assert not passes([10.0] * WINDOWS, [7.1] * WINDOWS, s2=5.0)
    assert passes([10.0] * WINDOWS, [6.0] * WINDOWS, s2=5.0)


def test_one_window_that_improves_carries_nothing_alone() -> None:
    after = [1.0, *[10.0] * (WINDOWS - 1)]
    assert not passes([10.0] * WINDOWS, after)


def test_where_bic_is_decided_less_support_is_enough() -> None:
    after = [4.0, 4.0, *[10.0] * 6, 10.5, 10.5]  # z = 1.3, and two windows of ten improve
    assert not passes([10.0] * WINDOWS, after, fall=20.0)
    assert passes([10.0] * WINDOWS, after, fall=200.0)


def test_what_shows_in_one_window_and_harms_none_passes_where_bic_is_decided() -> None:
    after = [1.0, 10.3, *[10.0] * (WINDOWS - 2)]  # z = 1
    assert passes([10.0] * WINDOWS, after, fall=200.0)
    harmed = [1.0, 12.0, *[10.0] * (WINDOWS - 2)]
    assert not passes([10.0] * WINDOWS, harmed, fall=200.0)


def test_a_window_in_which_both_lose_their_track_does_not_count() -> None:
    before, after = [1.6] * (WINDOWS - 1), [0.8] * (WINDOWS - 1)
    verdict = judged([*before, 3870.0], [*after, 4050.0])
    assert verdict == (True, "gate: squared error falls by 50%, passed")
    assert not passes([*before, 3870.0], [*after, 4050.0], s2=5.0), "it is lost anyway"
    assert not passes([*before, 1.6], [*after, 4050.0]), "the trial itself lost it"
    assert not passes([*before[:-1], 3870.0, 3870.0], [*after[:-1], 4050.0, 4050.0])


def test_without_an_error_there_is_nothing_to_improve() -> None:
    assert judged([0.0, 0.0], [0.0, 0.0]) == (False, "gate: nothing to improve")


def test_what_the_noise_has_on_the_gate_is_no_error_that_could_fall() -> None:
    """What acts seldom may act little there: of 1.3 noise variances only 0.3 can fall."""
    assert passes([1.3] * WINDOWS, [1.15] * WINDOWS, s2=5.0)
    assert not passes([1.3] * WINDOWS, [1.21] * WINDOWS, s2=5.0)
