"""What a result tells of fitted numbers."""

from __future__ import annotations

from oracles.oscillator import problem_of, record, trial_of
from tracewire.trace.results.result import _intervals_of


def test_an_interval_ends_at_the_bound_of_its_number() -> None:
    """More than the damping is taken away: c sits on 0, and a negative one is none."""
    trial = trial_of(problem_of(record(lambda x, v: 0.5 * v)))
    whole, told = trial.intervals(0.95), _intervals_of(trial, 0.95)
    assert whole["c"][0] < 0
    assert told["c"] == (0.0, whole["c"][1])
    assert told["k"] == whole["k"]
