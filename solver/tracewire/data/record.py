"""A measured record and the steps that may clean it; every step is told in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.data import filters
from tracewire.data.limits import CLEANING, FILE
from tracewire.data.steps import STEPS
from tracewire.errors import OptionError, unknown
from tracewire.formula import Unit, read_unit

ONE, SECOND = Unit("", 1.0), Unit("s", 1.0)


@dataclass(frozen=True, eq=False)
class Record:
    """Columns of a measurement at times `t` (N,) in s, in SI; a step of cleaning makes a new one.

    `columns` maps a name to its values (N,). `units` has the unit of each: its text in SI, and the
    factor by which the numbers of the file were multiplied; `time_unit` is that of the time.
    `steps` tells in words what was done to the numbers since they were read, `remarks` what is odd
    about the file.

    Every step raises OptionError on an argument without meaning: a column that does not exist, a
    frequency that the samples cannot show, a window without samples.
    """

    t: Vector
    columns: Mapping[str, Vector]
    units: Mapping[str, Unit] = field(default_factory=dict)
    time_unit: Unit = SECOND
    steps: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()
    file: str = ""

    def unit(self, name: str) -> Unit:
        """The unit of a column; the number 1 where none is known."""
        return self.units.get(name, ONE)

    def clean(self, step: str, options: Mapping[str, Any]) -> Record:
        """The record after one step by its name in a diagram: `record.clean("trim", {"from": 2})`.

        The options are those of the method of that name; `from` and `to` of a window are `begin`
        and `end` there.
        """
        if step not in STEPS:
            raise OptionError([unknown("step", step, STEPS)])
        known = STEPS[step]
        problems = [unknown(f"option of {step}", n, known) for n in options if n not in known]
        if problems:
            raise OptionError(problems)
        named = {known[name].argument or name: value for name, value in options.items()}
        made: Record = getattr(self, step)(**named)
        return made

    def sort(self, duplicates: str = "") -> Record:
        """The rows in the order of time.

        duplicates: of rows of one time the `first` in the file is kept, the `last`, or their
        `mean`. Without it, rows of one time raise OptionError.
        """
        if duplicates not in ("", *(words := STEPS["sort"]["duplicates"].words)):
            raise OptionError([unknown("word for 'duplicates'", duplicates, words)])
        order = np.argsort(self.t, kind="stable")
        behind = int(np.sum(self.t < np.maximum.accumulate(self.t)))
        moved = f"sorted by time: {behind} of {len(self.t)} rows stood behind a later one"
        times, begins, counts = np.unique(self.t[order], return_index=True, return_counts=True)
        record = self._rows(order)
        if len(times) == len(order):
            return record._told(moved)
        twice = ", ".join(f"{t:.9g}" for t in times[counts > 1][: FILE.most_told])
        twice += ", ..." if np.sum(counts > 1) > FILE.most_told else ""
        some = f"{len(order) - len(times)} of {len(order)} rows repeat a time"
        if not duplicates:
            hint = "Say which row of a time counts: sort: {duplicates: first}, or last, or mean."
            raise OptionError.one(f"{some} of another row: t = {twice} s", hint=hint)
        if len(times) < 2:
            raise OptionError.one("all rows have the same time", hint="Name the column of time.")
        if duplicates == "mean":
            means = {n: np.add.reduceat(y, begins) / counts for n, y in record.columns.items()}
            kept = replace(record, t=times, columns=means)
        else:
            kept = record._rows(begins if duplicates == "first" else begins + counts - 1)
        return kept._told(moved, f"{some}: of each the {duplicates} is kept, at t = {twice} s")

    def trim(self, begin: float = -math.inf, end: float = math.inf) -> Record:
        """Only the samples with begin <= t <= end (s)."""
        rows = np.flatnonzero((self.t >= begin) & (self.t <= end))
        if len(rows) < 2:
            what = f"{len(rows)} samples between {begin:g} and {end:g} s"
            hint = f"The record covers {self.t[0]:g} to {self.t[-1]:g} s."
            raise OptionError.one(what, hint=hint)
        kept = self._rows(rows)
        some = f"{len(rows)} of {len(self.t)} samples"
        return kept._told(f"trimmed to {kept.t[0]:g} ... {kept.t[-1]:g} s: {some}")

    def known(self, signals: Iterable[str]) -> Record:
        """Only the rows in which each of these columns has a value."""
        lacks = {name: np.isnan(self.columns[name]) for name in signals}
        words = []
        for name, rows in lacks.items():
            if count := int(rows.sum()):
                some = f"{name} has no value in {count} of {len(rows)} rows"
                first = f"the first at t = {self.t[rows][0]:g} s"
                words.append(f"{some}, which count for no signal, {first}")
        if not words:
            return self
        kept = np.flatnonzero(~np.any([*lacks.values()], axis=0))
        if len(kept) < 2:
            both = " and ".join(lacks)
            what = f"{len(kept)} of {len(self.t)} rows have a value of {both}"
            hint = "Give signals that are sampled at other times a series each."
            raise OptionError.one(what, hint=hint)
        return self._rows(kept)._told(*words)

    def shift(self, zero: float) -> Record:
        """The record with t = 0 at the time `zero` (s)."""
        if zero == 0:
            return self
        return replace(self, t=self.t - zero)._told(f"time: t = 0 is {zero:g} s of the file")

    def resample(self, every: float, method: str = "linear") -> Record:
        """All columns at equal intervals `every` (s), from the first time on.

        method: `linear`, on straight lines between samples; `spline`, on the cubic spline through
        them. Neither filters: before a lower rate use `lowpass`.
        """
        if method not in ("linear", "spline"):
            raise OptionError([unknown("method of resampling", method, ("linear", "spline"))])
        every = _above_zero("every", every)
        span = float(self.t[-1] - self.t[0])
        few = span / every < CLEANING.most_samples
        count = math.floor(span / every * (1 + 1e-12)) + 1 if few else 0
        if count < 2:
            what = f"the interval {every:g} s does not fit into a record of {span:g} s"
            raise OptionError.one(what, hint="Give an interval between samples, in s.")
        t = np.minimum(self.t[0] + every * np.arange(count), self.t[-1])
        columns = {
            name: filters.interpolate(self.t, y, t, method) for name, y in self.columns.items()
        }
        words = f"resampled every {every:g} s ({method}): {count} samples, {len(self.t)} before"
        return replace(self, t=t, columns=columns)._told(words)

    def detrend(self, signals: str | Iterable[str], order: int = 1) -> Record:
        """Columns without the polynomial of this order in t that is nearest to them.

        order 0 takes the mean away, 1 a straight line.
        """
        order = _count("order", order, 0, CLEANING.most_order)
        if len(self.t) <= order:
            raise OptionError.one(f"a trend of order {order} takes more than {len(self.t)} samples")
        words = {0: "the mean", 1: "a straight line"}.get(order, f"a polynomial of order {order}")

        def detrended(name: str, y: Vector) -> tuple[Vector, str]:
            taken = filters.trend(self.t, y, order)
            ends = f"{taken[0]:.6g} ... {taken[-1]:.6g} {self.unit(name).text}".strip()
            return y - taken, f"{words} taken away, {ends}"

        return self._each(signals, detrended)

    def calibrate(
        self, signal: str, gain: float = 1.0, offset: float = 0.0, unit: str = ""
    ) -> Record:
        """The column y as gain*y + offset, numbers in `unit`, which are then put into SI.

        Without `unit` they are in the unit that the column has, and stay in it.
        """
        if gain == 0 or not (math.isfinite(gain) and math.isfinite(offset)):
            raise OptionError.one(f"the calibration {gain:g}*value + {offset:g} has no meaning")
        made = read_unit(unit) if unit else self.unit(signal)
        text = unit or made.written or made.text

        def calibrated(name: str, y: Vector) -> tuple[Vector, str]:
            sign = "-" if offset < 0 else "+"
            words = f"calibrated, {gain:g}*value {sign} {abs(offset):g}"
            numbers = (gain * y + offset) * made.factor if unit else gain * y + offset * made.factor
            return numbers, words + (f" in {text}" if text else "")

        record = self._each(signal, calibrated)
        return replace(record, units={**self.units, signal: made})

    def lowpass(self, signals: str | Iterable[str], cutoff: float, order: int = 4) -> Record:
        """Columns through a Butterworth low pass forward and backward, so without shift of phase.

        cutoff: Hz, where the gain of both ways together is 1/2. Needs equal intervals.
        """
        cutoff, order = (
            _above_zero("cutoff", cutoff),
            _count("order", order, 1, CLEANING.most_order),
        )
        step, uneven = filters.jitter(self.t)
        if uneven > CLEANING.uniform:
            what = f"a filter needs equal intervals; these are up to {uneven:.0%} off {step:g} s"
            raise OptionError.one(what, hint=f"Resample first: resample: {{every: {step:.4g}}}.")
        half = 0.5 / step
        if cutoff >= half * (1 - 1e-9):
            what = f"the cutoff {cutoff:g} Hz is not below {half:g} Hz, half the sampling rate"
            raise OptionError.one(what, hint="Give a lower frequency.")
        if len(self.t) < (least := filters.low_pass_needs(order)):
            what = f"a low pass of order {order} takes at least {least} samples, not {len(self.t)}"
            raise OptionError.one(what)
        words = f"low pass {cutoff:g} Hz, Butterworth of order {order} forward and backward"

        def filtered(name: str, y: Vector) -> tuple[Vector, str]:
            made = filters.low_pass(y, step, cutoff, order)
            rest = float(np.sqrt(np.mean((made - y) ** 2)))
            return made, f"{words}; it took {rest:.3g} {self.unit(name).text}".rstrip() + " (rms)"

        return self._each(signals, filtered)

    def differentiate(self, signal: str, to: str, noise: float | None = None) -> Record:
        """A new column `to`: the derivative of a smoothing spline through another.

        noise: the standard deviation of that column's noise in SI, which the spline leaves out;
        without it the noise is taken to be white, and its size from fourth differences. The noise
        of the result is correlated over neighbouring samples.
        """
        if to in self.columns:
            raise OptionError.one(f"there is a column '{to}' already", hint="Choose another name.")
        y = self._column(signal)
        if len(self.t) < CLEANING.fewest_for_spline:
            raise OptionError.one(f"a spline takes at least {CLEANING.fewest_for_spline} samples")
        size = filters.white_noise(y) if noise is None else _above_zero("noise", noise)
        made, rest = filters.derivative(self.t, y, size)
        unit = self.unit(signal)
        text = f"{unit.text}/s" if unit.text else "1/s"
        words = (
            f"{to}: derivative of {signal}, from a smoothing spline that left out {rest:.3g} "
            f"{unit.text}".rstrip()
            + " (rms)"
        )
        return replace(
            self,
            columns={**self.columns, to: made},
            units={**self.units, to: Unit(text, unit.factor)},
        )._told(words)

    def outliers(self, signals: str | Iterable[str], width: int = 11, limit: float = 5.0) -> Record:
        """Without the samples that lie far from the median of their neighbours (Hampel's test).

        width: samples of the window, odd. limit: how far, in standard deviations (1.4826 times the
        median absolute deviation). A sample is left out with all its columns.
        """
        width, limit = _count("width", width, 3, 1001), _above_zero("limit", limit)
        if width % 2 == 0 or width > len(self.t):
            what = f"the width must be odd and at most {len(self.t)}, not {width}"
            raise OptionError.one(what, hint="It is the number of samples in the window.")
        out = np.zeros(len(self.t), dtype=bool)
        words = []
        for name in self._names(signals):
            far = filters.far_from_median(self.columns[name], width, limit)
            out |= far
            where = f", first at t = {self.t[far][0]:g} s" if far.any() else ""
            some = f"{far.sum()} of {len(far)} samples left out as outliers"
            words.append(f"{name}: {some} (width {width}, limit {limit:g}){where}")
        rows = np.flatnonzero(~out)
        if len(rows) < 2:
            raise OptionError.one("all samples are outliers", hint="Give a larger limit.")
        return self._rows(rows)._told(*words)

    def _rows(self, rows: NDArray[np.intp]) -> Record:
        columns = {name: y[rows] for name, y in self.columns.items()}
        return replace(self, t=self.t[rows], columns=columns)

    def _told(self, *words: str) -> Record:
        return replace(self, steps=(*self.steps, *words))

    def _names(self, signals: str | Iterable[str]) -> tuple[str, ...]:
        names = (signals,) if isinstance(signals, str) else tuple(signals)
        problems = [unknown("column", n, self.columns) for n in names if n not in self.columns]
        if problems:
            raise OptionError(problems)
        return names

    def _column(self, name: str) -> Vector:
        return self.columns[self._names(name)[0]]

    def _each(
        self,
        signals: str | Iterable[str],
        change: Callable[[str, Vector], tuple[Vector, str]],
    ) -> Record:
        """The record with some columns changed, and the words for each."""
        columns, words = dict(self.columns), []
        for name in self._names(signals):
            columns[name], said = change(name, self.columns[name])
            words.append(f"{name}: {said}")
        return replace(self, columns=columns)._told(*words)


def _above_zero(name: str, value: float) -> float:
    if not (math.isfinite(value) and value > 0):
        raise OptionError.one(f"'{name}' must be above zero, not {value:g}")
    return float(value)


def _count(name: str, value: float, least: int, most: int) -> int:
    if value != int(value) or not least <= value <= most:
        what = f"'{name}' must be a whole number from {least} to {most}, not {value:g}"
        raise OptionError.one(what)
    return int(value)
