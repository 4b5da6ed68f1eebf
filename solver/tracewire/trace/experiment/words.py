"""A separating experiment as sentences that an experimenter can follow, in the units of the user's
files."""

from __future__ import annotations

from collections.abc import Callable

from tracewire.formula import two_digits
from tracewire.trace.experiment.rig import Design, Rig

Units = Callable[[str], tuple[str, float]]
"""The unit of a signal in the user's files, and its factor to SI."""
ALIASES = {
    ("bias", "sensor_offset"): "Turn the sensor by a known angle, or rest the part at a second "
    "equilibrium: an offset stays with the sensor, a torque does not",
    ("bias", "coulomb"): "Let it move the other way: a friction turns with the motion, a constant "
    "force does not",
    ("inertia", "sensor_gain"): "Weigh the part, or calibrate the sensor",
    ("drive_gain", "inertia"): "Weigh the part, or calibrate the drive",
    ("drive_gain", "sensor_gain"): "Calibrate the sensor, or the drive",
    ("backlash", "barrier"): "Beside a free stiffness they are the same law: what a barrier adds "
    "outside its gap, a stiffer spring with backlash lacks inside it",
}
"""What tells effects apart that are the same law on a rig."""


def decision(
    rig: Rig, design: Design, separation: float, one: str, other: str, units: Units
) -> str:
    """What to do, and by how much the predictions then differ; or that nothing decides."""
    how = instruction(rig, design, units)
    if separation >= rig.options.decides:
        return (
            f"To decide between {one} and {other}: {how}. The predictions then differ by "
            f"{two_digits(separation)} times the sensor noise."
        )
    hint = alias_hint(one, other) if separation < rig.options.alike else ""
    none = none_within(one, other)
    return (
        f"{none[:1].upper()}{none[1:]}: the best one ({how}) makes them differ by "
        f"{two_digits(separation)} times the sensor noise.{f' {hint}.' if hint else ''}"
    )


def none_within(one: str, other: str) -> str:
    """That no experiment within reach decides."""
    return f"within the range of these records no experiment tells {one} from {other}"


def alias_hint(one: str, other: str) -> str:
    """What tells two effects apart that are the same law; '' where nothing is known."""
    first, second = sorted(label.split(" @ ")[0] for label in (one, other))
    return ALIASES.get((first, second), "")


def instruction(rig: Rig, design: Design, units: Units) -> str:
    """What to do."""

    def amount(signal: str, value: float) -> str:
        unit, factor = units(signal)
        return f"{value / factor:.4g} {unit}".rstrip()

    start = rig.start(design)
    held = [f"'{name}' held at {amount(name, v)}" for name, v in rig.held(design).items()]
    beside = f", with {' and '.join(held)}" if held else ""
    if not design.drive:
        places = " and ".join(f"{name} = {amount(name, start[name])}" for name in rig.width)
        off = _are_switched_off(rig)
        none = "no drive, " if off and not held else ""
        beside += " and no other drive" if off and held else ""
        return f"{none}release it from rest at {places}{beside}"
    drive = rig.drives[design.drive]
    off_zero = [
        f"{name} = {amount(name, start[name])}"
        for name, width in rig.width.items()
        if abs(start[name]) > rig.options.off_zero * abs(width)
    ]
    at = f" at {' and '.join(off_zero)}" if off_zero else ""
    begin = f"begin as '{rig.begins}' does" if rig.begins else f"start at rest{at}"
    around = f" around {amount(design.drive, drive.centre)}" if drive.centre else ""
    sine = f"a sine of {amount(design.drive, design.amplitude)}{around}"
    also = rig.rates.get(design.drive)
    beside += f"; '{also}' is its rate" if also else ""
    return f"{begin}, and drive '{design.drive}' with {sine} at {design.frequency:.4g} Hz{beside}"


def _are_switched_off(rig: Rig) -> bool:
    """Whether there are drives that are off where nothing is driven; the rate of one that is held
    is none of its own."""
    return any(
        drive.largest > 0 and not drive.off
        for name, drive in rig.drives.items()
        if name not in rig.rates.values()
    )
