"""Times that are dates (ISO 8601): to seconds from the earliest of them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector

NANO = 1_000_000_000
EPOCH = datetime(1970, 1, 1)
DATE = re.compile(
    r"(\d{4}-\d{2}-\d{2})(?:[T ](\d{2}:\d{2}(?::\d{2})?)(?:[.,](\d+))?)?"
    r"(?: ?(Z|[+-]\d{2}(?::?\d{2})?))?"
)


class Instant(NamedTuple):
    """A date: nanoseconds since 1970, in UTC where it has a zone."""

    nanoseconds: int
    has_zone: bool


def read_date(text: str) -> Instant | None:
    """The instant of an ISO 8601 date such as 2024-03-12T12:00:01.5+01:00, or None.

    A blank may stand for the T; without a time of the day it is midnight.
    """
    match = DATE.fullmatch(text)
    if match is None:
        return None
    day, clock, fraction, zone = match.groups()
    try:
        moment = datetime.fromisoformat(f"{day}T{clock or '00:00'}")
    except ValueError:  # the 30th of February
        return None
    seconds = round((moment - EPOCH) / timedelta(seconds=1))
    if zone not in (None, "Z"):
        hours, minutes = int(zone[1:3]), int(zone[3:].lstrip(":") or 0)
        seconds -= (hours * 3600 + minutes * 60) * (-1 if zone[0] == "-" else 1)
    return Instant(seconds * NANO + int((fraction or "")[:9].ljust(9, "0")), zone is not None)


def read_dates(texts: Sequence[str]) -> tuple[NDArray[np.int64], bool] | None:
    """Nanoseconds since 1970 (N,) of dates, and whether they have a zone; None where one is no date
    or only some have a zone."""
    instants = [read_date(text) for text in texts]
    dates = [instant for instant in instants if instant is not None]
    zones = {date.has_zone for date in dates}
    if len(dates) < len(instants) or len(zones) != 1:
        return None
    return np.array([date.nanoseconds for date in dates], dtype=np.int64), zones.pop()


def seconds_since_first(nanoseconds: NDArray[np.int64], has_zone: bool) -> tuple[Vector, str]:
    """Times (N,) in s from the earliest instant on, and that instant as text."""
    first = int(nanoseconds.min())
    since = (nanoseconds - first) / NANO
    moment = EPOCH + timedelta(microseconds=first // 1000)
    shown = moment.replace(tzinfo=UTC).isoformat() if has_zone else moment.isoformat()
    return since, shown.replace("+00:00", "Z")
