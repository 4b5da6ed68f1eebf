"""`tracewire analyse section`, `bifurcation` and `lyapunov`: motions that do not repeat."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.executors import executor_at
from tracewire.cli.options import DiagramPath
from tracewire.cli.output import telling, working
from tracewire.cli.records import FigureTarget, Given, PlaneOptions, Work
from tracewire.cli.setting import Modulo, Rtol, TwoStates, read_setting, tell
from tracewire.cli.values import start_values_of
from tracewire.errors import OptionError, Problem

Skip = Annotated[int, typer.Option(metavar="N", help="Points that are passed over.")]
Keep = Annotated[int, typer.Option(metavar="N", help="Points that are kept.")]


def section(
    diagram: DiagramPath,
    *,
    points: PlaneOptions,
    skip: Skip = 0,
    keep: Keep = 500,
    modulo: Modulo = None,
    plane: TwoStates = None,
    given: Given,
    rtol: Rtol = 1e-6,
    target: FigureTarget,
) -> None:
    """The points of a Poincaré section: once a period, at rising edges, or where a guard crosses.

    \b
    Examples:
      tracewire analyse section triple.yaml --edge torque --preset chaotic --skip 1000
                --keep 30000 --plane psi1 psi1_dot --figure attractor.png
      tracewire analyse section duffing.yaml --period 2*pi/omega --json
    """
    setting = read_setting(diagram, given, target)
    turns = start_values_of(setting.model, modulo or (), "--modulo")
    with working("collecting points"):
        from tracewire.analyse import section as section_of

        found = section_of(
            setting.model,
            points.plane,
            skip=skip,
            keep=keep,
            modulo=turns,
            start=setting.start,
            rtol=rtol,
            **setting.options,
        )
    x, y = plane or ("", "")
    columns = {"t": found.t} | {name: found[name] for name in found.states}
    tell(found, target, columns, look={"x": x, "y": y})


def bifurcation(
    diagram: DiagramPath,
    *,
    over: Annotated[
        str,
        typer.Option(
            "--over", metavar="NAME=FROM:TO:COUNT", help="The parameter and its values: f=1:2:100."
        ),
    ],
    points: PlaneOptions,
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
    given: Given,
    rtol: Rtol = 1e-6,
    work: Work,
    target: FigureTarget,
) -> None:
    """A bifurcation diagram: points of a section over a parameter, the state carried along.

    A motion is irregular where its points make more places than a quarter of their number.

    \b
    Examples:
      tracewire analyse bifurcation triple.yaml --over f=0.3:0.9:800 --edge torque
                --direction down_up --state psi1_dot --partial sweep.npz --figure sweep.png
      tracewire analyse bifurcation duffing.yaml --over f=0.2:0.5:200 --period 2*pi/omega
    """
    setting = read_setting(diagram, given, target)
    turns = start_values_of(setting.model, modulo or (), "--modulo")
    ((name, grid),) = setting.values_of([over]).items()
    if name not in setting.model.flat.parameters:
        what = "a bifurcation diagram goes over a parameter, and a start value is carried along"
        raise OptionError([Problem(what, hint="Name a parameter.")])
    if target.figure is not None:
        wrong = [state for state in states or () if state not in setting.model.states]
        if wrong:
            from tracewire.errors import unknown

            raise OptionError([unknown("state", state, setting.model.states) for state in wrong])
    with executor_at(work.executor) as pool, working(f"going through {name}") as show:
        from tracewire.analyse import bifurcation as bifurcation_of

        found = bifurcation_of(
            setting.model,
            name,
            grid,
            points.plane,
            direction=direction,  # type: ignore[arg-type]
            skip=skip,
            keep=keep,
            modulo=turns,
            start=setting.start,
            rtol=rtol,
            workers=work.workers,
            executor=pool,
            partial=work.partial,
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
    tell(found, target, columns, look={"states": states or ()})


def lyapunov(
    diagram: DiagramPath,
    *,
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
    given: Given,
    rtol: Rtol = 1e-6,
    target: FigureTarget,
) -> None:
    """The Lyapunov exponents of a motion, with their standard errors.

    Where the field is smooth their sum is the mean divergence, which is told beside it.

    \b
    Examples:
      tracewire analyse lyapunov lorenz.yaml --length 500 --transient 20 --figure exponents.png
      tracewire analyse lyapunov triple.yaml --preset chaotic --length 2000 --transient 500
    """
    setting = read_setting(diagram, given, target)
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
    exponents = range(found.running.shape[1])
    columns = {"t": found.t} | {f"exponent_{k + 1}": found.running[:, k] for k in exponents}
    look = {"title": setting.model.flat.title}
    tell(found, target, columns, look=look, warnings=found.warnings)
