"""`trace`: fit, find the residual, try every effect at every place, believe only unseen data."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from typing import Any

from tracewire.arguments import checked
from tracewire.blas import one_blas_thread
from tracewire.compile import Model
from tracewire.errors import Problem, TracewireError
from tracewire.fit import Fit
from tracewire.options import options_of
from tracewire.residual import (
    InputCovariance,
    Measured,
    channel_noise,
    load_measured,
    refuse_readers_of_free,
    with_measured_signals,
    with_past,
)
from tracewire.trace.candidates.places import describe_no_sum, describe_untried, find_places
from tracewire.trace.check.option_checks import check_options
from tracewire.trace.check.outliers import drop_outliers
from tracewire.trace.check.refusals import check_series, remarks, without_still
from tracewire.trace.choose.noisy_inputs import InputNoise, describe_input_noise, shown_input_noise
from tracewire.trace.choose.prediction import Prediction, predict
from tracewire.trace.choose.safeguards import refuse_mistaken, safeguard, tell_waves_tried_once
from tracewire.trace.choose.verdict import Judgement, judge_at_noise, judge_prediction
from tracewire.trace.found import Found
from tracewire.trace.options import TraceOptions
from tracewire.trace.results.result import result_of
from tracewire.trace.search.refinement import FinalModels
from tracewire.trace.search.search import Search
from tracewire.trace.search.workers import Workers
from tracewire.trace.trials.data_split import shortest_window, split_data
from tracewire.trace.trials.trial import TraceProblem


@checked
@one_blas_thread()
def trace(
    subject: Model | Fit,
    measured: Sequence[Measured] | None = None,
    *,
    options: TraceOptions | Mapping[str, Any] | None = None,
    rtol: float = 1e-6,
    executor: Executor | None = None,
    progress: Callable[[str], None] | None = None,
) -> Found:
    """Trace the residual of a diagram on its measured series to an effect that it lacks.

    Every effect of the library is tried at every place, first by a score test on one linearisation,
    then the best, and pairs of them, by a refit in the loop. Where the noise of the sensors is in
    reach, BIC ranks them and parts of the data that no fit saw accept them; elsewhere models are
    chosen by what they predict on blocks of time that their fits did not see. The errors reported
    come from a third part. `options`, a record or a dictionary, says what is tried, and
    from when on an effect is believed. With an `executor` of `concurrent.futures` its workers do
    the refits that do not need each other, with the same result to the last bit; what is left when
    one of them ends is done here. Ctrl-C ends it with what was found so far.

    Raises DataError where the series cannot be used, FitError where the model does not run, or
    where `rtol` is too loose for such small noise.
    """
    options = options_of(TraceOptions, options, "a trace")
    tell = progress or (lambda text: None)
    tell_in_time = limit_time(options.budget, tell)
    search = set_up_search(subject, measured, rtol, tell_in_time, options, executor)
    judgement = _run(search)
    if noise := judgement.input_noise:
        tell_in_time("searching again with the noise that the inputs show")
        try:
            again = set_up_search(subject, measured, rtol, tell_in_time, options, executor, noise)
            again.note(describe_input_noise(noise, search.problem.declared))
            search, judgement = again, _run(again)
        except (KeyboardInterrupt, OutOfTime) as stopped:
            judgement = _interrupted(search, stopped)
    search.tell = tell
    return result_of(search, judgement)


def _run(search: Search) -> Judgement:
    """Search and judge; what was found so far where that is interrupted. It is to be done again
    where no model reaches the noise of the sensors, and one does with the noise of the inputs."""
    prediction: Prediction | None = None
    try:
        declared = search.fit_declared_precisely()
        search.run(declared)
        first, best = search.declared_and_best
        found = judge_at_noise(search, first, best)
        if found is None:
            if noise := shown_input_noise(search):
                final = FinalModels(first, best)
                return Judgement("unexplained", final, input_noise=noise)
            prediction = predict(search, first)
            found = judge_prediction(search, prediction)
        judgement = safeguard(search, found)
        refuse_mistaken(search, declared, judgement)
        tell_waves_tried_once(search, judgement)
    except (KeyboardInterrupt, OutOfTime) as stopped:
        if search.best is None:
            raise
        return _interrupted(search, stopped)
    return replace(judgement, prediction=prediction)


def _interrupted(search: Search, stopped: BaseException) -> Judgement:
    """What a search has found when it is ended early."""
    if isinstance(stopped, OutOfTime):
        budget = search.options.budget
        search.words.append(f"the search ended after its budget of {budget:g} s")
    final = FinalModels(*search.declared_and_best)
    return Judgement("unexplained", final, interrupted=True)


def set_up_search(
    subject: Model | Fit,
    measured: Sequence[Measured] | None,
    rtol: float,
    progress: Callable[[str], None],
    options: TraceOptions,
    executor: Executor | None = None,
    input_noise: InputNoise | None = None,
) -> Search:
    """The search on a subject, ready to run; `input_noise` is that of inputs where none is
    declared, by series."""
    values: dict[str, float] = {}
    if isinstance(subject, Fit):
        values = dict(subject.values)
        measured = subject.measured if measured is None else measured
        subject = subject.model
    series = tuple(load_measured(subject) if measured is None else measured)
    model = with_measured_signals(subject, series)
    if input_noise:
        series = tuple(
            replace(m, input_sigma={**input_noise.get(m.name, {}), **m.input_sigma}) for m in series
        )
    series, left_out = without_still(series, options.check)
    check_series(model, series, options.check)
    refuse_readers_of_free(model)
    check_options(options, model)
    sigma = channel_noise([m for m in series if m.use != "validate"])
    series = tuple(drop_outliers(m, sigma, options.check) for m in series)
    series = tuple(with_past(model, m, "each window of a trace") for m in series)
    data_split = split_data(series, options.split)
    shortest = shortest_window(model, data_split, options)
    inputs = InputCovariance(sigma, model, series, shortest)
    problem = TraceProblem(model, series, sigma, rtol, inputs, options)
    places = find_places(model)
    words = [*left_out, *remarks(series, options.check), *data_split.words]
    words += describe_no_sum(model, places)
    words += describe_untried(model, [place for place in places if place.q])
    workers = Workers(executor)
    return Search(problem, data_split, places, shortest, values, progress, words, workers)


class OutOfTime(TracewireError):
    """A search has taken longer than the user allows: no refit that failed."""


def limit_time(seconds: float, tell: Callable[[str], None]) -> Callable[[str], None]:
    """A `tell` that raises OutOfTime where it is called after so many seconds."""
    end = time.monotonic() + seconds

    def tell_in_time(text: str) -> None:
        if time.monotonic() > end:
            what = f"the declared model was not fitted within the budget of {seconds:g} s"
            raise OutOfTime([Problem(what, hint="Give more with --budget.")])
        tell(text)

    return tell_in_time
