"""How analyses show themselves: steady states, orbits, charts, sweeps, spectra, exponents."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from tracewire.analyse import (
    Bifurcation,
    Drift,
    Floquet,
    GrowthRate,
    Linear,
    Lyapunov,
    PeriodicOrbit,
    PoincareSection,
    Scalogram,
    Spectrum,
    StabilityChart,
    SteadyState,
    Sweep,
)
from tracewire.errors import AnalysisError
from tracewire.show.bifurcation_figures import plot_bifurcation, plot_section
from tracewire.show.plane_figures import plot_orbit
from tracewire.show.presentation import Part, Presentation
from tracewire.show.signal_figures import (
    plot_growth,
    plot_invariants,
    plot_lyapunov,
    plot_scalogram,
    plot_spectrum,
)
from tracewire.show.style import with_unit
from tracewire.show.sweep_figures import plot_chart, plot_sweep
from tracewire.show.table import Table

DELAYS = ("signals", "times", "B2", "C2", "D12", "D21", "D22")
VALUE = frozenset({2})


def precise(value: float) -> str:
    """A number of an analysis."""
    return f"{value:.8g}"


def complex_text(value: complex) -> str:
    """A complex number for a table."""
    if abs(value.imag) <= 1e-12 * abs(value):
        return f"{value.real:.8g}"
    return f"{value.real:.8g} {'+' if value.imag >= 0 else '-'} {abs(value.imag):.8g}i"


def pairs(values: Iterable[complex]) -> list[list[float]]:
    """Complex numbers for JSON, as [real, imaginary]."""
    return [[float(value.real), float(value.imag)] for value in values]


def failed_lines(errors: Mapping[Any, str], first_at: str = "") -> list[str]:
    """What to say of points that failed: how many, where the first did, and why."""
    if not errors:
        return []
    points = "1 point failed" if len(errors) == 1 else f"{len(errors)} points failed"
    first = next(iter(errors.values())).split("\n")[0]
    return [f"{points}; the first of them{first_at and f', at {first_at}'}: {first}"]


# --- steady states and linear models ------------------------------------------------------------


def _steady_parts(found: SteadyState) -> list[Part]:
    rows = tuple((n, found.units.get(n, ""), precise(x)) for n, x in found.values.items())
    parts: list[Part] = [Table("steady state", ("state", "unit", "value"), rows, VALUE)]
    if len(found.eigenvalues):
        listed = tuple((complex_text(value),) for value in found.eigenvalues.tolist())
        parts.append(Table("eigenvalues [1/s]", ("eigenvalue",), listed, frozenset({0})))
    parts.append(f"{found.verdict}; the largest rate that is left is {found.residual:.2g}")
    return [*parts, *(f"no slopes here: {guard}" for guard in found.guards)]


def _steady_data(found: SteadyState) -> dict[str, Any]:
    return {
        "states": found.values,
        "residual": found.residual,
        "eigenvalues": pairs(found.eigenvalues),
        "verdict": found.verdict,
        "guards": found.guards,
    }


def _steady_in_a_line(found: SteadyState) -> str:
    values = ", ".join(f"{name} = {value:.6g}" for name, value in list(found.values.items())[:4])
    return f"{found.verdict}, {values}" + (", ..." if len(found.x) > 4 else "")


def _linear_parts(found: Linear) -> list[Part]:
    def table(name: str, matrix: Any, across: tuple[str, ...], down: tuple[str, ...]) -> Table:
        rows = tuple(
            (row, *map(precise, line)) for row, line in zip(down, matrix.tolist(), strict=True)
        )
        head = ("rate of" if name[0] in "AB" else "signal", *across)
        return Table(name, head, rows, frozenset(range(1, 1 + len(across))))

    matrices = (
        ("A", found.A, found.states, found.states),
        ("B", found.B, found.inputs, found.states),
        ("C", found.C, found.states, found.outputs),
        ("D", found.D, found.inputs, found.outputs),
    )
    tables: list[Part] = [table(*matrix) for matrix in matrices if matrix[1].size]
    name = "eigenvalues"
    try:
        eigenvalues, verdict = found.eigenvalues.tolist(), found.verdict
    except AnalysisError as error:  # a delay that feeds itself has none; the matrices are right
        return [*tables, str(error)]
    for time, matrix in sorted(found.delays.terms().items()) if found.delays is not None else ():
        tables.append(table(f"A, {time:.6g} s ago", matrix, found.states, found.states))
        name = "rightmost characteristic roots"
    listed = ", ".join(map(complex_text, eigenvalues))
    return [
        *tables,
        f"{name} [1/s]: {listed}",
        f"{verdict}: {found.told}" if found.told else verdict,
    ]


def _linear_data(found: Linear) -> dict[str, Any]:
    names = ("states", "inputs", "outputs", "t", "x", "rates", "A", "B", "C", "D")
    data = {name: getattr(found, name) for name in names}
    if found.delays is not None:
        data["delays"] = {name: getattr(found.delays, name) for name in DELAYS}
    try:
        return data | {"eigenvalues": pairs(found.eigenvalues), "verdict": found.verdict}
    except AnalysisError as error:
        return data | {"eigenvalues": None, "verdict": None, "error": str(error)}


# --- periodic motions ---------------------------------------------------------------------------


def _multipliers(found: Floquet) -> Table:
    rows = tuple(
        (complex_text(m), precise(abs(m)), complex_text(e))
        for m, e in zip(found.multipliers.tolist(), found.exponents.tolist(), strict=True)
    )
    header = ("multiplier", "size", "exponent [1/s]")
    return Table("Floquet multipliers", header, rows, frozenset({0, 1, 2}))


def _floquet_data(found: Floquet) -> dict[str, Any]:
    return {
        "multipliers": pairs(found.multipliers),
        "exponents": pairs(found.exponents),
        "verdict": found.verdict,
        "warnings": found.warnings,
        "period": found.period,
        "closure": found.closure,
    }


def _orbit_parts(found: PeriodicOrbit) -> list[Part]:
    rows = tuple(
        (name, found.units.get(name, ""), precise(x))
        for name, x in zip(found.states, found.x.tolist(), strict=True)
    )
    return [
        Table(f"orbit at t = {found.begin:.8g} s", ("state", "unit", "value"), rows, VALUE),
        _multipliers(found.floquet),
        f"period {found.period:.10g} s; it closes to {found.closure:.1g} of its size after "
        f"{found.steps} steps",
        found.floquet.verdict,
    ]


def _orbit_data(found: PeriodicOrbit) -> dict[str, Any]:
    return _floquet_data(found.floquet) | {
        "period": found.period,
        "begin": found.begin,
        "states": dict(zip(found.states, found.x.tolist(), strict=True)),
        "closure": found.closure,
        "steps": found.steps,
    }


def _chart_line(found: StabilityChart) -> str:
    return f"{int(found.unstable.sum())} of {found.radius.size} points are unstable"


def _chart_data(found: StabilityChart) -> dict[str, Any]:
    return {
        found.x_name: found.x,
        found.y_name: found.y,
        "radius": found.radius,
        "unstable": int(found.unstable.sum()),
        "failed": len(found.errors),
    }


# --- motions that do not repeat -----------------------------------------------------------------


def _section_line(found: PoincareSection) -> str:
    kind = "irregular" if found.irregular else "regular"
    return f"{len(found.t)} points in {found.clusters} places: {kind}"


def _section_parts(found: PoincareSection) -> list[Part]:
    rows = tuple(
        (name, found.units.get(name, ""), precise(found[name].min()), precise(found[name].max()))
        for name in found.states
    )
    header = ("state", "unit", "min", "max")
    return [Table("points", header, rows, frozenset({2, 3})), _section_line(found)]


def _section_data(found: PoincareSection) -> dict[str, Any]:
    return {
        "points": len(found.t),
        "clusters": found.clusters,
        "irregular": found.irregular,
        "from": float(found.t[0]),
        "to": float(found.t[-1]),
    }


def _bifurcation_line(found: Bifurcation) -> str:
    count = int(sum(branch.irregular.sum() for branch in found.branches))
    total = sum(len(branch.values) for branch in found.branches)
    return f"{count} of {total} values are irregular"


def _bifurcation_parts(found: Bifurcation) -> list[Part]:
    rows = tuple(
        (branch.direction, precise(low), precise(high))
        for branch in found.branches
        for low, high in branch.bands
    )
    header = ("direction", with_unit("from", found.unit), "to")
    failed = [line for branch in found.branches for line in failed_lines(branch.errors)]
    tables = [Table("irregular", header, rows, frozenset({1, 2}))] if rows else []
    return [*tables, *failed, _bifurcation_line(found)]


def _bifurcation_data(found: Bifurcation) -> dict[str, Any]:
    branches = {
        b.direction: {
            found.parameter: b.values,
            "clusters": b.clusters,
            "irregular": b.irregular,
            "bands": b.bands,
            "failed": len(b.errors),
        }
        for b in found.branches
    }
    return {"parameter": found.parameter, "branches": branches}


def _lyapunov_parts(found: Lyapunov) -> list[Part]:
    rows = tuple(
        (precise(value), f"{error:.2g}")
        for value, error in zip(found.exponents.tolist(), found.errors.tolist(), strict=True)
    )
    header = ("exponent", "error")
    parts: list[Part] = [Table("Lyapunov exponents [1/s]", header, rows, frozenset({0, 1}))]
    parts.append(_lyapunov_line(found))
    if len(found.exponents) == len(found.states):
        parts.append(f"sum {found.total:.6g} 1/s; Kaplan-Yorke dimension {found.dimension:.4g}")
    if -np.inf in found.exponents:
        parts.append(
            "-inf: lost where something sticks, or shrunk to rounding within an interval, "
            "which a shorter --interval would show"
        )
    if found.divergence is not None:
        parts.append(f"mean divergence {found.divergence:.6g} 1/s, which the sum should be")
    return parts


def _lyapunov_line(found: Lyapunov) -> str:
    return f"positive by three errors: {found.positive}"


def _lyapunov_data(found: Lyapunov) -> dict[str, Any]:
    return {
        "exponents": found.exponents,
        "errors": found.errors,
        "positive": found.positive,
        "sum": found.total,
        "divergence": found.divergence,
        "dimension": found.dimension,
        "warnings": found.warnings,
    }


# --- signals and grids --------------------------------------------------------------------------


def _spectrum_parts(found: Spectrum) -> list[Part]:
    found = found.as_shown
    rows = tuple((precise(line.frequency), precise(line.amplitude)) for line in found.lines)
    header = ("frequency [Hz]", with_unit("amplitude", found.unit))
    return [
        Table(f"lines of {found.signal}", header, rows, frozenset({0, 1})),
        f"lines nearer than {found.resolution:.3g} Hz are one",
    ]


def _spectrum_data(found: Spectrum) -> dict[str, Any]:
    return {name: getattr(found, name) for name in ("signal", "unit", "resolution", "lines")}


def _scalogram_line(found: Scalogram) -> str:
    found = found.as_shown
    return f"largest amplitude {found.amplitude.max():.6g} {found.unit}".rstrip()


def _scalogram_data(found: Scalogram) -> dict[str, Any]:
    return {
        "signal": found.signal,
        "unit": found.unit,
        "frequencies": [float(found.frequency[0]), float(found.frequency[-1])],
        "largest": float(found.amplitude.max()),
    }


def _growth_line(found: GrowthRate) -> str:
    return (
        f"{found.signal} goes as exp({found.rate:.6g} t): "
        f"rate {found.rate:.6g} ± {found.error:.2g} /s"
    )


def _growth_data(found: GrowthRate) -> dict[str, Any]:
    data = {name: getattr(found, name) for name in ("signal", "rate", "error", "bends", "late")}
    return data | {"peaks": len(found.t)}


def drift_table(found: Iterable[Drift]) -> Table:
    """How far signals drift that should stay the same."""
    rows = tuple(
        (d.name, d.unit, precise(d.start), f"{d.largest:.3g}", precise(d.at), f"{d.relative:.3g}")
        for d in (one.as_shown for one in found)
    )
    header = ("signal", "unit", "start", "largest drift", "at t [s]", "relative")
    return Table("drift", header, rows, frozenset({2, 3, 4, 5}))


def drift_data(found: Drift) -> dict[str, Any]:
    """The numbers of a drift."""
    return {n: getattr(found, n) for n in ("start", "largest", "final", "relative", "scale")}


def _drift_line(found: Drift) -> str:
    found = found.as_shown
    return f"{found.name} by at most {found.largest:.3g} {found.unit}".rstrip()


def _plot_drift(found: Drift, path: str, title: str = "") -> Any:
    return plot_invariants((found,), path, title)


def _sweep_line(found: Sweep) -> str:
    return f"{int(np.prod([len(axis) for axis in found.grid.values()]))} runs"


def _sweep_parts(found: Sweep) -> list[Part]:
    rows = tuple(
        (name, found.unit(name), precise(float(np.nanmin(v))), precise(float(np.nanmax(v))))
        for name, v in ((name, found.as_shown(name)) for name in found.values)
    )
    table = Table("over the grid", ("number", "unit", "min", "max"), rows, frozenset({2, 3}))
    first = zip(found.grid.items(), next(iter(found.errors), ()), strict=False)
    at = " and ".join(
        f"{name} = {values[i]:.6g} {found.units.get(name, '')}".rstrip()
        for (name, values), i in first
    )
    return [table, _sweep_line(found), *failed_lines(found.errors, at)]


PRESENTATIONS = {
    SteadyState: Presentation(_steady_in_a_line, _steady_parts, _steady_data),
    Linear: Presentation(
        lambda f: (
            f"{len(f.states)} states, {len(f.inputs)} inputs, {len(f.outputs)} outputs, {f.verdict}"
        ),
        _linear_parts,
        _linear_data,
    ),
    Floquet: Presentation(
        lambda f: f"period {f.period:.6g} s, {f.verdict}",
        lambda f: [_multipliers(f), f"period {f.period:.10g} s", f.verdict],
        _floquet_data,
    ),
    PeriodicOrbit: Presentation(
        lambda f: f"period {f.period:.6g} s, {f.floquet.verdict}",
        _orbit_parts,
        _orbit_data,
        plot_orbit,
    ),
    StabilityChart: Presentation(
        _chart_line,
        lambda f: [_chart_line(f), *failed_lines(f.errors)],
        _chart_data,
        plot_chart,
    ),
    PoincareSection: Presentation(_section_line, _section_parts, _section_data, plot_section),
    Bifurcation: Presentation(
        _bifurcation_line, _bifurcation_parts, _bifurcation_data, plot_bifurcation
    ),
    Lyapunov: Presentation(_lyapunov_line, _lyapunov_parts, _lyapunov_data, plot_lyapunov),
    Spectrum: Presentation(
        lambda f: f"{f.signal}, {len(f.lines)} lines, {f.resolution:.3g} Hz apart",
        _spectrum_parts,
        _spectrum_data,
        plot_spectrum,
    ),
    Scalogram: Presentation(
        lambda f: f"{f.signal}, {_scalogram_line(f)}",
        lambda f: [_scalogram_line(f)],
        _scalogram_data,
        plot_scalogram,
    ),
    GrowthRate: Presentation(_growth_line, lambda f: [_growth_line(f)], _growth_data, plot_growth),
    Drift: Presentation(
        _drift_line,
        lambda f: [drift_table([f])],
        drift_data,
        _plot_drift,
    ),
    Sweep: Presentation(
        lambda f: f"{_sweep_line(f)} over {', '.join(f.grid)}: {', '.join(f.values)}",
        _sweep_parts,
        lambda f: {"grid": f.grid, "values": f.values, "failed": len(f.errors)},
        plot_sweep,
    ),
}
