"""The verdict: when an effect is named, nothing is missing, or something is that has no name."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from tracewire.trace.found import Dependence, Verdict
from tracewire.trace.told import verdict_of


def verdict(
    s2: float,
    gate: float = 1.0,
    *,
    before: float = 50.0,
    effects: int = 1,
    shares: tuple[float, ...] = (),
) -> Verdict:
    declared = SimpleNamespace(s2=before, length=100)
    best = SimpleNamespace(s2=s2, length=100, freedom=1000, effects=("effect",) * effects)
    dependences = [Dependence("force", ("q",), share) for share in shares]
    return verdict_of(declared, best, gate, dependences)  # type: ignore[arg-type]


def test_at_the_noise_it_is_what_was_found_there() -> None:
    assert verdict(1.05) == "effect"
    assert verdict(1.05, effects=0, before=1.05) == "null"


def test_unseen_windows_must_reach_the_noise_too() -> None:
    assert verdict(1.05, gate=4.0, before=3.0) == "unexplained"
    assert verdict(1.05, gate=4.0, before=1.05, effects=0) == "null", "nothing was fitted to choose"


def test_above_the_noise_an_effect_is_named_where_it_takes_most_away() -> None:
    assert verdict(5.0, gate=5.0) == "effect"
    assert verdict(25.0, gate=25.0) == "unexplained"


def test_what_is_left_and_depends_on_a_variable_is_unexplained() -> None:
    assert verdict(5.0, gate=5.0, shares=(0.1, 0.8)) == "unexplained"
    assert verdict(5.0, gate=5.0, shares=(0.1, 0.2)) == "effect"


@pytest.mark.parametrize("s2", [1.5, 20.0, 1e4])
def test_without_an_effect_what_is_above_the_noise_is_unexplained(s2: float) -> None:
    assert verdict(s2, gate=s2, effects=0, before=s2) == "unexplained"
