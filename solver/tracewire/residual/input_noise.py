"""What the noise of measured inputs does to the signals of a series.

A run is driven by the measured input, noise and all. What this does to the signals is no effect
that the diagram lacks: it counts as noise.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model, compile
from tracewire.residual.input_response import (
    InputNoise,
    InputResponse,
    input_response,
    side_by_side,
    states_in_windows,
)
from tracewire.residual.limits import INPUT
from tracewire.residual.measured import Measured
from tracewire.residual.segment import Segment, of_diagram
from tracewire.residual.starts import whole_segment
from tracewire.solve import simulate


@dataclass(frozen=True)
class LikelyNoise:
    """The noise of an input that makes residuals in windows most likely: `sigma` in SI, and the
    reduced chi-square of the windows without it (`before`) and with it (`after`).

    It explains the residuals where `after` is about 1, and the noise is white: `evenness` is about
    1, the ratio of what is left in that half of what it made that is fast to that in the slow half,
    or the other way round, whichever is below 1. A law that is missing is slow.
    """

    sigma: float
    before: float
    after: float
    evenness: float


class InputCovariance:
    """The covariance of residuals that the noise of inputs makes in windows of series.

    It is slow, and adds up: a sensor's noise would have to be many times larger to hide it, and a
    short event would then not be seen. So residuals are whitened by it instead. `sigma` is the
    noise of the signals, `length` the samples of windows that a model follows.
    """

    def __init__(
        self, sigma: Mapping[str, float], model: Model, series: Sequence[Measured], length: int
    ) -> None:
        self.sigma, self.model, self.length = dict(sigma), model, length
        self.series = {m.name: m for m in series if m.input_sigma}
        self._responses: dict[str, InputResponse] = {}
        self._known: dict[tuple[str, int, bytes], Matrix | Vector] = {}

    def whitening(self, segment: Segment) -> Matrix | Vector | None:
        """The W (M, M) that makes a window's residuals in sigma white, by sample and signal: W C W'
        is 1 for their covariance C. Of long windows its diagonal (M,), as if they did not
        correlate. None where the series declares no noise of an input."""
        name = segment.measured.name
        if name not in self.series:
            return None
        measured = self.series[name]
        first = int(np.searchsorted(measured.t, segment.begin))
        key = name, min(first, int(segment.rows[0])), segment.rows.tobytes()
        if key not in self._known:
            if sum(known.size for known in self._known.values()) > INPUT.kept:
                self._known.clear()
            self._known[key] = self._compute(measured, key[1], segment.rows)
        return self._known[key]

    def _compute(self, measured: Measured, first: int, rows: NDArray[np.intp]) -> Matrix | Vector:
        from scipy.linalg import solve_triangular

        name = measured.name
        if name not in self._responses:
            self._responses[name] = response_in_windows(self.model, measured, {}, self.length)
        response = self._responses[name]
        level = np.array([self.sigma[signal] for signal in response.signals])
        window = np.arange(first, int(rows[-1]) + 1)
        size = len(rows) * len(level)
        if size > INPUT.largest:  # a free run: its covariance would fill the memory
            noise = response.noise(measured.input_sigma, [window], ())
            more = np.array([noise[signal].size for signal in response.signals]) / level
            return np.asarray(np.tile(1 / np.sqrt(1 + more**2), len(rows)))
        made = response.impulses(measured.input_sigma, window)[rows - first]
        scaled = (made / level[:, None]).reshape(size, -1)
        factor = np.linalg.cholesky(np.eye(size) + scaled @ scaled.T)
        # no value of C is below 1, so that none of its inverse is above it
        return np.asarray(solve_triangular(factor, np.eye(size), lower=True, check_finite=False))


def likely_input_noise(
    response: InputResponse,
    name: str,
    sigma: Mapping[str, float],
    windows: Sequence[tuple[Segment, Matrix, Matrix]],
) -> LikelyNoise:
    """The white noise of one input that makes the residuals of windows of a series most likely.

    `windows` are segments, their residuals (W, m) in sigma, not whitened, and the derivatives
    (W*m, f) of these by the free starts, which are projected out (restricted likelihood: H. D.
    Patterson and R. Thompson, Biometrika 58, 1971, 545). Windows that are too long are left out.
    """
    level = np.array([sigma[signal] for signal in response.signals])
    sizes, squares = [np.zeros(0)], [np.zeros(0)]
    for segment, residual, slopes in windows:
        if residual.size > INPUT.largest:
            continue
        first = int(np.searchsorted(segment.measured.t, segment.begin))
        first = min(first, int(segment.rows[0]))
        made = response.impulses({name: 1.0}, np.arange(first, int(segment.rows[-1]) + 1))
        scaled = (made[segment.rows - first] / level[:, None]).reshape(residual.size, -1)
        whole, _ = np.linalg.qr(slopes, mode="complete")
        rest = whole[:, slopes.shape[1] :].T
        left, strength, _ = np.linalg.svd(rest @ scaled, full_matrices=True)
        sizes.append(np.zeros(len(left)))
        sizes[-1][: len(strength)] = strength**2
        squares.append((left.T @ (rest @ residual.ravel())) ** 2)
    size, square = np.concatenate(sizes), np.concatenate(squares)
    if not len(size) or not np.max(size) > 0:
        return LikelyNoise(0.0, float(np.mean(square)) if len(square) else 0.0, 0.0, 0.0)

    def unlikely(log: float) -> float:

        variance = 1 + np.exp(log) * size
        return float(np.sum(np.log(variance) + square / variance))

    # from what no sample shows to what would make all of the residual
    ends = -np.log(np.max(size)) - 5, np.log(np.sum(square) / np.sum(size)) + 5
    grid = np.linspace(min(ends), max(ends), INPUT.grid)
    from scipy.optimize import minimize_scalar

    best = int(np.argmin([unlikely(log) for log in grid]))
    around = grid[max(best - 1, 0)], grid[min(best + 1, INPUT.grid - 1)]
    found = float(np.exp(minimize_scalar(unlikely, bounds=around, method="bounded").x))
    left = square / (1 + found * size)
    evenness = _evenness(left[np.argsort(size)][np.sum(found * size <= 1) :])
    return LikelyNoise(found**0.5, float(np.mean(square)), float(np.mean(left)), evenness)


def _evenness(left: Vector) -> float:
    """The ratio of the means of the first and the second half of what is left, at most 1."""
    if len(left) < INPUT.least_halves:
        return 1.0
    halves = [float(np.mean(half)) for half in np.array_split(left, 2)]
    return min(halves) / max(halves)


def response_in_windows(
    model: Model, measured: Measured, values: Mapping[str, float], length: int
) -> InputResponse:
    """How a series answers to its inputs along windows that begin at what the data tell."""
    states = states_in_windows(model, measured, values, length)
    return input_response(model, measured, states, values)


def run_noise(
    model: Model,
    measured: Measured,
    values: Mapping[str, float],
    start: Mapping[str, float],
    fitted: Sequence[str] = (),
) -> dict[str, InputNoise]:
    """What the declared noise of a series' inputs makes of its signals in one run over all of it,
    from a start, of which the states are free that the series says; parameters are `fitted`.

    Raises SimulationError where the run fails.
    """
    segment = whole_segment(model, measured)
    signals = list(measured.values)
    record = list(dict.fromkeys((*signals, *model.states)))
    asked = [name for name in fitted if name in model.flat.parameters]
    run = simulate(
        compile(model.diagram, record=record, backend="quick"),
        parameters=of_diagram(model, values, measured),
        start={**segment.start, **start},
        span=(segment.begin, float(measured.t[-1])),
        times=measured.t,
        preset=measured.preset,
        inputs=measured.inputs,
        sensitivities=asked,
    )
    states = side_by_side([run[name] for name in model.states], len(measured.t))
    slopes = np.zeros((len(measured.t), len(signals), len(asked)))
    for column, name in enumerate(asked):
        slopes[:, :, column] = np.stack([run.sensitivities[name][n] for n in signals], axis=1)
    response = input_response(model, measured, states, values)
    rows = [np.arange(len(measured.t))]
    return response.noise(measured.input_sigma, rows, segment.free, slopes)
