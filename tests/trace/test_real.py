"""Traces of real measurements, where they are at hand: what the pages in diagrams/real say."""

from __future__ import annotations

from pathlib import Path

import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.trace import Found, trace

ROOT = Path(__file__).parents[2]
REAL = ROOT / "diagrams/real"
DATA = ROOT.parent / "shared/data"
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not DATA.is_dir(), reason="the measured series are not here"),
]
FILES = {
    "data/drops.csv": "falling_balls/derived_drops.csv",
    "data/bicycle": "bicycle_wheel_pendulum/bicycle",
    "data/swing_small.csv": "multiarm_pendulum/derived_freeswing_small_200Hz.csv",
    "time: t\n": "time: t_s\n",
    "theta: theta}": "theta: theta_from_hanging_rad}",
}


def traced(path: str) -> Found:
    text = (REAL / path).read_text()
    small = path.startswith("multiarm")
    for old, new in FILES.items():
        if old.startswith("data/"):
            text = text.replace(old, str(DATA / new))
        elif small:
            text = text.replace(old, new)
    return trace(compile(read_text(text)))


@pytest.mark.parametrize("ball", ["golf_ball", "bowling_ball"])
def test_a_heavy_ball_stays_clean(ball: str) -> None:
    found = traced(f"falling_balls/{ball}.yaml")
    assert found.verdict == "null"
    assert not found.effects


@pytest.mark.parametrize(("ball", "after"), [("whiffle_ball", 0.115), ("tennis_ball", 0.27)])
def test_a_light_ball_is_slowed_in_proportion_to_its_speed(ball: str, after: float) -> None:
    found = traced(f"falling_balls/{ball}.yaml")
    assert found.verdict == "effect"
    assert [effect.name for effect in found.effects] == ["viscous"]
    assert found.rmse_after == pytest.approx(after, rel=0.05), "of the second drop"
    assert found.rmse_before > 4 * found.rmse_after


def test_a_gyro_does_not_show_zero_at_rest() -> None:
    found = traced("bicycle_wheel_pendulum/axial.yaml")
    assert found.verdict == "effect"
    (effect,) = found.effects
    assert (effect.name, effect.place) == ("sensor_offset", "sensor.omega")
    assert effect.params["offset"] == pytest.approx(-0.0306, rel=0.05)


@pytest.mark.xfail(reason="far above the estimated noise it adds more than dry friction")
def test_a_small_swing_sticks() -> None:
    found = traced("multiarm_pendulum/small.yaml")
    assert found.verdict == "effect"
    (effect,) = found.effects
    assert effect.name in {"coulomb", "lugre", "dahl", "hysteresis"}, "dry friction that sticks"
    assert effect.params["level"] == pytest.approx(0.163, rel=0.05)
    assert found.rmse_after < 0.3 * found.rmse_before
