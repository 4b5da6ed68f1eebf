"""Refits begin again: at the declared values where the declared fit has moved far from them, and of
a lag at other sizes."""

from __future__ import annotations

from dataclasses import dataclass
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
    criterion = SimpleNamespace(parameters={})
    return SimpleNamespace(
        rss=rss, values=values, effects=(), windows=SimpleNamespace(criterion=criterion)
    )


@dataclass
class Effect:
    """An effect whose refits begin at some sizes of its coefficient."""

    size: float = 1.0
    sizes: tuple[float, ...] = (1.0,)

    @property
    def candidate(self) -> Any:
        return SimpleNamespace(parameter="tau", at_sizes=self.sizes)

    def with_value(self, name: str, value: float) -> Effect:
        assert name == "tau"
        return Effect(value, self.sizes)


class Pool(ModelPool):
    """A pool whose declared fit is given, and what each refit leaves, one after the other."""

    def __init__(self, now: Any, left: list[float]) -> None:
        problem = SimpleNamespace(declared=MODEL)
        search: Any = SimpleNamespace(problem=problem, tell=lambda text: None)
        none: Any = None
        super().__init__(search, none, TraceOptions())
        self.now, self.left = now, iter(left)
        self.begun: list[float] = []
        self.sizes: list[float] = []
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
        self.begun.append({**now.values, **(values or {})}["c"])
        self.sizes.append(added[0].size)
        return trial(next(self.left))

    def run_refit(
        self,
        now: Any,
        effects: Any,
        fixed: Any,
        steps: Any,
        target: Any,
        values: Any = None,
        segments: Any = None,
    ) -> Any:
        self.sizes.append(effects[-1].size)
        return trial(next(self.left))

    def _select_first_fits(self, now: Any, first_fits: Any, number: int) -> Any:
        self.first_fits += [one.rss for one in first_fits]
        return []


def proposal(name: str, *sizes: float) -> Any:
    row = SimpleNamespace(placed_effect=Effect(sizes=sizes or (1.0,)))
    return SimpleNamespace(names=[name], rows=[row], values={})


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


def test_a_lag_begins_at_each_of_its_sizes_and_the_best_fit_is_kept() -> None:
    pool = Pool(trial(9.0, k=31.0, c=11.0), [3.0, 1.0, 2.0])
    declared: Any = SimpleNamespace(names=frozenset(), dropped=())
    pool.extend(declared, 0, [proposal("lag", 1.0, 20.0, 60.0)])
    assert pool.sizes == [1.0, 20.0, 60.0]
    assert pool.first_fits == [1.0]


def test_no_other_size_is_tried_where_the_first_takes_nearly_all() -> None:
    pool = Pool(trial(9.0, k=31.0, c=11.0), [0.8])
    declared: Any = SimpleNamespace(names=frozenset(), dropped=())
    pool.extend(declared, 0, [proposal("lag", 1.0, 20.0, 60.0)])
    assert pool.sizes == [1.0]
    assert pool.first_fits == [0.8]


def test_beside_other_effects_it_begins_where_it_promises_to_be() -> None:
    pool = Pool(trial(9.0, k=31.0, c=11.0), [3.0])
    parent: Any = SimpleNamespace(names=frozenset({"rub"}), dropped=())
    pool.extend(parent, 0, [proposal("lag", 1.0, 20.0, 60.0)])
    assert pool.sizes == [1.0]
