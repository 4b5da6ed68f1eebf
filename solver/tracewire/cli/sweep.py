"""`tracewire sweep`: a few numbers of runs over a grid of parameter values."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.executors import executor_at
from tracewire.cli.options import DiagramPath, SeriesName, read_series
from tracewire.cli.output import telling, working
from tracewire.cli.records import FigureTarget, Given, Since, Span, Work
from tracewire.cli.setting import Rtol, read_setting, tell


def sweep(
    diagram: DiagramPath,
    *,
    over: Annotated[
        list[str],
        typer.Option(
            "--over",
            metavar="NAME=FROM:TO:COUNT",
            help="A parameter, or start.STATE, and its values: 'k=1:5:41' or 'k=1,2,5'. "
            "Repeatable.",
        ),
    ],
    keep: Annotated[
        list[str],
        typer.Option(
            "--keep",
            metavar="QUANTITY",
            help="A number of each run, such as end(x), max(abs(x)), period(x) or "
            "count(impact); docs/quantities.md has all. Repeatable.",
        ),
    ],
    since: Since = None,
    span: Span = None,
    given: Given,
    series: SeriesName = "",
    rtol: Rtol = 1e-6,
    work: Work,
    target: FigureTarget,
) -> None:
    """Simulate a diagram over a grid of parameter values, and keep a few numbers of each run.

    \b
    Examples:
      tracewire sweep oscillator.yaml --over omega=0.5:3:101 --keep "max(x)" --since 50
                --figure resonance.png
      tracewire sweep pendulum.yaml --over k=1:5:21 --over c=0:1:11 --keep "rms(phi)"
                --partial sweep.npz --output sweep.csv
    """
    setting = read_setting(diagram, given, target)
    grid = setting.values_of(over)
    conditions, _ = read_series(setting.model, series)
    with executor_at(work.executor) as pool, working("sweeping") as show:
        from tracewire.analyse import sweep as sweep_of
        from tracewire.solve import with_options

        found = sweep_of(
            setting.model,
            grid,
            keep,
            since=since,
            workers=work.workers,
            executor=pool,
            progress=telling("sweeping", show),
            partial=work.partial,
            **with_options(conditions, setting.run_options(span, rtol)),
        )
    import numpy as np

    points = np.meshgrid(*found.grid.values(), indexing="ij")
    columns = dict(zip(found.grid, points, strict=True)) | dict(found.values)
    tell(found, target, columns)
