"""Series that nothing can be traced in: each is told with what is wrong, before the work begins."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.errors import DataError, Problem
from tracewire.formula import Name
from tracewire.residual import Measured, noise_level
from tracewire.trace.data_thresholds import CheckOptions

FACTORS = {
    180 / np.pi: "degrees beside radians",
    1000.0: "a unit and its thousandth, such as m and mm or s and ms",
    60.0: "a unit in a minute and in a second",
    2 * np.pi: "turns beside radians, or Hz beside rad/s",
    100.0: "m beside cm",
}


def check_series(model: Model, measured: Sequence[Measured], options: CheckOptions) -> None:
    """Refuse series that nothing can be traced in.

    Raises DataError with all that is wrong: no series to train on, no signals, series that are too
    short, constant or nothing but noise, inputs that are not known over the whole series, a signal
    and its measured rate in units that do not belong together.
    """
    if not any(m.use == "train" for m in measured):
        given = ", ".join(f"{m.name} ({m.use})" for m in measured)
        what = "no series is for training" + (f": {given}" if given else "")
        raise DataError.one(what, hint="Give one `use: train`, or name one with --train.")
    problems = [problem for m in measured for problem in _empty(m)]
    if problems:
        raise DataError(problems)
    for m in measured:
        found = [
            *_short(m, options.least_samples),
            *_still(m, options),
            *_inputs(m, options.input_ends),
        ]
        problems += found or _rates(model, m, options)
    problems += _dead_channels(measured, options) if not problems else []
    if problems:
        raise DataError(problems)


def without_still(
    measured: Sequence[Measured], options: CheckOptions
) -> tuple[tuple[Measured, ...], tuple[str, ...]]:
    """The series in which something moves, and a sentence on each other one. All of them, where
    nothing moves in any series for training."""
    moving = tuple(m for m in measured if not _is_still(m, options))
    if not any(m.use == "train" for m in moving):
        return tuple(measured), ()
    words = [
        f"{m.name} is left out: nothing in it moves beyond the noise of {' and '.join(m.values)}. "
        "Say `sigma:` where the noise is smaller."
        for m in measured
        if _is_still(m, options)
    ]
    return moving, tuple(words)


def remarks(measured: Sequence[Measured], options: CheckOptions) -> tuple[str, ...]:
    """What is odd about series, and no reason to refuse them: signals that are nothing but noise in
    some series, and what was remarked when they were read."""
    found = [f"{m.name}: {remark}" for m in measured for remark in m.remarks]
    for m in measured:
        quiet = [name for name in m.values if _is_noise(m, name, options)]
        found += [f"{m.name}: {name} shows nothing above its noise" for name in quiet]
    return tuple(dict.fromkeys(found))


def _empty(m: Measured) -> Iterator[Problem]:
    if not m.values:
        yield Problem(f"the series '{m.name}' measures nothing", hint="Name a signal.")


def _short(m: Measured, least: int) -> Iterator[Problem]:
    if len(m.t) < least:
        what = f"the series '{m.name}' has {len(m.t)} samples, too few to trace anything"
        yield Problem(what, hint=f"At least {least} are needed.")


def _is_still(m: Measured, options: CheckOptions) -> bool:
    """Whether no signal of a series shows more than noise."""
    if not m.values or len(m.t) < options.least_samples:
        return False  # it is refused for that
    return all(_is_noise(m, name, options) for name in m.values)


def _still(m: Measured, options: CheckOptions) -> Iterator[Problem]:
    """Constant signals, and series in which no signal shows more than noise."""
    constant = [name for name, values in m.values.items() if np.ptp(values) == 0]
    for name in constant:
        what = f"'{name}' of '{m.name}' is constant: {m.values[name][0]:.6g} in every sample"
        yield Problem(what, hint="Is the sensor connected? Leave the signal or the series out.")
    if not constant and _is_still(m, options):
        names = " and ".join(f"'{name}'" for name in m.values)
        what = f"the series '{m.name}' shows nothing above the noise of {names}"
        hint = (
            "Nothing moves in it, or it moves from sample to sample as noise does: leave it out, or"
        )
        yield Problem(what, hint=f"{hint} say its `sigma:` where the noise is smaller.")


def _dead_channels(measured: Sequence[Measured], options: CheckOptions) -> Iterator[Problem]:
    """Signals that show nothing but noise in every series."""
    for name in dict.fromkeys(name for m in measured for name in m.values):
        having = [m for m in measured if name in m.values]
        if all(_is_noise(m, name, options) for m in having):
            what = f"'{name}' shows nothing above its noise in any series"
            yield Problem(what, hint="Is the sensor connected? Leave the signal out.")


def _is_noise(m: Measured, name: str, options: CheckOptions) -> bool:
    """Whether a signal is nothing but white noise, or stays within its declared noise.

    White noise has a mean square of differences of twice its variance (von Neumann, 1941).
    """
    values = m.values[name]
    spread = float(np.std(values))
    declared = m.sigma.get(name)
    if declared is not None and spread < declared:
        return True
    if len(np.unique(values)) <= 2:
        return True  # a reading that flips between two steps
    ratio = float(np.mean(np.diff(values) ** 2)) / max(spread**2, 1e-300)
    white = ratio > 2 - options.neighbours / np.sqrt(len(values))
    return bool(white and spread < options.above_noise * noise_level(values))


def _inputs(m: Measured, ends: float) -> Iterator[Problem]:
    """Inputs that are not known over the whole series, or are in another time."""
    late = ends * m.interval
    for name, (t, _) in m.inputs.items():
        if len(t) and t[0] <= m.t[0] + late and t[-1] >= m.t[-1] - late:
            continue
        known = f"from {t[0]:g} to {t[-1]:g} s" if len(t) else "at no time"
        what = (
            f"the input '{name}' of '{m.name}' is known {known}, and its signals are measured from "
            f"{m.t[0]:g} to {m.t[-1]:g} s"
        )
        yield Problem(what, hint="Put both into one time, or cut the series.")


def _rates(model: Model, m: Measured, options: CheckOptions) -> Iterator[Problem]:
    """A measured signal whose measured rate is not its rate: in other units, or turned round."""
    for state in model.flat.states:
        rate = state.rate
        if not isinstance(rate, Name) or not {state.name, rate.name} <= set(m.values):
            continue
        ratio = rate_ratio(m.t, m.values[state.name], m.values[rate.name], options.sure_rate)
        if ratio is None or m.sensor(state.name).free or m.sensor(rate.name).free:
            continue
        what = f"in '{m.name}' the rate of '{state.name}' is {ratio:.4g} times '{rate.name}'"
        near = options.near_factor
        if ratio < 0 and abs(abs(ratio) - 1) < near:
            yield Problem(what, hint="One of them has the wrong sign: gain: -1 turns it round.")
        for factor, meaning in FACTORS.items():
            if any(abs(abs(ratio) / f - 1) < near for f in (factor, 1 / factor)):
                hint = f"Are their units, or that of time, mixed up: {meaning}?"
                yield Problem(what, hint=hint)


def rate_ratio(t: Vector, values: Vector, rates: Vector, sure: float) -> float | None:
    """How many times `rates` the rate of `values` (N,) is; None where they do not belong together,
    as their integral explains less than the part `sure`.

    By least squares of the values on the integral of the rates, a constant and a straight line: an
    offset of either does not count, and no noise is amplified.
    """
    from scipy.integrate import cumulative_trapezoid  # slow to import, seldom needed

    steps = cumulative_trapezoid(rates, t, initial=0)
    basis = np.column_stack((np.ones_like(t), t - t[0]))
    left, moved = (y - basis @ np.linalg.lstsq(basis, y, rcond=None)[0] for y in (values, steps))
    size = float(moved @ moved)
    if size <= 0 or float(left @ left) <= 0:
        return None
    ratio = float(left @ moved) / size
    explained = ratio * float(left @ moved) / float(left @ left)
    return ratio if explained > sure else None
