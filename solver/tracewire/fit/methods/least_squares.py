"""The method least_squares: a trust region on forward sensitivities."""

from __future__ import annotations

from tracewire.fit.limits import SEARCH
from tracewire.fit.search import MethodResult, Search
from tracewire.residual import solve_least_squares


def by_least_squares(search: Search) -> MethodResult:
    """The minimum next to the begin: fast and exact from nearby, astray from afar."""
    steps = int(min(SEARCH.most_steps, search.options.evaluations(search.size)))
    criterion = search.criterion
    moving = bool(criterion.model.states)
    result = solve_least_squares(
        search,
        search.begin,
        steps=steps,
        tolerance=SEARCH.noisy * criterion.rtol if moving else SEARCH.exact,
        frugal=moving,
        callback=search.count_iteration,
    )
    return MethodResult(result.z, search.iterations, int(result.converged), result.message)
