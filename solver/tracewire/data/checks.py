"""What is odd about a record: remarks in words, and nothing is changed."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.data.limits import CHECK, FILE

Marks = NDArray[np.bool_]


def time_remarks(t: Vector) -> list[str]:
    """What is odd about times (N,) in s: steps that differ by more than 1 %, gaps of 3 steps."""
    if len(t) < 3:
        return []
    steps = np.diff(t)
    median = float(np.median(steps))
    # the last digit of a time that was written rounded moves a step by as much as this
    rounding = 4 * float(np.spacing(max(abs(t[0]), abs(t[-1]))))
    gaps = np.flatnonzero(steps > CHECK.gap * median)
    regular = steps[steps <= CHECK.gap * median]
    remarks = []
    if count := int(np.sum(np.abs(regular - median) > CHECK.jitter * median + rounding)):
        low, high = float(regular.min()), float(regular.max())
        remarks.append(
            f"the time step is not regular: {low:.4g} to {high:.4g} s, median {median:.4g} s; "
            f"{count} of {len(steps)} are more than {CHECK.jitter:.0%} off; each sample counts at "
            "its own time"
        )
    if gaps.size:
        told = ", ".join(f"{steps[i]:.4g} s after {_time(t, i)}" for i in gaps[: FILE.most_told])
        more = f" and {gaps.size - FILE.most_told} more" if gaps.size > FILE.most_told else ""
        some = "a gap" if gaps.size == 1 else f"{gaps.size} gaps"
        remarks.append(
            f"{some} in the time, where the step is {median:.4g} s: {told}{more}" + _counted(t)
        )
    return remarks


def input_remarks(name: str, t: Vector, values: Vector) -> list[str]:
    """What is odd about an input (N,) at times (N,) in s: a gap in the time, within whose length it
    moves on either side."""
    steps, least = np.diff(t), CHECK.moved * float(np.ptp(values))
    for at in np.flatnonzero(steps > CHECK.gap * float(np.median(steps))).tolist():
        near = values[(t >= t[at] - steps[at]) & (t <= t[at + 1] + steps[at])]
        if np.ptp(near) > least:
            return [
                f"the input {name} is not known in the gap after {_time(t, at)}, and goes from "
                f"{near.min():.4g} to {near.max():.4g} around it: a run takes a guess there; where "
                "only a signal has no value, keep the row and leave its cell blank"
            ]
    return []


def _time(t: Vector, number: int) -> str:
    """The time of a sample, up to a tenth of the usual step: `t = 4.99 s`."""
    value, step = float(t[number]), float(np.median(np.diff(t)))
    value -= float(t[0]) if _is_far(t) else 0.0
    digits = math.log10(abs(value) / step) + 2 if value and step > 0 else 0.0
    return f"t = {value:.{min(max(math.ceil(digits), CHECK.least_digits), CHECK.most_digits)}g} s"


def _is_far(t: Vector) -> bool:
    """Whether a record begins far from zero, as at a time of day."""
    return abs(float(t[0])) > CHECK.far_zero * float(t[-1] - t[0])


def _counted(t: Vector) -> str:
    """From where on times are told, where that is not their zero."""
    return " (t counts from the first sample)" if _is_far(t) else ""


def signal_remarks(
    name: str,
    t: Vector,
    y: Vector,
    unit: str = "",
    *,
    exact: bool = False,
    cleaned: bool = False,
    noise: float = 0.0,
) -> list[str]:
    """What is odd about a signal y(t), (N,): constant, clipped, with spikes, made from a lower
    rate, coarse.

    exact: its values are what they were meant to be, such as those of a command: none is rounded,
    and it may rest as long as it likes. cleaned: its outliers are left out. noise: its declared
    standard deviation, beside which a smaller rounding is nothing odd.
    """
    if len(y) < 3:
        return []
    shown = f" {unit}" if unit else ""
    if np.ptp(y) == 0:
        return [f"{name} is constant: {y[0]:.6g}{shown} in every sample"]
    if len(y) < CHECK.fewest_samples:
        return []
    codes = [] if exact else _codes(y)
    if codes:
        rest = ~np.isin(y, codes)
        more = signal_remarks(name, t[rest], y[rest], unit, cleaned=cleaned, noise=noise)
        return [*_coded(name, y, codes, shown), *more]
    levels = np.unique(y)
    found = [
        *([] if exact else _clipped(name, y, levels, shown)),
        *([] if exact or cleaned else _spikes(name, t, y, shown)),
    ]
    if exact:
        return found
    made = [] if len(levels) < CHECK.fewest_levels else _from_lower_rate(name, t, y)
    return [*found, *(made or _coarse(name, y, levels, shown, noise))]


def _codes(y: Vector) -> list[float]:
    """The extreme values at which several samples are exactly, far from all others: numbers by
    which a logger says that it has no value."""
    found = []
    for code in (float(y.min()), float(y.max())):
        here = y == code
        rest = y[~here]
        if np.count_nonzero(here) < CHECK.fewest_codes or len(rest) < len(y) / 2:
            continue
        away = float(np.min(np.abs(rest - code)))
        if np.ptp(rest) > 0 and away > CHECK.spike * float(np.ptp(rest)):
            found.append(code)
    return found


def _coded(name: str, y: Vector, codes: list[float], unit: str) -> list[str]:
    """What to say of such codes."""
    rest = y[~np.isin(y, codes)]
    return [
        f"{name} is exactly {code:.9g}{unit} in {np.count_nonzero(y == code)} samples, far from "
        f"all others, which are between {rest.min():.4g} and {rest.max():.4g}{unit}: does the "
        f"number stand for no value? Then say format: {{missing: {code:.9g}}}"
        for code in codes
    ]


def _clipped(name: str, y: Vector, levels: Vector, unit: str) -> list[str]:
    """A signal that comes in steps, and then stays at exactly its extreme value, several times.

    A signal that turns round smoothly stays at its extreme too where it is read coarsely, but
    arrives there by the smallest of its steps.
    """
    if len(levels) < CHECK.fewest_levels:
        return []  # a square wave, or a switch
    smallest = float(np.min(np.diff(levels)))
    remarks = []
    for extreme, word in ((levels[-1], "largest"), (levels[0], "smallest")):
        begins, ends = _runs(y == extreme)
        long = np.flatnonzero((ends - begins >= CHECK.run) & (begins > 0))
        arrived = np.abs(y[begins[long]] - y[begins[long] - 1])
        abrupt = long[arrived > CHECK.abrupt * smallest]
        count = int((ends - begins)[abrupt].sum())
        if len(abrupt) >= CHECK.fewest_runs and count >= CHECK.clipped_share * len(y):
            remarks.append(
                f"{name} stays at exactly its {word} value, {extreme:.6g}{unit}, in {len(abrupt)} "
                f"stretches of together {count} samples: is the sensor at the end of its range?"
            )
    return remarks


def usual_range(y: Vector) -> tuple[float, float]:
    """Between which values nearly all samples (N,) are: spikes are outside."""
    low, high = np.quantile(y, CHECK.nearly_all)
    return float(low), float(high)


def _spikes(name: str, t: Vector, y: Vector, unit: str) -> list[str]:
    """Samples far beyond all others, whose neighbours are not."""
    low, high = usual_range(y)
    beyond = np.maximum(low - y, y - high)
    far = beyond > CHECK.spike * (high - low)
    beside = np.concatenate([[False], far[:-1]]) | np.concatenate([far[1:], [False]])
    alone = np.flatnonzero(far & ~beside)
    if high == low or not len(alone):
        return []
    told = ", ".join(f"{y[i]:.6g}{unit} at {_time(t, i)}" for i in alone[: FILE.most_told])
    more = f" and {len(alone) - FILE.most_told} more" if len(alone) > FILE.most_told else ""
    return [
        f"{name} has samples far from all others, each alone: {told}{more}{_counted(t)}; nearly "
        f"all are between {low:.4g} and {high:.4g}{unit}. Where they are faults of the "
        f"measurement, leave them out by clean: [outliers: {name.removeprefix('input ')}]"
    ]


def _runs(marks: Marks) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Begin and end (behind the last) of each stretch of true marks."""
    edges = np.diff(np.concatenate([[0], marks.astype(np.int8), [0]]))
    return np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)


