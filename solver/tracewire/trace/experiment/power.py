"""How small an effect the data would still show: the honest side of finding nothing."""

from __future__ import annotations

import numpy as np

from tracewire.trace.found import Power
from tracewire.trace.limits import ROUNDING
from tracewire.trace.screen.screening import Screen


def detection_limits(screen: Screen) -> tuple[Power, ...]:
    """The smallest coefficient of each effect that these data would show, in SI.

    c = 5*sqrt(s2/f)/|z|, with z the change of the residuals in sigma by a coefficient of 1, without
    what start values and free parameters imitate, s2 the variance of the residuals in sigma^2, 1 at
    least, and f the share of them that count where neighbours follow each other: a rest that is
    larger or slower than white noise hides more. Of the shapes that were tried, it is the one that
    shows best, and of a free phase the one that shows least. For the gain of a sensor it is the
    difference from 1. An effect that the free parameters imitate completely shows at no size, and
    is left out.
    """
    columns = screen.columns
    variance = max(columns.rss / max(columns.degrees_of_freedom, 1), 1.0)
    visible = columns.options.shows * float(np.sqrt(variance / columns.effective_fraction))
    found: dict[str, Power] = {}
    for row in screen.rows:
        indices = list(row.columns)
        if float(np.max(columns.absorbed_fraction[indices])) > 1 - ROUNDING.absorbed:
            continue
        singular = np.linalg.svd(columns.matrix[:, indices], compute_uv=False)
        if not singular[-1] > 0:
            continue
        smallest = visible / float(singular[-1])
        candidate = row.candidate
        known = found.get(str(candidate))
        if known is None or smallest < known.smallest:
            found[str(candidate)] = Power(
                candidate.effect, candidate.place.name, candidate.coefficient, smallest
            )
    return tuple(found.values())
