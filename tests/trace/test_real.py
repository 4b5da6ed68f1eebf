"""Traces of real measurements, where they are at hand: what the pages in diagrams/real say."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.trace import Found, trace

from benchmarks.tracing.sets import SHARED, lay_out

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not SHARED.is_dir(), reason="the measured series are not here"),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("openpyxl")
    return tmp_path_factory.mktemp("real")


def traced(path: str, folder: Path) -> Found:
    """The trace of a diagram of diagrams/real, on the files at hand."""
    lay_out(path.partition("/")[0], folder)
    return trace(compile(read(folder / path)))


@pytest.mark.parametrize("ball", ["golf_ball", "bowling_ball"])
def test_a_heavy_ball_stays_clean(ball: str, folder: Path) -> None:
    found = traced(f"falling_balls/{ball}.yaml", folder)
    assert found.verdict == "null"
    assert not found.effects


@pytest.mark.parametrize(("ball", "after"), [("whiffle_ball", 0.115), ("tennis_ball", 0.27)])
def test_a_light_ball_is_slowed_in_proportion_to_its_speed(
    ball: str, after: float, folder: Path
) -> None:
    found = traced(f"falling_balls/{ball}.yaml", folder)
    assert found.verdict == "effect"
    assert [effect.name for effect in found.effects] == ["viscous"]
    assert found.rmse_after == pytest.approx(after, rel=0.05), "of the second drop"
    assert found.rmse_before > 4 * found.rmse_after


def test_a_gyro_does_not_show_zero_at_rest(folder: Path) -> None:
    found = traced("bicycle_wheel_pendulum/axial.yaml", folder)
    assert found.verdict == "effect"
    (effect,) = found.effects
    assert (effect.name, effect.place) == ("sensor_offset", "sensor.omega")
    assert effect.params["offset"] == pytest.approx(-0.0306, rel=0.05)


def test_a_small_swing_sticks(folder: Path) -> None:
    found = traced("multiarm_pendulum/small.yaml", folder)
    assert found.verdict == "effect"
    friction, *others = found.effects
    assert friction.name in {"coulomb", "lugre", "dahl", "hysteresis", "bouc_wen"}, "it sticks"
    assert friction.params["level"] == pytest.approx(0.163, rel=0.1), "as in the large swing"
    for small in others:  # the angle does not count from where the body hangs
        assert "bias" in {small.name, *(tie.name for tie in small.ties)}
    assert found.dropped == ("c",), "the declared viscous friction stood in for it"
    assert found.explained is not None and found.explained.low > 0.9
    (swing,) = (e for e in found.errors if (e.use, e.kind) == ("train", "free run"))
    assert swing.after < 0.2 * swing.before
    assert any("before it settles" in words for words in found.words)


def test_a_motor_has_seven_waves_of_torque_on_a_turn(folder: Path) -> None:
    found = traced("motor_cogging/turn.yaml", folder)
    assert found.verdict == "effect"
    first = found.effects[0]
    assert first.name == "cogging"
    assert first.params["pitch"] == pytest.approx(2 * np.pi / 7, rel=0.01)
