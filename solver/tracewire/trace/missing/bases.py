"""Smooth functions of a few variables, as columns: what a missing torque may be made of."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.trace.candidates.drive_sines import fit_sine
from tracewire.trace.candidates.places import Place
from tracewire.trace.candidates.signal_scales import Trajectory
from tracewire.trace.thresholds import MapOptions

Scale = Callable[[Vector], Vector]


@dataclass(frozen=True, eq=False)
class Axis:
    """A variable along all series, and the centres (n,) of its bumps on a scale of its own."""

    values: Sequence[Vector]
    scale: Scale
    centres: Vector

    def bumps(self, x: Vector) -> Matrix:
        """Gaussian bumps at x, shape (N, n), whose sum is 1 everywhere."""
        spacing = float(self.centres[1] - self.centres[0])
        far = (self.scale(x)[:, None] - self.centres) / (0.8 * spacing)
        powers = -0.5 * far**2
        heights = np.exp(powers - powers.max(axis=1, keepdims=True))
        return np.asarray(heights / heights.sum(axis=1, keepdims=True))

    @property
    def ends(self) -> tuple[float, float]:
        """The smallest and the largest value that was met."""
        return min(float(x.min()) for x in self.values), max(float(x.max()) for x in self.values)


@dataclass(frozen=True, eq=False)
class Basis:
    """A set of smooth functions of some variables: columns (N, k) for each series.

    `axes` are those of the variables; empty where a table would say nothing (history).
    """

    variables: tuple[str, ...]
    columns: Sequence[Matrix]
    axes: tuple[Axis, ...] = ()

    def at(self, *points: Vector) -> Matrix:
        """The functions at points, shape (N, k)."""
        return _product([axis.bumps(x) for axis, x in zip(self.axes, points, strict=True)])


def bases_of(place: Place, runs: Sequence[Trajectory], options: MapOptions) -> Iterator[Basis]:
    """The bases at a place, along its runs.

    Variables: `q`, `v`, `a` of the place, `t`, `u` and `drive phase` of each drive, `history`
    (low-passed q and v, and q behind stops), q or v with a drive, `other_q` and `other_v` of other
    bodies. With a number of drives or bodies, each has its signal behind its name: `u of force`.
    """
    if place.kind == "sensor":
        yield from _smooth(options, "y", [run.signals[place.definition] for run in runs])
        yield bumps_in_time(runs, options.in_time)
        return
    q, v, a = (_values(runs, name) for name in (place.q, place.v, place.a))
    yield from _smooth(options, "q", q)
    yield from _ripples(options, "q", q)
    yield from _smooth(options, "v", v, rate=True)
    if q and v:
        yield from _surfaces(options, ("q", "v"), q, v)
    yield from _smooth(options, "a", a)
    yield bumps_in_time(runs, options.in_time)
    if q or v:
        yield _history(options, runs, q, v)
    for name in place.drive:
        of = f" of {name}" if len(place.drive) > 1 else ""
        u = _values(runs, name)
        yield from _smooth(options, f"u{of}", u)
        for variable, own in (("q", q), ("v", v)):
            if own and u:
                axes = _axis(own, options.others), _axis(u, options.others)
                yield _grid((variable, f"u{of}"), *axes)
        phase = [drive_phase(run.t, x, options.tonal) for run, x in zip(runs, u, strict=False)]
        if phase and all(x is not None for x in phase):
            known = [x for x in phase if x is not None]
            yield _harmonics(options, f"drive phase{of}", known)
    for other_q, other_v in place.others:
        of = f" of {other_v or other_q}" if len(place.others) > 1 else ""
        oq, ov = _values(runs, other_q), _values(runs, other_v)
        yield from _smooth(options, f"other_q{of}", oq)
        yield from _smooth(options, f"other_v{of}", ov, rate=True)
        yield from _relative(options, ("q", f"other_q{of}"), q, oq)
        yield from _relative(options, ("v", f"other_v{of}"), v, ov, rate=True)


def drive_phase(t: Vector, u: Vector, tonal: float) -> Vector | None:
    """The phase of a drive in rad, 0 where it rises through its mean; None where it is no sine, as
    one explains less than the part `tonal` of its variance."""
    sine = fit_sine(t, u, 1 - tonal)
    return None if sine is None else np.asarray(2 * np.pi * t / sine.period + sine.phase)


def bumps_in_time(runs: Sequence[Trajectory], count: int) -> Basis:
    """Some bumps in time in each series: what happens at a time happens in one series only."""
    axes = [_axis([run.t], count) for run in runs]
    columns = []
    for n, (run, axis) in enumerate(zip(runs, axes, strict=True)):
        mine = np.zeros((len(run.t), count * len(runs)))
        mine[:, n * count : (n + 1) * count] = axis.bumps(run.t)
        columns.append(mine)
    return Basis(("t",), columns, tuple(axes[:1]) if len(runs) == 1 else ())


def _values(runs: Sequence[Trajectory], name: str) -> list[Vector]:
    """A signal along the runs; [] where it is none, or never changes."""
    if not name or any(name not in run.signals for run in runs):
        return []
    found = [run.signals[name] for run in runs]
    return found if _moves(found) else []


def _moves(values: Sequence[Vector], size: float = 0.0) -> bool:
    """Whether a signal changes, by more than rounding does of its size."""
    low, high = min(float(x.min()) for x in values), max(float(x.max()) for x in values)
    return high - low > 1e-9 * max(abs(low), abs(high), size)


def _smooth(
    options: MapOptions, name: str, values: Sequence[Vector], rate: bool = False
) -> Iterator[Basis]:
    """Functions of one variable, coarse and fine."""
    if not values:
        return
    if rate:
        plain, bent = options.rates
        axes = [_axis(values, plain)]
        axes += [_axis(values, bent, _asinh(values, slope)) for slope in options.slopes]
    else:
        axes = [_axis(values, n) for n in (options.coarse, options.medium)]
    yield from (_grid((name,), axis) for axis in axes)


def _ripples(options: MapOptions, name: str, values: Sequence[Vector]) -> Iterator[Basis]:
    """Very fine functions of one variable, where the samples resolve them."""
    if not values:
        return
    axis = _axis(values, options.fine)
    step = float(np.median(np.abs(np.concatenate([np.diff(x) for x in values]))))
    low, high = axis.ends
    if step <= (high - low) / (options.fine - 1):
        yield _grid((name,), axis)


def _surfaces(
    options: MapOptions, names: tuple[str, str], q: Sequence[Vector], v: Sequence[Vector]
) -> Iterator[Basis]:
    """Functions of a coordinate and a rate: even, fine in the one, or about zero in the other."""
    bent = _asinh(v, options.slopes[0])
    for along, over, is_bent in options.surfaces:
        yield _grid(names, _axis(q, along), _axis(v, over, bent) if is_bent else _axis(v, over))


def _relative(
    options: MapOptions,
    names: tuple[str, str],
    own: Sequence[Vector],
    other: Sequence[Vector],
    rate: bool = False,
) -> Iterator[Basis]:
    """Functions of the difference of two variables, and of both."""
    if not own or not other:
        return
    difference = [a - b for a, b in zip(own, other, strict=True)]
    if _moves(difference, max(float(np.max(np.abs(x))) for x in own)):
        for basis in _smooth(options, "", difference, rate):
            yield Basis(names, basis.columns)
    yield _grid(names, _axis(own, options.others), _axis(other, options.others))


def _harmonics(options: MapOptions, name: str, phases: Sequence[Vector]) -> Basis:
    """Sines and cosines of the first multiples of a phase."""
    orders = np.arange(1, options.harmonics + 1)
    angles = [phase[:, None] * orders for phase in phases]
    return Basis((name,), [np.concatenate([np.sin(x), np.cos(x)], axis=1) for x in angles])


def _history(
    options: MapOptions, runs: Sequence[Trajectory], q: Sequence[Vector], v: Sequence[Vector]
) -> Basis:
    """Low-passed coordinate and rate, and what stops of several widths hold of the coordinate.

    A linear element with memory (Maxwell) is a sum of the former, hysteresis that does not depend
    on speed a sum of the latter (Prandtl and Ishlinskii).
    """
    size = max((float(np.max(np.abs(x - np.mean(x)))) for x in q), default=0.0)
    period = _period(runs, v or [x - np.mean(x) for x in q])
    columns = []
    for n, run in enumerate(runs):
        own = [x[n] for x in (q, v) if x]
        parts = [*own, *(low_pass(run.t, x, lag * period) for x in own for lag in options.lags)]
        if q:
            parts += [apply_stop(q[n], part * size) for part in options.plays]
        columns.append(np.stack(parts, axis=1))
    whole = np.concatenate(columns)
    sizes = np.maximum(np.sqrt(np.mean(whole**2, axis=0)), 1e-300)
    return Basis(("history",), [part / sizes for part in columns])


def _period(runs: Sequence[Trajectory], values: Sequence[Vector]) -> float:
    """The period in s of a signal, from its changes of sign, the median over the series; a fifth of
    the duration where it keeps its sign."""
    found = []
    for run, x in zip(runs, values, strict=True):
        turns = int(np.sum(np.diff(np.signbit(x))))
        found.append(float(run.t[-1] - run.t[0]) * (2 / turns if turns > 1 else 0.2))
    return float(np.median(found))


def low_pass(t: Vector, x: Vector, lag: float) -> Vector:
    """y with lag*y' = x - y, begun at the first value; even samples."""
    from scipy.signal import lfilter  # half a second that only the map of what is missing pays

    keep = math.exp(-float(np.median(np.diff(t))) / lag)
    found, _ = lfilter([1 - keep], [1, -keep], x, zi=[keep * x[0]])
    return np.asarray(found)


