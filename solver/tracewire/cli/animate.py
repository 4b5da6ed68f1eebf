"""`tracewire animate`: a run as a moving picture."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from tracewire.cli.limits import LIMITS
from tracewire.cli.options import AsJson, Debug, DiagramPath, SeriesName, read_diagram, read_series
from tracewire.cli.output import check_target, note, print_json, print_text, telling, working
from tracewire.cli.records import Given, Span
from tracewire.cli.setting import Rtol
from tracewire.cli.values import parameter_values_of, start_values_of
from tracewire.files import writing

ENDINGS = (".gif", ".mp4")


def animate(
    diagram: DiagramPath,
    *,
    output: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help="Write the film to .gif, or to .mp4 where ffmpeg is installed; NAME.gif in this "
            "folder unless given.",
            show_default=False,
        ),
    ] = None,
    speed: Annotated[
        float, typer.Option(metavar="FACTOR", help="1: as fast as it is; 0.1: ten times slower.")
    ] = 1.0,
    fps: Annotated[float, typer.Option(metavar="N", help="Pictures in a second.")] = 25.0,
    width: Annotated[int, typer.Option(metavar="PIXELS", help="The width of the film.")] = 480,
    given: Given,
    span: Span = None,
    series: SeriesName = "",
    rtol: Rtol = 1e-6,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Simulate a diagram and write it as a moving picture, as its section `scene` says.

    \b
    Examples:
      tracewire animate pendulum.yaml
      tracewire animate pendulum.yaml --output swing.mp4 --speed 0.5 --width 800
      tracewire animate triple.yaml --preset chaotic --span 20 30
    """
    target = output or f"{Path(diagram).stem}.gif"
    check_target(target, ENDINGS, "film")
    with working(f"compiling {diagram}"):
        import numpy as np

        from tracewire.compile import compile
        from tracewire.show import animate as film_of
        from tracewire.show import frame_times
        from tracewire.solve import Options, even_times, parameter_values, simulate, with_options

        plain = compile(read_diagram(diagram, given.library))
        model = compile(plain.diagram, plain.read_by_scene)
    conditions, _ = read_series(model, series)
    own = Options(
        parameters=parameter_values_of(model, given.values or ()),
        start=start_values_of(model, given.start or ()),
        preset=given.preset,
        span=span,
        rtol=rtol,
    )
    options = with_options(conditions, own)
    known = parameter_values(model, options.get("parameters") or {}, options.get("preset", ""))
    begin, end = options.get("span") or even_times(model, known, None, 1).tolist()
    times = frame_times(model, (begin, end), target, speed=speed, fps=fps, width=width)
    finer = max(LIMITS.film_finer, math.ceil(LIMITS.film_samples / len(times)))
    samples = np.interp(
        np.arange((len(times) - 1) * finer + 1) / finer, np.arange(len(times)), times
    )
    what = f"simulating {diagram}"
    with working(what) as show:
        options |= Options(span=(begin, end), times=samples)
        run = simulate(model, **options, progress=telling(what, show))
    for warning in run.warnings:
        note(f"warning: {warning}")
    with working(f"drawing {target}") as show, writing(target):
        film_of(
            run,
            target,
            speed=speed,
            fps=fps,
            width=width,
            progress=lambda part: show(f"drawing {target}: {100 * part:.0f} %"),
        )
    if as_json:
        print_json({"written": [target], "pictures": len(times), "span": [begin, end]})
    else:
        print_text(f"written: {target}")
