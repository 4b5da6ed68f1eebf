"""The torques at places that take the residual of windows away.

In each window, with w_p the torque at place p, free at some nodes and straight between them:

    w = argmin |r + A w|^2 + sum over p of |D2 w_p|^2/s_p^2 + |l w_p|^2/s_p^2,

r the residual in sigma and A the linearised answer, both without what the start of the window
explains, D2 the second differences, s_p a bend that is usual there, l the level.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.linalg import block_diag

from tracewire.array_types import Vector
from tracewire.trace.candidates.places import Place
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation


def missing_torques(
    linearisation: TorqueLinearisation,
    places: Sequence[Place],
    bend: Callable[[Vector], float],
    level: float,
    nodes: int,
) -> dict[str, list[Vector]]:
    """By place the torque at the samples of each series, (N,), nan where no window is.

    `bend` gives s_p, in the unit of the place, from the signal of the place along a series; a
    window has `nodes` at equal distances, and one at each sample where it has fewer of these.
    """
    runs = linearisation.trajectories
    found = {place.name: [np.full(len(run.t), np.nan) for run in runs] for place in places}
    for window, number in zip(linearisation.window_pieces, linearisation.series, strict=True):
        samples = np.unique(window.samples)
        count = min(nodes, len(samples))
        edges = np.linspace(samples[0], samples[-1], count) if count < len(samples) else samples
        hats = np.stack([np.interp(samples, edges, one) for one in np.eye(count)], axis=1)
        given = [np.zeros((len(run.t), count)) for run in runs]
        given[number][samples] = hats
        near = linearisation.windows.linearisations[window.index]
        view, answers, rows = near.projection, [], []
        for place in places:
            answers.append(
                view.project_out(linearisation.window_response(window, {place.name: given}))
            )
            size = max(bend(runs[number].signals[place.name]), 1e-300)
            rows.append(
                np.vstack((np.diff(np.eye(count), 2, axis=0), level * np.eye(count))) / size
            )
        held = block_diag(*rows)
        matrix = np.vstack((np.hstack(answers), held))
        target = np.concatenate((-view.project_out(near.residual.ravel()), np.zeros(len(held))))
        torque = np.linalg.lstsq(matrix, target, rcond=None)[0]
        for place, part in zip(places, np.split(torque, len(places)), strict=True):
            found[place.name][number][samples] = hats @ part
    return found