def _from_lower_rate(name: str, t: Vector, y: Vector) -> list[str]:
    """Samples on straight lines, or held, between points that stand a fixed number apart."""
    steps = np.diff(t)
    if float(np.ptp(steps)) > CHECK.jitter * float(np.median(steps)):
        return []
    first = np.diff(y)
    second = np.diff(first)
    size = float(np.max(np.abs(first)))
    moving = np.abs(first) > 1e-9 * size
    kinks = np.abs(second) > 1e-6 * size
    every = _pattern(np.flatnonzero(kinks), len(second), moving)
    if every and moving.mean() > 0.5:
        share = 1.0 - float(kinks.mean())
        return [
            f"{name} lies on straight lines between samples {every} apart ({share:.0%} of its "
            f"second differences are zero): it was taken at {1 / (every * np.median(steps)):.4g} Hz"
        ]
    every = _pattern(np.flatnonzero(moving), len(first), moving)
    if every:
        return [
            f"{name} changes only every {every} samples: it was taken at "
            f"{1 / (every * np.median(steps)):.4g} Hz"
        ]
    return []


def _pattern(places: NDArray[np.intp], count: int, moving: Marks) -> int:
    """The number k > 1 such that nearly all places stand at multiples of k from each other; or 0.

    They must cover most of the stretches in which the signal moves at all.
    """
    if len(places) < CHECK.fewest_kinks:
        return 0
    gaps = np.diff(places)
    every = int(np.median(gaps))
    if not 2 <= every <= CHECK.longest_pattern or len(places) < 0.5 * count / every * moving.mean():
        return 0
    rests = np.bincount(places % every, minlength=every)
    return every if rests.max() >= CHECK.regular * len(places) else 0


def _coarse(name: str, y: Vector, levels: Vector, unit: str, noise: float) -> list[str]:
    """Readings in few equal steps: their rounding is noise that no model explains. That of a sensor
    with more noise of its own is not told."""
    if not CHECK.fewest_levels <= len(levels) <= len(y) / 2:
        return []
    gaps = np.diff(levels)
    step = float(gaps.min())
    multiples = gaps / step
    count = float(np.ptp(levels)) / step
    if count > CHECK.most_levels or float(np.max(np.abs(multiples - np.round(multiples)))) > 0.05:
        return []
    if step / math.sqrt(12) < noise:
        return []
    return [
        f"{name} is read in steps of {step:.3g}{unit} ({count:.0f} over its range): the rounding "
        f"alone has a standard deviation of {step / math.sqrt(12):.3g}{unit}"
    ]
