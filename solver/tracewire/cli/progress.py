"""Progress of work that tells its stages in words: elapsed time, and the time left where known."""

from __future__ import annotations

import re
import time
from collections.abc import Callable

from tracewire.cli.limits import LIMITS
from tracewire.cli.output import clock

COUNTED = re.compile(r" \((\d+) of (\d+)\)$")
"""How a stage of several like parts ends its words: the part that begins now, and how many."""


def stages(show: Callable[[str], None]) -> Callable[[str], None]:
    """What tells each stage with the time since the start.

    Parts that are counted, `refitting with bias @ torque (3 of 9)`, also get the time that is left
    for them, from the mean of those that are done; other stages end when they end, and get none.
    """
    began = time.monotonic()
    first = (1, began)
    of = 0

    def tell(text: str) -> None:
        nonlocal first, of
        now = time.monotonic()
        left = ""
        if counted := COUNTED.search(text):
            part, parts = int(counted[1]), int(counted[2])
            if part <= first[0] or parts != of:
                first, of = (part, now), parts
            elif now - first[1] > LIMITS.soon:
                rest = (now - first[1]) / (part - first[0]) * (parts - part + 1)
                left = f", about {clock(rest)} left for these"
        show(f"{f'{now - began:.0f} s':>6}  {text}{left}")

    return tell
