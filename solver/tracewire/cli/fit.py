"""`tracewire fit`: the free parameters of a diagram from its measured series."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.limits import LIMITS
from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries, load_model
from tracewire.cli.output import Cut, note, print_json, print_parts, print_text, working
from tracewire.cli.reporting import (
    Apply,
    Output,
    ReportFile,
    WriteAttempts,
    check_home,
    check_targets,
    store,
    write_report,
)
from tracewire.cli.values import parameter_values_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from tracewire.compile import Model
    from tracewire.diagram import Diagram
    from tracewire.fit import Options, Profile, Progress

PLOTS = "fit_frames"


@dataclass(frozen=True)
class FitGiven:
    """What is fitted, and how: arguments of `tracewire.fit`."""

    method: Annotated[
        str,
        typer.Option(
            help="least_squares, growing_windows, multiple_shooting, shooting, multistart or "
            "fminsearch."
        ),
    ] = "least_squares"
    free: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="A parameter to fit, instead of those with `fit:`."),
    ] = None
    fix: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="A parameter with `fit:` that stays. Repeatable."),
    ] = None
    values: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="A value to begin with. Repeatable."),
    ] = None
    loss: Annotated[
        str, typer.Option(help="linear, or huber or cauchy for data with outliers.")
    ] = "linear"


@dataclass(frozen=True)
class Limits:
    """When a fit ends: options of `optimset`."""

    max_iter: Annotated[int | None, typer.Option("--MaxIter", help="The most iterations.")] = None
    max_fun_evals: Annotated[
        int | None, typer.Option("--MaxFunEvals", help="The most evaluations of the criterion.")
    ] = None
    tol_x: Annotated[
        float | None, typer.Option("--TolX", help="fminsearch: size of the simplex.")
    ] = None
    tol_fun: Annotated[
        float | None, typer.Option("--TolFun", help="fminsearch: spread of the criterion.")
    ] = None

    @property
    def options(self) -> dict[str, float]:
        """These by the names of `optimset`, as far as they are given."""
        named = {
            "MaxIter": self.max_iter,
            "MaxFunEvals": self.max_fun_evals,
            "TolX": self.tol_x,
            "TolFun": self.tol_fun,
        }
        return {name: value for name, value in named.items() if value is not None}


@dataclass(frozen=True)
class Course:
    """How a search begins, where it is stored, and what is told of it."""

    seed: Annotated[int, typer.Option(help="What the random methods begin from.")] = 0
    rtol: Annotated[float, typer.Option(help="The relative tolerance of runs.")] = 1e-6
    save: Annotated[
        str | None, typer.Option(metavar="FILE", help="Store the search here while it runs.")
    ] = None
    resume: Annotated[
        str | None, typer.Option(metavar="FILE", help="Go on from a stored search.")
    ] = None
    profile: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME", help="Tell how far a parameter may go, the others refitted. Repeatable."
        ),
    ] = None
    plot: Annotated[
        bool,
        typer.Option(
            "--plot", help=f"Draw the fit while it runs; without a display into {PLOTS}/."
        ),
    ] = False


@dataclass(frozen=True)
class FitTarget:
    """What is written of a fit, and how it is printed."""

    report: ReportFile = None
    apply: Apply = False
    output: Output = None
    as_json: AsJson = False
    debug: Debug = False


def fit(
    diagram: DiagramPath,
    *,
    given: FitGiven,
    limits: Limits,
    course: Course,
    target: FitTarget,
    library: Libraries = None,
) -> None:
    """Fit the free parameters of a diagram to its measured series.

    Ctrl-C ends a fit at its best so far, which is told as ever, with exit code 130.

    \b
    Examples:
      tracewire fit pendulum.yaml --report fit.html
      tracewire fit pendulum.yaml --fix c --profile w0_squared --apply
      tracewire fit pendulum.yaml --method fminsearch --MaxIter 150 --save fit.json
    """
    from tracewire.diagram import SetValues, patch
    from tracewire.fit import fit as fit_model
    from tracewire.fit import profile as profile_of
    from tracewire.show import present

    check_targets(target.report, target.output)
    model = load_model(diagram, library)
    check_home(model.diagram, target.output, target.apply)
    options = _options(limits.options, course.plot)
    if target.apply or target.output:
        _check_values(model, given)
    parameters = parameter_values_of(model, given.values or [])
    with working("fitting") as tell:
        found = fit_model(
            model,
            method=given.method,
            free=given.free or None,
            fixed=given.fix or (),
            parameters=parameters,
            options=options,
            loss=given.loss,
            seed=course.seed,
            rtol=course.rtol,
            save=course.save,
            resume=course.resume,
            progress=_told(tell),
        )
        profiles: list[Profile] = []
        cut = found.interrupted
        for name in () if cut else course.profile or ():
            tell(f"profile of {name}")
            try:
                profiles.append(profile_of(found, name))
            except KeyboardInterrupt:  # the fit is done, and is told
                note(f"the profile of {name} was interrupted")
                cut = True
                break
    attempt = WriteAttempts()

    def edited() -> Diagram:
        return patch(model.diagram, [SetValues(found.found)])

    attempt(lambda: store(model.diagram, edited, target.apply, target.output))
    attempt(lambda: write_report(found, target.report, profiles))
    if target.as_json:
        told = {"profiles": profiles, "written": attempt.written} | attempt.not_written
        print_json(found.json() | told)
    else:
        print_parts(present(found).parts)
        for text in (*(p.words for p in profiles), *(f"written: {w}" for w in attempt.written)):
            print_text(text)
    attempt.finish(target.as_json)
    if cut:
        raise Cut


def _check_values(model: Model, given: FitGiven) -> None:
    """Refuse, before the work, values that could not be written into the diagram after it."""
    from tracewire.diagram import SetValues, patch
    from tracewire.solve import parameter_values

    now = parameter_values(model, {})
    usual = [name for name, known in model.flat.parameters.items() if known.fit is not None]
    moved = [name for name in given.free or usual if name not in (given.fix or ())]
    patch(model.diagram, [SetValues({name: now[name] for name in moved if name in now})])


def _options(limits: dict[str, float], plot: bool) -> Options | None:
    """The options of optimset, or None where nothing is said."""
    from tracewire.fit import optimset

    if not plot:
        return optimset(Display="off", **limits) if limits else None
    from tracewire.show.live import FitPlot, ValuePlot

    functions = [kind(folder=PLOTS) for kind in (ValuePlot, FitPlot)]
    return optimset(Display="off", PlotFcns=functions, **limits)


def _told(tell: Callable[[str], None]) -> Callable[[Progress], None]:
    """Tell progress: always on a terminal, every ten seconds elsewhere."""
    last = time.perf_counter()

    def progress(now: Progress) -> None:
        nonlocal last
        stage = f", {now.stage}" if now.stage else ""
        text = (
            f"fitting: {now.evaluations} evaluations{stage}, best criterion {now.best:.6g}, "
            f"at most {now.remaining:.0f} s to go"
        )
        tell(text)
        if time.perf_counter() - last > LIMITS.tell_every:
            last = time.perf_counter()
            note(text)

    return progress
