"""`tracewire analyse steady` and `linearise`."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries
from tracewire.cli.output import working
from tracewire.cli.setting import (
    OutputFile,
    Preset,
    Start,
    Values,
    complex_text,
    parts,
    read_setting,
    shown,
    tell,
)

Time = Annotated[float, typer.Option("--time", metavar="T", help="The time in s.")]


def steady(
    diagram: DiagramPath,
    preset: Preset = "",
    values: Values = None,
    start: Start = None,
    output: OutputFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Find a steady state near the start values, and tell whether it is stable.

    \b
    Examples:
      tracewire analyse steady pendulum.yaml --start phi=3
      tracewire analyse steady triple.yaml --set q=0 --json
    """
    setting = read_setting(diagram, library, preset, values, start, output=output)
    with working("searching"):
        from tracewire.analyse import steady_state

        found = steady_state(setting.model, guess=setting.start, **setting.options)
    from tracewire.show import Table

    units = {state.name: state.unit for state in setting.model.flat.states}
    rows = tuple((name, units[name], shown(x)) for name, x in found.values.items())
    tables = [Table("steady state", ("state", "unit", "value"), rows, frozenset({2}))]
    if len(found.eigenvalues):
        listed = tuple((complex_text(value),) for value in found.eigenvalues.tolist())
        tables.append(Table("eigenvalues [1/s]", ("eigenvalue",), listed, frozenset({0})))
    lines = [f"{found.verdict}; the largest rate that is left is {found.residual:.2g}"]
    lines += [f"no slopes here: {guard}" for guard in found.guards]
    data = {
        "states": found.values,
        "residual": found.residual,
        "eigenvalues": parts(found.eigenvalues),
        "verdict": found.verdict,
        "guards": found.guards,
    }
    columns = {"state": list(found.states), "value": found.x}
    tell(data, tables, lines, as_json=as_json, columns=columns, output=output)


def linearise(
    diagram: DiagramPath,
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
    preset: Preset = "",
    values: Values = None,
    start: Start = None,
    output: OutputFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Linearise a diagram: dx' = A dx + B du, dy = C dx + D du around the start values.

    At a point where a guard is at its level there are no slopes, and it says which guard that is.
    In Python, `linearise(model).to_control()` hands over to python-control.

    \b
    Examples:
      tracewire analyse linearise pendulum.yaml --input torque --signal phi
      tracewire analyse linearise pendulum.yaml --steady --output matrices.npz
    """
    setting = read_setting(diagram, library, preset, values, start, output=output)
    with working("linearising"):
        from tracewire.analyse import linearise as linearise_model
        from tracewire.analyse import steady_state

        at = setting.start
        if at_steady:
            at = steady_state(setting.model, guess=at, t=time, **setting.options).values
        found = linearise_model(
            setting.model, at=at, t=time, inputs=inputs or (), outputs=outputs, **setting.options
        )
    from tracewire.show import Table

    def table(name: str, matrix: list[list[float]], across: tuple[str, ...], down: str) -> Table:
        names = found.states if down == "state" else found.outputs
        rows = tuple(
            (row, *(shown(x) for x in line)) for row, line in zip(names, matrix, strict=True)
        )
        head = ("rate of" if down == "state" else "signal", *across)
        return Table(name, head, rows, frozenset(range(1, 1 + len(across))))

    given = [
        ("A", found.A, found.states, "state"),
        ("B", found.B, found.inputs, "state"),
        ("C", found.C, found.states, "output"),
        ("D", found.D, found.inputs, "output"),
    ]
    tables = [table(n, m.tolist(), across, down) for n, m, across, down in given if m.size]
    listed = ", ".join(complex_text(value) for value in found.eigenvalues.tolist())
    data = {
        "states": found.states,
        "inputs": found.inputs,
        "outputs": found.outputs,
        "t": found.t,
        "x": found.x,
        "rates": found.rates,
        **{name: matrix for name, matrix, _, _ in given},
        "eigenvalues": parts(found.eigenvalues),
        "verdict": found.verdict,
    }
    columns = {name: matrix for name, matrix, _, _ in given} | {"x": found.x}
    if output is not None and output.endswith(".csv"):
        columns = {name: found.A[:, n] for n, name in enumerate(found.states)}  # A alone
    verdict = f"{found.verdict}: {found.told}" if found.told else found.verdict
    lines = [f"eigenvalues [1/s]: {listed}", verdict]
    tell(data, tables, lines, as_json=as_json, columns=columns, output=output)
