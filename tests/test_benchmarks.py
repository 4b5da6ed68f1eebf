"""What the benchmarks' times rest on: who runs when."""

from __future__ import annotations

from benchmarks.measure import Entrant, in_turn


def entrant(name: str, seconds: float, order: list[str]) -> Entrant:
    """One whose runs take so long, and write its name."""

    def run() -> float:
        order.append(name)
        return seconds

    return Entrant(name, run)


def test_all_runs_of_a_fast_entrant_are_spread_over_those_of_a_slow_one() -> None:
    order: list[str] = []
    fast, slow = entrant("fast", 1.0, order), entrant("slow", 4.0, order)
    in_turn([fast, slow], 20.0)
    assert len(fast.times) == 20
    assert len(slow.times) == 5
    turns = "".join(name[0] for name in order).split("s")
    assert [len(runs) for runs in turns] == [1, 5, 5, 5, 4, 0]


def test_an_entrant_that_is_slower_than_its_time_runs_once() -> None:
    order: list[str] = []
    in_turn([entrant("fast", 1.0, order), entrant("slow", 30.0, order)], 3.0)
    assert order == ["fast", "slow", "fast", "fast"]
