"""Options of the kinds of analysis that look at one run, and that run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.output import note, telling, working
from tracewire.cli.records import Sampling
from tracewire.cli.setting import Setting

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
    from tracewire.solve import Options, parameter_values, simulate

    options = setting.run_options(sampling.span, rtol) | Options(every=sampling.every)
    if steps is not None and sampling.every is None and setting.model.flat.every is None:
        values = parameter_values(setting.model, setting.parameters, setting.preset)
        options["times"] = evenly(setting.model, values, sampling.span, steps)
    with working("simulating") as show:
        run = simulate(setting.model, **options, progress=telling("simulating", show))
    for warning in run.warnings:
        note(f"warning: {warning}")
    return run