def apply_stop(q: Vector, width: float) -> Vector:
    """What a stop of half width `width` holds of q: it follows q and slips at its ends."""
    found = np.zeros(len(q))
    for n, step in enumerate(np.diff(q).tolist()):
        found[n + 1] = min(max(found[n] + step, -width), width)
    return found


def _axis(values: Sequence[Vector], count: int, scale: Scale = np.asarray) -> Axis:
    ends = [float(f(scale(np.concatenate(values)))) for f in (np.min, np.max)]
    return Axis(values, scale, np.linspace(ends[0], ends[1], count))


def _asinh(values: Sequence[Vector], part: float) -> Scale:
    slope = part * float(np.sqrt(np.mean(np.concatenate(values) ** 2)))
    return lambda x: np.arcsinh(x / slope)


def _grid(names: tuple[str, ...], *axes: Axis) -> Basis:
    columns = [
        _product([axis.bumps(x) for axis, x in zip(axes, found, strict=True)])
        for found in zip(*(axis.values for axis in axes), strict=True)
    ]
    return Basis(names, columns, axes)


def _product(bumps: Sequence[Matrix]) -> Matrix:
    """All products of the columns of one or two matrices."""
    if len(bumps) == 1:
        return bumps[0]
    one, other = bumps
    return np.asarray((one[:, :, None] * other[:, None, :]).reshape(len(one), -1))
