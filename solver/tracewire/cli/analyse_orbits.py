"""`tracewire analyse orbit`, `floquet` and `chart`: periodic motions and their stability."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.executors import ExecutorAddress, executor_at
from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries
from tracewire.cli.output import telling, working
from tracewire.cli.setting import (
    Begin,
    FigureFile,
    Modulo,
    OutputFile,
    PartialFile,
    Period,
    Preset,
    Rtol,
    Start,
    TwoStates,
    Values,
    Workers,
    complex_text,
    failed_lines,
    number_or_formula,
    parts,
    read_setting,
    shown,
    tell,
    values_of,
)
from tracewire.errors import OptionError, Problem

if TYPE_CHECKING:
    from tracewire.analyse import Floquet
    from tracewire.show import Table


def orbit(
    diagram: DiagramPath,
    period: Period,
    begin: Begin = "0",
    skip: Annotated[
        int, typer.Option(metavar="N", help="Periods to simulate before the search begins.")
    ] = 0,
    turns: Modulo = None,
    plane: TwoStates = None,
    preset: Preset = "",
    values: Values = None,
    start: Start = None,
    rtol: Rtol = 1e-10,
    figure: FigureFile = None,
    output: OutputFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Find a periodic orbit near the start values by shooting, and tell whether it is stable.

    The period of a driven diagram is given, that of another one is found near it.

    \b
    Examples:
      tracewire analyse orbit triple.yaml --period 1/f --begin 0.5/f --skip 30 --set f=0.6
      tracewire analyse orbit van_der_pol.yaml --period 6 --skip 3 --figure cycle.png
    """
    setting = read_setting(diagram, library, preset, values, start, figure=figure, output=output)
    from tracewire.cli.values import start_values_of

    modulo = start_values_of(setting.model, turns or (), "--modulo")
    with working("shooting"):
        from tracewire.analyse import periodic_orbit

        found = periodic_orbit(
            setting.model,
            number_or_formula(period),
            begin=number_or_formula(begin),
            skip=skip,
            guess=setting.start,
            modulo=modulo,
            rtol=rtol,
            **setting.options,
        )
    from tracewire.show import Table

    units = {state.name: state.unit for state in setting.model.flat.states}
    rows = tuple(
        (name, units[name], shown(x)) for name, x in zip(found.states, found.x, strict=True)
    )
    title = f"orbit at t = {found.begin:.8g} s"
    tables = [Table(title, ("state", "unit", "value"), rows, frozenset({2}))]
    data = {
        "period": found.period,
        "begin": found.begin,
        "states": dict(zip(found.states, found.x.tolist(), strict=True)),
        "closure": found.closure,
        "steps": found.steps,
        **_data(found.floquet),
    }
    lines = [
        f"period {found.period:.10g} s; it closes to {found.closure:.1g} of its size after "
        f"{found.steps} steps",
        found.floquet.verdict,
    ]
    columns = {"t": found.t} | {n: found.motion[:, i] for i, n in enumerate(found.states)}

    def draw(path: str) -> object:
        from tracewire.show import plot_orbit

        return plot_orbit(found, path, *(plane or ("", "")))

    tell(
        data,
        [*tables, _multipliers(found.floquet)],
        lines,
        as_json=as_json,
        draw=draw,
        figure=figure,
        columns=columns,
        output=output,
        warnings=found.floquet.warnings,
    )


def floquet(
    diagram: DiagramPath,
    period: Period,
    begin: Begin = "0",
    preset: Preset = "",
    values: Values = None,
    start: Start = None,
    rtol: Rtol = 1e-10,
    output: OutputFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """The Floquet multipliers of the periodic motion through the start values.

    Rates that are linear in the states (Hill, Mathieu, Meissner) have them from each start; the
    motion of others must come back to its start: `analyse orbit` finds one.

    \b
    Examples:
      tracewire analyse floquet mathieu.yaml --period pi --set a=1 --set q=0.2
      tracewire analyse floquet meissner.yaml --period 2*pi/omega --json
    """
    setting = read_setting(diagram, library, preset, values, start, output=output)
    with working("following one period"):
        from tracewire.analyse import floquet as floquet_of

        found = floquet_of(
            setting.model,
            number_or_formula(period),
            begin=number_or_formula(begin),
            start=setting.start,
            rtol=rtol,
            **setting.options,
        )
    columns = {"re": found.multipliers.real, "im": found.multipliers.imag}
    lines = [f"period {found.period:.10g} s", found.verdict]
    tell(
        _data(found) | {"period": found.period, "closure": found.closure},
        [_multipliers(found)],
        lines,
        as_json=as_json,
        columns=columns,
        output=output,
        warnings=found.warnings,
    )


def chart(
    diagram: DiagramPath,
    over: Annotated[
        list[str],
        typer.Option(
            "--over",
            metavar="NAME=FROM:TO:COUNT",
            help="A parameter and its values; give two, first across, then up.",
        ),
    ],
    period: Period,
    begin: Begin = "0",
    preset: Preset = "",
    values: Values = None,
    start: Start = None,
    rtol: Rtol = 1e-9,
    workers: Workers = None,
    executor: ExecutorAddress = "",
    partial: PartialFile = None,
    figure: FigureFile = None,
    output: OutputFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """A stability chart over two parameters, from Floquet multipliers at each point.

    \b
    Examples:
      tracewire analyse chart mathieu.yaml --over a=-1:6:141 --over q=0:3:61 --period pi
                --figure tongues.png --partial tongues.npz
    """
    setting = read_setting(diagram, library, preset, values, start, figure=figure, output=output)
    grid = values_of(setting.model, over)
    if len(grid) != 2:
        what = f"--over names {len(grid)} parameter{'s' * (len(grid) != 1)}, and a chart has two"
        raise OptionError([Problem(what, hint="Give --over a=0:5:101 --over q=0:2:41.")])
    across, up = grid.items()
    with executor_at(executor) as pool, working("charting") as show:
        from tracewire.analyse import stability_chart

        found = stability_chart(
            setting.model,
            across,
            up,
            number_or_formula(period),
            begin=number_or_formula(begin),
            start=setting.start,
            rtol=rtol,
            workers=workers,
            executor=pool,
            partial=partial,
            progress=telling("charting", show),
            **setting.options,
        )
    unstable = int(found.unstable.sum())
    lines = [f"{unstable} of {found.radius.size} points are unstable"]
    lines += failed_lines(found.errors)
    import numpy as np

    xs, ys = np.meshgrid(found.x, found.y)
    columns = {found.x_name: xs, found.y_name: ys, "radius": found.radius}
    data = {
        found.x_name: found.x,
        found.y_name: found.y,
        "radius": found.radius,
        "unstable": unstable,
        "failed": len(found.errors),
    }

    def draw(path: str) -> object:
        from tracewire.show import plot_chart

        return plot_chart(found, path)

    tell(
        data,
        [],
        lines,
        as_json=as_json,
        draw=draw,
        figure=figure,
        columns=columns,
        output=output,
    )


def _multipliers(found: Floquet) -> Table:
    from tracewire.show import Table

    rows = tuple(
        (complex_text(m), shown(abs(m)), complex_text(e))
        for m, e in zip(found.multipliers.tolist(), found.exponents.tolist(), strict=True)
    )
    header = ("multiplier", "size", "exponent [1/s]")
    return Table("Floquet multipliers", header, rows, frozenset({0, 1, 2}))


def _data(found: Floquet) -> dict[str, object]:
    return {
        "multipliers": parts(found.multipliers),
        "exponents": parts(found.exponents),
        "verdict": found.verdict,
        "warnings": found.warnings,
    }
