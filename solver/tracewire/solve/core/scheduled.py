"""What happens at a known time that a step ends on: what jumps by itself, then what fires."""

from __future__ import annotations

import numpy as np

from tracewire.solve.core import locate
from tracewire.solve.core.arrays import (
    Vector,
    crossings_of,
    flow_of,
    plan_of,
    progress_of,
    watch_of,
)
from tracewire.solve.core.codes import CHANGES, DELAY, FINISHED, GUARD, SEGMENT, TIME, WAITS, H, T
from tracewire.solve.core.history import is_rough
from tracewire.solve.core.modes import fires_reset
from tracewire.solve.core.quiet import SAMPLES
from tracewire.solve.core.transition import happen, no_crossings
from tracewire.solve.core.units import unit

NEARLY = 0.01  # of what a margin falls by in the last quarter of a step


@unit
def _reached_with(core: int) -> bool:
    """Let the guards cross that reach their levels at the known time at which a step has ended.

    None of its samples is beyond its level, and the next step would begin with a zero. What would
    reach it later, however soon, is located by that step.
    """
    progress, watched, crossings = progress_of(core), watch_of(core), crossings_of(core)
    rows, start = watched.rows, watched.start
    last, some = SAMPLES - 1, False
    for row in range(locate.watched_count(core)):
        armed = watched.armed[row] and watched.kind[row] == GUARD
        some = some or (armed and start[row] <= NEARLY * (rows[last - 1, row] - start[row]))
    if not some or not locate.reached(core, progress.now[T], progress.x, 0.0, watched.hit):
        return False
    some = False
    for row in range(locate.watched_count(core)):
        i = watched.mode[row]
        if watched.hit[row] and watched.armed[row] and crossings.how[i] < 0:
            crossings.how[i], crossings.to[i] = GUARD, watched.to[row]
            crossings.up[i] = int(watched.sign[row] < 0)
            some = True
    return some


@unit
def _jump_first(core: int) -> int:
    """Let modes of known times change, and all others with them, while all that fires waits: what
    is left to happen is what fires. A status."""
    flow, progress, crossings = flow_of(core), progress_of(core), crossings_of(core)
    how, to = crossings.how.copy(), crossings.to.copy()
    for i in range(len(how)):
        if how[i] == GUARD:
            crossings.how[i], crossings.to[i] = WAITS, flow.m[i]
    status = happen(core, progress.now[T], progress.x)
    no_crossings(core)
    for i in range(len(how)):
        crossings.to[i] = to[i]
        if how[i] == CHANGES:
            crossings.how[i] = TIME
        elif how[i] == GUARD and flow.m[i] != to[i]:
            crossings.how[i] = GUARD
    return status


@unit
def happen_at_known_time(core: int, ahead: Vector) -> int:
    """Change timed modes, and settle the others in the new field. A status.

    What fires resets at a known time, as a clock, reads the field that holds from then on, and the
    states as they were before all resets.
    """
    flow = flow_of(core)
    plan = plan_of(core)
    progress, crossings = progress_of(core), crossings_of(core)
    loud, fires = False, False
    no_crossings(core)
    for row, i in enumerate(plan.timed):
        if not np.isnan(ahead[row]):
            waits = fires_reset(core, i)
            crossings.how[i], crossings.to[i] = CHANGES if waits else TIME, ahead[row]
            crossings.up[i] = ahead[row] > flow.m[i]
            quiet = plan.kind[i] == SEGMENT
            if plan.kind[i] == DELAY:
                quiet = not is_rough(core, i, ahead[row])
            loud = loud or not quiet
            fires = fires or waits
    loud = _reached_with(core) or loud
    status = _jump_first(core) if fires else FINISHED
    if status == FINISHED:
        status = happen(core, progress.now[T], progress.x)
    if loud:
        progress.now[H] = 0.0
    return status
