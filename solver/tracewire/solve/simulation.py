"""`simulate`: from a model and its arguments to a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from numpy.typing import ArrayLike

from tracewire.arguments import checked
from tracewire.compile import Model
from tracewire.solve.integrator import Integrator, refuse_nan
from tracewire.solve.interrupt import Interrupted
from tracewire.solve.limits import Limits
from tracewire.solve.options import Options
from tracewire.solve.problem import pose
from tracewire.solve.progress import ProgressCallback
from tracewire.solve.run import Run


@checked
def simulate(
    model: Model,
    *,
    parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    span: tuple[float, float] | None = None,
    times: ArrayLike | None = None,
    every: float | None = None,
    method: str = "auto",
    rtol: float = 1e-6,
    atol: float | Mapping[str, float] | None = None,
    step: float | None = None,
    preset: str = "",
    inputs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    past: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    limits: Limits | Mapping[str, float] | None = None,
    progress: ProgressCallback | None = None,
    sensitivities: Sequence[str] = (),
) -> Run:
    """Simulate a model: integrate x' = f(x, t) with frozen modes between located events.

    `parameters` and `start` override the diagram's values by name, in SI; `preset` is applied
    before them. `span` is (from, to) in s, `times` (N,) the ascending sample times in s, or
    `every` the time between two of them; without these the diagram's span and its `every`, or 1001
    samples. `method` is
    `dormand_prince` (explicit, order 5), `dop853` (explicit, order 8), `rosenbrock` (stiff, order
    5), `rk4` (fixed `step` in s, order 4), or `auto`: dormand_prince, dop853 where rtol is
    1e-8 or less, and rosenbrock where a mode combination turns out to be stiff. `atol` is given as
    a number or by state; else it is rtol/1000 of the largest value so far of each state, or of 1,
    whichever is less. `inputs` gives measured inputs as (times, values), joined by straight lines;
    `Held(times, values)` holds each value until the next. `past` gives in the same way what delayed
    signals were before the start, by the name of the signal, in place of `before` from its first
    time on. `limits` is a record or a dictionary such as `{"seconds": 60}`.
    `progress` is told about ten times a second the part of the span that is done, and the seconds
    that are left.
    `sensitivities` names parameters and start values (`start.theta`) whose forward sensitivities
    are wanted.

    Raises OptionError for arguments that do not fit, SimulationError for a run that cannot be
    finished: it names block, signal and time; of that kind Interrupted, where Ctrl-C stopped it:
    it carries the run up to there.
    """
    given = Options(
        parameters=parameters,
        start=start,
        span=span,
        times=times,
        every=every,
        method=method,
        rtol=rtol,
        atol=atol,
        step=step,
        preset=preset,
        inputs=inputs,
        past=past,
        limits=limits,
    )
    problem = pose(model, given, sensitivities)
    integrator = Integrator(problem, progress=progress)
    try:
        integrator.go_to()
    except Interrupted as error:
        error.run = integrator.run
        raise
    refuse_nan(model, integrator.progress.samples, problem.times)
    run = integrator.run
    integrator.give_back()
    return run
