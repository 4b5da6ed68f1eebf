"""The method least_squares: a trust region on forward sensitivities."""

from __future__ import annotations

from tracewire.fit.search import MethodResult, Search
from tracewire.residual import solve_least_squares

MOST = 1_000_000
EXACT, NOISY = 1e-14, 1e-2
"""The tolerance of formulas alone; and that of runs, over their rtol."""


def by_least_squares(search: Search) -> MethodResult:
    """The minimum next to the begin: fast and exact from nearby, astray from afar."""
    steps = int(min(MOST, search.options.evaluations(search.size)))
    criterion = search.criterion
    moving = bool(criterion.model.states)
    result = solve_least_squares(
        search,
        search.begin,
        steps=steps,
        tolerance=NOISY * criterion.rtol if moving else EXACT,
        frugal=moving,
        callback=search.count_iteration,
    )
    return MethodResult(result.z, search.iterations, int(result.converged), result.message)
