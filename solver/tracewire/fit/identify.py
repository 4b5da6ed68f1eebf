"""Which combinations of parameters the data do not determine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.fit.limits import UNCERTAINTY


@dataclass(frozen=True, eq=False)
class ParameterColumns:
    """The unknowns of a fit (n,), in SI: parameters and sensors first, then free start values.

    `count` are the parameters and sensors. `sizes` are those by which unknowns were scaled. `value`
    is the criterion at values (n,); it is asked only where a sum and a product look alike.
    """

    names: tuple[str, ...]
    count: int
    values: Vector
    sizes: Vector
    low: Vector
    high: Vector
    value: Callable[[Vector], float] | None = None


@dataclass(frozen=True, eq=False)
class LinearResponse:
    """What the data say of relative changes of parameters, all correlations included.

    The residual moves by `response` (n, n) times the relative changes, `noise` (n, n) is the
    covariance of the data in the same coordinates: those of an orthonormal basis of the columns.
    `accuracy` is the relative error of the derivatives.
    """

    response: Matrix
    noise: Matrix
    accuracy: float

    def normal(self, active: Sequence[int]) -> tuple[Vector, Vector, Matrix]:
        """Lengths of the active columns, singular values and directions of unit columns."""
        columns = self.response[:, active]
        lengths = np.linalg.norm(columns, axis=0)
        _, singular, directions = np.linalg.svd(columns / lengths)
        return lengths, singular, directions

    def covariance(self, active: Sequence[int]) -> Matrix:
        """The covariance of the active relative changes, the others held: P noise P'."""
        columns = self.response[:, active]
        lengths = np.linalg.norm(columns, axis=0)
        inverse = np.linalg.pinv(columns / lengths, rcond=1e-15) / lengths[:, None]
        return np.asarray(inverse @ self.noise @ inverse.T)

    def information(self, active: Sequence[int]) -> Matrix:
        """The inverse of the covariance, which exists where that is infinite."""
        basis, square = np.linalg.qr(self.response[:, active])
        return np.asarray(square.T @ np.linalg.pinv(basis.T @ self.noise @ basis) @ square)

    def refit_change(self, one: int, others: Sequence[int]) -> Vector:
        """How the others change in a refit when one parameter is changed by its size."""
        moved = np.zeros(self.response.shape[1])
        moved[one] = 1.0
        columns = self.response[:, others]
        lengths = np.linalg.norm(columns, axis=0)
        found, *_ = np.linalg.lstsq(columns / lengths, -self.response[:, one])
        moved[list(others)] = found / lengths
        return moved

    def direction_of(self, fixed: int, changes: Vector, ratio: float) -> FlatDirection:
        """A flat direction; exactly flat with an infinite ratio."""
        effects = np.abs(changes) * np.linalg.norm(self.response, axis=0)
        return FlatDirection(fixed, changes, effects / effects.max(), ratio, not np.isfinite(ratio))


@dataclass(frozen=True, eq=False)
class FlatDirection:
    """A direction along which the residual hardly changes, in relative changes (n,).

    It is what the others do in a refit when the parameter `fixed` is changed; `ratio` is the
    relative standard deviation along it, infinite where the direction is `exact`ly flat. `effects`
    (n,) are what each change alone does to the residual, the largest being 1.
    """

    fixed: int
    changes: Vector
    effects: Vector
    ratio: float
    exact: bool


def flat_directions(
    response: LinearResponse, active: Sequence[int], preferred: int, values: Vector
) -> tuple[list[FlatDirection], set[int]]:
    """The directions that the data do not determine, and the parameters that these are made of.

    In turn, the parameter that takes the largest part in an undetermined direction is held, until
    the rest is determined; those below `preferred` are held first, and of equals the last. A
    direction is undetermined where unit columns have a singular value below the derivatives'
    accuracy; or where a relative standard error exceeds 50 %, so that two of them reach the value
    itself, and the others imitate the parameter so well that its error is over 100 times that of
    the parameter alone (the collinearity index of Brun, Reichert and Kuensch, Water Resources
    Research 37, 2001). A large error without collinearity is an honest interval and no missing
    information. `values` (n,) are the values in units of the sizes that changes are relative to.
    """
    left, missing = list(active), set[int]()
    exact: list[int] = []
    found: list[FlatDirection] = []
    information = response.information(active) if active else np.zeros((0, 0))
    while left:
        lengths, singular, directions = response.normal(left)
        is_exact = bool(singular[-1] < response.accuracy)
        if is_exact:
            null = np.linalg.qr((directions[singular < response.accuracy] / lengths).T)[0]
            part = np.linalg.norm(null, axis=1)
            weak = part > UNCERTAINTY.part
        else:
            inflation = np.linalg.norm(directions.T / singular, axis=1)
            covariance = response.covariance(left)
            errors = np.sqrt(np.diag(covariance))
            weak = (errors > UNCERTAINTY.loose) & (inflation > UNCERTAINTY.collinear)
            if not weak.any():
                break
            worst = int(np.argmax(np.where(weak, errors, 0.0)))
            part = np.abs(covariance[worst]) / np.linalg.norm(covariance[worst])
            weak &= (part > UNCERTAINTY.part) | (np.arange(len(left)) == worst)
        missing |= {left[j] for j in np.flatnonzero(weak)}
        first = weak & (np.array(left) < preferred)
        share = np.where(first if first.any() else weak, part / values[left], 0.0)
        held = int(np.flatnonzero(share > 0.9 * share.max())[-1])
        if is_exact:
            exact.append(left[held])
        else:
            changes = np.zeros(len(values))
            changes[left] = covariance[held] / covariance[held, held]
            unit = changes[list(active)] / np.linalg.norm(changes)
            stiffness = max(float(unit @ information @ unit), 1e-300)
            found.append(response.direction_of(left[held], changes, stiffness**-0.5))
        del left[held]
    exact_ones = [
        response.direction_of(one, response.refit_change(one, left), np.inf) for one in exact
    ]
    return [*exact_ones, *found], missing
