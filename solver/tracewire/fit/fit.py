"""`fit`: the free parameters of a diagram from its measured series."""

from __future__ import annotations

import inspect
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tracewire.arguments import checked
from tracewire.array_types import Vector
from tracewire.blas import one_blas_thread
from tracewire.compile import Model
from tracewire.errors import DataError, FitError, OptionError, Problem, unknown
from tracewire.fit.checkpoint import Store, resume_from
from tracewire.fit.compare import compare_series, outputs_by_series
from tracewire.fit.kept import EXACT, is_exact, kept_words, with_unmoved_kept
from tracewire.fit.methods import METHODS
from tracewire.fit.optimset import Options, optimset
from tracewire.fit.refusals import (
    refuse_few_samples,
    refuse_presets_of_free,
    refuse_simplex_tolerances,
    refuse_unusable,
)
from tracewire.fit.remarks import (
    ENDED,
    begins_fast,
    collect_remarks,
    raises_unseen,
    rises,
    starts_elsewhere,
    unfinished,
)
from tracewire.fit.result import Comparison, Fit, Improvement
from tracewire.fit.search import MethodResult, Progress, Search, Stopped
from tracewire.fit.uncertainty import uncertainty_of
from tracewire.fit.weighing import noise_instead_of_units, weighing_words
from tracewire.options import options_of
from tracewire.residual import (
    Criterion,
    Measured,
    chosen_unknowns,
    half_square,
    load_measured,
    whole_segment,
    with_measured_signals,
    with_past,
)
from tracewire.solve import parameter_values

AMPLE = "10000*numberofvariables"
"""The limits of a method that is not Scilab's, where no options are given."""


