"""The columns of a TDMS file of LabVIEW: channels in groups; npTDMS reads them."""

from __future__ import annotations

import io
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.data.quiet import Attempts
from tracewire.data.vectors import Column, Group
from tracewire.errors import DataError, Location
from tracewire.extras import import_extra

UNITS = ("unit_string", "NI_UnitDescription", "unit")
INTERVAL = "wf_increment"
TIME = "time"


def groups_of_tdms(content: bytes, path: Path, place: Location) -> list[Group]:
    """The groups with their channels. A waveform says the interval of its samples; where a group
    has one and no channel `time`, that is a column, in s from the trigger on."""
    nptdms = import_extra(
        "nptdms",
        "tdms",
        f"to read '{path}', a TDMS file",
        error=DataError,
        place=place,
        otherwise="Or export it as text.",
    )

    attempt = Attempts("nptdms", "a TDMS file", path, place)

    def read(channel: Any) -> NDArray[Any]:
        return np.asarray(attempt(lambda: channel[:]))

    file = attempt(lambda: nptdms.TdmsFile.read(io.BytesIO(content)))
    cut = [record for record in attempt.logged if not record.name.endswith("types")]
    if cut:  # what it says of types is of characters in names
        raise attempt.damaged(cut[0].getMessage())
    found = []
    for group in attempt(file.groups):
        channels = group.channels()
        columns = [
            Column(channel.name, partial(read, channel), _unit(channel.properties))
            for channel in channels
        ]
        waves = (channel for channel in channels if INTERVAL in channel.properties)
        if (wave := next(waves, None)) and TIME not in {column.head for column in columns}:
            columns.append(Column(TIME, partial(attempt, wave.time_track), "s"))
        found.append(Group(group.name, tuple(columns)))
    return [group for group in found if group.columns]


def _unit(properties: Any) -> str:
    return next((str(properties[name]) for name in UNITS if properties.get(name)), "")
