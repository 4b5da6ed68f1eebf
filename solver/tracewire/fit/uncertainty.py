"""How well the data determine what was fitted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit

from tracewire.array_types import Matrix, Vector
from tracewire.fit.combinations import Direction, describe_directions, followers
from tracewire.fit.identify import LinearResponse, ParameterColumns, flat_directions
from tracewire.fit.limits import UNCERTAINTY
from tracewire.residual import (
    LOSSES,
    Criterion,
    Windows,
    degrees_of,
    noise_in,
    noises_beside,
    project_out_initial_states,
)


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """What the data say of the fitted values `names` (n,), in SI.

    `covariance` (n, n) is NaN where the data do not determine a value or it sits on a bound.
    `degrees` are those of freedom of the residual, `quantile` Student's for 95 %. `orders` tells
    of each (series, signal) the order of the autoregression of its residual, 0 where white.
    `at_bounds` are values on a bound, `unmoved` parameters that the data do not depend on,
    `directions` combinations that these do not determine; `words` say all this in sentences.
    """

    names: tuple[str, ...]
    values: Vector
    covariance: Matrix
    degrees: int = 0
    quantile: float = 1.96
    orders: Mapping[tuple[str, str], int] = field(default_factory=dict)
    at_bounds: tuple[str, ...] = ()
    unmoved: tuple[str, ...] = ()
    directions: tuple[Direction, ...] = ()
    words: tuple[str, ...] = ()

    @property
    def errors(self) -> dict[str, float]:
        """Standard errors by name; NaN where the data do not determine a value."""
        return dict(zip(self.names, np.sqrt(np.diag(self.covariance)).tolist(), strict=True))

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """95 % intervals by name; NaN where the data do not determine a value."""
        half = self.quantile * np.sqrt(np.diag(self.covariance))
        ends = zip((self.values - half).tolist(), (self.values + half).tolist(), strict=True)
        return dict(zip(self.names, ends, strict=True))

    @property
    def correlation(self) -> Matrix:
        """The correlation of the values (n, n); NaN where the data do not determine one."""
        errors = np.sqrt(np.diag(self.covariance))
        sizes = np.where(errors > 0, errors, np.nan)
        return np.asarray(self.covariance / np.outer(sizes, sizes))


def uncertainty_of(
    criterion: Criterion,
    z: Vector,
    residuals: Sequence[Matrix],
    derivatives: Sequence[Matrix],
    correlated: bool = True,
) -> Uncertainty:
    """What the data say of scaled unknowns z (n,) at the minimum of a criterion.

    See `uncertainty_from`. With a robust loss rho the residual is replaced by psi/mean(psi'), psi =
    rho'/2; then the covariance is that of an M-estimator (Huber, Annals of Statistics 1, 1973).
    """
    segments = criterion.segments
    low, high = criterion.bounds()
    columns = ParameterColumns(
        tuple(criterion.names),
        len(criterion.unknowns),
        z * criterion.scales,
        criterion.scales,
        low * criterion.scales,
        high * criterion.scales,
        lambda values: criterion.value(values / criterion.scales),
    )
    found = uncertainty_from(
        [_pseudo(r, criterion.loss) for r in residuals],
        derivatives,
        [criterion.weights(n) for n in range(len(segments))],
        [(segment.measured.name, segment.signals) for segment in segments],
        columns,
        correlated=correlated,
        accuracy=max(1e-6, criterion.rtol),
    )
    lost = _lost(criterion, residuals)
    if not lost:
        return found
    words = (
        f"with the loss {criterion.loss} most samples of {', '.join(lost)} count as outliers: the "
        "errors say nothing; begin from a fit with the linear loss, or correct sigma"
    )
    covariance = np.full_like(found.covariance, np.nan)
    return replace(found, covariance=covariance, words=(words, *found.words))


def describe_undetermined(windows: Windows) -> tuple[str, ...]:
    """In sentences, which fitted values of windows with free starts the data leave open.

    As in `uncertainty_from`; a value on a bound counts as free.
    """
    names, values = tuple(windows.values), np.array([*windows.values.values()])
    if not names:
        return ()
    sizes = np.where(values, np.abs(values), 1.0)
    slopes, residual = project_out_initial_states(windows)
    everywhere = np.full(len(names), np.inf)
    columns = ParameterColumns(names, len(names), values, sizes, -everywhere, everywhere)
    found = uncertainty_from(
        [residual[:, None]],
        [slopes * sizes],
        [np.ones((1, 1))],
        [("", ("",))],
        columns,
        accuracy=max(1e-6, windows.criterion.rtol),
    )
    return found.words


def _lost(criterion: Criterion, residuals: Sequence[Matrix]) -> list[str]:
    """The signals most of whose residuals are where a robust loss hardly counts them."""
    if criterion.loss == "linear":
        return []
    return [
        f"{signal} in {segment.measured.name}"
        for segment, r in zip(criterion.segments, residuals, strict=True)
        for signal, far in zip(
            segment.signals, np.mean(np.abs(r) > UNCERTAINTY.far, axis=0), strict=True
        )
        if far > 0.5
    ]


def _pseudo(residual: Matrix, loss: str) -> Matrix:
    if loss == "linear":
        return residual
    step = 1e-4

    def psi(r: Matrix) -> Matrix:
        seen = LOSSES[loss](r)
        return seen.residual * seen.slope

    slope = (psi(residual + step) - psi(residual - step)) / (2 * step)
    return np.asarray(psi(residual) / np.maximum(np.mean(slope, axis=0), 1e-3))


def uncertainty_from(
    residuals: Sequence[Matrix],
    derivatives: Sequence[Matrix],
    weights: Sequence[Matrix],
    channels: Sequence[tuple[str, Sequence[str]]],
    columns: ParameterColumns,
    *,
    correlated: bool = True,
    accuracy: float = 1e-6,
) -> Uncertainty:
    """What the data say of fitted values, from residuals and derivatives of each segment.

    residuals (N, signals); derivatives (N*signals, n): d residual/d (unknown/size); weights that
    broadcast to (N, signals): the criterion is the sum of (weight*residual)^2/2. channels: series
    and signals of each segment.

    To first order the minimum moves by -P w e when the data move by e, P the pseudo-inverse of
    w J. So the covariance is P w S w P' (White, Econometrica 48, 1980; with autocorrelation
    Newey and West, Econometrica 55, 1987), S the covariance of the noise: for each series and
    signal sum(r^2)/N * M/(M - n), M all samples, times its autocorrelation. This is white or,
    where BIC asks for one, that of an autoregression (see `noise_of`); never one with
    `correlated=False`. For one series and one signal of white noise it is the textbook's
    s^2 (J'J)^-1 with N - n degrees of freedom. Correlation divides these by sum rho_k^2. Samples
    count by index: uneven sampling spoils the autoregression, no more.

    A value on a bound is held: it has no error, and those of the others suppose that it stays.
    Parameters that the data leave open (see `flat_directions`) have none either, nor have those
    that move with them by more than a tenth of what they do; the errors of the others suppose them
    known to 100 % of their values (one standard deviation). `accuracy` is the relative
    error of the derivatives.
    """
    names, values, sizes = columns.names, columns.values, columns.sizes
    sizes = np.maximum(np.abs(values), sizes)
    weighted = [np.broadcast_to(w, r.shape) for w, r in zip(weights, residuals, strict=True)]
    matrix = np.concatenate(
        [w.reshape(-1, 1) * m for w, m in zip(weighted, derivatives, strict=True)]
    ) * (sizes / columns.sizes)
    at_bound = _on_bounds(columns)
    lengths = np.linalg.norm(matrix, axis=0)
    moving = lengths > 1e-12 * lengths.max(initial=0.0)
    free = np.flatnonzero(moving & ~at_bound).tolist()
    basis, response = np.linalg.qr(matrix)
    own = np.linalg.qr(matrix[:, free])[0]
    noises = noises_beside(residuals, correlated, own)
    noise = noise_in(basis, weighted, noises)
    alone = np.array([_error_alone(response[:, j], noise) for j in range(len(names))])
    unmoved = ~moving | (alone > UNCERTAINTY.unmoved)
    active = [j for j in free if not unmoved[j]]
    linear_response = LinearResponse(response, noise, accuracy)
    relative = np.where(values, np.abs(values) / sizes, 1.0)
    flats, missing = flat_directions(linear_response, active, columns.count, relative)
    directions, words = describe_directions(flats, missing, replace(columns, sizes=sizes))
    covariance = np.full((len(names), len(names)), np.nan)
    kept = [j for j in active if j not in missing | followers(flats, missing)]
    if kept:
        found = _covariance(linear_response, active, missing) * np.outer(
            sizes[active], sizes[active]
        )
        rows = [active.index(j) for j in kept]
        covariance[np.ix_(kept, kept)] = found[np.ix_(rows, rows)]
    degrees = degrees_of(residuals, noises, len(free))
    first = slice(0, columns.count)
    bounds = tuple(n for n, on in zip(names[first], at_bound[first], strict=True) if on)
    still = tuple(n for n, un in zip(names[first], (unmoved & ~at_bound)[first], strict=True) if un)
    return Uncertainty(
        names[first],
        values[first],
        covariance[first, first],
        degrees,
        float(stdtrit(degrees, 0.975)),
        {
            (series, signal): noise.order
            for (series, signals), row in zip(channels, noises, strict=True)
            for signal, noise in zip(signals, row, strict=True)
        },
        bounds,
        still,
        directions,
        (*words, *(_on_bound_words(n, columns) for n in bounds), *map(_still_words, still)),
    )


def criterion_unit(
    criterion: Criterion,
    residuals: Sequence[Matrix],
    derivatives: Sequence[Matrix],
    one: int,
    correlated: bool,
) -> tuple[float, float]:
    """By how much a criterion rises where -2 log likelihood does by 1, as one unknown moves.

    Also the standard error of that scaled unknown. To first order the unknown moves by -a e when
    the weighted data move by e, so half a'a over a' S a of a rise of 1.
    """
    weights = [criterion.weights(n) for n in range(len(residuals))]
    matrix = np.concatenate(
        [w.reshape(-1, 1) * m for w, m in zip(weights, derivatives, strict=True)]
    )
    seen = [_pseudo(r, criterion.loss) for r in residuals]
    basis, response = np.linalg.qr(matrix)
    noises = noises_beside(seen, correlated, basis)
    noise = noise_in(basis, weights, noises)
    answer = np.linalg.pinv(response, rcond=1e-6)[one]
    variance = float(answer @ noise @ answer)
    return 0.5 * variance / float(answer @ answer), variance**0.5


def _on_bounds(columns: ParameterColumns) -> NDArray[np.bool_]:
    width = columns.high - columns.low
    size = np.maximum(np.abs(columns.values), columns.sizes)
    near = UNCERTAINTY.at_bound * np.minimum(width, size)
    inside = (columns.values - columns.low > near) & (columns.high - columns.values > near)
    return np.asarray(~inside)


def _error_alone(response: Vector, noise: Matrix) -> float:
    """The relative standard error of a parameter if all others were known."""
    square = float(response @ response)
    return float(np.sqrt(response @ noise @ response)) / square if square > 0 else np.inf


def _covariance(
    linear_response: LinearResponse, active: Sequence[int], missing: set[int]
) -> Matrix:
    """Of relative changes; those that are missing are supposed to be known to 100 %."""
    if not missing:
        return linear_response.covariance(active)
    supposed = np.diag([1.0 if j in missing else 0.0 for j in active])
    return np.asarray(np.linalg.inv(linear_response.information(active) + supposed))


def _on_bound_words(name: str, columns: ParameterColumns) -> str:
    j = columns.names.index(name)
    value, low, high = columns.values[j], columns.low[j], columns.high[j]
    side, bound = ("lower", low) if abs(value - low) <= abs(high - value) else ("upper", high)
    return (
        f"{name} sits on its {side} bound {bound:g} (SI): it has no error, and the errors of the "
        "others suppose that it stays there"
    )


def _still_words(name: str) -> str:
    return (
        f"{name}: the data do not depend on it, or so little that a change by its whole size "
        f"counts less than a tenth of its error; fix {name}, or measure something that it moves"
    )
