"""`tracewire analyse section`, `bifurcation` and `lyapunov`: motions that do not repeat."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from tracewire.cli.executors import ExecutorAddress, executor_at
from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries
from tracewire.cli.output import telling, working
from tracewire.cli.setting import (
    FigureFile,
    Modulo,
    OutputFile,
    PartialFile,
    Preset,
    Rtol,
    Start,
    TwoStates,
    Values,
    Workers,
    number_or_formula,
    read_setting,
    tell,
    values_of,
)
from tracewire.cli.values import start_values_of
from tracewire.errors import OptionError, Problem

if TYPE_CHECKING:
    from tracewire.analyse import Plane

Period = Annotated[
    str,
    typer.Option(metavar="T", help="Points once a period, in s or a formula: '2*pi/omega'."),
]
Phase = Annotated[
    str, typer.Option(metavar="T", help="The time of the first of them, in s or a formula.")
]
Edge = Annotated[
    str, typer.Option(metavar="SOURCE", help="Points where a source rises, as a square wave does.")
]
Guard = Annotated[
    str,
    typer.Option(metavar="GUARD", help="Points where a guard crosses zero: its text or its block."),
]
Crosses = Annotated[str, typer.Option(help="The way a guard crosses: up, down or both.")]
Skip = Annotated[int, typer.Option(metavar="N", help="Points that are passed over.")]
Keep = Annotated[int, typer.Option(metavar="N", help="Points that are kept.")]


def section(
    diagram: DiagramPath,
    period: Period = "",
    phase: Phase = "0",
    edge: Edge = "",
    guard: Guard = "",
    crosses: Crosses = "up",
    skip: Skip = 0,
    keep: Keep = 500,
    modulo: Modulo = None,
    plane: TwoStates = None,
    preset: Preset = "",
    values: Values = None,
    start: Start = None,
    rtol: Rtol = 1e-6,
    figure: FigureFile = None,
    output: OutputFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """The points of a Poincaré section: once a period, at rising edges, or where a guard crosses.

    \b
    Examples:
      tracewire analyse section triple.yaml --edge torque --preset chaotic --skip 1000
                --keep 30000 --plane psi1 psi1_dot --figure attractor.png
      tracewire analyse section duffing.yaml --period 2*pi/omega --json
    """
    setting = read_setting(diagram, library, preset, values, start, figure=figure, output=output)
    turns = start_values_of(setting.model, modulo or (), "--modulo")
    with working("collecting points"):
        from tracewire.analyse import section as section_of

        found = section_of(
            setting.model,
            _plane(period, phase, edge, guard, crosses),
            skip=skip,
            keep=keep,
            modulo=turns,
            start=setting.start,
            rtol=rtol,
            **setting.options,
        )
    x, y = plane or ("", "")
    tell(
        found,
        as_json=as_json,
        figure=figure,
        look={"x": x, "y": y},
        columns={"t": found.t} | {name: found[name] for name in found.states},
        output=output,
    )


def bifurcation(
    diagram: DiagramPath,
    over: Annotated[
        str,
        typer.Option(
            "--over", metavar="NAME=FROM:TO:COUNT", help="The parameter and its values: f=1:2:100."
        ),
    ],
    period: Period = "",
    phase: Phase = "0",
    edge: Edge = "",
    guard: Guard = "",
    crosses: Crosses = "up",
    direction: Annotated[
        str,
        typer.Option(
            help="up, down, both (side by side), up_down, down_up (the state carried on), or apart "
            "(each value from the start)."
        ),
    ] = "up",
    skip: Skip = 200,
    keep: Keep = 100,
    modulo: Modulo = None,
    states: Annotated[
        list[str] | None,
        typer.Option("--state", metavar="NAME", help="A state of the figure. Repeatable."),
    ] = None,
    preset: Preset = "",
    values: Values = None,
    start: Start = None,
    rtol: Rtol = 1e-6,
    workers: Workers = None,
    executor: ExecutorAddress = "",
    partial: PartialFile = None,
    figure: FigureFile = None,
    output: OutputFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """A bifurcation diagram: points of a section over a parameter, the state carried along.

    A motion is irregular where its points make more places than a quarter of their number.

    \b
    Examples:
      tracewire analyse bifurcation triple.yaml --over f=0.3:0.9:800 --edge torque
                --direction down_up --state psi1_dot --partial sweep.npz --figure sweep.png
      tracewire analyse bifurcation duffing.yaml --over f=0.2:0.5:200 --period 2*pi/omega
    """
    setting = read_setting(diagram, library, preset, values, start, figure=figure, output=output)
    turns = start_values_of(setting.model, modulo or (), "--modulo")
    ((name, grid),) = values_of(setting.model, [over]).items()
    if name.startswith("start."):
        what = "a bifurcation diagram goes over a parameter, and a start value is carried along"
        raise OptionError([Problem(what, hint="Name a parameter.")])
    if figure is not None:
        wrong = [state for state in states or () if state not in setting.model.states]
        if wrong:
            from tracewire.errors import unknown

            raise OptionError([unknown("state", state, setting.model.states) for state in wrong])
    with executor_at(executor) as pool, working(f"going through {name}") as show:
        from tracewire.analyse import bifurcation as bifurcation_of

        found = bifurcation_of(
            setting.model,
            name,
            grid,
            _plane(period, phase, edge, guard, crosses),
            direction=direction,  # type: ignore[arg-type]
            skip=skip,
            keep=keep,
            modulo=turns,
            start=setting.start,
            rtol=rtol,
            workers=workers,
            executor=pool,
            partial=partial,
            progress=telling(f"going through {name}", show),
            **setting.options,
        )
    import numpy as np

    first = [np.repeat(branch.values, keep) for branch in found.branches]
    columns = {
        "direction": np.concatenate(
            [np.full(v.shape, b.direction) for b, v in zip(found.branches, first, strict=True)]
        ),
        name: np.concatenate(first),
    }
    for n, state in enumerate(found.states):
        columns[state] = np.concatenate([b.points[:, :, n].ravel() for b in found.branches])
    tell(
        found,
        as_json=as_json,
        figure=figure,
        look={"states": states or ()},
        columns=columns,
        output=output,
    )


def lyapunov(
    diagram: DiagramPath,
    length: Annotated[float, typer.Option(metavar="T", help="The time to average over, in s.")],
    transient: Annotated[
        float, typer.Option(metavar="T", help="The time to leave out before, in s.")
    ] = 0.0,
    interval: Annotated[
        float | None,
        typer.Option(
            metavar="DT",
            help="The time between two orthogonalisations; about 30 steps if not given.",
        ),
    ] = None,
    count: Annotated[
        int | None, typer.Option(metavar="N", help="The largest exponents alone.")
    ] = None,
    seed: Annotated[int, typer.Option(help="Of the first directions.")] = 0,
    preset: Preset = "",
    values: Values = None,
    start: Start = None,
    rtol: Rtol = 1e-6,
    figure: FigureFile = None,
    output: OutputFile = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """The Lyapunov exponents of a motion, with their standard errors.

    Where the field is smooth their sum is the mean divergence, which is told beside it.

    \b
    Examples:
      tracewire analyse lyapunov lorenz.yaml --length 500 --transient 20 --figure exponents.png
      tracewire analyse lyapunov triple.yaml --preset chaotic --length 2000 --transient 500
    """
    setting = read_setting(diagram, library, preset, values, start, figure=figure, output=output)
    with working("following deviations") as show:
        from tracewire.analyse import lyapunov as lyapunov_of

        found = lyapunov_of(
            setting.model,
            length,
            interval=interval,
            transient=transient,
            count=count,
            start=setting.start,
            rtol=rtol,
            seed=seed,
            progress=telling("following deviations", show),
            **setting.options,
        )
    tell(
        found,
        as_json=as_json,
        figure=figure,
        look={"title": setting.model.flat.title},
        columns={"t": found.t}
        | {f"exponent_{k + 1}": found.running[:, k] for k in range(found.running.shape[1])},
        output=output,
        warnings=found.warnings,
    )


def _plane(period: str, phase: str, edge: str, guard: str, crosses: str) -> Plane:
    from tracewire.analyse import Plane

    return Plane(
        period=number_or_formula(period) if period else None,
        edge=edge,
        guard=guard,
        phase=number_or_formula(phase),
        direction=crosses,  # type: ignore[arg-type]
    )
