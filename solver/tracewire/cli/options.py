"""Options that several verbs share, and the way from a path to a model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.limits import LIMITS
from tracewire.cli.output import note, working
from tracewire.cli.project import with_project

if TYPE_CHECKING:
    from tracewire.compile import Model
    from tracewire.diagram import Diagram
    from tracewire.residual import Measured
    from tracewire.solve import Options

DiagramPath = Annotated[
    str,
    typer.Argument(
        metavar="DIAGRAM", help="A diagram file (YAML); - is stdin.", show_default=False
    ),
]
Libraries = Annotated[
    list[str] | None,
    typer.Option(
        "--library",
        metavar="PATH",
        help="A Python file or folder of further blocks; it is run, so trust it. Repeatable.",
        show_default=False,
        callback=with_project,
    ),
]
SeriesName = Annotated[
    str,
    typer.Option(
        "--series",
        metavar="NAME",
        help="Run as this measured series: its inputs, start, values and time.",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON, for programs.")]
Debug = Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")]


def read_diagram(path: str, libraries: Sequence[str] | None = None) -> Diagram:
    """The diagram of a file, or of stdin, -, whose files are looked for from here. Raises
    DiagramError, BlockError, OptionError."""
    from tracewire.diagram import STDIN, load_stdin, read, read_text

    if path == "-":
        return read_text(load_stdin(), STDIN, libraries or ())
    return read(path, libraries or ())


def load_model(
    path: str, libraries: Sequence[str] | None = None, record: Sequence[str] | None = None
) -> Model:
    """The compiled model of what `read_diagram` reads; units that contradict each other are told on
    stderr. Raises DiagramError, BlockError, OptionError."""
    with working(f"compiling {path}"):
        from tracewire.compile import compile

        model = compile(read_diagram(path, libraries), record or ())
    note_units(model)
    return model


def note_units(model: Model) -> None:
    """Tell units that contradict each other on stderr."""
    from tracewire.compile import unit_problems

    contradictions = unit_problems(model.flat)
    for problem in contradictions[: LIMITS.contradictions]:
        note(f"units: {problem}")
    more = len(contradictions) - LIMITS.contradictions
    if more > 0:
        note(f"units: {more} more; `tracewire check` tells them all.")


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
