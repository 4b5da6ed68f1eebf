"""The thresholds of measured data: how much is read, and from when on a record is remarked upon.

Where no source stands, a number is a judgement, checked on made and measured records by the tests.
"""

from __future__ import annotations

from typing import Final


class FileLimits:
    """Of what is read of a file, so that a damaged or hostile one fills no memory."""

    most_bytes: Final[int] = 200_000_000
    """Of a file."""
    most_unpacked: Final[int] = 1_000_000_000
    """Bytes of the arrays that a file holds, once they are unpacked."""
    most_depth: Final[int] = 20
    """Levels of groups, structures and cells that are read."""
    listed_depth: Final[int] = 6
    """Levels of these that are listed."""
    most_columns: Final[int] = 200
    """Columns of a matrix, entries of a cell array, and addresses that are listed."""
    sample_rows: Final[int] = 200
    """First rows that tell how a table is written."""
    most_texts: Final[int] = 1000
    """Values of a column among which a name that is not there may have been meant."""
    most_problems: Final[int] = 10
    """Of a file that are told."""
    most_told: Final[int] = 3
    """Places of a kind that a message names before it says how many more there are."""


FILE = FileLimits()


class CleaningLimits:
    """Of the steps that clean a record."""

    most_samples: Final[int] = 20_000_000
    """Of a record that is sampled anew."""
    uniform: Final[float] = 0.01
    """Of the interval: times that are off by more are not filtered."""
    fewest_for_spline: Final[int] = 5
    """Samples."""
    most_order: Final[int] = 20
    """Of a polynomial or a filter."""
    logarithms: Final[tuple[float, float]] = (-6.0, 12.0)
    """Between which the weight of a smoothing spline lies: beyond, rounding is larger than what the
    spline shall leave out."""
    most_at_once: Final[int] = 2_000_000
    """Samples of all windows whose medians are taken together: 16 MB."""


CLEANING = CleaningLimits()


class CheckLimits:
    """From when on samples are remarked upon."""

    jitter: Final[float] = 0.01
    """Of the median interval: times that are off by more are told."""
    gap: Final[float] = 3.0
    """Steps of this many medians are gaps."""
    moved: Final[float] = 0.05
    """The part of its range by which an input moves around a gap that matters."""
    far_zero: Final[float] = 10.0
    """A record that begins this many times its length from zero is told times of its own."""
    least_digits: Final[int] = 6
    """Of a time that is told ..."""
    most_digits: Final[int] = 15
    """... and as many as there are."""
    fewest_samples: Final[int] = 20
    """Less say nothing about how they were taken."""
    run: Final[int] = 4
    """Samples at the extreme value in a row of a clipped signal ..."""
    fewest_runs: Final[int] = 2
    """... in so many such runs ..."""
    clipped_share: Final[float] = 0.005
    """... that are this part of all samples ..."""
    abrupt: Final[float] = 3.0
    """... and are reached by a jump of so many smallest steps."""
    longest_pattern: Final[int] = 50
    """Samples between two own ones of a record from a lower rate, at most."""
    fewest_kinks: Final[int] = 20
    """Places that show such a pattern."""
    regular: Final[float] = 0.9
    """The part of them that keeps to it."""
    spike: Final[float] = 10.0
    """Times the range of nearly all samples is one away that stands alone."""
    fewest_codes: Final[int] = 2
    """Samples at exactly one value, as far away, are a code and no spike."""
    nearly_all: Final[tuple[float, float]] = (0.02, 0.98)
    """The quantiles between which these lie."""
    most_levels: Final[int] = 500
    """Of a signal that has steps, in units of the smallest."""
    fewest_levels: Final[int] = 5
    """Less are a square wave, or a switch."""


CHECK = CheckLimits()
