"""The thresholds of measured data: how much is read, and from when on a record is remarked upon.

Where no source stands, a number is a judgement, checked on made and measured records by the tests.
"""

from __future__ import annotations

from typing import NamedTuple


class FileLimits(NamedTuple):
    """Of what is read of a file, so that a damaged or hostile one fills no memory."""

    most_bytes: int = 200_000_000
    """Of a file."""
    most_unpacked: int = 1_000_000_000
    """Bytes of the arrays that a file holds, once they are unpacked."""
    most_depth: int = 20
    """Levels of groups, structures and cells that are read."""
    listed_depth: int = 6
    """Levels of these that are listed."""
    most_columns: int = 200
    """Columns of a matrix, entries of a cell array, and addresses that are listed."""
    sample_rows: int = 200
    """First rows that tell how a table is written."""
    most_texts: int = 1000
    """Values of a column among which a name that is not there may have been meant."""
    most_problems: int = 10
    """Of a file that are told."""
    most_told: int = 3
    """Places of a kind that a message names before it says how many more there are."""


FILE = FileLimits()


class StepLimits(NamedTuple):
    """Of the steps that clean a record."""

    most_samples: int = 20_000_000
    """Of a record that is sampled anew."""
    uniform: float = 0.01
    """Of the interval: times that are off by more are not filtered."""
    fewest_for_spline: int = 5
    """Samples."""
    most_order: int = 20
    """Of a polynomial or a filter."""
    logarithms: tuple[float, float] = (-6.0, 12.0)
    """Between which the weight of a smoothing spline lies: beyond, rounding is larger than what the
    spline shall leave out."""
    most_at_once: int = 2_000_000
    """Samples of all windows whose medians are taken together: 16 MB."""


STEP = StepLimits()


class CheckLimits(NamedTuple):
    """From when on samples are remarked upon."""

    jitter: float = 0.01
    """Of the median interval: times that are off by more are told."""
    gap: float = 3.0
    """Steps of this many medians are gaps."""
    far_zero: float = 10.0
    """A record that begins this many times its length from zero is told times of its own."""
    least_digits: int = 6
    """Of a time that is told ..."""
    most_digits: int = 15
    """... and as many as there are."""
    fewest_samples: int = 20
    """Less say nothing about how they were taken."""
    run: int = 4
    """Samples at the extreme value in a row of a clipped signal ..."""
    fewest_runs: int = 2
    """... in so many such runs ..."""
    clipped_share: float = 0.005
    """... that are this part of all samples ..."""
    abrupt: float = 3.0
    """... and are reached by a jump of so many smallest steps."""
    longest_pattern: int = 50
    """Samples between two own ones of a record from a lower rate, at most."""
    fewest_kinks: int = 20
    """Places that show such a pattern."""
    regular: float = 0.9
    """The part of them that keeps to it."""
    spike: float = 10.0
    """Times the range of nearly all samples is one away that stands alone."""
    nearly_all: tuple[float, float] = (0.02, 0.98)
    """The quantiles between which these lie."""
    most_levels: int = 500
    """Of a signal that has steps, in units of the smallest."""
    fewest_levels: int = 5
    """Less are a square wave, or a switch."""


CHECK = CheckLimits()
