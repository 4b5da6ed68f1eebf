"""Which effects of a model give way to others that look alike, and in what order."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from tracewire.trace.choose import exchanges
from tracewire.trace.options import TraceOptions

COULOMB, DRAG = "coulomb @ force", "quad_drag @ force"


def model(*names: str, rss: float) -> Any:
    return SimpleNamespace(names=frozenset(names), dropped=(), rss=rss)


def exchanged(monkeypatch: pytest.MonkeyPatch, spent: int, known: list[Any]) -> list[str]:
    """The effects that are exchanged in the best pair, in this order, and for what."""
    asked: list[str] = []

    def note(pool: Any, model: Any, name: str, others: list[str]) -> None:
        asked.append(f"{name} for {', '.join(others)}")

    monkeypatch.setattr(exchanges, "_alternatives", lambda pool, model, name: ["bias", DRAG])
    monkeypatch.setattr(exchanges, "_look_alikes", lambda pool, name: ["bias", "viscous"])
    monkeypatch.setattr(exchanges, "_replace_effect", note)
    best = model(COULOMB, DRAG, rss=1.0)
    pool: Any = SimpleNamespace(
        options=TraceOptions(),
        spent=spent,
        models={(one.names, ()): one for one in known},
        best=lambda size, count: [best],
    )
    exchanges.exchange_effects(pool, 2)
    return asked


def test_the_effect_that_takes_least_is_exchanged_first_and_in_any_case(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What stands beside a large effect was screened where that one hid much."""
    known = [model(COULOMB, rss=90.0), model(DRAG, rss=7.0)]
    both = [f"{COULOMB} for bias, viscous", f"{DRAG} for bias, viscous"]
    most = TraceOptions().most_steps
    assert exchanged(monkeypatch, 0, known) == both
    assert exchanged(monkeypatch, most + 1, known) == both[:1]
    assert exchanged(monkeypatch, most + 1, [model(DRAG, rss=90.0), model(COULOMB, rss=7.0)]) == [
        both[1]
    ]


def test_an_effect_without_which_nothing_is_known_comes_last(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (first, _) = exchanged(monkeypatch, 0, [model(COULOMB, rss=90.0)])
    assert first.startswith(DRAG)
