"""Several points of a search at once, in threads: a run lets other threads work meanwhile."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor

from tracewire.array_types import Vector
from tracewire.fit.search import Search
from tracewire.residual import Criterion
from tracewire.solve import cores


def evaluate_parallel(search: Search, points: Sequence[Vector]) -> Iterator[float]:
    """The criterion at each of the points, in their order.

    What comes is the same for any number of threads. Raises Stopped where the limit of evaluations
    is reached, behind the last point that it allows.
    """
    whole = search.criterion
    allowed = max(int(search.options.evaluations(search.size)) - whole.evaluations, 0)
    part = points[:allowed]

    def valued(z: Vector) -> tuple[Criterion, float]:
        own = whole.on_segments(whole.segments)
        return own, own.value(z)

    with ThreadPoolExecutor(max(1, min(cores(), len(part)))) as pool:
        try:
            for z, (own, value) in zip(part, pool.map(valued, part), strict=True):
                search.count_evaluations(own)
                search.record_best(z, value)
                yield value
        except BaseException:  # Ctrl-C, or a limit: what is not yet begun shall not begin
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    if len(part) < len(points):
        search.check_limits()
