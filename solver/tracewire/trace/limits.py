"""What a trace takes for rounding, and how much it works on at once: nothing that decides what is
missing. Thresholds that do stand in `TraceOptions`."""

from __future__ import annotations

from typing import Final


class RoundingLimits:
    """Below these parts nothing is told from rounding."""

    on_bound: Final[float] = 1e-6
    """Of the size of a value: nearer to its bound it sits there."""
    seen: Final[float] = 1e-10
    """The part of a column's square from which on it is seen beside what window starts imitate."""
    absorbed: Final[float] = 1e-6
    """The part of a column's square beyond which the unknowns that are there imitate it."""
    same: Final[float] = 1 - 1e-6
    """The canonical correlation from which on two effects are one and the same on these data."""
    flat: Final[float] = 1e-12
    """Of the largest information: what a direction of values has less is nothing."""
    direction: Final[float] = 1e-8
    """Of the largest singular value of columns of length 1: a direction that has less is none."""
    negligible: Final[float] = 1e-9
    """A bound on a p-value below which no better one is sought."""


ROUNDING = RoundingLimits()


class BatchSizes:
    """How much is worked on at once, for memory and speed."""

    lengths: Final[int] = 64
    """Lengths of waves."""
    torques: Final[int] = 2_000_000
    """Numbers of torques."""
    rows: Final[int] = 64
    """Rows of a projection."""
    map_rows: Final[int] = 2000
    """Rows of a map of the residual."""
    map_columns: Final[int] = 100
    """Columns of such a map."""


BATCH = BatchSizes()


class MessageLimits:
    """Of what a reader is told."""

    most_names: Final[int] = 6
    """Places, or blocks, that one sentence names."""


MESSAGE = MessageLimits()
