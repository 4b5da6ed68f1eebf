"""`tracewire analyse steady` and `linearise`."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.options import DiagramPath
from tracewire.cli.output import working
from tracewire.cli.records import Given, Target
from tracewire.cli.setting import read_setting, tell

Time = Annotated[float, typer.Option("--time", metavar="T", help="The time in s.")]


def steady(
    diagram: DiagramPath,
    *,
    given: Given,
    target: Target,
) -> None:
    """Find a steady state near the start values, and tell whether it is stable.

    \b
    Examples:
      tracewire analyse steady pendulum.yaml --start phi=3
      tracewire analyse steady triple.yaml --set q=0 --json
    """
    setting = read_setting(diagram, given, target)
    with working("searching"):
        from tracewire.analyse import steady_state

        found = steady_state(setting.model, guess=setting.start, **setting.options)
    columns = {"state": list(found.states), "value": found.x}
    tell(found, target, columns)


def linearise(
    diagram: DiagramPath,
    *,
    inputs: Annotated[
        list[str] | None,
        typer.Option(
            "--input",
            metavar="NAME",
            help="A column of B and D: a parameter, an input of the diagram or a signal. "
            "Repeatable.",
        ),
    ] = None,
    outputs: Annotated[
        list[str] | None,
        typer.Option(
            "--signal",
            metavar="NAME",
            help="A row of C and D, the recorded signals unless given. Repeatable.",
        ),
    ] = None,
    at_steady: Annotated[
        bool, typer.Option("--steady", help="At the steady state near the start values.")
    ] = False,
    time: Time = 0.0,
    given: Given,
    target: Target,
) -> None:
    """Linearise a diagram: dx' = A dx + B du, dy = C dx + D du around the start values.

    At a point where a guard is at its level there are no slopes, and it says which guard that is.
    In Python, `linearise(model).to_control()` hands over to python-control.

    \b
    Examples:
      tracewire analyse linearise pendulum.yaml --input torque --signal phi
      tracewire analyse linearise pendulum.yaml --steady --output matrices.npz
    """
    setting = read_setting(diagram, given, target)
    with working("linearising"):
        from tracewire.analyse import linearise as linearise_model
        from tracewire.analyse import steady_state

        at = setting.start
        if at_steady:
            at = steady_state(setting.model, guess=at, t=time, **setting.options).values
        found = linearise_model(
            setting.model, at=at, t=time, inputs=inputs or (), outputs=outputs, **setting.options
        )
    columns = {"A": found.A, "B": found.B, "C": found.C, "D": found.D, "x": found.x}
    if target.output is not None and target.output.endswith(".csv"):
        columns = {name: found.A[:, n] for n, name in enumerate(found.states)}  # A alone
    tell(found, target, columns)
