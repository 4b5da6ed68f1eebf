"""Options of the kinds of analysis that look at one run, and that run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.output import note, telling, working
from tracewire.cli.setting import Setting
from tracewire.errors import OptionError, Problem

if TYPE_CHECKING:
    from tracewire.solve import Run

Span = Annotated[
    tuple[float, float] | None, typer.Option(metavar="FROM TO", help="From and to, in s.")
]
Every = Annotated[float | None, typer.Option(metavar="DT", help="The time between samples, in s.")]
Since = Annotated[
    float | None, typer.Option(metavar="T", help="Leave out what is before this time, in s.")
]
Signal = Annotated[str, typer.Argument(metavar="SIGNAL", help="A signal.", show_default=False)]


def run_of(
    setting: Setting, span: tuple[float, float] | None, every: float | None, rtol: float
) -> Run:
    """The run of a setting, with its warnings told."""
    import numpy as np

    from tracewire.analyse.plane import span_of
    from tracewire.solve import parameter_values, simulate

    times = None
    if every is not None:
        values = parameter_values(setting.model, setting.parameters, setting.preset)
        begin, end = span or span_of(setting.model, values)
        count = np.floor((end - begin) / every * (1 + 1e-12)) if every > 0 else 0
        if not 1 <= count <= 10_000_000:
            what = f"an output every {every:g} s from {begin:g} to {end:g} s cannot be kept"
            raise OptionError([Problem(what, hint="Give another time between samples.")])
        times = np.minimum(begin + every * np.arange(count + 1), end)
    with working("simulating") as show:
        run = simulate(
            setting.model,
            parameters=setting.parameters,
            start=setting.start,
            preset=setting.preset,
            span=span,
            times=times,
            rtol=rtol,
            progress=telling("simulating", show),
        )
    for warning in run.warnings:
        note(f"warning: {warning}")
    return run