@checked
@one_blas_thread()
def fit(
    model: Model,
    measured: Sequence[Measured] | None = None,
    *,
    method: str = "least_squares",
    free: Sequence[str] | None = None,
    fixed: Sequence[str] = (),
    parameters: Mapping[str, float] | None = None,
    options: Options | Mapping[str, Any] | None = None,
    loss: str = "linear",
    scale: Mapping[str, float] | None = None,
    correlated: bool | None = None,
    seed: int = 0,
    rtol: float = 1e-6,
    save: str | Path | None = None,
    resume: str | Path | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> Fit:
    """Fit the free parameters of a model to the train series of its diagram.

    `method` is one of
      `least_squares`      a trust region on forward sensitivities: most problems;
      `fminsearch`         Scilab's simplex, as in paper A's appendix;
      `growing_windows`    least squares on growing parts of each series: long, unstable records;
      `multiple_shooting`  least squares on segments with free start states that grow together:
                           chaotic records;
      `shooting`           random shots round the best and the simplex from there, as paper B:
                           criteria that jump;
      `multistart`         points all over the bounds, the best ones polished: many minima.
    `free` names the free parameters (and `offset.SIGNAL`, `gain.SIGNAL`, `delay.SIGNAL`) instead of
    the diagram's, `fixed` those that are not; a parameter whose value is a formula of others
    follows them. `parameters` gives values to begin with, in SI. `measured` gives series instead of
    the diagram's. Series for other uses are compared with the fitted model; only their free start
    values are adapted to them.

    `options` are those of optimset, or a dictionary such as `{"MaxIter": 50}`: limits of iterations
    and evaluations and output functions for every method, tolerances for the simplex. `loss` is
    `linear`, `huber` or `cauchy`, the last two for data with outliers. `scale` gives sizes by name,
    by which unknowns are divided in a search. `correlated` says whether errors follow from the
    actual autocorrelation of the residuals; unless given they do where the model has states. `seed`
    makes random methods repeatable. The search is
    stored in the file `save`, and goes on from the file `resume`; Ctrl-C ends it at its best.

    Raises DataError, OptionError; FitError where the model cannot be simulated at the start.
    """
    if isinstance(options, Mapping):
        given = {"Display": "off", **options}
        options = options_of(Options, given, "a fit", inspect.signature(fit).parameters)
    if method not in METHODS:
        raise OptionError([unknown("method", method, METHODS)])
    if options is not None:
        refuse_simplex_tolerances(options, method)
    began = time.perf_counter()
    if measured is None:
        measured = load_measured(model, parameters=parameters)
    series = tuple(measured)
    if not series:
        raise DataError([Problem("there is no measured series to fit to")])
    model = with_measured_signals(model, series)
    train = [m for m in series if m.use == "train"]
    refuse_unusable(series, train)
    values = parameter_values(model, parameters or {}, _common_preset(train))
    unknowns = chosen_unknowns(model, train, values, free, fixed)
    refuse_presets_of_free(model, train, [u.name for u in unknowns])
    unknowns = [replace(u, scale=_size(scale or {}, u.name, u.scale)) for u in unknowns]
    if method == "multiple_shooting":
        moving = [u.name for u in unknowns]
        train = [with_past(model, m, "each segment of multiple_shooting", moving) for m in train]
    segments = [whole_segment(model, m) for m in train]
    others = [whole_segment(model, m) for m in series if m.use != "train"]
    sigma = noise_instead_of_units(model, train)
    criterion = Criterion(model, segments, unknowns, parameters or {}, rtol, sigma, loss=loss)
    refuse_few_samples(criterion)

    first = criterion.initial_unknowns()
    units = np.ones(len(first))
    units[: len(unknowns)] = [_size(scale or {}, u.name, 1.0) for u in unknowns]
    criterion_before = criterion.value(first)
    if criterion.failure is not None:
        raise FitError(
            [
                replace(problem, what=f"the model does not run at the start: {problem.what}")
                for problem in criterion.failure.problems
            ]
        )
    before = outputs_by_series(criterion, first, others)
    criterion.evaluations = 0

    def comparisons(z: Vector) -> tuple[Comparison, ...]:
        return compare_series(model, series, before, outputs_by_series(criterion, z, others))

    if options is None:
        limits = {} if method == "fminsearch" else {"MaxIter": AMPLE, "MaxFunEvals": AMPLE}
        options = optimset(Display="off", **limits)
    store = None if save is None else Store(save, method)
    search = Search(
        criterion,
        options,
        seed=seed,
        units=units,
        progress=progress,
        store=store,
        comparisons=comparisons,
    )
    if resume is not None:
        _resume(search, resume_from(resume, method, criterion))
    if criterion_before == 0:
        result = MethodResult(first, 0, 1, "the criterion is 0 at the start: nothing is to gain")
    else:
        result = _run_method(search, method)
    search.finish()
    evaluations = criterion.evaluations
    last, z = result.criterion or criterion, result.z
    failures = criterion.failures if last is criterion else criterion.failures + last.failures
    began_with = {u.name: u.value for u in unknowns}
    follows = bool(model.states) if correlated is None else correlated
    residuals, derivatives = last.residuals_and_jacobians(z)
    uncertainty = uncertainty_of(last, z, residuals, derivatives, follows)
    kept = with_unmoved_kept(last, z, uncertainty.unmoved, began_with)
    if kept is not z:
        z = kept
        residuals, derivatives = last.residuals_and_jacobians(z)
        uncertainty = uncertainty_of(last, z, residuals, derivatives, follows)
    named, starts = last.unpack(z)
    found_starts: dict[str, Mapping[str, float]] = {}
    for segment, start in zip(last.segments, starts, strict=True):
        found_starts.setdefault(segment.measured.name, start)
    value = half_square(last.weigh(residuals))
    shown = compare_series(model, series, before, outputs_by_series(last, z, others))
    exact = is_exact(shown, rtol)
    matrix = last.weigh_jacobians(residuals, derivatives)
    short = "" if exact else unfinished(uncertainty, last, matrix, last.weigh(residuals), method)
    return Fit(
        model=model,
        method=method,
        measured=series,
        began=began_with,
        values=named,
        bounds={u.name: (u.low, u.high) for u in unknowns},
        starts=found_starts,
        criterion_before=criterion_before,
        criterion=value,
        evaluations=evaluations,
        iterations=result.iterations,
        exitflag=result.exitflag,
        message=result.message.replace("converged", ENDED, 1) if short else result.message,
        seconds=time.perf_counter() - began,
        comparisons=shown,
        uncertainty=uncertainty,
        history=tuple(search.history),
        seed=seed,
        loss=loss,
        parameters=dict(parameters or {}),
        rtol=rtol,
        interrupted=result.interrupted,
        unfinished=short,
        remarks=(
            *(store.remarks if store else ()),
            *([EXACT] if exact else rises(criterion_before, value, method)),
            *kept_words(uncertainty.unmoved, named, began_with),
            *starts_elsewhere(model, series, shown),
            *begins_fast(model, series, found_starts),
            *raises_unseen(shown, method),
            *weighing_words(model, sigma),
            *collect_remarks(series, failures, last),
        ),
    )


def _run_method(search: Search, method: str) -> MethodResult:
    """Where a method ended, or was stopped."""
    tells_itself = method == "fminsearch"  # as Scilab's does
    try:
        if not tells_itself:
            search.announce("init")
        result = METHODS[method](search)
    except Stopped as stopped:
        result = MethodResult(search.best, search.iterations, stopped.exitflag, stopped.message)
    except KeyboardInterrupt:
        message = "stopped by Ctrl-C: this is the best so far"
        result = MethodResult(search.best, search.iterations, -1, message, interrupted=True)
        tells_itself = False
    if not tells_itself:
        with suppress(Stopped):  # there is nothing left to stop
            search.announce("done")
    return result


def _resume(search: Search, saved: Mapping[str, Any]) -> None:
    """Let a search begin where a saved one was."""
    search.begin = search.best = np.array(saved["best"]) / search.criterion.scales
    search.best_value = search.criterion.value(search.best)
    search.criterion.evaluations = saved["evaluations"]
    search.history = [Improvement(**step) for step in saved["history"]]
    if saved["state"]:
        search.iterations = saved["iterations"]
        search.resumed = search.state = saved["state"]


def _common_preset(series: Sequence[Measured]) -> str:
    """The preset to begin a fit with: that of the series, where they agree."""
    presets = {m.preset for m in series}
    return presets.pop() if len(presets) == 1 else ""


def _size(scale: Mapping[str, float], name: str, usual: float) -> float:
    size = scale.get(name, usual)
    if not (np.isfinite(size) and size > 0):
        what = f"the scale of '{name}' is {size:g}"
        raise OptionError.one(what, hint="Give a number above zero, of the size of its changes.")
    return size
