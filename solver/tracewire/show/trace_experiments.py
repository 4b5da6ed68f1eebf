"""A separating experiment as a sentence that an experimenter can follow, with units."""

from __future__ import annotations

from collections.abc import Mapping

from tracewire.show.limits import WORD
from tracewire.trace import Experiment, Found

START, AMPLITUDE, FREQUENCY = "start.", " amplitude", " frequency"


def setting_unit(found: Found, name: str) -> str:
    """The SI unit of a setting: that of the state or of the drive, or Hz; '' where unknown."""
    if name.endswith(FREQUENCY):
        return "Hz"
    return found.units.get(name.removeprefix(START).removesuffix(AMPLITUDE), "")


def settings_words(found: Found, settings: Mapping[str, float]) -> str:
    """Settings with their units: `start.theta = 0.2 rad`."""
    return ", ".join(
        f"{name} = {value:.4g} {setting_unit(found, name)}".rstrip()
        for name, value in settings.items()
    )


def experiment_words(found: Found, experiment: Experiment) -> str:
    """What to do, by how much the two predictions then differ, and how much that depends on how
    well it is done; or that nothing within reach decides."""
    how = _how(found, experiment)
    if experiment.separation < found.options.experiment.decides or not how:
        return f"{experiment.words.rstrip('.')}."
    told = (
        f"To decide between {experiment.one} and {experiment.other}: {how}. The predictions then "
        f"differ by {experiment.separation:.2g} times the sensor noise"
    )
    keys = {*experiment.settings, "separation"}
    others = [row["separation"] for row in experiment.map if {"separation"} < row.keys() <= keys]
    if len(others) > 1:
        low, high = min(others), max(*others, experiment.separation)
        enough = WORD.least_separation
        least = f"{low:.2g}" if low >= enough else f"less than {enough:g}"
        told += f" (by {least} to {high:.2g} at the settings that were searched)"
    return f"{told}."


def _how(found: Found, experiment: Experiment) -> str:
    settings = experiment.settings
    if settings and all(name.startswith(START) for name in settings):
        places = " and ".join(
            f"{name.removeprefix(START)} = {value:.4g} {setting_unit(found, name)}".rstrip()
            for name, value in settings.items()
        )
        off = "no drive, " if "without drive" in experiment.words else ""
        return f"{off}release it from rest at {places}"
    drive = next((n.removesuffix(AMPLITUDE) for n in settings if n.endswith(AMPLITUDE)), "")
    if not drive or f"{drive}{FREQUENCY}" not in settings:
        return ""
    amplitude, frequency = (settings[f"{drive}{end}"] for end in (AMPLITUDE, FREQUENCY))
    size = f"{amplitude:.4g} {setting_unit(found, f'{drive}{AMPLITUDE}')}".rstrip()
    return f"start at rest, and drive '{drive}' with a sine of {size} at {frequency:.4g} Hz"
