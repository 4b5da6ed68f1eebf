"""The instant of a crossing that was located inside a step, made exact on true steps."""

from __future__ import annotations

import numpy as np

from tracewire.solve.core import methods
from tracewire.solve.core.arrays import Vector, copy, flow_of, progress_of, trial_of, watch_of
from tracewire.solve.core.codes import CURRENT, GUARD, LENGTH
from tracewire.solve.core.flow import RESTING, SLIDING
from tracewire.solve.core.locate import ROOT, margins, smallest_step
from tracewire.solve.core.readings import guard_rates, guard_values
from tracewire.solve.core.surface import pin
from tracewire.solve.core.units import helper, unit

POLISH = 3  # corrections of a located instant
BACK = 1e-4  # of a step: how far back a secant begins


@unit
def polish(core: int, theta: float, row: int) -> None:
    """Make the trial end at the crossing: located on the polynomial, then on a true step, whose end
    is moved where that is by little.

    At a guard it ends on the far side, where the formula of the mode to come is defined. The end
    of a slide or of a contact is where its fraction or force is zero, but for rounding: how far a
    rate is from zero there decides other modes. All is read where the end lies on the surfaces of
    slides and contacts: there the run goes on.
    """
    flow = flow_of(core)
    progress = progress_of(core)
    trial = trial_of(core)
    watched = watch_of(core)
    t, x, whole = trial.ends[0], progress.x, trial.ends[1]
    method, i = progress.ints[CURRENT], watched.mode[row]
    h = max(theta * whole, smallest_step(core))
    methods.end_at(core, method, t, x, trial.rate, h)
    if not np.all(np.isfinite(trial.x_end)):
        return
    if watched.kind[row] != GUARD:
        _polish_end(core, h, whole, row)
        return
    guards, along = np.empty(len(flow.bound)), np.empty(len(flow.bound))
    pinned = np.empty(len(x))
    for _ in range(POLISH):
        _end(core, t + h, pinned)
        guard_values(core, t + h, pinned, guards)
        guard_rates(core, t + h, pinned, along)
        change = -(guards[i] - watched.level[row]) / along[i] if along[i] != 0.0 else 0.0
        if not 0 < h + change <= whole:
            return
        if abs(change) <= ROOT * progress.now[LENGTH]:
            if change > 0.0:
                _end_beyond(core, h, change, whole, row)
            return
        if abs(change) > 0.1 * whole:
            return
        h += change
        methods.end_at(core, method, t, x, trial.rate, h)


@unit
def _end_beyond(core: int, h: float, change: float, whole: float, row: int) -> None:
    """Make the trial end beyond the guard that is `change` after h. Rounding may hide so short a
    way, as where two bodies are far from zero and the guard is their distance: it is doubled then.
    """
    progress, trial, watched = progress_of(core), trial_of(core), watch_of(core)
    t, method, i = trial.ends[0], progress.ints[CURRENT], watched.mode[row]
    guards, pinned = np.empty(len(flow_of(core).bound)), np.empty(len(progress.x))
    ahead = 2.0 * change
    while h + ahead <= whole:
        methods.end_at(core, method, t, progress.x, trial.rate, h + ahead)
        _end(core, t + h + ahead, pinned)
        guard_values(core, t + h + ahead, pinned, guards)
        if watched.sign[row] * (guards[i] - watched.level[row]) < 0.0:
            return
        if ahead > ROOT * progress.now[LENGTH]:
            return
        ahead *= 2.0


@unit
def _polish_end(core: int, h: float, whole: float, row: int) -> None:
    """Make the trial end where the margin of a slide or a contact is zero: secants over steps."""
    progress, trial = progress_of(core), trial_of(core)
    t, x, method = trial.ends[0], progress.x, progress.ints[CURRENT]
    values, pinned = np.empty(len(watch_of(core).mode)), np.empty(len(x))
    _end(core, t + h, pinned)
    margins(core, t + h, pinned, values)
    here, at, other = values[row], h, h * (1.0 - BACK)
    methods.end_at(core, method, t, x, trial.rate, other)
    _end(core, t + other, pinned)
    margins(core, t + other, pinned, values)
    there = values[row]
    for _ in range(POLISH):
        change = -here * (at - other) / (here - there) if here != there else 0.0
        if not (0.0 < at + change <= whole and abs(change) <= 0.1 * whole):
            break
        there, other = here, at
        at += change
        methods.end_at(core, method, t, x, trial.rate, at)
        if abs(change) <= ROOT * progress.now[LENGTH]:
            return
        _end(core, t + at, pinned)
        margins(core, t + at, pinned, values)
        here = values[row]
    methods.end_at(core, method, t, x, trial.rate, at)


@helper
def _end(core: int, t: float, out: Vector) -> None:
    """Where the trial ends, back on the surfaces that hold the run."""
    copy(trial_of(core).x_end, out)
    if flow_of(core).counts[SLIDING] + flow_of(core).counts[RESTING]:
        pin(core, t, out)
