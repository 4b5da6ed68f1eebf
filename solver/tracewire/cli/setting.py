"""What all kinds of analysis are given, and how they tell what came out."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tracewire.cli.options import load_model
from tracewire.cli.output import (
    check_target,
    note,
    print_json,
    print_parts,
    print_text,
    working,
)
from tracewire.cli.values import parameter_values_of, start_values_of
from tracewire.errors import OptionError, Problem
from tracewire.files import replacing, write_rows, writing

if TYPE_CHECKING:
    from tracewire.compile import Model
    from tracewire.result import Result
    from tracewire.show import Table

OUTPUTS = (".csv", ".npz")
FIGURES = (".png", ".svg", ".pdf")
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
VALUES = re.compile(rf"\s*([^=\s]+)\s*=\s*({NUMBER})\s*:\s*({NUMBER})\s*:\s*(\d+)\s*(.*)")
LISTED = re.compile(rf"\s*([^=\s]+)\s*=\s*({NUMBER}(?:\s*,\s*{NUMBER})*)\s*([^\d:,;]?[^:,;]*)")

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
Record = Annotated[
    list[str] | None,
    typer.Option(metavar="SIGNAL", help="A further signal to record. Repeatable."),
]
Period = Annotated[
    str,
    typer.Option(metavar="T", help="The period in s, or a formula of parameters: '2*pi/omega'."),
]
Begin = Annotated[
    str, typer.Option(metavar="T", help="When it begins, in s or a formula: '0.5/f'.")
]
Modulo = Annotated[
    list[str] | None,
    typer.Option(
        "--modulo",
        metavar="NAME=VALUE",
        help="A state that closes up to a multiple, as in 'phi=360 deg'. Repeatable.",
    ),
]
TwoStates = Annotated[
    tuple[str, str] | None, typer.Option(metavar="X Y", help="The two states of the figure.")
]
Rtol = Annotated[float, typer.Option(help="The relative tolerance.")]
FigureFile = Annotated[
    str | None, typer.Option("--figure", metavar="FILE", help="Draw it to .png, .svg or .pdf.")
]
OutputFile = Annotated[
    str | None, typer.Option("--output", metavar="FILE", help="Write the numbers to .csv or .npz.")
]
PartialFile = Annotated[
    str | None,
    typer.Option(
        "--partial",
        metavar="FILE",
        help="Keep what is done in this .npz; the same command goes on from there.",
    ),
]
Workers = Annotated[
    int | None, typer.Option(metavar="N", help="Threads; the number of cores unless given.")
]


@dataclass(frozen=True)
class Setting:
    """A model with the values that the command line gives it."""

    model: Model
    parameters: Mapping[str, float]
    start: Mapping[str, float]
    preset: str

    @property
    def options(self) -> dict[str, Any]:
        """The values as functions take them."""
        return {"parameters": self.parameters, "preset": self.preset}


def read_setting(
    diagram: str,
    library: Sequence[str] | None,
    preset: str,
    values: Sequence[str] | None,
    start: Sequence[str] | None = None,
    record: Sequence[str] | None = None,
    *,
    figure: str | None = None,
    output: str | None = None,
) -> Setting:
    """The model and its values; targets that could not be written are refused before the work."""
    check_target(figure, FIGURES, "figure")
    check_target(output, OUTPUTS, "output")
    model = load_model(diagram, library, record)
    from tracewire.solve import parameter_values

    parameters = parameter_values_of(model, values or ())
    parameter_values(model, parameters, preset)
    return Setting(model, parameters, start_values_of(model, start or ()), preset)


def values_of(model: Model, texts: Sequence[str], option: str = "--over") -> dict[str, Any]:
    """NAME=FROM:TO:COUNT as evenly spaced values, NAME=VALUE,VALUE,... as these, in SI by name.

    Raises OptionError.
    """
    import numpy as np

    found: dict[str, Any] = {}
    problems: list[Problem] = []
    for text in texts:
        even, listed = VALUES.fullmatch(text), LISTED.fullmatch(text)
        if even is not None:
            name, first, last, count, unit = even.groups()
            given = [first, last]
        elif listed is not None:
            name, numbers, unit = listed.groups()
            given, count = numbers.split(","), "1"
        else:
            what = f"{option} '{text}' is not a name, '=' and FROM:TO:COUNT or values"
            hint = f"Write it like {option} f=0.3:0.9:800 or {option} f=0.3,0.5,1."
            problems.append(Problem(what, hint=hint))
            continue
        read, known = parameter_values_of, name
        if name.startswith("start."):
            read, known = start_values_of, name.removeprefix("start.")
        values = [
            next(iter(read(model, [f"{known}={number.strip()} {unit}"], option).values()))
            for number in given
        ]
        if int(count) < 1:
            problems.append(Problem(f"{option} '{text}' has no values", hint="Give a COUNT."))
            continue
        if name in found:
            problems.append(Problem(f"{option} gives '{name}' twice", hint="Leave one out."))
        found[name] = np.linspace(values[0], values[1], int(count)) if even else np.array(values)
    if problems:
        raise OptionError(problems)
    return found


def tell(
    found: Result,
    *,
    as_json: bool,
    figure: str | None = None,
    look: Mapping[str, Any] | None = None,
    columns: Mapping[str, Any] | None = None,
    output: str | None = None,
    warnings: Sequence[str] = (),
) -> None:
    """Write figure and numbers of a result where they are asked for, and print what came out.

    look: options of its figure. columns: its arrays.
    """
    from tracewire.show import present

    shown = present(found)
    tell_parts(
        found.json(),
        shown.parts,
        lambda path: shown.draw(path, look or {}),
        as_json=as_json,
        figure=figure,
        columns=columns,
        output=output,
        warnings=warnings,
    )


def tell_parts(
    data: Mapping[str, object],
    parts: Sequence[str | Table],
    draw: Callable[[str], object],
    *,
    as_json: bool,
    figure: str | None = None,
    columns: Mapping[str, Any] | None = None,
    output: str | None = None,
    warnings: Sequence[str] = (),
) -> None:
    """The same of data, tables and sentences that are no result by themselves."""
    for warning in warnings:
        note(f"warning: {warning}")
    if output is not None:
        with writing(output):
            write_numbers(output, columns or {})
    if figure is not None:
        with working(f"drawing {figure}"), writing(figure):
            draw(figure)
    written = [path for path in (output, figure) if path is not None]
    if as_json:
        print_json({**data, "written": written})
        return
    print_parts(parts)
    for path in written:
        print_text(f"written: {path}")


def write_numbers(path: str, columns: Mapping[str, Any]) -> None:
    """Arrays by name to .npz; to .csv columns of one length. Raises OptionError."""
    import numpy as np

    arrays = {name: np.asarray(values) for name, values in columns.items()}
    if path.endswith(".npz"):
        with replacing(path) as file:
            np.savez(file, allow_pickle=False, **arrays)
        return
    rows = zip(*(values.ravel().tolist() for values in arrays.values()), strict=True)
    write_rows(path, list(arrays), rows)


def number_or_formula(text: str) -> float | str:
    """A number, or the text as a formula."""
    try:
        return float(text)
    except ValueError:
        return text
