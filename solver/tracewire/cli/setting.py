"""What all kinds of analysis are given, and how they tell what came out."""

from __future__ import annotations

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
    telling,
    working,
)
from tracewire.cli.records import Given, Sampling, Target
from tracewire.cli.values import parameter_values_of, start_values_of, values_of
from tracewire.files import replacing, write_rows, writing

if TYPE_CHECKING:
    from tracewire.compile import Model
    from tracewire.result import Result
    from tracewire.show import Table
    from tracewire.solve import Options, Run

OUTPUTS = (".csv", ".npz")
FIGURES = (".png", ".svg", ".pdf")

Modulo = Annotated[
    list[str] | None,
    typer.Option(
        "--modulo",
        metavar="NAME=VALUE",
        help="A state that closes up to a multiple, as in 'phi=360 deg'. Repeatable.",
    ),
]
Signal = Annotated[str, typer.Argument(metavar="SIGNAL", help="A signal.", show_default=False)]
TwoStates = Annotated[
    tuple[str, str] | None, typer.Option(metavar="X Y", help="The two states of the figure.")
]
Rtol = Annotated[float, typer.Option(help="The relative tolerance.")]


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

    def values_of(self, over: Sequence[str]) -> dict[str, Any]:
        """The values that --over gives, by name. Raises OptionError: a name that is set, too."""
        return values_of(self.model, over, parameters=self.parameters, start=self.start)

    def run_options(self, span: tuple[float, float] | None, rtol: float) -> Options:
        """The values as `simulate` takes them, with a span and a tolerance."""
        from tracewire.solve import Options

        return Options(
            parameters=self.parameters, start=self.start, preset=self.preset, span=span, rtol=rtol
        )


def read_setting(
    diagram: str, given: Given, target: Target, record: Sequence[str] | None = None
) -> Setting:
    """The model and its values; targets that could not be written are refused before the work."""
    check_target(target.picture, FIGURES, "figure")
    check_target(target.output, OUTPUTS, "output")
    model = load_model(diagram, given.library, record)
    from tracewire.solve import parameter_values

    parameters = parameter_values_of(model, given.values or ())
    parameter_values(model, parameters, given.preset)
    return Setting(model, parameters, start_values_of(model, given.start or ()), given.preset)


def run_of(setting: Setting, sampling: Sampling, rtol: float, *, steps: int | None = None) -> Run:
    """The run of a setting, with its warnings told; in `steps` steps where nothing says another."""
    from tracewire.solve import Options, even_times, parameter_values, simulate

    options = setting.run_options(sampling.span, rtol) | Options(every=sampling.every)
    if steps is not None and sampling.every is None and setting.model.flat.every is None:
        values = parameter_values(setting.model, setting.parameters, setting.preset)
        options["times"] = even_times(setting.model, values, sampling.span, steps)
    with working("simulating") as show:
        run = simulate(setting.model, **options, progress=telling("simulating", show))
    for warning in run.warnings:
        note(f"warning: {warning}")
    return run


def tell(
    found: Result,
    target: Target,
    columns: Mapping[str, Any],
    *,
    look: Mapping[str, Any] | None = None,
    warnings: Sequence[str] = (),
) -> None:
    """Write figure and numbers of a result where they are asked for, and print what came out.

    columns: its arrays. look: options of its figure.
    """
    from tracewire.show import present

    shown = present(found)

    def draw(path: str) -> None:
        shown.draw(path, look or {})

    tell_parts(found.json(), shown.parts, draw, target, columns, warnings)


def tell_parts(
    data: Mapping[str, object],
    parts: Sequence[str | Table],
    draw: Callable[[str], object],
    target: Target,
    columns: Mapping[str, Any],
    warnings: Sequence[str] = (),
) -> None:
    """The same of data, tables and sentences that are no result by themselves."""
    for warning in warnings:
        note(f"warning: {warning}")
    output, figure = target.output, target.picture
    if output is not None:
        with writing(output):
            write_numbers(output, columns)
    if figure is not None:
        with working(f"drawing {figure}"), writing(figure):
            draw(figure)
    written = [path for path in (output, figure) if path is not None]
    if target.as_json:
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
