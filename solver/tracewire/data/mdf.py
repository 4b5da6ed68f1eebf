"""The columns of a measurement data file (ASAM MDF 3 and 4): channels; asammdf reads them."""

from __future__ import annotations

import io
from collections import Counter
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.data.quiet import Attempts
from tracewire.data.vectors import Column, Group
from tracewire.errors import DataError, Location
from tracewire.extras import import_extra

TIME = "time"


def groups_of_mdf(content: bytes, path: Path, place: Location) -> list[Group]:
    """The channel groups, each with its channels and its time in s, as `time`. A group has the name
    of its acquisition where there is one that no other has, else its number from 1."""
    asammdf = import_extra(
        "asammdf",
        "mdf",
        f"to read '{path}', a measurement data file (MDF)",
        error=DataError,
        place=place,
        otherwise="Or export it as CSV.",
    )

    attempt = Attempts("asammdf", "an MDF file", path, place)
    file = attempt(lambda: asammdf.MDF(io.BytesIO(content)))

    def read(group: int, index: int) -> NDArray[Any]:
        return np.asarray(attempt(lambda: file.get(group=group, index=index).samples))

    names = [_name(group) for group in file.groups]
    counts = Counter(names)
    found = []
    for g, group in enumerate(file.groups):
        master = file.masters_db.get(g)
        columns = [
            Column(
                TIME if c == master else channel.name,
                partial(read, g, c),
                "s" if c == master else str(getattr(channel, "unit", "") or ""),
            )
            for c, channel in enumerate(group.channels)
        ]
        name = names[g] if names[g] and counts[names[g]] == 1 else str(g + 1)
        found.append(Group(name if len(file.groups) > 1 else "", tuple(columns)))
    return found


def _name(group: Any) -> str:
    """The name of a group's acquisition, or ''."""
    name = getattr(group.channel_group, "acq_name", "")
    return name if isinstance(name, str) else ""
