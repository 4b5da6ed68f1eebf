"""The result of a fit: values, what the data say of them, and every series beside the model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.fit.uncertainty import Uncertainty
from tracewire.residual import Measured, wrap_to_period
from tracewire.result import Result


@dataclass(frozen=True, eq=False)
class Comparison:
    """One measured signal of one series beside the model before and after the fit.

    `t` (N,) in s; `measured`, `before` and `after` (N,) in SI; `counts` (N,) marks the samples that
    the criterion counts. `period` is that of a signal compared modulo it, whose turns go on from
    sample to sample, and `before` and `after` are on the turns of `measured`; else 0. `users_unit`
    is the unit in which the user has the signal (`Diagram.users_unit`), with its factor to SI.
    """

    series: str
    use: str
    signal: str
    unit: str
    t: Vector
    measured: Vector
    before: Vector
    after: Vector
    counts: NDArray[np.bool_]
    period: float = 0.0
    sigma: float | None = None
    users_unit: tuple[str, float] = ("", 1.0)

    @property
    def as_shown(self) -> Comparison:
        """The comparison in the user's unit, as tables and figures show it."""
        unit, factor = self.users_unit
        return replace(
            self,
            unit=unit or self.unit,
            measured=self.measured / factor,
            before=self.before / factor,
            after=self.after / factor,
            period=self.period / factor,
            sigma=self.sigma and self.sigma / factor,
            users_unit=("", 1.0),
        )

    def residual(self, simulated: Vector) -> Vector:
        """Measured - simulated (N,) in SI, of a periodic signal modulo its period: that goes the
        shortest way around at the first sample that counts."""
        first = int(np.argmax(self.counts))
        return wrap_to_period(self.measured - simulated, self.period, first)

    @property
    def residual_before(self) -> Vector:
        """Measured - simulated (N,) before the fit, in SI."""
        return self.residual(self.before)

    @property
    def residual_after(self) -> Vector:
        """Measured - simulated (N,) after the fit, in SI."""
        return self.residual(self.after)

    @property
    def rmse_before(self) -> float:
        """Root mean square error before the fit, in SI, of the samples that count."""
        return float(np.sqrt(np.mean(self.residual_before[self.counts] ** 2)))

    @property
    def rmse_after(self) -> float:
        """Root mean square error after the fit, in SI, of the samples that count."""
        return float(np.sqrt(np.mean(self.residual_after[self.counts] ** 2)))


@dataclass(frozen=True)
class Improvement:
    """A new best of a search: evaluations so far, its criterion, and the values by name in SI."""

    evaluations: int
    criterion: float
    values: Mapping[str, float]


@dataclass(frozen=True, eq=False, repr=False)
class Fit(Result):
    """A fitted diagram.

    `values` are the free parameters by name in SI (those of a sensor are `offset.SIGNAL`,
    `gain.SIGNAL`, `delay.SIGNAL`), `began` what they were before. `starts` holds the fitted start
    values by series and state. `criterion` is the sum over series and signals of
    mean(residual^2)/2 of the train series, in SI, or in sigma where these are declared, or where
    the signals have different units (`fit.weighing`); with weights and another loss where these are
    given. `evaluations` counts evaluations of the criterion; one with sensitivities counts as one
    plus the number of free parameters. `history` holds each new best of the search. `parameters`
    were given for the fit, `rtol` is that of its runs. `exitflag` is 1 where the search ended by
    its own tolerance, which may be before a minimum (`message`), 0 where a limit ended it, -1 where
    an output function or Ctrl-C did (`interrupted`). `unfinished` says that the search ended before
    a minimum, and how to go on; it is empty at a minimum. `uncertainty` is what the data say of the
    values, `remarks` what a reader must know: runs that failed, series whose data are odd.
    """

    model: Model
    method: str
    measured: tuple[Measured, ...]
    began: Mapping[str, float]
    values: Mapping[str, float]
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
    uncertainty: Uncertainty
    history: tuple[Improvement, ...] = ()
    seed: int = 0
    loss: str = "linear"
    parameters: Mapping[str, float] = field(default_factory=dict)
    rtol: float = 1e-6
    interrupted: bool = False
    unfinished: str = ""
    remarks: tuple[str, ...] = field(default_factory=tuple)

    @property
    def found(self) -> dict[str, float]:
        """The values without those that the data do not depend on, which are as they were."""
        kept = {n for n in self.uncertainty.unmoved if self.values.get(n) == self.began.get(n)}
        return {name: value for name, value in self.values.items() if name not in kept}

    @property
    def errors(self) -> Mapping[str, float]:
        """Standard errors by name in SI; NaN where the data do not determine a value."""
        return self.uncertainty.errors

    @property
    def intervals(self) -> Mapping[str, tuple[float, float]]:
        """95 % intervals by name in SI; NaN where the data do not determine a value."""
        return self.uncertainty.intervals
