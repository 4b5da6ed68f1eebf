"""`--series`: a run under the conditions of a measured series."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from tracewire.compile import Model
    from tracewire.residual import Measured
    from tracewire.solve import Options

SeriesName = Annotated[
    str,
    typer.Option(
        "--series",
        metavar="NAME",
        help="Run as this measured series: its inputs, start, values and time.",
    ),
]


def read_series(model: Model, name: str) -> tuple[Options, Measured | None]:
    """The conditions of a measured series and the series; none where no name is given.

    Raises OptionError, DataError.
    """
    from tracewire.solve import Options

    if not name:
        return Options(), None
    from tracewire.residual import measured_series

    measured = measured_series(model, name)
    return measured.conditions, measured
