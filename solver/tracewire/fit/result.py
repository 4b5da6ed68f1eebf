"""The result of a fit: values, standard errors, and every series beside the model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.fit.measured import Measured

Vector = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Comparison:
    """One measured signal of one series beside the model before and after the fit.

    `t` (N,) in s; `measured`, `before` and `after` (N,) in SI.
    """

    series: str
    use: str
    signal: str
    unit: str
    t: Vector
    measured: Vector
    before: Vector
    after: Vector

    @property
    def rmse_before(self) -> float:
        """Root mean square error before the fit, in SI."""
        return float(np.sqrt(np.mean((self.before - self.measured) ** 2)))

    @property
    def rmse_after(self) -> float:
        """Root mean square error after the fit, in SI."""
        return float(np.sqrt(np.mean((self.after - self.measured) ** 2)))


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted diagram.

    `values` are the free parameters by name in SI (the offset of a sensor is `offset.SIGNAL`),
    `began` what they were before, `errors` their standard errors (NaN where the data do not
    determine them). `starts` holds the fitted start values by series and state. `criterion` is the
    sum over series and signals of mean(residual^2)/2 of the train series, in SI, or in sigma where
    these are declared. `exitflag` is 1 where the search converged, 0 where a limit ended it, -1
    where an output function did.
    """

    model: Model
    method: str
    measured: tuple[Measured, ...]
    began: Mapping[str, float]
    values: Mapping[str, float]
    errors: Mapping[str, float]
    bounds: Mapping[str, tuple[float, float]]
    starts: Mapping[str, Mapping[str, float]]
    criterion_before: float
    criterion: float
    evaluations: int
    iterations: int
    exitflag: int
    message: str
    seconds: float
    comparisons: tuple[Comparison, ...]
