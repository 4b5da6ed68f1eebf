"""The unknowns and the starts of windows fitted together, by Levenberg and Marquardt."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.residual.initial_states import (
    fit_initial_states,
    is_far_off,
    previous_ends,
    refine_initial_states,
    restart_from_data,
    restart_from_ends,
    update_memories,
)
from tracewire.residual.limits import DESCENT, WINDOW
from tracewire.residual.linearisation import Projection
from tracewire.residual.windows import (
    Windows,
    keep_better,
    project_out_initial_states,
    with_initial_states,
)


def fit_windows(
    windows: Windows,
    steps: int = 20,
    target: float = np.inf,
    ftol: float = DESCENT.ftol,
    initial_state_steps: int = WINDOW.initial_state_steps,
) -> tuple[Windows, bool]:
    """The unknowns and all starts fitted by Levenberg and Marquardt; whether it converged.

    Each step comes from the problem without the starts, within the bounds of the unknowns. Windows
    that do worse than the step promised are fitted for themselves before it is judged. It ends
    early where the sum of squares would not fall to `target` at its pace in the steps that are
    left: it has lost against what reached that. A step that gains less than the part `ftol` of
    the sum is the last one; before the first the starts are fitted alone in `initial_state_steps`
    steps, and after the last those that went astray, from the data; if that does better it goes on.
    """
    windows = fit_initial_states(windows, initial_state_steps)
    if not len(windows.criterion.unknowns):
        return windows, True
    while True:
        windows, converged, steps = _take_steps(windows, steps, target, ftol)
        found = restart_from_data(windows, initial_state_steps)
        if found is windows or not steps:
            return found, converged
        windows = found


def _take_steps(
    windows: Windows, steps: int, target: float, ftol: float
) -> tuple[Windows, bool, int]:
    """The steps from where the starts are fitted; whether they converged, and how many are
    left."""
    unknowns = windows.criterion.unknowns
    low, high = np.array([u.low for u in unknowns]), np.array([u.high for u in unknowns])
    scales = np.array([u.scale for u in unknowns])
    damping, failures = DESCENT.first_damping, 0
    gained, too_slow = np.inf, 0
    for left_over in reversed(range(steps)):
        views = windows.projections
        reduced, residual = project_out_initial_states(windows)
        reduced = reduced * scales
        values = np.array([windows.values[u.name] for u in unknowns])
        room = (low - values) / scales, (high - values) / scales
        refused = False
        while True:
            step = bounded_step(reduced, residual, damping, room)
            left = residual + reduced @ step
            promised = float(residual @ residual - left @ left)
            start_gain = windows.rss - float(residual @ residual)
            if promised + start_gain < max(WINDOW.negligible_gain, 0.2 * ftol * windows.rss):
                return windows, True, left_over
            there = _step_windows(windows, views, step * scales)
            failures += there is None
            if there is not None and there.rss < windows.rss:
                before, gained = gained, windows.rss - there.rss
                windows = there
                # what was refused a moment ago would be refused again
                damping = damping if refused else max(damping / 10, DESCENT.least_damping)
                break
            if there is not None and there.rss < (1 + ftol) * windows.rss:
                return windows, True, left_over  # as flat as the solver is exact
            damping = max(damping * (100 if refused else 10), DESCENT.first_damping)
            refused = True
            if damping > DESCENT.most_damping or failures > DESCENT.most_failures:
                return windows, False, left_over
        if gained < max(WINDOW.negligible_gain, ftol * windows.rss):
            return windows, True, left_over
        pace = min(gained / before, 1 - 1e-9)
        coming = DESCENT.hope * gained * min(left_over, pace / (1 - pace))
        too_slow = too_slow + 1 if windows.rss - coming > target else 0
        if too_slow >= DESCENT.patience:
            return windows, False, 0
    return windows, False, 0


def bounded_step(
    reduced: Matrix, residual: Vector, damping: float, room: tuple[Vector, Vector]
) -> Vector:
    """The step that minimises the squares, damped by the sizes of its columns, within bounds."""
    from scipy.optimize import lsq_linear

    corner = np.asarray(np.linalg.qr(np.column_stack((reduced, residual)), mode="r"))
    count = reduced.shape[1]
    sizes = np.linalg.norm(reduced, axis=0)
    damped = np.diag(np.sqrt(damping) * np.maximum(sizes, 1e-12 * max(sizes.max(), 1e-300)))
    matrix = np.vstack((corner[:, :count], damped))
    target = np.concatenate((-corner[:, count], np.zeros(count)))
    low, high = np.minimum(room[0], 0.0), np.maximum(room[1], 0.0)
    high = np.maximum(high, low + 1e-12)
    sizes = np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
    found = lsq_linear(matrix / sizes, target, (low * sizes, high * sizes), method="bvls")
    return np.asarray(found.x / sizes)


def _step_windows(windows: Windows, views: Sequence[Projection], step: Vector) -> Windows | None:
    """The windows after a step of the unknowns, their starts following by the linear answer; None
    where one does not run."""
    count = len(windows.values)
    names = windows.values
    values = {name: windows.values[name] + float(d) for name, d in zip(names, step, strict=True)}
    for u in windows.criterion.unknowns:
        values[u.name] = min(max(values[u.name], u.low), u.high)
    starts: dict[int, Mapping[str, float]] = {}
    promised = []
    for n, (view, old) in enumerate(zip(views, windows.linearisations, strict=True)):
        expected = old.residual.ravel() + old.slopes[:, :count] @ step
        moved = np.array(list(windows.starts[n].values())) - view.start_of(expected)
        start: Mapping[str, float] = dict(zip(windows.starts[n], moved.tolist(), strict=True))
        starts[n] = windows.starts[n] if is_far_off(windows, n, start) else start
        promised.append(float(np.sum(view.project_out(expected) ** 2)))
    there = with_initial_states(replace(windows, values=values), starts)
    # a start that is led into a barrier is kicked away
    lost = [
        n
        for n, old in enumerate(windows.linearisations)
        if old.ran and not there.linearisations[n].ran
    ]
    there = with_initial_states(there, {n: windows.starts[n] for n in lost})
    if not all(there.linearisations[n].ran for n in lost):
        return None
    sizes = np.array([x.residual.size for x in there.linearisations])
    limits = 2 * np.array(promised) + windows.inlier_limit * sizes
    far = np.flatnonzero(there.squares > np.maximum(limits, windows.squares)).tolist()
    return _rescue(there, {n: windows.starts[n] for n in far}) if far else there


def _rescue(windows: Windows, before: Mapping[int, Mapping[str, float]]) -> Windows:
    """Some windows from where they were `before`, or from the ends of those before them, where that
    does better."""
    rows = list(before)
    tried = keep_better(windows, with_initial_states(windows, before), rows)
    ends = previous_ends(tried, rows)
    tried = keep_better(tried, with_initial_states(tried, ends), list(ends))
    steps = DESCENT.rescue_steps
    tried = refine_initial_states(tried, rows, steps)
    return update_memories(restart_from_ends(tried, rows, steps))
