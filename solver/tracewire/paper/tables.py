"""The tables of a reproduction: paper A's steps and what they found, paper B's bands."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tracewire.analyse import Bifurcation, Judge, Lyapunov
from tracewire.diagram import Diagram
from tracewire.paper.identification import FLOOR, NINE, RTOL, SPRING, STAGES, Identification
from tracewire.show import Table, shown
from tracewire.solve import parameter_values, simulate


def tables_of(
    paper: str, judge: Judge, steps: Identification, diagrams: tuple[Diagram, ...]
) -> tuple[Table, ...]:
    """The tables of a paper; what they need was made for its statements."""
    if paper == "a":
        return steps_table(steps), found_table(steps), printed_table(steps)
    if paper == "b":
        (diagram,) = diagrams
        settings = {statement.name: statement.run for statement in diagram.expect}
        bands = judge.subject(diagram, settings["B lower edge down"])
        exponents = judge.subject(diagram, settings["B exponents"])
        length = float(exponents.need("length", "the table"))
        return (
            bands_table(bands.bifurcation, judge.full),
            exponents_table(exponents.lyapunov, length),
        )
    return ()


def steps_table(steps: Identification) -> Table:
    """Step by step: model, what was adapted, and mean((φ_exp - φ_num)²)/2 of both angles."""
    rows = tuple(
        (
            step.name,
            step.stage,
            step.did,
            str(step.iterations),
            str(step.evaluations),
            f"{step.disk:.3e}",
            f"{step.column:.3e}",
        )
        for step in steps.steps
    )
    header = ("step", "model", "what", "iterations", "evaluations", "φ2 [rad²]", "φ1 [rad²]")
    title = f"the paper's strategy, criterion after each step; that of the noise is {FLOOR:.2e}"
    return Table(title, header, rows, frozenset({3, 4, 5, 6}))


def found_table(steps: Identification) -> Table:
    """What the last two steps found, beside what made the record, and their ratios to B1 or B2."""
    found = steps["M8"].values
    true = parameter_values(steps.model("S4"), {})
    names = ("B1", "B2", *SPRING, *NINE)
    rows = [(name, shown(found[name]), shown(true[name])) for name in names]

    def product(values: Mapping[str, float], side: str) -> float:
        return values["alpha"] * (1 + values["beta"]) * values[f"T_s2_{side}"]

    for side in "lr":
        name = f"alpha (1 + beta) T_s2_{side}"
        rows.append((name, shown(product(found, side)), shown(product(true, side))))
    title = "what M8 ends with, and what made the record; alpha, beta and T_s2 act as their product"
    return Table(title, ("parameter", "found", "true"), tuple(rows), frozenset({1, 2}))


def printed_table(steps: Identification) -> Table:
    """How far each stage as printed goes from the corrected one."""
    rows = []
    for stage in STAGES:
        model = steps.model(stage)
        run, printed = (simulate(model, preset=p, rtol=RTOL) for p in ("", "as_printed"))
        off = [np.degrees(np.abs(printed[n] - run[n]).max()) for n in ("phi1", "phi2")]
        rows.append((stage, *map(shown, off)))
    title = "each stage as printed (preset as_printed), largest difference within 4 s"
    return Table(title, ("stage", "φ1 [deg]", "φ2 [deg]"), tuple(rows), frozenset({1, 2}))


def bands_table(found: Bifurcation, full: bool) -> Table:
    """All bands of irregular motion that 200 skipped periods leave."""
    rows = tuple(
        (branch.direction, f"{low:.5f}", f"{high:.5f}")
        for branch in found.branches
        for low, high in branch.bands
    )
    count = len(found.branches[0].values)
    dense = "as many as in the paper" if full else "dense near 0.700 and 0.768 Hz only"
    title = f"irregular motion, {count} frequencies ({dense})"
    return Table(title, ("direction", "from [Hz]", "to [Hz]"), rows, frozenset({1, 2}))


def exponents_table(found: Lyapunov, length: float) -> Table:
    """The Lyapunov exponents at 0.73 Hz with their standard errors."""
    rows = tuple(
        (str(n), f"{value:.5f}", f"{error:.2g}")
        for n, (value, error) in enumerate(zip(found.exponents, found.errors, strict=True), start=1)
    )
    title = f"Lyapunov exponents at 0.73 Hz over {length:g} s"
    return Table(title, ("", "exponent [1/s]", "standard error"), rows, frozenset({0, 1, 2}))
