"""How delayed signals move with what is asked for: kept along each step, beside the signals."""

from __future__ import annotations

import numpy as np

from tracewire.solve.core import methods
from tracewire.solve.core.arrays import flow_of, history_of, sensitivity_of, trial_of
from tracewire.solve.core.codes import MOVES, NODE
from tracewire.solve.core.flow import DELAYED, SLIDING, held, patterns
from tracewire.solve.core.history import (
    HEAD,
    find_lags,
    is_delayed,
    powers_from_nodes,
    recall,
    stretch_now,
)
from tracewire.solve.core.sensitivity import follow, total_of
from tracewire.solve.core.trail import step_at
from tracewire.solve.core.units import unit
from tracewire.solve.core.variation import OF_DELAYED, derive, derive_blended, held_parts

DEGREE = 4
NODES = np.array([-np.cos(np.pi * k / DEGREE) for k in range(DEGREE + 1)])
POWERS = powers_from_nodes(NODES)


@unit
def follow_all(core: int, end: float) -> None:
    """Follow the sensitivities to a time in the trial step, and keep those of delayed signals."""
    if is_delayed(core):
        history, trial = history_of(core), trial_of(core)
        while history.along[NODE] <= DEGREE:
            node = history.along[NODE]
            theta = 0.5 * (1.0 + NODES[node])
            time = trial.ends[0] + (1.0 if node == DEGREE else theta) * trial.ends[1]
            if time > end:
                break
            follow(core, time)
            _keep(core, node, time)
            history.along[NODE] = node + 1
    follow(core, end)


@unit
def _keep(core: int, node: int, t: float) -> None:
    """Take the derivatives of the signals at a node; at the last one a piece is made of them."""
    history, trial, sensitivity = history_of(core), trial_of(core), sensitivity_of(core)
    flow, x, rows = flow_of(core), np.empty(len(trial.x)), history.rows
    count, q, w = len(history.mode), len(sensitivity.moved), rows.shape[1]
    methods.inside(core, step_at(core, t), min(1.0, (t - trial.ends[0]) / trial.ends[1]), x)
    find_lags(core, t, x)
    recall(core, t)
    some = flow.counts[SLIDING]
    if some:
        both = held(core, t, x)
        derive_blended(core, OF_DELAYED, t, x, both, rows)
        parts, moves = np.empty((len(both), w)), patterns(core, DELAYED, t, x, count)
        held_parts(core, t, x, parts)
        for k in range(some):
            for j in range(count):
                rows[j] += moves[1 + k, j] * parts[k]
    else:
        derive(core, OF_DELAYED, t, x, rows)
    for j in range(count):
        for k in range(q):
            history.at[node, j * q + k] = total_of(rows[j], sensitivity.s, sensitivity.chain, k)
    if node < DEGREE:
        return
    piece = history.moves[history.along[MOVES]]
    history.along[MOVES] += 1
    piece[0], piece[1] = trial.ends[0], trial.ends[0] + 0.5 * trial.ends[1]
    piece[2] = 2.0 / trial.ends[1]
    for j in range(count):
        piece[HEAD + j] = stretch_now(core, j)
        for k in range(q):
            for power in range(DEGREE + 1):
                total = 0.0
                for at in range(DEGREE + 1):
                    total += POWERS[power, at] * history.at[at, j * q + k]
                piece[HEAD + count + 5 * (j * q + k) + power] = total
