"""From a diagram and its series to a search that is ready to run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor

from tracewire.compile import Model
from tracewire.fit import Fit
from tracewire.residual import (
    InputCovariance,
    Measured,
    channel_noise,
    load_measured,
    refuse_readers_of_free,
    with_measured_signals,
    with_past,
)
from tracewire.trace.candidates.places import describe_untried, find_places
from tracewire.trace.check.option_checks import check_options
from tracewire.trace.check.outliers import drop_outliers
from tracewire.trace.check.refusals import check_series, remarks
from tracewire.trace.options import TraceOptions
from tracewire.trace.search.search import Search
from tracewire.trace.search.workers import Workers
from tracewire.trace.trials.data_split import shortest_window, split_data
from tracewire.trace.trials.trial import TraceProblem


def set_up_search(
    subject: Model | Fit,
    measured: Sequence[Measured] | None,
    rtol: float,
    progress: Callable[[str], None],
    options: TraceOptions,
    executor: Executor | None = None,
) -> Search:
    """The search on a subject, ready to run."""
    values: dict[str, float] = {}
    if isinstance(subject, Fit):
        values = dict(subject.values)
        measured = subject.measured if measured is None else measured
        subject = subject.model
    series = tuple(load_measured(subject) if measured is None else measured)
    model = with_measured_signals(subject, series)
    check_series(model, series, options.check)
    refuse_readers_of_free(model)
    check_options(options, model)
    sigma = channel_noise([m for m in series if m.use != "validate"])
    series = tuple(drop_outliers(m, sigma, options.check) for m in series)
    series = tuple(with_past(model, m, "each window of a trace") for m in series)
    data_split = split_data(series, options.split)
    shortest = shortest_window(data_split, options.split)
    inputs = InputCovariance(sigma, model, series, shortest)
    problem = TraceProblem(model, series, sigma, rtol, inputs, options)
    places = find_places(model)
    words = [*remarks(series, options.check), *data_split.words]
    words += describe_untried(model.diagram, [place for place in places if place.q])
    workers = Workers(executor)
    return Search(problem, data_split, places, shortest, values, progress, words, workers)
