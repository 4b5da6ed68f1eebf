"""Options of the kinds of analysis that look at one run, and that run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.output import note, telling, working
from tracewire.cli.records import Sampling
from tracewire.cli.setting import Setting
from tracewire.errors import OptionError, Problem

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from tracewire.compile import Model
    from tracewire.solve import Run

    Vector = NDArray[np.float64]

Signal = Annotated[str, typer.Argument(metavar="SIGNAL", help="A signal.", show_default=False)]


def evenly(
    model: Model, values: Mapping[str, float], span: tuple[float, float] | None, steps: int
) -> Vector:
    """Times (steps + 1,) from the begin to the end of a span, that of the diagram unless given."""
    import numpy as np

    from tracewire.analyse.plane import span_of

    begin, end = span or span_of(model, values)
    return np.linspace(begin, end, steps + 1)


def run_of(setting: Setting, sampling: Sampling, rtol: float, *, steps: int | None = None) -> Run:
    """The run of a setting, with its warnings told; in `steps` steps where nothing says another."""
    import numpy as np

    from tracewire.analyse.plane import span_of
    from tracewire.solve import parameter_values, simulate

    span, every, times = sampling.span, sampling.every, None
    values = parameter_values(setting.model, setting.parameters, setting.preset)
    if every is None and steps is not None and setting.model.flat.every is None:
        times = evenly(setting.model, values, span, steps)
    if every is not None:
        begin, end = span or span_of(setting.model, values)
        count = np.floor((end - begin) / every * (1 + 1e-12)) if every > 0 else 0
        if not 1 <= count <= 10_000_000:
            what = f"an output every {every:g} s from {begin:g} to {end:g} s cannot be kept"
            raise OptionError([Problem(what, hint="Give another time between samples.")])
        times = np.minimum(begin + every * np.arange(count + 1), end)
    with working("simulating") as show:
        options = setting.run_options(span, rtol) | {"times": times}
        run = simulate(setting.model, **options, progress=telling("simulating", show))
    for warning in run.warnings:
        note(f"warning: {warning}")
    return run
