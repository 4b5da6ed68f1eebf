"""The edge of a chart is drawn where points ran on both of its sides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from analyse.models import MATHIEU, made
from matplotlib.contour import ContourSet
from tracewire.analyse import StabilityChart, stability_chart


def lowest_of_edge(chart: StabilityChart) -> float:
    axes = chart.figure().axes[0]
    (edge,) = (one for one in axes.get_children() if isinstance(one, ContourSet))
    return float(min(path.vertices[:, 1].min() for path in edge.get_paths()))


def test_the_edge_ends_at_points_that_failed() -> None:
    found = stability_chart(
        made(MATHIEU), ("a", np.linspace(0, 3, 13)), ("q", np.linspace(0, 1, 9)), "pi"
    )
    assert lowest_of_edge(found) < 0.3
    margin, radius = found.margin.copy(), found.radius.copy()
    margin[:4], radius[:4] = np.nan, np.nan
    assert lowest_of_edge(replace(found, margin=margin, radius=radius)) >= found.y[4]
