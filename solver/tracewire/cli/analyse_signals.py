"""`tracewire analyse spectrum, scalogram, growth, invariants`: signals of one run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import typer

from tracewire.cli.options import DiagramPath
from tracewire.cli.records import FigureFile, FigureTarget, Given, Sampling, Since
from tracewire.cli.setting import Rtol, Signal, read_setting, run_of, tell, tell_parts


@dataclass(frozen=True)
class ScalogramTarget(FigureTarget):
    """A figure in any case."""

    figure: FigureFile = "scalogram.png"


def spectrum(
    diagram: DiagramPath,
    *,
    signal: Signal,
    window: Annotated[str, typer.Option(help="hann, flattop, blackman or boxcar.")] = "hann",
    high: Annotated[
        float | None, typer.Option(metavar="HZ", help="The highest frequency of the figure.")
    ] = None,
    lines: Annotated[int, typer.Option(metavar="N", help="Lines to tell.")] = 8,
    since: Since = None,
    sampling: Sampling,
    given: Given,
    rtol: Rtol = 1e-6,
    target: FigureTarget,
) -> None:
    """The amplitude spectrum of a signal, in its unit, and its largest lines.

    \b
    Examples:
      tracewire analyse spectrum coupled.yaml phi1 --span 0 200 --every 0.02 --figure lines.png
      tracewire analyse spectrum triple.yaml psi1 --since 100 --lines 3 --json
    """
    setting = read_setting(diagram, given, target, [signal])
    run = run_of(setting, sampling, rtol)
    from tracewire.analyse import spectrum as spectrum_of

    found = spectrum_of(run, signal, since=since, window=window, lines=lines)
    columns = {"frequency": found.frequency, "amplitude": found.amplitude}
    tell(found, target, columns, look={"high": high})


def scalogram(
    diagram: DiagramPath,
    *,
    signal: Signal,
    low: Annotated[float | None, typer.Option(metavar="HZ", help="The lowest frequency.")] = None,
    high: Annotated[float | None, typer.Option(metavar="HZ", help="The highest frequency.")] = None,
    waves: Annotated[
        float, typer.Option(help="More tell frequencies apart, fewer tell times.")
    ] = 6.0,
    since: Since = None,
    sampling: Sampling,
    given: Given,
    rtol: Rtol = 1e-6,
    target: ScalogramTarget,
) -> None:
    """Draw which frequencies a signal has at which times: Morlet's wavelet transform.

    \b
    Example:
      tracewire analyse scalogram ramp.yaml phi --low 0.1 --high 3 --figure ramp.png
    """
    setting = read_setting(diagram, given, target, [signal])
    run = run_of(setting, sampling, rtol)
    from tracewire.analyse import scalogram as scalogram_of

    found = scalogram_of(run, signal, low=low, high=high, waves=waves, since=since)

    columns = {"t": found.t, "ridge": found.ridge}
    if target.output is not None and target.output.endswith(".npz"):
        columns |= {"frequency": found.frequency, "amplitude": found.amplitude}
    tell(found, target, columns)


def growth(
    diagram: DiagramPath,
    *,
    signal: Signal,
    by: Annotated[str, typer.Option(help="peaks of a wave, or size of a norm.")] = "peaks",
    beat: Annotated[
        float | None, typer.Option(metavar="T", help="Of a signal that beats: the period in s.")
    ] = None,
    since: Since = None,
    sampling: Sampling,
    given: Given,
    rtol: Rtol = 1e-8,
    target: FigureTarget,
) -> None:
    """How fast an oscillation grows or decays: the rate in 1/s with its standard error.

    \b
    Examples:
      tracewire analyse growth hill.yaml x --since 2
      tracewire analyse growth mathieu.yaml y --beat 6.283 --figure growth.png
    """
    setting = read_setting(diagram, given, target, [signal])
    run = run_of(setting, sampling, rtol)
    from tracewire.analyse import growth_rate

    found = growth_rate(run, signal, by=by, since=since, period=beat)  # type: ignore[arg-type]

    bent = f"the envelope bends, and its second half has {found.late:.6g} /s: try --since"
    columns = {"t": found.t, "size": found.size}
    tell(found, target, columns, warnings=[bent] if found.bends else [])


def invariants(
    diagram: DiagramPath,
    *,
    names: Annotated[
        list[str],
        typer.Argument(metavar="SIGNAL ...", help="Signals that should not change: energies."),
    ],
    scale: Annotated[
        float | None,
        typer.Option(metavar="SIZE", help="What a drift is compared with, in SI."),
    ] = None,
    sampling: Sampling,
    given: Given,
    rtol: Rtol = 1e-9,
    target: FigureTarget,
) -> None:
    """How far signals that should stay the same drift over a run.

    \b
    Examples:
      tracewire analyse invariants atwood.yaml energy --set mu=3
      tracewire analyse invariants atwood.yaml energy second --rtol 1e-10 --figure drift.png
    """
    setting = read_setting(diagram, given, target, names)
    run = run_of(setting, sampling, rtol)
    from tracewire.analyse import invariant_drift
    from tracewire.show.present_analyses import drift_data, drift_table

    found = invariant_drift(run, names, scale=scale)

    def draw(path: str) -> object:
        from tracewire.show import plot_invariants

        return plot_invariants(found, path, run.title)

    tell_parts(
        {"drift": {d.name: drift_data(d) for d in found}, "rtol": rtol},
        [drift_table(found)],
        draw,
        target,
        {"t": run.t} | {d.name: d.values for d in found},
    )
