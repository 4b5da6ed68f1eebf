"""`trace`: fit, find the residual, try every effect at every place, believe only unseen data."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from typing import Any

from tracewire.blas import one_blas_thread
from tracewire.compile import Model
from tracewire.errors import Problem, TracewireError
from tracewire.fit import Fit
from tracewire.options import options_of
from tracewire.residual import Measured
from tracewire.trace.choose.prediction import Prediction, predict
from tracewire.trace.choose.safeguards import fit_declared, refuse_mistaken, safeguard
from tracewire.trace.choose.verdict import (
    Judgement,
    judge_at_noise,
    judge_prediction,
)
from tracewire.trace.found import Found
from tracewire.trace.options import TraceOptions
from tracewire.trace.results.result import result_of
from tracewire.trace.search.refinement import FinalModels
from tracewire.trace.search.setup import set_up_search


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
    search = set_up_search(
        subject, measured, rtol, limit_time(options.budget, tell), options, executor
    )
    interrupted = False
    prediction: Prediction | None = None
    try:
        declared = fit_declared(search)
        search.run(declared)
        first, best = search.declared_and_best
        found = judge_at_noise(search, first, best)
        if found is None:
            prediction = predict(search, first)
            found = judge_prediction(search, prediction)
        judgement = safeguard(search, found)
        refuse_mistaken(search, declared, judgement)
    except (KeyboardInterrupt, OutOfTime) as stopped:
        if search.best is None:
            raise
        interrupted = True
        if isinstance(stopped, OutOfTime):
            search.words.append(f"the search ended after its budget of {options.budget:g} s")
    search.tell = tell
    if interrupted:
        judgement = Judgement("unexplained", FinalModels(*search.declared_and_best))
    return result_of(search, judgement, prediction, interrupted)


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
