"""`fit`: the free parameters of a diagram from its measured series."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model, compile
from tracewire.errors import DataError, FitError, OptionError, Problem, unknown
from tracewire.fit.criterion import Criterion, Segment
from tracewire.fit.descent import descend
from tracewire.fit.measured import Measured, load_measured, measured_signals
from tracewire.fit.optimset import Options
from tracewire.fit.result import Comparison, Fit
from tracewire.fit.search import Progress, by_least_squares, by_simplex
from tracewire.fit.starts import whole_segment
from tracewire.fit.uncertainty import standard_errors
from tracewire.fit.unknowns import free_unknowns, offset_unknowns
from tracewire.solve import parameter_values

Vector = NDArray[np.float64]
METHODS = ("fminsearch", "least_squares")


def fit(
    model: Model,
    measured: Sequence[Measured] | None = None,
    *,
    method: str = "fminsearch",
    free: Sequence[str] | None = None,
    parameters: Mapping[str, float] | None = None,
    options: Options | None = None,
    rtol: float = 1e-6,
    progress: Callable[[Progress], None] | None = None,
) -> Fit:
    """Fit the free parameters of a model to the train series of its diagram.

    `method` is `fminsearch` (Scilab's simplex; `options` from optimset, as in paper A's appendix)
    or `least_squares`. `free` names the free parameters instead of the diagram's, `parameters` the
    values to begin with, in SI. `measured` gives series instead of the diagram's. Series for other
    uses are compared with the fitted model; only their free start values are adapted to them.

    Raises DataError, OptionError; FitError where the model cannot be simulated at the start.
    """
    if method not in METHODS:
        raise OptionError([unknown("method", method, METHODS)])
    if options is not None and method != "fminsearch":
        hint = "Leave them out, or take the method fminsearch."
        raise OptionError([Problem(f"options of optimset have no meaning for {method}", hint=hint)])
    began = time.perf_counter()
    series = tuple(load_measured(model) if measured is None else measured)
    if not series:
        raise DataError([Problem("there is no measured series to fit to")])
    model = with_measured_signals(model, series)
    train = [m for m in series if m.use == "train"] or list(series)
    values = parameter_values(model, parameters or {}, _common_preset(train))
    unknowns = [*free_unknowns(model, free, values), *offset_unknowns(train)]
    segments = [whole_segment(model, m) for m in train]
    others = [whole_segment(model, m) for m in series if m not in train]
    criterion = Criterion(model, segments, unknowns, parameters or {}, rtol)
    first = criterion.begin()
    criterion_before = criterion.value(first)
    if criterion.failure is not None:
        raise FitError(
            [
                replace(problem, what=f"the model does not run at the start: {problem.what}")
                for problem in criterion.failure.problems
            ]
        )
    before = _outputs(criterion, first, others)
    if method == "fminsearch":
        ended = by_simplex(criterion, options, progress)
    else:
        ended = by_least_squares(criterion, progress)
    named, starts = criterion.split(ended.z)
    errors = standard_errors(criterion, ended.z)[: len(named)]
    return Fit(
        model=model,
        method=method,
        measured=series,
        began={u.name: u.value for u in unknowns},
        values=named,
        errors=dict(zip(named, errors.tolist(), strict=True)),
        bounds={u.name: (u.low, u.high) for u in unknowns},
        starts={s.measured.name: start for s, start in zip(segments, starts, strict=True)},
        criterion_before=criterion_before,
        criterion=criterion.value(ended.z),
        evaluations=criterion.evaluations,
        iterations=ended.iterations,
        exitflag=ended.exitflag,
        message=ended.message,
        seconds=time.perf_counter() - began,
        comparisons=_compared(model, series, before, _outputs(criterion, ended.z, others)),
    )


def with_measured_signals(model: Model, series: Sequence[Measured] | None = None) -> Model:
    """The model with every signal of the series, or of the diagram's, among the recorded ones.

    Raises OptionError: a signal that the model does not have.
    """
    if series is None:
        signals = measured_signals(model.diagram)
    else:
        signals = tuple(signal for m in series for signal in m.values)
    if set(signals) <= set(model.recorded):
        return model
    return compile(model.diagram, record=[*model.recorded, *signals])


def _common_preset(series: Sequence[Measured]) -> str:
    """The preset to begin a fit with: that of the series, where they agree."""
    presets = {m.preset for m in series}
    return presets.pop() if len(presets) == 1 else ""


def _outputs(criterion: Criterion, z: Vector, others: Sequence[Segment]) -> dict[str, Vector]:
    """The simulated signals (N, signals) by series; `others` get start values of their own."""
    named, starts = criterion.split(z)
    found = {
        segment.measured.name: criterion.outputs(segment, named, start)
        for segment, start in zip(criterion.segments, starts, strict=True)
    }
    for segment in others:
        start: Mapping[str, float] = {}
        if segment.free:
            fixed = {**criterion.parameters, **named}
            alone = Criterion(criterion.model, [segment], [], fixed, criterion.rtol)
            (start,) = alone.split(descend(alone).z)[1]
        found[segment.measured.name] = criterion.outputs(segment, named, start)
    return found


def _compared(
    model: Model,
    series: Sequence[Measured],
    before: Mapping[str, Vector],
    after: Mapping[str, Vector],
) -> tuple[Comparison, ...]:
    return tuple(
        Comparison(
            series=m.name,
            use=m.use,
            signal=signal,
            unit=model.flat.units.get(signal, ""),
            t=m.t,
            measured=values,
            before=before[m.name][:, n],
            after=after[m.name][:, n],
        )
        for m in series
        for n, (signal, values) in enumerate(m.values.items())
    )
