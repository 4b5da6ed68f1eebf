"""How small an effect the data would still show: the honest side of finding nothing."""

from __future__ import annotations

import numpy as np

from tracewire.trace.found import Power
from tracewire.trace.screen.screening import Screen
from tracewire.trace.trials.statistics import ABSORBED


def detection_limits(screen: Screen) -> tuple[Power, ...]:
    """The smallest coefficient of each effect that these data would show, in SI.

    c = 5/|z|, with z the change of the residuals in sigma by a coefficient of 1, without what start
    values and free parameters imitate; of the shapes that were tried, the one that shows best, and
    of a free phase the one that shows least. For the gain of a sensor it is the difference from 1.
    An effect that the free parameters imitate completely shows at no size, and is left out.
    """
    found: dict[str, Power] = {}
    for row in screen.rows:
        indices = list(row.columns)
        if float(np.max(screen.columns.absorbed_fraction[indices])) > 1 - ABSORBED:
            continue
        singular = np.linalg.svd(screen.columns.matrix[:, indices], compute_uv=False)
        if not singular[-1] > 0:
            continue
        smallest = screen.columns.options.shows / float(singular[-1])
        candidate = row.candidate
        known = found.get(str(candidate))
        if known is None or smallest < known.smallest:
            found[str(candidate)] = Power(
                candidate.effect, candidate.place.name, candidate.coefficient, smallest
            )
    return tuple(found.values())
