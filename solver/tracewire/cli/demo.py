"""`tracewire demo`: the main job on the shipped examples, from a diagram to a named effect."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from tracewire.cli.check import check
from tracewire.cli.fit import fit
from tracewire.cli.options import Debug
from tracewire.cli.output import print_text, writing
from tracewire.cli.run import run
from tracewire.cli.trace import trace


def demo(
    output: Annotated[
        str, typer.Option(metavar="DIR", help="The folder for figures and reports.")
    ] = "out",
    debug: Debug = False,
) -> None:
    """Check, run and fit the double torsion pendulum; trace what a pendulum's diagram lacks.

    \b
    Example:
      tracewire demo --output out
    """
    from tracewire.shipped import shipped

    began = time.perf_counter()
    diagrams, folder = shipped("diagrams"), Path(output)
    with writing(output):
        for part in (folder / "fit", folder / "trace"):
            part.mkdir(parents=True, exist_ok=True)
    torsion = str(diagrams / "papers" / "a_torsion" / "pendulum.yaml")
    pendulum = str(diagrams / "lessons" / "pendulum.yaml")
    print_text("--- 1. check the double torsion pendulum")
    check(torsion)
    print_text("\n--- 2. run it")
    run(torsion, figure=str(folder / "torsion.png"))
    print_text("\n--- 3. fit the nine parameters of the paper's appendix, as it does")
    fit(torsion, max_iter=150)
    print_text("\n--- 4. hold the two that the data do not determine, and fit by least squares")
    report = str(folder / "fit" / "report.html")
    fit(torsion, method="least_squares", fix=["alpha", "beta"], report=report)
    print_text("\n--- 5. trace what the diagram of a swinging pendulum lacks")
    patch = str(folder / "pendulum.patch")
    trace(pendulum, report=str(folder / "trace" / "report.md"), output=patch)
    print_text(
        f"\ndone in {time.perf_counter() - began:.0f} s; figures and reports are in {folder}/"
    )
