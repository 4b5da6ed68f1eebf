"""A record that is at the noise but for its begin or its end: the note that says so."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tracewire.trace.choose.settling import describe_few_samples, describe_settling, quiet_from
from tracewire.trace.options import TraceOptions

OPTIONS = TraceOptions()
NOISE = np.random.default_rng(5).standard_normal((400, 2))
T = np.arange(400) / 10


def disturbed(first: int, end: int, by: float = 6.0) -> Any:
    """White residuals that are larger from one row to another."""
    residual = NOISE.copy()
    residual[first:end] *= by
    return residual


def trial_of(residual: Any) -> Any:
    """The same in four windows, whose order is not that of time."""
    rows = np.split(np.arange(400), 4)
    rows = [rows[n] for n in (2, 0, 3, 1)]
    measured = SimpleNamespace(name="run")
    segments = [SimpleNamespace(measured=measured, t=T[part]) for part in rows]
    residuals = [residual[part] for part in rows]
    return SimpleNamespace(windows=SimpleNamespace(segments=segments, residuals=residuals))


def told(residual: Any) -> list[str]:
    return list(describe_settling(trial_of(residual), OPTIONS))


def test_a_begin_that_is_far_off_may_be_left_out() -> None:
    (words,) = told(disturbed(0, 60))
    begin = float(words.partition("noise from ")[2].partition(" s on")[0])
    assert 4.5 < begin <= 6.0
    assert words.startswith("'run' is at the noise from ")
    assert " σ off before. If something settles there, leave it out by `from:` of the " in words


def test_an_end_that_is_far_off_may_be_left_out() -> None:
    (words,) = told(disturbed(340, 400))
    end = float(words.partition("noise until ")[2].partition(" s, and")[0])
    assert 33.9 <= end < 35.5
    assert "off after that. If something disturbs it there, leave it out by `to:` of the " in words


@pytest.mark.parametrize(
    "residual",
    [NOISE, 3 * NOISE, disturbed(0, 60, by=2.0), disturbed(0, 300), disturbed(150, 250)],
    ids=["noise", "all of it", "hardly more", "most of it", "in the middle"],
)
def test_elsewhere_nothing_is_said(residual: Any) -> None:
    assert told(residual) == []


@pytest.mark.parametrize("count", [0, 1, 2])
def test_too_few_samples_say_nothing(count: int) -> None:
    assert quiet_from(np.full(count, 50.0), OPTIONS) == 0


def test_few_samples_that_hold_half_of_the_residual_are_named() -> None:
    residual = NOISE.copy()
    residual[[120, 280]] = 40.0
    (words,) = describe_few_samples(trial_of(residual), OPTIONS)
    assert words.startswith(
        "half of the squared residual of 'run' stands in 2 of 400 samples, at t = 12, 28 s: look"
    )


@pytest.mark.parametrize("residual", [NOISE, 3 * NOISE, disturbed(200, 240)])
def test_many_samples_are_not(residual: Any) -> None:
    assert not list(describe_few_samples(trial_of(residual), OPTIONS))
