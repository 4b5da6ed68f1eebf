"""What a reader of a fit must know beside its numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.fit.limits import DIAGNOSIS
from tracewire.fit.result import Comparison
from tracewire.fit.uncertainty import Uncertainty
from tracewire.formula import Name, two_digits
from tracewire.residual import Criterion, Measured, begins_elsewhere

ENDED = "ended before a minimum"
GO_ON = "go on with --method least_squares"
BEGIN_ELSEWHERE = (
    "least_squares gains nothing more from here: try --method growing_windows, which begins with "
    "short parts of the series; begin elsewhere; or fix a parameter that these data do not "
    "determine"
)


def unfinished(
    uncertainty: Uncertainty, criterion: Criterion, matrix: Matrix, vector: Vector, method: str
) -> str:
    """That the search ended before a minimum, or nothing: a Gauss-Newton step goes beyond the
    errors, or promises to take away much of the sum of squares."""
    names = uncertainty.names
    held = {names.index(name) for name in uncertainty.at_bounds}
    moved = [j for j in range(matrix.shape[1]) if j not in held]
    lengths = np.maximum(np.linalg.norm(matrix[:, moved], axis=0), 1e-300)
    step = np.zeros(matrix.shape[1])
    step[moved] = np.linalg.lstsq(matrix[:, moved] / lengths, -vector)[0] / lengths
    far = {
        name: abs(move) / error
        for name, move in zip(names, step * criterion.scales, strict=False)
        if (error := uncertainty.errors[name]) > 0 and abs(move) > error
    }
    go_on = BEGIN_ELSEWHERE if method == "least_squares" else GO_ON
    promised = np.linalg.norm(vector + matrix @ step) / max(float(np.linalg.norm(vector)), 1e-300)
    if not far and promised < DIAGNOSIS.promised:
        return (
            f"the search {ENDED}: the slope there promises to lower the residual to "
            f"{two_digits(float(promised))} of it; {go_on}"
        )
    if not far:
        return ""
    most = max(far, key=lambda name: far[name])
    return (
        f"the search {ENDED}: the slope there leads {most} {two_digits(far[most])} standard "
        f"errors further, so errors and intervals say nothing yet; {go_on}"
    )


def rises(before: float, after: float, method: str) -> list[str]:
    """That a search ended above where it began, which only a criterion without slopes can do."""
    if not after > DIAGNOSIS.raised * before:
        return []
    return [
        f"the criterion is {after / before:.3g} times that of the values with which the search "
        "began: a rounding of values changes runs as long as these (chaos); "
        f"{_shorter(method)}"
    ]


def raises_unseen(comparisons: Sequence[Comparison], method: str) -> list[str]:
    """Series that were not fitted, and of which a fit has raised the error."""
    found = []
    for c in comparisons:
        if c.use == "train":
            continue
        before, after = (
            float(np.sqrt(np.mean(residual[c.counts] ** 2)))
            for residual in (c.residual_before, c.residual_after)
        )
        if before > 0 and after > DIAGNOSIS.raised * before:
            found.append(
                f"{c.series}: the fit raises the error of {c.signal}, which it has not seen, "
                f"{after / before:.3g}-fold: the fitted data want other values than these, so that "
                "something is missing (`tracewire trace`), or their runs are too long for this "
                f"model ({_shorter(method)})"
            )
    return found


def _shorter(method: str) -> str:
    """How a fit follows a model that runs astray."""
    if method == "multiple_shooting":
        return "cut the series shorter by `from:` and `to:`, or begin nearer to the right values"
    return "--method multiple_shooting takes short ones"


def starts_elsewhere(
    model: Model, series: Sequence[Measured], comparisons: Sequence[Comparison]
) -> list[str]:
    """Series without start values that begin elsewhere than the run."""
    without = {m.name for m in series if not m.start and not m.periods}
    found = []
    for c in comparisons:
        if c.series not in without or c.signal not in model.states:
            continue
        if text := begins_elsewhere(c.signal, c.measured, float(c.after[0])):
            found.append(f"{c.series}: {text}")
    return found


def begins_fast(
    model: Model, series: Sequence[Measured], starts: Mapping[str, Mapping[str, float]]
) -> list[str]:
    """Fitted starts of rates that are far above the rates that the record shows."""
    found = []
    for m in series:
        for state in model.flat.states:
            rate = state.rate.name if isinstance(state.rate, Name) else ""
            start = starts.get(m.name, {}).get(rate, 0.0)
            if not start or state.name not in m.values or len(m.t) < 2:
                continue
            seen = np.diff(m.values[state.name]) / (m.sensor(state.name).gain or 1.0)
            fastest = float(np.max(np.abs(seen / np.diff(m.t))))
            if abs(start) > DIAGNOSIS.fast * fastest:
                found.append(
                    f"{m.name}: the fit lets {rate} begin at {start:.3g} (SI), and {state.name} "
                    f"is never faster than {fastest:.3g} between two samples: fix it (`start: "
                    f"{{{rate}: 0}}` where it rests), or look at what sits on its bound"
                )
    return found


def collect_remarks(
    series: Sequence[Measured], failures: Mapping[str, int], criterion: Criterion
) -> list[str]:
    """What a reader of the result must know."""
    remarks = [f"{m.name}: {remark}" for m in series for remark in m.remarks]
    for name, count in failures.items():
        times = "once" if count == 1 else f"{count} times"
        remarks.append(
            f"{name}: its run failed {times} during the search, and counted as far from the data"
        )
    if failures and criterion.failure is not None:
        remarks.append(f"the last failure: {criterion.failure.problems[0].what}")
    remarks += [f"{name}: {warning}" for name, warning in sorted(criterion.warnings)]
    return remarks
