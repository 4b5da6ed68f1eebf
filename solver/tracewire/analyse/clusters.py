"""How many different points a section has: the rule that tells irregular motion from periodic."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
NEAR = 1e-3
IRREGULAR = 0.25


def count_clusters(
    points: Matrix, extent: Vector, unit: Vector | None = None, near: float = NEAR
) -> int:
    """The number of clusters of the points (K, n) of a section.

    Two points are neighbours when no coordinate differs by more than `near` times its extent (n,),
    which is how far the motion goes between the points, and coordinates with a finite `unit` (n,)
    modulo that. A cluster is what neighbours connect: a motion of period p has p clusters, also
    one that still comes nearer to it; a motion that never repeats has about as many as points.
    """
    if not len(points):
        return 0
    apart = np.abs(points[:, None, :] - points[None, :, :])
    if unit is not None:
        turns = np.isfinite(unit)
        rest = np.mod(apart[..., turns], unit[turns])
        apart[..., turns] = np.minimum(rest, unit[turns] - rest)
    reach = near * np.where(extent > 0, extent, np.inf)
    neighbours = np.all(apart <= reach, axis=2)
    return int(connected_components(neighbours, directed=False)[0])


def is_irregular(clusters: int, points: int) -> bool:
    """Whether more than a quarter of the points are clusters: no period up to that is there."""
    return clusters > IRREGULAR * points
