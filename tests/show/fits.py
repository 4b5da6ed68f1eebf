"""Made-up results of fits, of any size, whose numbers are known."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.fit import Comparison, Fit
from tracewire.fit.result import Improvement
from tracewire.fit.uncertainty import Uncertainty
from tracewire.residual import Measured, Sensor

TEXT = """\
title: Swing & rest
span: [0, 2]
parameters:
  k: {value: 4, unit: N m/rad, fit: [0, 10]}
  J: {value: 1, unit: kg m^2, fit: free}
  w0: {value: sqrt(k/J), unit: rad/s}
presets: {lab: {k: 4}}
blocks:
  x: {type: integrator, of: v, start: 1, unit: rad}
  v: {type: integrator, of: a}
  a: {type: expression, formula: -w0**2*x}
"""
MODEL = compile(read_text(TEXT))


def compared(
    series: str = "run",
    use: str = "train",
    signal: str = "x",
    count: int = 21,
    sigma: float | None = None,
    after: float = 0.1,
    period: float = 0.0,
    burn: int = 0,
) -> Comparison:
    """A signal cos(2t) + 5t where it has a period, 0.2 off before the fit and `after` after it."""
    t = np.linspace(0, 2, count)
    x = np.cos(2 * t) + (5 * t if period else 0 * t)
    noise = 0.0 if sigma is None else sigma * np.random.default_rng(0).standard_normal(count)
    measured = x + noise
    if period:
        measured = measured - period * np.round(measured / period)
    counts = np.arange(count) >= burn
    return Comparison(
        series, use, signal, "rad", t, measured, x + 0.2, x + after, counts, period, sigma
    )


def covariance(errors: Sequence[float], correlation: float = 0.0) -> NDArray[np.float64]:
    """The covariance of values with these errors that are all correlated alike."""
    size = len(errors)
    matrix = np.full((size, size), correlation) + (1 - correlation) * np.eye(size)
    return np.asarray(np.outer(errors, errors) * matrix)


def made_fit(
    values: dict[str, float] | None = None,
    errors: Sequence[float] = (0.25, math.nan, 0.01),
    comparisons: tuple[Comparison, ...] | None = None,
    model: Model = MODEL,
    bounds: dict[str, tuple[float, float]] | None = None,
    correlation: float = 0.3,
) -> Fit:
    """A fit from other values to these; without any, of k, J (not determined) and offset.x."""
    if values is None:
        values = {"k": 10.0, "J": 2.0, "offset.x": 0.1}
        began = {"k": 4.0, "J": 1.0, "offset.x": 0.0}
        bounds = {"k": (0.0, 10.0), "J": (-math.inf, math.inf), "offset.x": (-1.0, 1.0)}
    else:
        began = {name: 1.3 * value for name, value in values.items()}
    shown = (compared(),) if comparisons is None else comparisons
    uncertainty = Uncertainty(
        tuple(values),
        np.array(list(values.values())),
        covariance(errors, correlation),
        degrees=18,
        quantile=2.0,
        words=("Only k/J is determined: fix J or k.",) if math.nan in errors else (),
    )
    counts = np.unique(np.geomspace(1, 42, 15).astype(int)).tolist()
    history = tuple(
        Improvement(
            count,
            0.005 + 0.495 * math.exp(-0.3 * (count - 1)),
            {
                name: value + (began[name] - value) * math.exp(-0.2 * (n + 1) * (count - 1))
                for n, (name, value) in enumerate(values.items())
            },
        )
        for count in counts
    )
    return Fit(
        model=model,
        method="fminsearch",
        measured=measured_of(shown),
        began=began,
        values=values,
        bounds=bounds or dict.fromkeys(values, (-math.inf, math.inf)),
        starts={},
        criterion_before=0.5,
        criterion=0.005,
        evaluations=42,
        iterations=21,
        exitflag=1,
        message="It\nconverged.\n",
        seconds=1.25,
        comparisons=shown,
        uncertainty=uncertainty,
        history=history,
    )


def measured_of(comparisons: Sequence[Comparison]) -> tuple[Measured, ...]:
    """The measured series that the comparisons belong to."""
    names = dict.fromkeys(c.series for c in comparisons)
    found = []
    for name in names:
        own = [c for c in comparisons if c.series == name]
        first = own[0]
        found.append(
            Measured(
                name,
                first.use,
                first.t,
                {c.signal: c.measured for c in own},
                sigma={c.signal: c.sigma for c in own},
                sensors={"x": Sensor(offset=0.0, delay=0.01, free={"offset": (-1.0, 1.0)})},
                periods={c.signal: c.period for c in own if c.period},
                counts_from=float(first.t[first.counts][0]),
                preset="lab",
                file="data/swing.csv",
                steps=("resampled to 10 ms by linear interpolation",),
                remarks=("the time base jitters by 2 %",),
            )
        )
    return tuple(found)
