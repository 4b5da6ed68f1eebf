"""A delay that is half of the time between samples: of an input that is held, and read as lines."""

from __future__ import annotations

from collections.abc import Iterable

from tracewire.residual import Measured, looks_held
from tracewire.solve import Held
from tracewire.trace.data_thresholds import CheckOptions


def describe_held_input(
    place: str, delay: float, measured: Iterable[Measured], options: CheckOptions
) -> str:
    """What to do about a delay, or a lag, that a held input would imitate; '' where none would.

    An input whose values act until the next sample is late by half of the time between samples,
    where straight lines between its samples stand for it. `place`: where the delay was found;
    `delay` in s.
    """
    for m in measured:
        half = m.interval / 2
        if not abs(delay - half) <= options.near_half * half:
            continue
        for name, points in m.inputs.items():
            elsewhere = place.startswith("drive.") and place != f"drive.{name}"
            if elsewhere or isinstance(points, Held) or not looks_held(points[1]):
                continue
            return (
                f"{delay:.3g} s is half of the time between samples, and the input '{name}' looks "
                "held: say hold: previous for it, and trace again"
            )
    return ""
