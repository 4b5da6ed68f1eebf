"""`--series`: a run under the conditions of a measured series."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tracewire.errors import OptionError, unknown

if TYPE_CHECKING:
    from tracewire.compile import Model
    from tracewire.residual import Measured

SeriesName = Annotated[
    str,
    typer.Option(
        "--series",
        metavar="NAME",
        help="Run as this measured series: its inputs, start, values and time.",
    ),
]


@dataclass(frozen=True)
class Conditions:
    """What a run takes from a measured series; nothing where no series is named."""

    inputs: Mapping[str, Any] = field(default_factory=dict)
    start: Mapping[str, float] = field(default_factory=dict)
    preset: str = ""
    span: tuple[float, float] | None = None
    parameters: Mapping[str, float] = field(default_factory=dict)
    measured: Measured | None = None


def read_series(model: Model, name: str) -> Conditions:
    """The conditions of a measured series, the first window of several. Raises OptionError."""
    if not name:
        return Conditions()
    if name not in model.diagram.measured:
        raise OptionError([unknown("measured series", name, model.diagram.measured)])
    from tracewire.residual import load_measured

    measured = load_measured(model, driving=True, series=[name])[0]
    return Conditions(
        dict(measured.inputs),
        measured.known_start,
        measured.preset,
        measured.span,
        dict(measured.parameters),
        measured,
    )
