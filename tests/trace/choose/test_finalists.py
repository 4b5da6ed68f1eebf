"""Which models of the search come into the choice."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from tracewire.trace.choose.finalists import _search_models, _simplify
from tracewire.trace.options import TraceOptions


def pool_of(steps: list[Any], best: Any) -> Any:
    search = SimpleNamespace(steps=steps, best=best)
    return SimpleNamespace(search=search, options=TraceOptions())


def trial(*effects: str) -> Any:
    return SimpleNamespace(effects=effects)


def test_the_models_along_the_path_of_a_search_are_compared() -> None:
    """Where the declared fit is stuck, the path alone knows the pair: a third effect that it took
    besides may be refused."""
    declared, one, two, three, other = (
        trial(),
        trial("stiffness"),
        trial("stiffness", "position_friction"),
        trial("stiffness", "position_friction", "harmonic"),
        trial("coulomb"),
    )
    refits = [SimpleNamespace(trial=t) for t in (one, other)]
    steps = [
        SimpleNamespace(before=declared, refits=refits),
        SimpleNamespace(before=one, refits=[]),
        SimpleNamespace(before=two, refits=[]),
        SimpleNamespace(before=three, refits=[]),
    ]
    found = _search_models(pool_of(steps, three))
    assert found[: len(refits)] == [one, other]
    assert found[len(refits) :] == [one, two, three]


def test_a_search_that_took_nothing_has_no_path() -> None:
    declared, one = trial(), trial("coulomb")
    steps = [SimpleNamespace(before=declared, refits=[SimpleNamespace(trial=one)])]
    assert _search_models(pool_of(steps, declared)) == [one]


def test_models_of_each_size_are_simplified() -> None:
    asked: list[tuple[int, int]] = []

    def best(size: int, count: int) -> list[Any]:
        asked.append((size, count))
        return []

    pool: Any = SimpleNamespace(options=TraceOptions(effects=4), first=[], best=best)
    _simplify(pool)
    assert asked == [(1, 2), (1, 1), (2, 1), (2, 1), (3, 1), (3, 1), (4, 1), (4, 1)]
