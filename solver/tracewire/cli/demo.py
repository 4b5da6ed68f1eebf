"""`tracewire demo`: the main job, from a declared diagram to the effects that it lacks."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from tracewire.cli.check import check
from tracewire.cli.delivery import Targets
from tracewire.cli.options import Debug
from tracewire.cli.output import print_text
from tracewire.cli.records import Sampling
from tracewire.cli.run import run
from tracewire.cli.run_records import Accuracy, RunGiven, RunTarget
from tracewire.cli.trace import Asked, SeriesFiles, trace
from tracewire.files import writing


def demo(
    output: Annotated[
        str, typer.Option(metavar="DIR", help="The folder for figures and reports.")
    ] = "out",
    debug: Debug = False,
) -> None:
    """Check and run the double torsion pendulum as first declared, and trace what it lacks.

    The friction and the spring of the record differ between their two sides; the diagram does not
    say so.

    \b
    Example:
      tracewire demo --output out
    """
    from tracewire.shipped import shipped

    began = time.perf_counter()
    folder = Path(output)
    with writing(output):
        (folder / "trace").mkdir(parents=True, exist_ok=True)
    pendulum = str(shipped("diagrams") / "demo" / "pendulum.yaml")
    print_text("--- 1. check the double torsion pendulum as it was first declared")
    check([pendulum])
    print_text("\n--- 2. run it")
    run(
        pendulum,
        given=RunGiven(preset=["as_in_the_paper"]),
        sampling=Sampling(),
        accuracy=Accuracy(),
        target=RunTarget(figure=str(folder / "torsion.png")),
    )
    print_text("\n--- 3. trace what it lacks to explain five records")
    patch = str(folder / "pendulum.patch")
    targets = Targets(report=str(folder / "trace" / "report.md"), patch=patch)
    trace(pendulum, files=SeriesFiles(), asked=Asked(), targets=targets)
    print_text(
        f"\ndone in {time.perf_counter() - began:.0f} s; figures and reports are in {folder}/"
    )
