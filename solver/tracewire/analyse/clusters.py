"""How many different points a section has: the rule that tells irregular motion from periodic."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from tracewire.analyse.limits import SECTION
from tracewire.array_types import Matrix, Vector


def count_clusters(
    points: Matrix, extent: Vector, unit: Vector | None = None, near: float = SECTION.near
) -> int:
    """The number of clusters of the points (K, n) of a section.

    Two points are neighbours when no coordinate differs by more than `near` times its extent (n,),
    which is how far the motion goes between the points, and coordinates with a finite `unit` (n,)
    modulo that. A cluster is what neighbours connect: a motion of period p has p clusters, also
    one that still comes nearer to it; a motion that never repeats has about as many as points.
    """
    reach = near * np.where(extent > 0, extent, np.inf)
    if len(points) > SECTION.many:
        return _one_by_one(points, reach, unit)
    neighbours = _close(points[:, None, :] - points[None, :, :], reach, unit)
    return int(connected_components(neighbours, directed=False)[0]) if len(points) else 0


def _one_by_one(points: Matrix, reach: Vector, unit: Vector | None) -> int:
    """The same for so many points that their pairs fill the memory: each cluster is grown.

    Sorted by a coordinate that does not turn, neighbours are within a window.
    """
    straight = np.ones(len(reach), bool) if unit is None else ~np.isfinite(unit)
    axis = int(np.argmax(straight))
    points = points[np.argsort(points[:, axis])]
    width = reach[axis] * (1 + 1e-9) if straight[axis] else np.inf
    low = np.searchsorted(points[:, axis], points[:, axis] - width, "left")
    high = np.searchsorted(points[:, axis], points[:, axis] + width, "right")
    left = np.ones(len(points), bool)
    clusters = 0
    while left.any():
        clusters += 1
        grown = [int(np.argmax(left))]
        left[grown] = False
        while grown:
            at = grown.pop()
            window = low[at] + np.flatnonzero(left[low[at] : high[at]])
            close = window[_close(points[window] - points[at], reach, unit)]
            left[close] = False
            grown.extend(close.tolist())
    return clusters


def _close(apart: NDArray[np.float64], reach: Vector, unit: Vector | None) -> NDArray[np.bool_]:
    """Which differences (..., n) of points are those of neighbours."""
    apart = np.abs(apart)
    if unit is not None:
        turns = np.isfinite(unit)
        rest = np.mod(apart[..., turns], unit[turns])
        apart[..., turns] = np.minimum(rest, unit[turns] - rest)
    return np.asarray(np.all(apart <= reach, axis=-1))


def is_irregular(clusters: int, points: int) -> bool:
    """Whether more than a quarter of the points are clusters: no period up to that is there."""
    return clusters > SECTION.irregular * points
