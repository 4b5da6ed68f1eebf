"""Profile likelihood: how the fit worsens as one value is held away from its best."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracewire.arguments import checked
from tracewire.array_types import Vector
from tracewire.blas import one_blas_thread
from tracewire.errors import FitError, OptionError, Problem, unknown
from tracewire.fit.limits import PROFILE
from tracewire.fit.result import Fit
from tracewire.fit.uncertainty import criterion_unit
from tracewire.fit.weighing import noise_instead_of_units
from tracewire.residual import Criterion, Unknown, solve_least_squares, whole_segment
from tracewire.result import Result

Step = tuple[float, float, NDArray[np.float64]]
"""A value, the rise there, and the other scaled unknowns."""


@dataclass(frozen=True, eq=False, repr=False)
class Profile(Result):
    """How the fit worsens as the value `name` is held and the others are fitted again.

    `values` (n,) in SI, ascending, and at each the `rise` (n,) of -2 log likelihood over the best
    found, with the `others` (n,) by name. `interval` holds the values whose rise stays below
    `level`: 95 % of Student's t squared, chi-square's 3.84 where there are many samples. An end
    that was not found is infinite; `words` say why.
    """

    name: str
    values: Vector
    rise: Vector
    others: Mapping[str, Vector]
    interval: tuple[float, float]
    level: float
    words: str


@checked
@one_blas_thread()
def profile(
    fit: Fit,
    name: str,
    *,
    points: int = 10,
    span: tuple[float, float] | None = None,
    steps: int = 30,
) -> Profile:
    """The profile likelihood of one fitted value (D. M. Bates and D. G. Watts, Nonlinear Regression
    Analysis, 1988, chapter 6).

    From the best to each side the value is held at most `points` times, in growing steps from its
    standard error, until the rise passes its 95 % level or the value meets a bound or the end of
    `span` (SI); each time the others go on from the neighbour's by least squares of at most `steps`
    trials. The rise is that of the criterion in units that make it chi-square near the best, with
    the noise's autocorrelation (R. E. Chandler and S. Bate, Biometrika 94, 2007, 167).

    Raises OptionError: the fit has no such value, no points, a span that leaves the best outside;
    FitError: a residual of zero.
    """
    if name not in fit.values:
        raise OptionError([unknown("fitted value", name, fit.values)])
    if points < 2:
        raise OptionError.one(f"{points} points on each side show no profile", hint="Ask for 2.")
    best = fit.values[name]
    low, high = fit.bounds[name] if span is None else span
    if not low <= best <= high or low == high:
        what = f"'{name}' was fitted at {best:g}, outside the span {low:g} to {high:g} (SI)"
        raise OptionError([Problem(what, hint="Give a span in SI with the fitted value inside.")])
    held = _Held(fit, name, steps)
    level = fit.uncertainty.quantile**2
    step = PROFILE.first * held.error
    sides = [
        held.follow(best, sign * step, end, points, level)
        for sign, end in ((-1.0, low), (1.0, high))
    ]
    found = [*reversed(sides[0]), (best, 0.0, held.begin), *sides[1]]
    values = np.array([value for value, _, _ in found])
    rise = np.array([more for _, more, _ in found])
    fell, middle = float(-rise.min()), int(np.argmin(rise))
    rise = rise + fell
    ends = (
        _crossing(values[middle::-1], rise[middle::-1], level, -math.inf),
        _crossing(values[middle:], rise[middle:], level, math.inf),
    )
    others = np.array([held.others(z) for _, _, z in found])
    names = [unknown.name for unknown in held.unknowns]
    words = _words(name, values, ends, (low, high))
    if fell > PROFILE.fell:
        words += f"; a better fit was found at {values[middle]:.5g}: the fit had not converged"
    return Profile(name, values, rise, dict(zip(names, others.T, strict=True)), ends, level, words)


class _Held:
    """The criterion of a fit with one of its values held."""

    def __init__(self, fit: Fit, name: str, steps: int) -> None:
        train = [m for m in fit.measured if m.use == "train"] or list(fit.measured)
        self.segments = [whole_segment(fit.model, m) for m in train]
        unknowns = [
            Unknown(n, value, *fit.bounds[n], _size(fit, n)) for n, value in fit.values.items()
        ]
        self.sigma = noise_instead_of_units(fit.model, train)
        free = Criterion(
            fit.model, self.segments, unknowns, fit.parameters, fit.rtol, self.sigma, loss=fit.loss
        )
        starts = [
            fit.starts.get(segment.measured.name, {})[state]
            for segment in self.segments
            for state in segment.free
        ]
        z = np.array([*fit.values.values(), *starts]) / free.scales
        residuals, derivatives = free.residuals_and_jacobians(z)
        index = list(fit.values).index(name)
        correlated = any(fit.uncertainty.orders.values())
        self.unit, error = criterion_unit(free, residuals, derivatives, index, correlated)
        if self.unit <= 0:
            what = "the residual is zero to the last digit: without noise there is no profile"
            raise FitError([Problem(what)])
        error *= free.scales[index]
        own = fit.errors[name]
        self.error = own if own > 0 else min(error, 0.3 * free.scales[index])
        self.best = free.value(z)
        self.fit, self.name, self.steps = fit, name, steps
        self.unknowns = [u for u in unknowns if u.name != name]
        self.begin = np.delete(z, index)

    def others(self, z: Vector) -> list[float]:
        """The other fitted values."""
        return [float(x * u.scale) for u, x in zip(self.unknowns, z, strict=False)]

    def at(self, value: float, z: Vector) -> Step:
        """The rise where the value is held, and the others refitted from z."""
        criterion = Criterion(
            self.fit.model,
            self.segments,
            self.unknowns,
            {**self.fit.parameters, self.name: value},
            self.fit.rtol,
            self.sigma,
            loss=self.fit.loss,
        )
        if len(z):
            z = solve_least_squares(criterion, z, steps=self.steps).z
        return value, (criterion.value(z) - self.best) / self.unit, z

    def follow(self, best: float, step: float, end: float, points: int, level: float) -> list[Step]:
        """Values to one side: beyond the level, and close to where it is passed."""
        found = [(best, 0.0, self.begin)]
        size = abs(step)
        while (
            len(found) <= points and found[-1][0] != end and found[-1][1] < PROFILE.beyond * level
        ):
            ahead = found[-1][0] + math.copysign(size, step)
            ahead = max(ahead, end) if step < 0 else min(ahead, end)
            found.append(self.at(ahead, found[-1][2]))
            size *= PROFILE.growth
        for _ in range(PROFILE.finer):
            n = next((n for n, (_, rise, _) in enumerate(found) if rise > level), 0)
            values = np.array([value for value, _, _ in found])
            rise = np.array([rise for _, rise, _ in found])
            if n == 0 or rise[n] < 3 * level:
                break
            between = _crossing(values, rise, 1.2 * level, values[n])
            found.insert(n, self.at(between, found[n - 1][2]))
        return found[1:]


def _size(fit: Fit, name: str) -> float:
    low, high = fit.bounds[name]
    width = high - low if np.isfinite(high - low) else 1.0
    return max(abs(fit.began[name]), abs(fit.values[name])) or 0.1 * width


def _crossing(values: Vector, rise: Vector, level: float, otherwise: float) -> float:
    """Where the rise first passes the level; its root is nearly linear in the value."""
    roots = np.sqrt(np.maximum(rise, 0.0))
    above = np.flatnonzero(rise > level)
    if not len(above):
        return otherwise
    n = int(above[0])
    return float(np.interp(level**0.5, roots[n - 1 : n + 1], values[n - 1 : n + 1]))


def _words(
    name: str, values: Vector, ends: tuple[float, float], bounds: tuple[float, float]
) -> str:
    low, high = ends
    if np.isfinite(low) and np.isfinite(high):
        return f"{name} lies between {low:.5g} and {high:.5g} (SI, 95 %)"
    below = _open(name, "lower", "below", low, float(values[0]), bounds[0])
    return f"{below}; {_open(name, 'upper', 'above', high, float(values[-1]), bounds[1])}"


def _open(name: str, side: str, where: str, end: float, last: float, bound: float) -> str:
    if np.isfinite(end):
        return f"the {side} end of {name} is {end:.5g} (SI, 95 %)"
    reach = "within the bounds" if last == bound else f"down to {last:.5g}"
    if side == "upper" and last != bound:
        reach = f"up to {last:.5g}"
    return f"no {side} end {reach}: {name} is not determined from {where}"
