"""Waves in time that keep the rhythm of a free motion stand for a law of the motion."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from oracles.oscillator import DIAGRAM, model_of, record
from tracewire.residual import Section
from tracewire.trace.choose.own_rhythm import describe_own_rhythm
from tracewire.trace.options import TraceOptions

PERIOD = 2 * np.pi / np.sqrt(25.0 - 0.01)
DRIVEN = DIAGRAM.replace("[spring, damper]", "[spring, damper, push]").replace(
    "  force:", "  push: {type: sine, amplitude: 1, omega: 5}\n  force:"
)


def effect(
    name: str, lines: tuple[str, ...] = ("period",), each: tuple[str, ...] = ("phase",)
) -> Any:
    candidate = SimpleNamespace(block=name, lines=lines, each=each)
    return SimpleNamespace(candidate=candidate)


def told(period: float, *effects: Any, text: str = DIAGRAM, end: float = 12.0) -> str:
    swing = record(end=end)
    search: Any = SimpleNamespace(
        options=TraceOptions(),
        problem=SimpleNamespace(declared=model_of(text)),
        data_split=SimpleNamespace(train=[Section(swing, 0, len(swing.t))]),
    )
    trial: Any = SimpleNamespace(
        effects=effects or (effect("wave"),),
        values={"wave.period": period},
        standard_errors={"wave.period": 1e-3 * period},
    )
    return describe_own_rhythm(search, trial)


@pytest.mark.parametrize("waves", [1, 2, 3])
def test_a_wave_with_the_period_of_the_motion_or_a_part_of_it_keeps_its_rhythm(waves: int) -> None:
    assert told(PERIOD / waves).endswith("its wave keeps the rhythm of the motion itself")


@pytest.mark.parametrize("waves", [0.5, 0.98, 1.5, 2.03, 4.0])
def test_a_wave_with_another_period_does_not(waves: float) -> None:
    assert told(PERIOD / waves) == ""


def test_no_wave_keeps_the_rhythm_of_what_is_driven() -> None:
    assert told(PERIOD, text=DRIVEN) == ""


def test_what_has_another_effect_beside_the_wave_is_not_asked() -> None:
    assert told(PERIOD, effect("wave"), effect("rub", (), ())) == ""
    assert told(PERIOD, effect("load", ("period",), ())) == "", "a mass on a spring is no wave"


def test_a_record_of_less_than_three_swings_has_no_rhythm() -> None:
    assert told(PERIOD, end=1.5 * PERIOD) == ""
