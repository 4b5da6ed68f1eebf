"""What torques do to the residuals, without what starts and unknowns imitate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.residual import Projection
from tracewire.trace.limits import BATCH
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation


def project_out_starts(
    linearisation: TorqueLinearisation,
    views: Sequence[Projection],
    torques: Mapping[str, Sequence[Matrix]],
    every: int = 1,
    chosen: Sequence[int] | None = None,
    rows: Matrix | None = None,
) -> tuple[Matrix, Vector]:
    """What torques by place do to the residuals of all windows, or of those `chosen`, as rows
    (K, M) without what the starts of windows imitate, of every so many residuals of a window; and
    the squares (K,) of them with it.

    Window by window: all of them are much memory. Rows are scaled so that squares stay the same;
    they are written into `rows` where these are given.
    """
    numbers = range(len(views)) if chosen is None else chosen
    count = sum(given[0].shape[1] for given in torques.values())
    size = sum(-(-len(views[n].basis) // every) for n in numbers)
    rows = np.empty((count, size)) if rows is None else rows
    whole, first = np.zeros(count), 0
    for n in numbers:
        window, view = linearisation.window_pieces[n], views[n]
        columns = linearisation.window_response(window, torques)
        whole += np.einsum("ij,ij->j", columns, columns)
        shown = view.project_out(columns)[::every] * every**0.5
        last = first + len(shown)
        rows[:, first:last] = shown.T
        first = last
    return rows, whole


def project_out(rows: Matrix, basis: Matrix) -> Matrix:
    """Rows (K, M) without their parts along an orthonormal basis (M, n); they are changed."""
    for first in range(0, len(rows), BATCH.rows):
        some = rows[first : first + BATCH.rows]
        some -= (some @ basis) @ basis.T
    return rows
