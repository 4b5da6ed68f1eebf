"""`tracewire analyse orbit`, `floquet` and `chart`: periodic motions and their stability."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.executors import executor_at
from tracewire.cli.options import DiagramPath
from tracewire.cli.output import telling, working
from tracewire.cli.records import FigureTarget, Given, MotionPeriod, Target, Work
from tracewire.cli.setting import Modulo, Rtol, TwoStates, read_setting, tell
from tracewire.errors import OptionError, Problem


def orbit(
    diagram: DiagramPath,
    *,
    motion: MotionPeriod,
    skip: Annotated[
        int, typer.Option(metavar="N", help="Periods to simulate before the search begins.")
    ] = 0,
    turns: Modulo = None,
    plane: TwoStates = None,
    given: Given,
    rtol: Rtol = 1e-10,
    target: FigureTarget,
) -> None:
    """Find a periodic orbit near the start values by shooting, and tell whether it is stable.

    The period of a driven diagram is given, that of another one is found near it.

    \b
    Examples:
      tracewire analyse orbit triple.yaml --period 1/f --begin 0.5/f --skip 30 --set f=0.6
      tracewire analyse orbit van_der_pol.yaml --period 6 --skip 3 --figure cycle.png
    """
    setting, (period, begin) = read_setting(diagram, given, target), motion.times
    from tracewire.cli.values import start_values_of

    modulo = start_values_of(setting.model, turns or (), "--modulo")
    with working("shooting"):
        from tracewire.analyse import periodic_orbit

        found = periodic_orbit(
            setting.model,
            period,
            begin=begin,
            skip=skip,
            guess=setting.start,
            modulo=modulo,
            rtol=rtol,
            **setting.options,
        )
    columns = {"t": found.t} | {n: found.motion[:, i] for i, n in enumerate(found.states)}
    x, y = plane or ("", "")
    tell(found, target, columns, look={"x": x, "y": y}, warnings=found.floquet.warnings)


def floquet(
    diagram: DiagramPath,
    *,
    motion: MotionPeriod,
    given: Given,
    rtol: Rtol = 1e-10,
    target: Target,
) -> None:
    """The Floquet multipliers of the periodic motion through the start values.

    Rates that are linear in the states (Hill, Mathieu, Meissner) have them from each start; the
    motion of others must come back to its start: `analyse orbit` finds one.

    \b
    Examples:
      tracewire analyse floquet mathieu.yaml --period pi --set a=1 --set q=0.2
      tracewire analyse floquet meissner.yaml --period 2*pi/omega --json
    """
    setting, (period, begin) = read_setting(diagram, given, target), motion.times
    with working("following one period"):
        from tracewire.analyse import floquet as floquet_of

        found = floquet_of(
            setting.model,
            period,
            begin=begin,
            start=setting.start,
            rtol=rtol,
            **setting.options,
        )
    columns = {"re": found.multipliers.real, "im": found.multipliers.imag}
    tell(found, target, columns, warnings=found.warnings)


def chart(
    diagram: DiagramPath,
    *,
    over: Annotated[
        list[str],
        typer.Option(
            "--over",
            metavar="NAME=FROM:TO:COUNT",
            help="A parameter and its values; give two, first across, then up.",
        ),
    ],
    motion: MotionPeriod,
    given: Given,
    rtol: Rtol = 1e-9,
    work: Work,
    target: FigureTarget,
) -> None:
    """A stability chart over two parameters, from Floquet multipliers at each point.

    \b
    Examples:
      tracewire analyse chart mathieu.yaml --over a=-1:6:141 --over q=0:3:61 --period pi
                --figure tongues.png --partial tongues.npz
    """
    setting, (period, begin) = read_setting(diagram, given, target), motion.times
    grid = setting.values_of(over)
    if len(grid) != 2:
        what = f"--over names {len(grid)} parameter{'s' * (len(grid) != 1)}, and a chart has two"
        raise OptionError([Problem(what, hint="Give --over a=0:5:101 --over q=0:2:41.")])
    across, up = grid.items()
    with executor_at(work.executor) as pool, working("charting") as show:
        from tracewire.analyse import stability_chart

        found = stability_chart(
            setting.model,
            across,
            up,
            period,
            begin=begin,
            start=setting.start,
            rtol=rtol,
            workers=work.workers,
            executor=pool,
            partial=work.partial,
            progress=telling("charting", show),
            **setting.options,
        )
    import numpy as np

    xs, ys = np.meshgrid(found.x, found.y)
    columns = {found.x_name: xs, found.y_name: ys, "radius": found.radius}
    tell(found, target, columns)
