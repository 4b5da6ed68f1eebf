"""What each of several named effects takes away beside the others is told where it is little."""

from __future__ import annotations

from typing import Any

import pytest
from tracewire.trace.choose.choice import Choice, Entrant
from tracewire.trace.choose.prediction import Prediction
from tracewire.trace.options import TraceOptions
from tracewire.trace.results.result import _small_share

DRY, DRIFT, PLAY = "coulomb @ forces", "sensor_drift @ sensor.v", "play @ forces"
LEFT = {
    (): (1.0, 1.0),
    (DRY,): (0.05, 0.09),
    (DRIFT,): (0.7, 0.5),
    (DRY, DRIFT): (0.02, 0.04),
    (PLAY, DRY): (0.02, 0.04),
    (PLAY,): (float("nan"), 0.3),
}
"""The part of the declared model's squared error that is left at two horizons, by effects."""


def shares(*names: str) -> dict[str, float]:
    entrants = tuple(Entrant(frozenset(of), 2 + len(of), left=left) for of, left in LEFT.items())
    choice = Choice([*LEFT].index(names), 0.0, 0.0, True, ())
    horizons: Any = None
    screen: Any = None
    errors: Any = None
    return Prediction(horizons, (), errors, choice, screen, entrants, TraceOptions()).shares()


def test_the_share_of_an_effect_is_what_comes_back_without_it() -> None:
    found = shares(DRY, DRIFT)
    assert found == pytest.approx({DRIFT: 0.04, DRY: (0.68 + 0.46) / 2})


def test_of_what_was_not_compared_no_share_is_known() -> None:
    assert shares(PLAY, DRY) == pytest.approx({PLAY: 0.04})


@pytest.mark.parametrize("names", [(DRY,), ()])
def test_one_effect_has_no_share(names: tuple[str, ...]) -> None:
    assert shares(*names) == {}


@pytest.mark.parametrize(
    ("share", "words"),
    [
        (
            0.038,
            "coulomb @ forces takes 3.8 % of the squared error that was missing: so small",
        ),
        (
            -0.01,
            "coulomb @ forces takes 0 % of the squared error that was missing: so small",
        ),
        (0.2, ""),
        (None, ""),
    ],
)
def test_a_small_share_is_told(share: float | None, words: str) -> None:
    found = _small_share(DRY, share, TraceOptions())
    assert found.startswith(words)
    assert bool(found) == bool(words)
