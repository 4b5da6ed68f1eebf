"""`tracewire analyse portrait` and `polar`: a run as a path in a plane."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.one_run import Every, Signal, Since, Span, run_of, signal_setting
from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries
from tracewire.cli.setting import FigureFile, OutputFile, Preset, Rtol, Start, Values, tell


def portrait(
    diagram: DiagramPath,
    x: Signal,
    y: Signal,
    figure: FigureFile = "portrait.png",
    since: Since = None,
    span: Span = None,
    every: Every = None,
    preset: Preset = "",
    values: Values = None,
    start: Start = None,
    rtol: Rtol = 1e-6,
    output: OutputFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Draw a phase portrait: one signal of a run over another.

    \b
    Examples:
      tracewire analyse portrait pendulum.yaml phi phi_dot --figure portrait.svg
      tracewire analyse portrait duffing.yaml x v --span 0 400 --since 200
    """
    _draw_plane(
        *(diagram, library, preset, values, start, (x, y), span, every, rtol, since),
        *(figure, output, as_json, False),
    )


def polar(
    diagram: DiagramPath,
    radius: Annotated[
        str, typer.Argument(metavar="RADIUS", help="The signal of the distance from the pivot.")
    ],
    angle: Annotated[
        str,
        typer.Argument(metavar="ANGLE", help="The signal of the angle from the downward vertical."),
    ],
    figure: FigureFile = "polar.png",
    since: Since = None,
    span: Span = None,
    every: Every = None,
    preset: Preset = "",
    values: Values = None,
    start: Start = None,
    rtol: Rtol = 1e-6,
    output: OutputFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Draw the path of a body in the plane, from its distance and angle, the pivot at the centre.

    \b
    Example:
      tracewire analyse polar atwood.yaml l phi --set mu=3 --figure orbit.svg
    """
    _draw_plane(
        *(diagram, library, preset, values, start, (radius, angle), span, every, rtol, since),
        *(figure, output, as_json, True),
    )


def _draw_plane(
    diagram: str,
    library: list[str] | None,
    preset: str,
    values: list[str] | None,
    start: list[str] | None,
    names: tuple[str, str],
    span: tuple[float, float] | None,
    every: float | None,
    rtol: float,
    since: float | None,
    figure: str | None,
    output: str | None,
    as_json: bool,
    is_polar: bool,
) -> None:
    setting = signal_setting(diagram, library, preset, values, start, names, figure, output)
    run = run_of(setting, span, every, rtol)
    first = -float("inf") if since is None else since

    def draw(path: str) -> object:
        from tracewire.show import plot_polar, plot_portrait

        plot = plot_polar if is_polar else plot_portrait
        return plot(run, *names, path, since=first)

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
    tell(data, [], [], as_json=as_json, draw=draw, figure=figure, columns=columns, output=output)
