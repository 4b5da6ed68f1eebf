"""`growth_rate`: how fast an oscillation grows or decays."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks

from tracewire.analyse.limits import SIGNAL
from tracewire.analyse.signal import SI, floor_of, signal_of, users_unit_of, vertex
from tracewire.arguments import checked
from tracewire.array_types import Vector
from tracewire.errors import AnalysisError, OptionError, Problem, unknown
from tracewire.result import Result
from tracewire.solve import Run


@dataclass(frozen=True, eq=False, repr=False)
class GrowthRate(Result):
    """The envelope of a signal as exp(rate*t): `rate` and its standard `error` in 1/s.

    `t` (K,) in s and `size` (K,) in the unit of the signal are the points of the envelope that the
    line through the logarithms is fitted to; `level` is the line at t = 0, in ln(size). Where the
    points lie on a line but for their scatter the error is right. `bends`: the rates of the two
    halves differ by more than their scatter and a tenth, as where a part that dies out is still
    there; `late` is that of the second half.
    """

    signal: str
    unit: str
    rate: float
    error: float
    level: float
    late: float
    bends: bool
    t: Vector
    size: Vector
    users_unit: tuple[str, float] = SI

    @property
    def as_shown(self) -> GrowthRate:
        """The same in the unit in which tables and figures show the signal."""
        unit, factor = self.users_unit
        return replace(
            self,
            unit=unit or self.unit,
            size=self.size / factor,
            level=self.level - float(np.log(factor)),
            users_unit=SI,
        )


@checked
def growth_rate(
    run: Run,
    signal: str,
    *,
    by: Literal["peaks", "size"] = "peaks",
    since: float | None = None,
    until: float | None = None,
    period: float | None = None,
) -> GrowthRate:
    """The growth rate of a recorded signal from a line through the logarithms of its envelope.

    `by` "peaks": the largest |values| of each half wave, or with `period` in s of each period (of a
    signal that beats, several times its longest one); "size": |values| themselves, for a norm or an
    energy, which has no waves. What the tolerances of the run do not resolve does not count. The
    error is the standard error of the slope, widened where neighbouring residuals go together.
    Raises OptionError; AnalysisError where there are fewer than four peaks.
    """
    if by not in ("peaks", "size"):
        raise OptionError([unknown("envelope", by, ("peaks", "size"))])
    if period is not None and not period > 0:
        what = f"a period of {period:g} s has no use"
        raise OptionError([Problem(what, hint="Give a period above 0, in s.")])
    found = signal_of(run, signal, since, until, even=False)
    size = np.abs(found.values)
    floor = floor_of(run, signal)[np.searchsorted(run.t, found.t)]
    if by == "peaks":
        at = _windows(found.t, size, period) if period else _peaks(size)
    else:
        at = np.flatnonzero(size > 0)
    noise = int(np.sum(size[at] <= floor[at]))
    at = at[size[at] > floor[at]]
    if len(at) < SIGNAL.fewest_peaks:
        raise _too_few(signal, len(at), noise, floor[-1], found.unit)
    t, top = (
        _refined(found.t, size, at) if by == "peaks" and not period else (found.t[at], size[at])
    )
    rate, level, error, _ = _line(t, np.log(top))
    late, bends = _halves(t, np.log(top), rate)
    shown = users_unit_of(run, signal)
    return GrowthRate(signal, found.unit, rate, error, level, late, bends, t, top, shown)


def _too_few(signal: str, count: int, noise: int, floor: float, unit: str) -> AnalysisError:
    """The error of an envelope with so few points: of how many the run's noise has more."""
    what = f"'{signal}' has {count} peaks there, too few for a growth rate"
    hint = "Take a longer time, or samples that are closer."
    if noise:
        size = f"{floor:.2g} {unit}".rstrip()
        what += f"; below {size} the tolerances of the run do not resolve it ({noise} peaks)"
        hint = "Take closer samples or a smaller rtol; what does not oscillate has no peaks."
    return AnalysisError([Problem(what, hint=hint)])


def _peaks(size: Vector) -> NDArray[np.int64]:
    """The samples that are larger than their neighbours, and no small ripples."""
    peaks, _ = find_peaks(size)
    if len(peaks) < 3:
        return np.asarray(peaks, dtype=np.int64)
    # ripples on a wave are lower than the peaks on both sides
    tall = [
        k
        for n, k in enumerate(peaks.tolist())
        if not (
            0 < n < len(peaks) - 1 and size[k] < 0.5 * min(size[peaks[n - 1]], size[peaks[n + 1]])
        )
    ]
    return np.array(tall, dtype=np.int64)


def _windows(t: Vector, size: Vector, period: float) -> NDArray[np.int64]:
    """The largest sample in each whole period."""
    number = np.floor((t - t[0]) / period).astype(np.int64)
    whole = int(np.floor((t[-1] - t[0]) / period * (1 + 1e-12)))
    return np.array(
        [np.flatnonzero(number == k)[np.argmax(size[number == k])] for k in range(whole)
         if np.any(number == k)], dtype=np.int64,
    )  # fmt: skip


def _refined(t: Vector, size: Vector, at: NDArray[np.int64]) -> tuple[Vector, Vector]:
    """Times and heights of peaks between samples: of the parabola through three."""
    at = at[(at > 0) & (at < len(t) - 1)]
    a, b, c = size[at - 1], size[at], size[at + 1]
    shift = vertex(a, b, c)
    height = b - 0.25 * (a - c) * shift
    return t[at] + shift * (t[at + 1] - t[at - 1]) / 2, height


def _halves(t: Vector, y: Vector, rate: float) -> tuple[float, bool]:
    """The slope of the second half, and whether that of the first is another one."""
    half = len(t) // 2
    if half < SIGNAL.fewest_peaks:
        return rate, False
    first, late = _line(t[:half], y[:half]), _line(t[half:], y[half:])
    # an envelope that bends makes residuals go together: errors are taken without that here
    sure = SIGNAL.apart * np.hypot(first[3], late[3])
    seen = SIGNAL.seen * max(abs(first[0]), abs(late[0]))
    return late[0], bool(abs(late[0] - first[0]) > max(sure, seen))


def _line(t: Vector, y: Vector) -> tuple[float, float, float, float]:
    """Of a line through points slope, value at 0, the slope's error, and that for single points."""
    middle = t - t.mean()
    spread = float(middle @ middle)
    slope = float(middle @ y) / spread
    residual = y - y.mean() - slope * middle
    square = float(residual @ residual)
    single = float(np.sqrt(square / max(len(t) - 2, 1) / spread))
    # residuals that go together count for fewer: by their first correlation
    together = float(residual[:-1] @ residual[1:]) / square if square > 0 else 0.0
    together = min(max(together, 0.0), 0.99)
    widened = single * float(np.sqrt((1 + together) / (1 - together)))
    return slope, float(y.mean() - slope * t.mean()), widened, single
