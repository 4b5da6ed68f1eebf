"""`tracewire analyse portrait` and `polar`: a run as a path in a plane."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.limits import LIMITS
from tracewire.cli.options import DiagramPath
from tracewire.cli.output import telling, working
from tracewire.cli.records import FigureFile, FigureTarget, Given, Sampling, Since, Target
from tracewire.cli.setting import Rtol, Setting, Signal, read_setting, run_of, tell_parts

if TYPE_CHECKING:
    from tracewire.solve import Run


@dataclass(frozen=True)
class PortraitTarget(FigureTarget):
    """A figure in any case."""

    figure: FigureFile = "portrait.png"


@dataclass(frozen=True)
class PolarTarget(FigureTarget):
    """A figure in any case."""

    figure: FigureFile = "polar.png"


def portrait(
    diagram: DiagramPath,
    *,
    x: Signal,
    y: Signal,
    since: Since = None,
    sampling: Sampling,
    given: Given,
    rtol: Rtol = 1e-6,
    target: PortraitTarget,
) -> None:
    """Draw a phase portrait: one signal of a run over another.

    \b
    Examples:
      tracewire analyse portrait pendulum.yaml phi phi_dot --figure portrait.svg
      tracewire analyse portrait duffing.yaml x v --span 0 400 --since 200
    """
    names = (x, y)
    setting = read_setting(diagram, given, target, names)
    run = run_of(setting, sampling, rtol, steps=LIMITS.curve)
    from tracewire.show import plot_portrait

    seen = _with_both_sides(run, setting, sampling, rtol)
    _tell_plane(run, seen, names, since, plot_portrait, target)


def polar(
    diagram: DiagramPath,
    *,
    radius: Annotated[
        str, typer.Argument(metavar="RADIUS", help="The signal of the distance from the pivot.")
    ],
    angle: Annotated[
        str,
        typer.Argument(metavar="ANGLE", help="The signal of the angle from the downward vertical."),
    ],
    since: Since = None,
    sampling: Sampling,
    given: Given,
    rtol: Rtol = 1e-6,
    target: PolarTarget,
) -> None:
    """Draw the path of a body in the plane, from its distance and angle, the pivot at the centre.

    \b
    Example:
      tracewire analyse polar atwood.yaml l phi --set mu=3 --figure orbit.svg
    """
    names = (radius, angle)
    setting = read_setting(diagram, given, target, names)
    run = run_of(setting, sampling, rtol, steps=LIMITS.curve)
    from tracewire.show import plot_polar

    _tell_plane(run, run, names, since, plot_polar, target)


def _with_both_sides(run: Run, setting: Setting, sampling: Sampling, rtol: float) -> Run:
    """The same run with samples on both sides of each event: between these a line is a jump."""
    if not run.events:
        return run
    import numpy as np

    from tracewire.solve import simulate

    at = np.array([event.time for event in run.events])
    times = np.unique(np.concatenate([run.t, at, np.nextafter(at, -np.inf)]))
    times = times[(times >= run.t[0]) & (times <= run.t[-1])]
    with working("simulating again for the sides of jumps") as show:
        options = setting.run_options(sampling.span, rtol)
        options["times"] = times
        return simulate(setting.model, **options, progress=telling("simulating again", show))


def _tell_plane(
    run: Run,
    drawn: Run,
    names: tuple[str, str],
    since: float | None,
    plot: Callable[..., object],
    target: Target,
) -> None:
    """Write two signals of a run, and draw them as `drawn` has them."""
    first = -float("inf") if since is None else since

    def draw(path: str) -> object:
        return plot(drawn, *names, path, since=first)

    chosen = run.t >= first
    columns = {"t": run.t[chosen]} | {name: run[name][chosen] for name in names}
    data = {
        "samples": int(chosen.sum()),
        "signals": {
            name: {"min": run[name][chosen].min(), "max": run[name][chosen].max()}
            for name in names
            if chosen.any()
        },
    }
    tell_parts(data, [], draw, target, columns)
