"""What is worth a refit, told from scores alone."""

from __future__ import annotations

import numpy as np
from tracewire.trace.candidates import Candidate
from tracewire.trace.screening import shortlist
from tracewire.trace.statistics import Screen

RANDOM = np.random.default_rng(5)
N = 1000
NAMES = ("one", "two", "three", "four", "five")


def candidates(sign: int = 0) -> list[Candidate]:
    return [Candidate(name, "place", name, sign) for name in NAMES]


def chosen(truth: dict[str, float], sign: int = 0, room: int = 2) -> list[set[str]]:
    columns = {name: RANDOM.normal(size=N) for name in NAMES}
    residual = RANDOM.normal(size=N)
    for name, coefficient in truth.items():
        residual = residual - coefficient * columns[name]
    screen = Screen(residual, np.zeros((N, 0)), columns, 1.0)
    return [{e.effect for e in p.effects} for p in shortlist(screen, candidates(sign), room, 5.0)]


def test_a_single_effect_is_proposed_alone() -> None:
    assert chosen({"two": 0.5}) == [{"two"}]


def test_two_effects_are_proposed_alone_and_together() -> None:
    found = chosen({"two": 0.5, "four": -0.4})
    assert {"two"} in found
    assert {"two", "four"} in found
    assert all(pair <= {"two", "four"} for pair in found)


def test_where_one_effect_has_room_no_pair_is_proposed() -> None:
    assert all(len(effects) == 1 for effects in chosen({"two": 0.5, "four": -0.4}, room=1))


def test_a_coefficient_of_the_wrong_sign_is_not_proposed() -> None:
    assert chosen({"two": -0.5}, sign=1) == []
    assert chosen({"two": 0.5}, sign=1) == [{"two"}]


def test_nothing_is_proposed_where_nothing_is() -> None:
    assert chosen({}) == []
