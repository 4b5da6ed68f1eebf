"""The period of a measured motion in samples."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.formula import Name
from tracewire.residual import Measured, Section
from tracewire.trace.data_thresholds import PeriodOptions
from tracewire.trace.options import TraceOptions


def passing_period(model: Model, signal: str, section: Section, options: TraceOptions) -> float:
    """Twice the mean time between passages of a signal's mean, in samples; infinite where there is
    at most one. A turn of what goes round is a period, and so is, where a body on a spring moves
    and rests many times between such passages, the time between its moves."""
    period = _between_passages(section.measured.values[signal][section.first : section.end])
    period = min(period, _between_moves(model, section.measured, [signal], options.period))
    return min(period, samples_in_turn(model, signal, section.measured, options))


def _between_passages(y: Vector) -> float:
    crossings = int(np.sum(np.diff(np.signbit(y - np.mean(y)))))
    return 2 * len(y) / crossings if crossings > 1 else float("inf")


def _between_moves(
    model: Model, m: Measured, signals: Iterable[str], options: PeriodOptions
) -> float:
    """The time between moves of what is a pulled place among signals, the median over signals;
    infinite where the mean of the record is passed often beside that."""
    places = [m.values[name] for name in signals if _is_pulled_place(model, name)]
    if not places:
        return float("inf")
    moves = float(np.median([time_between_moves(y, options) for y in places]))
    passages = float(np.median([_between_passages(y) for y in places]))
    return moves if options.returns * moves <= passages else float("inf")


def _is_pulled_place(model: Model, signal: str) -> bool:
    """Whether a signal is where a body is, a state whose rate is a state, and the place pulls at
    some body, as by a spring: only then do runs lose the phase of its moves."""
    rate = next((state.rate for state in model.flat.states if state.name == signal), None)
    if not isinstance(rate, Name) or rate.name not in model.states:
        return False
    low = model.lowered
    roots = [*low.rates, *(mode.guard for mode in low.modes)]
    return low.states[model.states.index(signal)] in low.tape.needed(roots)


def time_between_moves(y: Vector, options: PeriodOptions) -> float:
    """The mean time in samples from one move to the next, of what moves and rests, or slows down,
    many times; infinite for other motions.

    A move begins where the speed passes its root mean square, and ends where it falls far below
    that. The speed is that of means over steps of time in which noise makes no moves: steps twice
    as long count as many, and are short beside the time between moves.
    """
    finest = max(len(y) // options.speed_steps, 1)
    steps = [finest << doublings for doublings in range(options.speed_doublings + 1)]
    counts = [_count_moves(y, step, options.rests) for step in steps]
    for step, (count, coarser) in zip(steps, pairwise(counts), strict=False):
        alike = abs(count - coarser) <= options.moves_alike * count
        if count >= options.returns and alike and len(y) >= options.steps_in_a_move * step * count:
            return len(y) / count
    return float("inf")


def _count_moves(y: Vector, step: int, rests: float) -> int:
    if len(y) <= 2 * step:
        return 0
    means = np.convolve(y, np.full(step, 1 / step), "valid")
    speed = np.abs(means[step:] - means[:-step])
    size = float(np.sqrt(np.mean(speed**2)))
    level = np.where(speed > size, 1, np.where(speed < rests * size, 0, -1))
    return int(np.sum(np.diff(level[level >= 0]) > 0))


def period_of(model: Model, section: Section, options: TraceOptions) -> float:
    """The dominant period in samples, the time between many moves, or a turn of what goes round."""
    turns = [samples_in_turn(model, n, section.measured, options) for n in section.measured.values]
    m, period = section.measured, dominant_period(section)
    moves = _between_moves(model, m, m.values, options.period)
    return min(period, moves, float(np.median(turns)))


def dominant_period(section: Section) -> float:
    """The period in samples that halves the power of the measured signals, the median over them;
    infinite where most of the power has a period longer than half the record."""
    found = [
        _median_period(values[section.first : section.end])
        for values in section.measured.values.values()
    ]
    return float(np.median(found))


def samples_in_turn(model: Model, signal: str, measured: Measured, options: TraceOptions) -> float:
    """The samples in which an angle, or what a rate in rad/s adds up to, goes once round, the mean
    over a series; infinite where it does not go round many times, or too fast to see a turn."""
    t, values, unit = measured.t, measured.values[signal], model.flat.units.get(signal)
    if unit == "rad/s":
        values = np.cumsum(values * np.gradient(t))
    turns = float(np.ptp(values)) / (2 * np.pi)
    if unit not in ("rad", "rad/s") or turns < options.period.returns:
        return float("inf")
    samples = len(values) / turns
    return samples if samples >= options.split.shortest else float("inf")


def _median_period(values: Vector) -> float:
    count = len(values)
    if count < 8:
        return float("inf")
    slope = np.linspace(-0.5, 0.5, count)
    basis = np.column_stack((np.ones(count), slope))
    left = values - basis @ np.linalg.lstsq(basis, values, rcond=None)[0]
    power = np.abs(np.fft.rfft(left * np.hanning(count))) ** 2
    power[0] = 0.0
    if not power.sum() > 0:
        return float("inf")
    line = int(np.searchsorted(np.cumsum(power), 0.5 * power.sum()))
    return count / line if line > 2 else float("inf")
