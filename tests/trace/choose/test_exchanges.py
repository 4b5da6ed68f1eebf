"""Which effects of a model give way to others that look alike, and in what order."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Measured
from tracewire.solve import simulate
from tracewire.trace import trace
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


DOOR = """
span: [0, 12]
every: 0.02
record: [x]
parameters:
  k: {value: 60.0878, unit: N/m, fit: [10, 200]}
  c: {value: 20.3729, unit: N s/m, fit: [0, 100]}
blocks:
  x: {type: integrator, of: v, start: 0.9, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  closer: {type: stiffness, of: x, k: k}
  damper: {type: viscous, rate: v, c: c}
  force: {type: sum, of: [closer, damper], unit: N}
  a: {type: gain, of: force, k: 1/40}
"""


@pytest.mark.slow
def test_dry_friction_is_found_behind_a_stribeck_curve_that_was_fitted_more_easily() -> None:
    """A door that closes by itself, with a friction of 6 N: a fit from below ends at 4.86 N, where
    the door makes one move more, and leaves 17 times the noise; a Stribeck curve gets past it."""
    text = DOOR.replace("damper]", "damper, rub]")
    truth = compile(read_text(f"{text}  rub: {{type: coulomb, rate: v, level: 6}}\n"))
    rng, series = np.random.default_rng(3), []
    for name, use, x in (("release", "train", 0.9), ("other", "validate", 0.5)):
        run = simulate(truth, parameters={"k": 60.0, "c": 15.0}, start={"x": x})
        noisy = run["x"] + 1e-3 * rng.standard_normal(len(run.t))
        start = {"x": None, "v": None}
        series.append(Measured(name, use, run.t, {"x": noisy}, start=start))
    found = trace(compile(read_text(DOOR)), series, options={"only": ["force"]})
    assert [str(effect) for effect in found.effects] == [COULOMB]
    assert found.effects[0].params["level"] == pytest.approx(6.0, rel=0.01)
