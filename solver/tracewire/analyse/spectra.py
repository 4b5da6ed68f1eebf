"""`spectrum`: the amplitudes of the lines of a signal, in the signal's unit."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq
from scipy.signal import find_peaks, get_window

from tracewire.analyse.limits import SIGNAL
from tracewire.analyse.signal import SI, signal_of, users_unit_of
from tracewire.arguments import checked
from tracewire.array_types import Vector
from tracewire.errors import OptionError, Problem, unknown
from tracewire.result import Result
from tracewire.solve import Run

WINDOWS = ("hann", "flattop", "blackman", "boxcar")
WIDE = {"hann": 2.0, "flattop": 5.0, "blackman": 3.0, "boxcar": 1.0}  # half of a line, in bins


@dataclass(frozen=True, eq=False)
class Line:
    """A line of a spectrum: its frequency in Hz and its amplitude in the unit of the signal."""

    frequency: float
    amplitude: float


@dataclass(frozen=True, eq=False, repr=False)
class Spectrum(Result):
    """Amplitudes over frequencies: a*cos(2 pi f t) gives a line of height a at f.

    `frequency` (K,) in Hz, `amplitude` (K,) in `unit`; `resolution` in Hz is half the width of a
    line: what is nearer to a larger line is a part of it; `lines` are the largest peaks, placed
    between the frequencies by the shape of the window.
    """

    title: str
    signal: str
    unit: str
    frequency: Vector
    amplitude: Vector
    resolution: float
    lines: tuple[Line, ...]
    users_unit: tuple[str, float] = SI

    @property
    def as_shown(self) -> Spectrum:
        """The same in the unit in which tables and figures show the signal."""
        unit, factor = self.users_unit
        return replace(
            self,
            unit=unit or self.unit,
            amplitude=self.amplitude / factor,
            lines=tuple(replace(line, amplitude=line.amplitude / factor) for line in self.lines),
            users_unit=SI,
        )


@checked
def spectrum(
    run: Run,
    signal: str,
    *,
    since: float | None = None,
    until: float | None = None,
    window: str = "hann",
    lines: int = 8,
) -> Spectrum:
    """The one-sided amplitude spectrum of a recorded signal between two times in s.

    The mean is taken off. `window` is "hann", "flattop" (amplitudes right to 0.1 % off the grid of
    frequencies, wide lines), "blackman" or "boxcar" (none). `lines` is how many are told at most.
    Raises OptionError: no such signal, too few or uneven samples, no such window.
    """
    if window not in WINDOWS:
        raise OptionError([unknown("window", window, WINDOWS)])
    if lines < 0:
        raise OptionError([Problem(f"{lines} lines cannot be told", hint="Give 0 or more.")])
    found = signal_of(run, signal, since, until)
    count = len(found.values)
    weights = get_window(window, count)
    values = found.values - found.values.mean()
    amplitude = np.abs(np.fft.rfft(values * weights)) * 2 / weights.sum()
    if count % 2 == 0:
        amplitude[-1] /= 2
    frequency = np.asarray(np.fft.rfftfreq(count, found.step), dtype=float)
    resolution = WIDE[window] / (count * found.step)
    return Spectrum(
        run.title,
        signal,
        found.unit,
        frequency,
        amplitude,
        resolution,
        _lines(frequency, amplitude, window, lines),
        users_unit_of(run, signal),
    )


def _lines(frequency: Vector, amplitude: Vector, window: str, most: int) -> tuple[Line, ...]:
    """The largest peaks in the order of their height, above a thousandth of the largest.

    A peak that is nearer to a larger one than half the width of a line is a part of that.
    """
    if not amplitude.max(initial=0.0) > 0:
        return ()
    peaks, _ = find_peaks(amplitude, height=1e-3 * amplitude.max())
    peaks = peaks[np.argsort(-amplitude[peaks], kind="stable")]
    found: dict[float, Line] = {}
    for k in peaks.tolist():
        if len(found) == most:
            break
        shift, height = _between(amplitude[k - 1 : k + 2], window)
        if all(abs(k + shift - place) >= WIDE[window] for place in found):
            found[k + shift] = Line(float((k + shift) * frequency[1]), height)
    return tuple(found.values())


def _between(three: Vector, window: str) -> tuple[float, float]:
    """Where between the frequencies a line lies whose peak these are, in bins, and its height.

    The ratio of the two largest of the three is that of the window's own transform there.
    """
    weights = get_window(window, SIGNAL.window_points)
    places = np.arange(SIGNAL.window_points) / SIGNAL.window_points

    def response(away: float) -> float:
        return float(np.abs(weights @ np.exp(-2j * np.pi * away * places)) / weights.sum())

    side = 1.0 if three[2] >= three[0] else -1.0
    ratio = float(max(three[0], three[2]) / three[1])

    def off(away: float) -> float:
        return response(1.0 - away) / response(away) - ratio

    if off(0.0) >= 0.0:
        away = 0.0
    elif off(0.5) <= 0.0:
        away = 0.5
    else:
        away = float(brentq(off, 0.0, 0.5, xtol=1e-9))
    return side * away, float(three[1]) / response(away)
