"""Values that a fit leaves as they were: of parameters that the data do not depend on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tracewire.array_types import Vector
from tracewire.fit.limits import SEARCH
from tracewire.fit.result import Comparison
from tracewire.residual import Criterion

EXACT = (
    "the runs follow the series as closely as they are computed: nothing is left that could be "
    "noise, so errors and intervals say nothing"
)


def with_unmoved_kept(
    criterion: Criterion, z: Vector, unmoved: Sequence[str], began: Mapping[str, float]
) -> Vector:
    """The scaled unknowns z (n,) with parameters without effect where they began.

    All stay as they are where the criterion says that these parameters have an effect after all.
    """
    kept = z.copy()
    for j, name in enumerate(criterion.names):
        if name in unmoved and name in began:
            kept[j] = began[name] / criterion.scales[j]
    if np.array_equal(kept, z):
        return z
    same = criterion.value(kept) <= (1 + SEARCH.unmoved) * criterion.value(z)
    return kept if same else z


def kept_words(
    unmoved: Sequence[str], values: Mapping[str, float], began: Mapping[str, float]
) -> list[str]:
    """What a reader must know of parameters that kept their values."""
    kept = (name for name in unmoved if name in began and values[name] == began[name])
    return [
        f"{name} keeps the value with which the search began, and is not written" for name in kept
    ]


def is_exact(comparisons: Sequence[Comparison], rtol: float) -> bool:
    """Whether fitted runs follow their series as closely as they are computed, with `rtol` of what
    the series move by: noise of 0.1 mK on 300 K is noise."""
    return all(
        _size(c.residual_after[c.counts]) <= rtol * _extent(c.measured[c.counts])
        for c in comparisons
        if c.use == "train" and c.counts.any()
    )


def _extent(values: Vector) -> float:
    """From the smallest to the largest value; the size of one that does not change."""
    return float(np.ptp(values)) or float(np.max(np.abs(values)))


def _size(values: Vector) -> float:
    return float(np.sqrt(np.mean(values**2)))
