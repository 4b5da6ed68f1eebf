"""Common laws go before waves that follow whatever is left."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tracewire.residual import Measured
from tracewire.trace.options import TraceOptions
from tracewire.trace.search.common import common_first, goes_with_motion, least_part, uncommon

OPTIONS = TraceOptions()
DECLARED: Any = SimpleNamespace(rss=10000.0)
SWING = 1.59
"""The period in s of the free motion."""


def swing(driven: bool = False) -> Measured:
    t = np.arange(0, 30, 0.02)
    drive = {"u": (t, np.sin(t))} if driven else {}
    x = np.exp(-t / 20) * np.sin(2 * np.pi * t / SWING)
    return Measured("swing", "train", t, {"x": x}, inputs=drive)


def trial(*effects: str, rss: float, period: float = 0.4, driven: bool = False) -> Any:
    """A trial with effects; waves have this period."""
    waves = {"harmonic", "parametric"}
    placed = [
        SimpleNamespace(
            candidate=SimpleNamespace(
                effect=name,
                lines=("period",) if name in waves else (),
                modulated={"period": "x"} if name == "parametric" else {},
            ),
            values={"period": period} if name in waves else {},
        )
        for name in effects
    ]
    windows = SimpleNamespace(segments=[SimpleNamespace(measured=swing(driven))])
    return SimpleNamespace(effects=placed, rss=rss, windows=windows)


def result(*effects: str, rss: float, numbers: int, period: float = 0.4) -> Any:
    return SimpleNamespace(
        trial=trial(*effects, rss=rss, period=period),
        proposal=SimpleNamespace(count=numbers),
        delta_bic=rss,
    )


@pytest.mark.parametrize(
    ("rss", "numbers", "queue"),
    [
        (1100.0, 3, [1, 0]),
        (1100.0, 4, [0, 1]),  # with more numbers
        (1500.0, 3, [0, 1]),  # leaves more than a thirtieth of what is missing
    ],
)
def test_a_common_law_that_leaves_hardly_more_than_a_wave_comes_first(
    rss: float, numbers: int, queue: list[int]
) -> None:
    results = [
        result("harmonic", rss=1000.0, numbers=3),
        result("coulomb", "cubic_stiffness", rss=rss, numbers=numbers),
    ]
    assert common_first([0, 1], results, DECLARED, OPTIONS) == queue


def test_a_law_is_not_exchanged_for_a_wave_and_an_empty_queue_stays_empty() -> None:
    results = [
        result("coulomb", rss=1000.0, numbers=1),
        result("harmonic", rss=1001.0, numbers=1),
    ]
    assert common_first([0, 1], results, DECLARED, OPTIONS) == [0, 1]
    assert common_first([], results, DECLARED, OPTIONS) == []


@pytest.mark.parametrize(
    ("name", "period", "goes"),
    [
        ("harmonic", 1.55, True),  # 0.5 lines of a record of 30 s from that of the motion
        ("harmonic", 1.4, False),
        ("parametric", 0.785, True),
        ("parametric", 1.59, False),
        ("coulomb", 1.59, False),
    ],
)
def test_a_wave_that_beats_with_a_free_motion_is_known(
    name: str, period: float, goes: bool
) -> None:
    """A damping or a stiffness that is nearly right leaves the same."""
    free = trial(name, rss=1.0, period=period)
    assert goes_with_motion(free, OPTIONS) == goes
    assert least_part(free, OPTIONS) == (OPTIONS.with_motion if goes else OPTIONS.material)
    assert not goes_with_motion(trial(name, rss=1.0, period=period, driven=True), OPTIONS)


def test_dry_friction_goes_before_a_wave_with_the_motion_although_it_leaves_more() -> None:
    results = [
        result("harmonic", rss=1000.0, numbers=3, period=1.55),
        result("dahl", rss=2000.0, numbers=3),
    ]
    assert common_first([0], results, DECLARED, OPTIONS) == [1, 0]
    assert [uncommon(one.trial, OPTIONS) for one in results] == [1, 0]
