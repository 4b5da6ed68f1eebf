"""Refits begin again at the declared values where the declared fit has moved far from them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
import tracewire as tw
from tracewire.diagram import read_text
from tracewire.trace.choose.model_pool import ModelPool
from tracewire.trace.options import TraceOptions

MODEL = tw.compile(
    read_text("""\
parameters: {k: {value: 30, fit: [1, 500]}, c: {value: 10, fit: [0.5, 200]}}
blocks:
  v: {type: integrator, of: a}
  a: {type: expression, formula: k - c*v}
""")
)


def trial(rss: float, **values: float) -> Any:
    return SimpleNamespace(rss=rss, values=values)


class Pool(ModelPool):
    """A pool whose declared fit is given, and what each refit leaves, one after the other."""

    def __init__(self, now: Any, left: list[float]) -> None:
        problem = SimpleNamespace(declared=MODEL)
        search: Any = SimpleNamespace(problem=problem, tell=lambda text: None)
        none: Any = None
        super().__init__(search, none, TraceOptions())
        self.now, self.left = now, iter(left)
        self.begun: list[float] = []
        self.first_fits: list[float] = []

    def on_sparse_windows(self, parent: Any, number: int) -> Any:
        return self.now

    def _refit(
        self,
        now: Any,
        added: Any,
        dropped: Any,
        steps: Any,
        target: Any,
        values: Any = None,
        segments: Any = None,
    ) -> Any:
        self.begun.append({**now.values, **values}["c"])
        return trial(next(self.left))

    def _select_first_fits(self, now: Any, first_fits: Any, number: int) -> Any:
        self.first_fits += [one.rss for one in first_fits]
        return []


def proposal(name: str) -> Any:
    return SimpleNamespace(names=[name], rows=[SimpleNamespace(placed_effect=name)], values={})


@pytest.mark.parametrize(
    ("c", "begun", "left"),
    [(200.0, [200.0, 200.0, 10.0], [1.0, 0.5]), (11.0, [11.0, 11.0], [1.0, 7.0])],
)
def test_an_effect_that_is_not_hopeful_begins_again_at_declared_values(
    c: float, begun: list[float], left: list[float]
) -> None:
    pool = Pool(trial(9.0, k=31.0, c=c), [1.0, 7.0, 0.5])
    declared: Any = SimpleNamespace(names=frozenset(), dropped=())
    pool.extend(declared, 0, [proposal("first"), proposal("second")])
    assert pool.begun == begun
    assert pool.first_fits == left
