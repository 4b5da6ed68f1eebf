"""`scalogram`: which frequencies a signal has at which times (paper C, Eq 18's pendulum)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.fft import fft, ifft, next_fast_len

from tracewire.analyse.limits import SIGNAL
from tracewire.analyse.signal import SI, signal_of, users_unit_of, vertex
from tracewire.arguments import checked
from tracewire.array_types import Matrix, Vector
from tracewire.errors import OptionError, Problem
from tracewire.result import Result
from tracewire.solve import Run

REACH = np.sqrt(2.0)  # e-folding time of the wavelet in its scale


@dataclass(frozen=True, eq=False, repr=False)
class Scalogram(Result):
    """Amplitudes over time and frequency: a*cos(2 pi f t) gives a at f, at all times.

    `t` (N,) in s, `frequency` (K,) in Hz, `amplitude` (K, N) in `unit`. `edge` (K,) in s: so near
    to the ends a value of that frequency lacks a part of the signal. `ridge` (N,) in Hz is the
    frequency of the largest amplitude at each time, NaN within the edges.
    """

    title: str
    signal: str
    unit: str
    t: Vector
    frequency: Vector
    amplitude: Matrix
    edge: Vector
    ridge: Vector
    users_unit: tuple[str, float] = SI

    @property
    def as_shown(self) -> Scalogram:
        """The same in the unit in which tables and figures show the signal."""
        unit, factor = self.users_unit
        return replace(
            self, unit=unit or self.unit, amplitude=self.amplitude / factor, users_unit=SI
        )


@checked
def scalogram(
    run: Run,
    signal: str,
    *,
    low: float | None = None,
    high: float | None = None,
    count: int = 120,
    waves: float = 6.0,
    since: float | None = None,
    until: float | None = None,
) -> Scalogram:
    """The continuous wavelet transform of a recorded signal with the Morlet wavelet.

    psi(u) = exp(i w u - u^2/2) with w = `waves`, stretched so that its frequency is f; the
    amplitude is that of a cosine of frequency f (C. Torrence and G. P. Compo, Bull. Am. Meteorol.
    Soc. 79, 1998, with their norm changed to that). `low` and `high` in Hz bound the `count`
    frequencies, which are evenly apart by their ratio: unless given, four periods in the signal and
    a quarter of the samples' frequency. More `waves` tell frequencies apart, fewer tell times.
    Raises OptionError.
    """
    found = signal_of(run, signal, since, until)
    n, step = len(found.values), found.step
    least = 4 / (n * step) if low is None else low
    most = 0.25 / step if high is None else high
    _check(least, most, count, waves, n, step)
    frequency = np.geomspace(least, most, count)
    scale = waves / (2 * np.pi * frequency)
    padded = next_fast_len(2 * n)
    values = found.values - found.values.mean()
    transform = fft(values, padded)
    omega = 2 * np.pi * np.fft.fftfreq(padded, step)
    amplitude = np.empty((count, n))
    for k, s in enumerate(scale.tolist()):
        response = np.where(omega > 0, 2.0 * np.exp(-0.5 * (s * omega - waves) ** 2), 0.0)
        amplitude[k] = np.abs(ifft(transform * response)[:n])
    edge = REACH * scale
    best = np.argmax(amplitude, axis=0)
    ridge = frequency[best] * np.exp(np.log(frequency[1] / frequency[0]) * _beside(amplitude, best))
    away = np.minimum(found.t - found.t[0], found.t[-1] - found.t)
    ridge = np.where(away >= edge[best], ridge, np.nan)
    shown = users_unit_of(run, signal)
    return Scalogram(
        run.title, signal, found.unit, found.t, frequency, amplitude, edge, ridge, shown
    )


def _beside(amplitude: Matrix, best: NDArray[np.int64]) -> Vector:
    """How far between the frequencies the largest amplitudes are: of parabolas through three."""
    column = np.arange(amplitude.shape[1])
    inner = np.clip(best, 1, len(amplitude) - 2)
    found = vertex(*(amplitude[inner + k, column] for k in (-1, 0, 1)))
    return np.where(inner == best, np.clip(found, -0.5, 0.5), 0.0)


def _check(low: float, high: float, count: int, waves: float, n: int, step: float) -> None:
    problems = []
    if not 0 < low < high <= 0.5 / step * (1 + 1e-9):
        what = f"frequencies from {low:g} to {high:g} Hz are not in samples every {step:g} s"
        hint = f"Give low < high, up to {0.5 / step:g} Hz."
        problems.append(Problem(what, hint=hint))
    if count < 3 or count * n > SIGNAL.most_numbers:
        what = f"{count} frequencies of {n} samples make no scalogram"
        problems.append(Problem(what, hint="Give 3 or more, or fewer samples."))
    if not 4 <= waves <= 100:
        what = f"a wavelet of {waves:g} waves is none of Morlet's"
        problems.append(Problem(what, hint="Give from 4 to 100; 6 is usual."))
    if problems:
        raise OptionError(problems)
