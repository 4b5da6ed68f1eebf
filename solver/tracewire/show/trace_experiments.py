"""A separating experiment as a sentence that an experimenter can follow, with units."""

from __future__ import annotations

from collections.abc import Mapping

from tracewire.formula import two_digits
from tracewire.show.limits import WORD
from tracewire.trace import Experiment, Found, users_unit

START, FREQUENCY = "start.", " frequency"
OF_DRIVES = (" mean", " amplitude", " held")


def setting_unit(found: Found, name: str) -> str:
    """The SI unit of a setting: that of the state or of the drive, or Hz; '' where unknown."""
    return "Hz" if name.endswith(FREQUENCY) else found.units.get(_signal(name), "")


def settings_words(found: Found, settings: Mapping[str, float]) -> str:
    """Settings in the units of the user's files: `start.theta = 12 deg`."""
    parts = []
    for name, value in settings.items():
        hertz = name.endswith(FREQUENCY)
        unit, factor = ("Hz", 1.0) if hertz else users_unit(found, _signal(name))
        parts.append(f"{name} = {value / factor:.4g} {unit}".rstrip())
    return ", ".join(parts)


def experiment_words(found: Found, experiment: Experiment) -> str:
    """What to do, by how much the two predictions then differ, and how much that depends on how
    well it is done; or that nothing within reach decides."""
    told = experiment.words.rstrip(".")
    if experiment.separation < found.options.experiment.decides:
        return f"{told}."
    keys = {*experiment.settings, "separation"}
    others = [row["separation"] for row in experiment.map if {"separation"} < row.keys() <= keys]
    if len(others) > 1:
        low, high = min(others), max(*others, experiment.separation)
        enough = WORD.least_separation
        least = f"{two_digits(low)}" if low >= enough else f"less than {enough:g}"
        told += f" (by {least} to {two_digits(high)} at the settings that were searched)"
    return f"{told}."


def _signal(name: str) -> str:
    """The state, or the drive, that a setting is of."""
    for end in OF_DRIVES:
        name = name.removesuffix(end)
    return name.removeprefix(START)
