"""Options that several commands share, as records: a command names a record as an argument."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields, is_dataclass
from inspect import Parameter, Signature, signature
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer

from tracewire.cli.executors import ExecutorAddress
from tracewire.cli.options import AsJson, Debug, Libraries

if TYPE_CHECKING:
    from tracewire.analyse import Plane

Preset = Annotated[str, typer.Option(help="A preset of the diagram.", metavar="NAME")]
Values = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="A parameter, as in k=2.5 or 'phi=13.6 deg'. Repeatable.",
        show_default=False,
    ),
]
Start = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME=VALUE", help="The start value of a state. Repeatable.", show_default=False
    ),
]
OutputFile = Annotated[
    str | None, typer.Option("--output", metavar="FILE", help="Write the numbers to .csv or .npz.")
]
FigureFile = Annotated[
    str | None, typer.Option("--figure", metavar="FILE", help="Draw it to .png, .svg or .pdf.")
]
Span = Annotated[
    tuple[float, float] | None, typer.Option(metavar="FROM TO", help="From and to, in s.")
]
Since = Annotated[
    float | None, typer.Option(metavar="T", help="Leave out what is before this time, in s.")
]
Every = Annotated[float | None, typer.Option(metavar="DT", help="The time between samples, in s.")]


def with_fields(command: Callable[..., None]) -> Callable[..., None]:
    """The command with the fields of each record among its arguments in the place of the record.

    An option is made of each field, with its default; the command gets the records.
    """
    hints = get_type_hints(command, include_extras=True)
    parameters: list[Parameter] = []
    records: dict[str, type[Any]] = {}
    for argument in signature(command).parameters.values():
        kind = hints[argument.name]
        if not is_dataclass(kind):
            shown = argument.replace(annotation=kind, kind=Parameter.KEYWORD_ONLY)
            parameters.append(shown)
            continue
        records[argument.name] = kind  # type: ignore[assignment]
        of = get_type_hints(kind, include_extras=True)
        for field in fields(kind):
            usual = Parameter.empty if field.default is MISSING else field.default
            parameters.append(
                Parameter(
                    field.name, Parameter.KEYWORD_ONLY, default=usual, annotation=of[field.name]
                )
            )

    def call(**given: Any) -> None:
        for name, kind in records.items():
            given[name] = kind(**{field.name: given.pop(field.name) for field in fields(kind)})
        command(**given)

    call.__name__, call.__doc__, call.__module__ = (
        command.__name__,
        command.__doc__,
        command.__module__,
    )
    call.__annotations__ = {one.name: one.annotation for one in parameters}
    call.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
    return call


@dataclass(frozen=True)
class Given:
    """What a model is given: a preset, values and start values, and libraries of blocks."""

    preset: Preset = ""
    values: Values = None
    start: Start = None
    library: Libraries = None


@dataclass(frozen=True)
class Target:
    """Where the numbers of a result go, and how it is printed."""

    output: OutputFile = None
    as_json: AsJson = False
    debug: Debug = False

    @property
    def picture(self) -> str | None:
        """The file of the figure; None where there is none."""
        return None


@dataclass(frozen=True)
class FigureTarget(Target):
    """The same of a result that can be drawn."""

    figure: FigureFile = None

    @property
    def picture(self) -> str | None:
        """The file of the figure; None where there is none."""
        return self.figure


@dataclass(frozen=True)
class Work:
    """Who does long work, and where it is kept."""

    workers: Annotated[
        int | None, typer.Option(metavar="N", help="Threads; the number of cores unless given.")
    ] = None
    executor: ExecutorAddress = ""
    partial: Annotated[
        str | None,
        typer.Option(
            "--partial",
            metavar="FILE",
            help="Keep what is done in this .npz; the same command goes on from there.",
        ),
    ] = None


@dataclass(frozen=True)
class Sampling:
    """From when to when a run goes, and how often it is sampled."""

    span: Span = None
    every: Every = None


@dataclass(frozen=True)
class PlaneOptions:
    """When the points of a section are taken: the fields of `tracewire.analyse.Plane`."""

    period: Annotated[
        str,
        typer.Option(metavar="T", help="Points once a period, in s or a formula: '2*pi/omega'."),
    ] = ""
    phase: Annotated[
        str, typer.Option(metavar="T", help="The time of the first of them, in s or a formula.")
    ] = "0"
    edge: Annotated[
        str,
        typer.Option(metavar="SOURCE", help="Points where a source rises, as a square wave does."),
    ] = ""
    guard: Annotated[
        str,
        typer.Option(
            metavar="GUARD", help="Points where a guard crosses zero: its text or its block."
        ),
    ] = ""
    crosses: Annotated[str, typer.Option(help="The way a guard crosses: up, down or both.")] = "up"

    @property
    def plane(self) -> Plane:
        """The section as functions take it."""
        from tracewire.analyse import Plane

        return Plane(
            period=number_or_formula(self.period) if self.period else None,
            edge=self.edge,
            guard=self.guard,
            phase=number_or_formula(self.phase),
            direction=self.crosses,  # type: ignore[arg-type]
        )


@dataclass(frozen=True)
class MotionPeriod:
    """The period of a motion and when it begins."""

    period: Annotated[
        str,
        typer.Option(
            metavar="T", help="The period in s, or a formula of parameters: '2*pi/omega'."
        ),
    ]
    begin: Annotated[
        str, typer.Option(metavar="T", help="When it begins, in s or a formula: '0.5/f'.")
    ] = "0"

    @property
    def times(self) -> tuple[float | str, float | str]:
        """Period and begin as functions take them."""
        return number_or_formula(self.period), number_or_formula(self.begin)


def number_or_formula(text: str) -> float | str:
    """A number, or the text as a formula."""
    try:
        return float(text)
    except ValueError:
        return text
