"""Steps of a drive: no fit follows where they are, and a scan beside the model does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from oracles.oscillator import search_of
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Measured
from tracewire.solve import Held
from tracewire.trace.options import TraceOptions
from tracewire.trace.search.search import Search
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.scanned_lengths import rescan_lengths
from tracewire.trace.trials.trial import TraceProblem, Trial

HEAT, LOSS, STEP, SIGMA = 0.5, 0.2, 0.4, 2e-3  # 1/J, 1/s, W, K
TEXT = """\
span: [0, 60]
inputs: {knob: {unit: W}}
parameters: {heat: {value: 0.4, fit: [0.1, 2]}, loss: {value: 0.3, unit: 1/s, fit: [0.01, 2]}}
blocks:
  warm: {type: integrator, of: rate, start: 0}
  cooling: {type: gain, of: warm, k: -loss}
  power: {type: gain, of: knob, k: heat}
  rate: {type: sum, of: [power, cooling]}
"""


def record(name: str, use: str, seed: int) -> Measured:
    """T' = heat*u - loss*T, where u is the knob in steps of STEP: exact, as it is held for a second
    each, on a grid of 0.1 s."""
    random = np.random.default_rng(seed)
    knob = np.repeat(random.uniform(-2, 2, 60), 10)
    power = HEAT * STEP * np.floor(knob / STEP + 0.5)
    fade, warm = np.exp(-LOSS * 0.1), [0.0]
    for heat in power[:-1]:
        warm.append(fade * warm[-1] + (1 - fade) * heat / LOSS)
    t = 0.1 * np.arange(len(knob))
    seen = np.array(warm) + SIGMA * random.standard_normal(len(t))
    return Measured(
        name, use, t, {"warm": seen}, inputs={"knob": Held(t, knob)},
        start={"warm": None},
    )  # fmt: skip


@pytest.fixture(scope="module")
def search() -> Search:
    model = compile(read_text(TEXT), record=["warm"])
    series = tuple(
        record(f"s{n}", use, n) for n, use in enumerate(["train", "train", "gate", "validate"])
    )
    return search_of(TraceProblem(model, series, {"warm": SIGMA}, 1e-8, options=TraceOptions()))


def with_step(search: Search, step: float) -> Trial:
    """The declared model with a drive in steps of this length, fitted."""
    declared = search.fit_declared()
    known = search.candidates(search.linearise(declared), [])
    (candidate,) = (c for c in known if c.effect == "drive_quantiser")
    effect = PlacedEffect(candidate, {"share": 0.8, "step": step})
    return search.problem.fit(
        (effect,), declared.windows.segments, declared.length, declared.values
    )


def test_a_fit_does_not_change_the_step(search: Search) -> None:
    trial = with_step(search, 0.39)
    assert trial.effects[0].values["step"] == 0.39
    assert "drive_quantiser.step" not in trial.values


@pytest.mark.parametrize("step", [0.39, 0.4, 0.412])
def test_the_step_is_that_of_a_scan_beside_the_model(search: Search, step: float) -> None:
    trial = with_step(search, step)
    found = rescan_lengths(search.problem, trial)
    assert found.effects[0].values["step"] == pytest.approx(STEP, rel=2e-3)
    assert found.effects[0].values["share"] == pytest.approx(1.0, abs=0.02)
    assert found.reduced_chi2 < 1.2
    assert found.rss <= trial.rss


def test_a_step_far_from_the_right_one_is_no_better_near_by(search: Search) -> None:
    trial = with_step(search, 1.3)
    assert rescan_lengths(search.problem, trial).rss <= trial.rss


def test_a_model_without_scanned_lengths_stays_as_it_is(search: Search) -> None:
    declared = search.fit_declared()
    assert rescan_lengths(search.problem, declared) is declared


def test_the_search_finds_the_step(search: Search) -> None:
    own = replace(search, words=[], steps=[])
    own.run(own.fit_declared())
    assert own.best is not None
    assert [str(effect) for effect in own.best.effects] == ["drive_quantiser @ drive.knob"]
    assert own.best.effects[0].values["step"] == pytest.approx(STEP, rel=2e-3)
