"""How large the noise of a measured signal is, how that was estimated, and how sure it is."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import comb

import numpy as np

from tracewire.array_types import Vector
from tracewire.residual.limits import NOISE
from tracewire.residual.readings import MAD, interpolation, replace_outliers, rounding_step
from tracewire.residual.spectrum import Spectrum, spectrum_of


@dataclass(frozen=True)
class NoiseEstimate:
    """The noise of a measured signal: its standard deviation `level`, in SI.

    It lies between `low` and `high` (about 95 %), `method` says how it was found. `step` is the
    step on which the readings stand, 0 where none is seen.
    """

    level: float
    low: float
    high: float
    method: str
    step: float = 0.0

    @property
    def factor(self) -> float:
        """By which factor the level may be wrong."""
        return max(self.high / self.level, self.level / self.low) if self.low > 0 else np.inf

    @property
    def is_sure(self) -> bool:
        """Whether the level is right within a factor 2."""
        return self.factor <= NOISE.sure


def noise_level(values: Vector) -> float:
    """The standard deviation of the noise on an evenly sampled signal, shape (N,)."""
    return noise_of_signal(values).level


def noise_of_signal(values: Vector, t: Vector | None = None) -> NoiseEstimate:
    """The noise on a signal, shape (N,), with times t (N,); even ones unless given.

    From the spectral density, the median over short stretches of time: noise is its plateau at high
    frequencies. Where a filter has taken these away, or rounding is all that is there, it is the
    plateau below, from which the signal rises. An interpolated record counts as its own samples.
    Short or uneven series have differences of high order instead, and so have those in which
    something happens in most stretches: a difference sees a dozen samples only.
    """
    step = rounding_step(values, t)
    if len(values) <= NOISE.orders[0] + 1:
        return NoiseEstimate(step / 12**0.5, 0.0, float(np.ptp(values)), "too few samples", step)
    factor, phase = interpolation(values)
    if factor > 1:
        own = noise_of_signal(values[phase::factor], None if t is None else t[phase::factor])
        return replace(own, method=f"{own.method}; interpolated {factor} times between samples")
    even = t is None or bool(np.ptp(np.diff(t)) <= NOISE.uneven * np.median(np.diff(t)))
    if len(values) < NOISE.fewest_samples:
        found = _of_differences(values, t)
    else:
        clean = replace_outliers(values)
        spectrum = spectrum_of(clean)
        local = _of_differences(values, None if even else t)
        if not len(spectrum.density):  # nothing moves
            return replace(local, step=step)
        found = _of_spectrum(spectrum, clean, step, local)
        # events in most stretches: between them differences see less than the highest band
        disturbed = local.level < NOISE.disturbed * float(spectrum.density[0]) ** 0.5
        if (disturbed and local.is_sure) or (not even and local.level < found.level):
            found = local
    rounding = step / 12**0.5
    if found.level < rounding:
        found = NoiseEstimate(rounding, 0.7 * rounding, max(found.high, rounding), "rounding")
    return replace(found, step=step)


def _of_spectrum(
    spectrum: Spectrum, values: Vector, step: float, local: NoiseEstimate
) -> NoiseEstimate:
    """The noise by the plateaus of a spectrum: as `noise_of_signal` says.

    `local` is the estimate by differences, which see less of a signal's events: where it finds less
    white noise than the spectrum, the geometric mean counts.
    """
    density, width = spectrum.density, 2 * (spectrum.high - spectrum.low)
    end = 2 * float(spectrum.low[-1])  # what is slower than all bands: as one band more
    slower = max(float(np.var(values)) - float(density @ width), 0.0) / end
    steps = np.append(density[1:], slower) / np.maximum(density, 1e-300)
    likely = 1 + 3 * np.append(np.hypot(spectrum.error[1:], spectrum.error[:-1]), 0.0)

    def level(last: int) -> float:
        """Of noise with the density down to a band, and as much below it."""
        within = float(density[: last + 1] @ width[: last + 1])
        return float((within + density[last] * 2 * spectrum.low[last]) ** 0.5)

    flat = _flat_from(density, spectrum.error, 0)
    steep = np.flatnonzero(steps > NOISE.steepest * likely)
    last = int(steep[0]) if len(steep) else len(density) - 1
    floor, whole = level(flat - 1), level(last)
    rounding = floor <= NOISE.rounded * step / 12**0.5
    if (flat == 1 and last == 0) or rounding:
        below = _plateau_below(density, slower, spectrum.error, flat)
        found = 0.0 if below is None else level(below)
        if 0 < found < NOISE.part * float(np.std(values)):
            words = "the plateau of the spectrum below " + (
                "rounding" if rounding else "a filter's edge"
            )
            return NoiseEstimate(found, floor if rounding else 0.7 * found, 1.5 * found, words)
    if rounding:
        return NoiseEstimate(floor, 0.7 * floor, 1.4 * floor, "rounding")
    ending = density[max(last - NOISE.plateau + 1, 0) : last + 1]
    less = min(local.level / float(density[0]) ** 0.5, 1.0) if local.is_sure else 1.0
    calm = min(float(np.median(spectrum.calm[:flat] / density[:flat])), less**2, 1.0) ** 0.5
    if flat > 1 and (last < flat or whole <= 1.3 * floor):
        found, error = whole * less**0.5, 1 + 3 * float(np.min(spectrum.error[:flat])) / 2
        low = min(whole * calm, found) / error
        return NoiseEstimate(found, low, whole * error, "white: the spectrum's floor")
    rise = float(np.max(ending) / np.min(ending))
    if len(ending) == NOISE.plateau and rise < NOISE.flat * (1 + 3 * float(spectrum.error[last])):
        most = whole * (1.5 if rise < NOISE.flat else 2.5)
        return NoiseEstimate(whole, whole / 1.5, most, "coloured: the spectrum's plateau")
    if flat > 1 or last > 0:
        found, words = floor * less**0.5, "the spectrum's floor, which rises slowly"
        return NoiseEstimate(found, min(calm * floor, found), 2 * max(floor, whole), words)
    # all that is faster than the signal may be noise, and none of it
    signal = np.flatnonzero(density * NOISE.above >= max(float(np.max(density)), slower))
    most = level(max(int(signal[0]) - 1, 0)) if len(signal) else level(len(density) - 1)
    least = max(local.level, NOISE.least * float(np.std(values)))
    words = "differences of high order: the spectrum has no plateau"
    low = 0.5 * min(floor, local.level)
    return NoiseEstimate(least, low, max(1.5 * most, 2 * least), words)


def _flat_from(density: Vector, error: Vector, first: int) -> int:
    """The band after those that are as dense as each other, from a band on."""
    after = first + 1
    while after < len(density):
        part = density[first : after + 1]
        if np.max(part) > NOISE.flat * (1 + 3 * error[after]) * np.min(part):
            break
        after += 1
    return after


def _plateau_below(density: Vector, slower: float, error: Vector, first: int) -> int | None:
    """The last band of the first plateau that the density rises to, and the signal from."""
    begin = first
    while begin + NOISE.plateau <= len(density) and begin < NOISE.lowest:
        after = _flat_from(density, error, begin)
        if after - begin >= NOISE.plateau:
            rest = np.append(density[after:], slower)
            rises = np.max(rest) > NOISE.above * np.max(density[begin:after])
            return after - 1 if rises else None
        if density[begin + 1] < density[begin] / NOISE.flat:
            return None  # a hump: signal
        begin += 1
    return None


def _of_differences(values: Vector, t: Vector | None) -> NoiseEstimate:
    """The least of differences of several orders, divided by the norm of their weights."""
    most = max(len(values) // 3 - 2, NOISE.orders[0])
    orders = [order for order in NOISE.orders if order <= most]
    found = [_difference(values, t, order) for order in orders]
    if t is not None:
        even = [_difference(values, None, order) for order in orders]
        found = even if min(even) < min(found) else found
    least = min(found)
    # the first that sees no signal
    level = next(size for size in found if size <= NOISE.falling * least)
    spread = 1 + 3 / max(len(values) - NOISE.orders[0], 1) ** 0.5
    falls = level == found[-1] or len(found) < 3
    low = level / spread * (0.3 if falls else 1.0)
    return NoiseEstimate(level, low, level * spread, "differences of high order")


def _difference(values: Vector, t: Vector | None, order: int) -> float:
    """The size of differences of an order, divided ones at times t, in units of white noise's.

    Where the signal stands still they are zero, and do not count.
    """
    if t is None:
        return _median_size(np.diff(values, order) / comb(2 * order, order) ** 0.5)
    rows = np.arange(len(values) - order)[:, None] + np.arange(order + 1)
    near = t[rows]
    near = (near - near[:, :1]) / np.maximum(near[:, -1:] - near[:, :1], 1e-300)
    apart = near[:, :, None] - near[:, None, :]
    apart[:, np.arange(order + 1), np.arange(order + 1)] = 1.0
    weights = 1 / np.prod(apart, axis=2)
    weights /= np.linalg.norm(weights, axis=1, keepdims=True)
    return _median_size(np.sum(weights * values[rows], axis=1))


def _median_size(differences: Vector) -> float:
    sizes = np.abs(differences[differences != 0])
    return MAD * float(np.median(sizes)) if len(sizes) else 0.0
