"""What an experimenter is told to do."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tracewire.residual import Measured
from tracewire.trace.experiment.drives import Drive
from tracewire.trace.experiment.rig import Design, Rig
from tracewire.trace.experiment.words import decision, instruction

T = np.arange(0.0, 1.0, 0.1)
UNITS = {"q": ("deg", np.pi / 180), "fan": ("mN", 1e-3), "rope": ("mm", 1e-3)}


def units(signal: str) -> tuple[str, float]:
    return UNITS.get(signal, ("", 1.0))


def rig(**drives: Drive) -> Rig:
    """A pendulum that went from 0 to 20 degrees, with drives."""
    values: dict[str, Any] = dict.fromkeys(drives, (T, 0 * T))
    return Rig(
        t=T,
        rest={"q": 0.0, "v": 0.0},
        width={"q": np.pi / 9},
        drives=drives,
        rates={},
        drive_parameters={},
        frequency=1.0,
        template=Measured("run", "train", T, {"q": T}, inputs=values),
        ranges={"q": (0.0, np.pi / 9)},
    )


FAN, ROPE = Drive(0.0, 0.05, 0.0), Drive(0.9, 0.2, 0.9)


@pytest.mark.parametrize(
    ("drives", "words"),
    [
        ({}, "release it from rest at q = 10 deg"),
        ({"fan": FAN}, "no drive, release it from rest at q = 10 deg"),
        ({"rope": ROPE}, "release it from rest at q = 10 deg, with 'rope' held at 900 mm"),
        (
            {"rope": ROPE, "fan": FAN},
            "release it from rest at q = 10 deg, with 'rope' held at 900 mm and no other drive",
        ),
    ],
)
def test_a_release_says_where_and_what_the_drives_do(drives: dict[str, Drive], words: str) -> None:
    assert instruction(rig(**drives), Design(release=0.5), units) == words


def test_a_sine_says_where_it_begins_and_around_what_it_swings() -> None:
    driven = Design(0.0, "fan", 0.02, 0.5)
    assert instruction(rig(fan=FAN), driven, units) == (
        "start at rest, and drive 'fan' with a sine of 20 mN at 0.5 Hz"
    )
    away = replace(rig(fan=replace(FAN, centre=0.03)), rest={"q": np.pi / 18, "v": 0.0})
    assert instruction(away, driven, units) == (
        "start at rest at q = 10 deg, and drive 'fan' with a sine of 20 mN around 30 mN at 0.5 Hz"
    )
    tank = replace(rig(fan=FAN), width={}, begins="fire_1")
    assert instruction(tank, driven, units) == (
        "begin as 'fire_1' does, and drive 'fan' with a sine of 20 mN at 0.5 Hz"
    )
    both = replace(rig(rope=ROPE, speed=FAN), rates={"rope": "speed"})
    assert instruction(both, Design(0.0, "rope", 0.1, 0.2), units) == (
        "start at rest, and drive 'rope' with a sine of 100 mm around 900 mm at 0.2 Hz; 'speed' is "
        "its rate"
    )


def test_by_how_much_it_decides_or_that_nothing_does() -> None:
    released = Design(release=0.5)
    told = decision(rig(), released, 12.0, "coulomb @ sum", "stribeck @ sum", units)
    assert told == (
        "To decide between coulomb @ sum and stribeck @ sum: release it from rest at q = 10 deg. "
        "The predictions then differ by 12 times the sensor noise."
    )
    told = decision(rig(), released, 0.01, "coulomb @ sum", "bias @ sum", units)
    assert told == (
        "Within the range of these records no experiment tells coulomb @ sum from bias @ sum: the "
        "best one (release it from rest at q = 10 deg) makes them differ by 0.01 times the sensor "
        "noise. Let it move the other way: a friction turns with the motion, a constant force does "
        "not."
    )
