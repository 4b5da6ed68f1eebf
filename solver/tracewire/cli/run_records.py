"""The options of `tracewire run`, as records."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.options import AsJson, Debug, Libraries, SeriesName
from tracewire.cli.output import check_target
from tracewire.cli.reporting import ReportFile
from tracewire.errors import OptionError, Problem

if TYPE_CHECKING:
    from tracewire.solve import Options

OUTPUTS = (".csv", ".npz")
FIGURES = (".png", ".svg", ".pdf")
REPORTS = (".md", ".html")


@dataclass(frozen=True)
class RunGiven:
    """What is run: presets, values, start values, a measured series, signals to record."""

    preset: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME", help="A preset of the diagram. Repeatable: a run for each of them."
        ),
    ] = None
    values: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="NAME=VALUE",
            help="A parameter, as in k=2.5 or 'phi=13.6 deg'; a number without unit is in the unit "
            "that the diagram's file gives it. Repeatable.",
            show_default=False,
        ),
    ] = None
    start: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="The start value of a state; without unit in SI. Repeatable.",
            show_default=False,
        ),
    ] = None
    over: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUES",
            help="A run for each of these values of a parameter, or of start.STATE, in one table "
            "and figure: 'k=1,2,5' or 'k=FROM:TO:COUNT'. Repeatable.",
            show_default=False,
        ),
    ] = None
    series: SeriesName = ""
    record: Annotated[
        list[str] | None,
        typer.Option(metavar="SIGNAL", help="A further signal to record. Repeatable."),
    ] = None
    library: Libraries = None

    @property
    def is_own(self) -> bool:
        """Whether it is another run than that of the diagram alone."""
        return bool(self.series or self.preset or self.values or self.start or self.over)


@dataclass(frozen=True)
class Accuracy:
    """How exact a run is: options of `simulate`."""

    method: Annotated[
        str, typer.Option(help="auto, dormand_prince, dop853, rosenbrock or rk4.")
    ] = "auto"
    rtol: Annotated[float, typer.Option(help="The relative tolerance.")] = 1e-6
    atol: Annotated[
        float | None, typer.Option(help="The absolute tolerance; rtol/1000 unless given.")
    ] = None
    step: Annotated[
        float | None, typer.Option(help="The step of rk4 in s.", show_default=False)
    ] = None

    @property
    def options(self) -> Options:
        """These, as `simulate` takes them."""
        from tracewire.solve import Options

        options = Options(method=self.method, rtol=self.rtol, atol=self.atol)
        if self.step is not None:
            options["step"] = self.step
        return options


@dataclass(frozen=True)
class RunTarget:
    """What is printed of a run, and which files are written."""

    unit: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SIGNAL=UNIT",
            help="The unit of a signal in table and figure; files are in SI. Repeatable.",
            show_default=False,
        ),
    ] = None
    events: Annotated[bool, typer.Option("--events", help="Print the log of events.")] = False
    output: Annotated[
        str | None, typer.Option(metavar="FILE", help="Write the samples to .csv or .npz.")
    ] = None
    figure: Annotated[
        str | None, typer.Option(metavar="FILE", help="Draw the run to .png, .svg or .pdf.")
    ] = None
    report: ReportFile = None
    samples: Annotated[
        bool, typer.Option("--samples", help="With --json: print the samples, too.")
    ] = False
    as_json: AsJson = False
    debug: Debug = False

    def check(self) -> None:
        """Refuse, before the work, what could not be written after it. Raises OptionError."""
        if self.samples and not self.as_json:
            what = "--samples prints samples as JSON only"
            hint = "Add --json, or write them to a file with --output samples.csv."
            raise OptionError([Problem(what, hint=hint)])
        check_target(self.output, OUTPUTS, "output")
        check_target(self.figure, FIGURES, "figure")
        check_target(self.report, REPORTS, "report")

    def check_several(self) -> None:
        """Raises OptionError where something is asked for that several runs do not have."""
        if self.output or self.samples or self.events or self.report:
            what = "--output, --report, --samples and --events are those of one run"
            what += ", and here are several"
            hint = "Leave them out, or run each case by itself."
            raise OptionError([Problem(what, hint=hint)])

    @property
    def written(self) -> list[str]:
        """The files."""
        return [path for path in (self.output, self.figure, self.report) if path is not None]
