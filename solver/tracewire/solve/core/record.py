"""What a run keeps: samples of the recorded signals, and the log of events."""

from __future__ import annotations

from tracewire.solve.core import methods
from tracewire.solve.core.arrays import (
    Vector,
    crossings_of,
    flow_of,
    is_sensitive,
    plan_of,
    progress_of,
    sensitivity_of,
    trial_of,
)
from tracewire.solve.core.codes import LOG_HEAD, LOGGED, SAMPLED
from tracewire.solve.core.flow import RESTING, SLIDING, outputs
from tracewire.solve.core.history import is_delayed, record_step
from tracewire.solve.core.history_moves import follow_all
from tracewire.solve.core.sensitivity import reach, sample
from tracewire.solve.core.surface import pin
from tracewire.solve.core.trail import end_of_trail, keep_step, put_step, step_at
from tracewire.solve.core.units import unit


@unit
def sample_inside(core: int, method: int, end: float) -> None:
    """Fill the samples of a step that lie before its `end`, and keep what is read later of it."""
    if is_delayed(core):
        record_step(core, method)
    progress = progress_of(core)
    trial = trial_of(core)
    first = progress.ints[SAMPLED]
    row = first
    while row < len(progress.times) and progress.times[row] < end:
        time = progress.times[row]
        methods.inside(core, method, (time - trial.ends[0]) / trial.ends[1], trial.at)
        _fill(core, row, time, trial.at)
        row += 1
    progress.ints[SAMPLED] = row
    if is_sensitive(core):
        keep_step(core, method, first)
        if is_delayed(core) or sensitivity_of(core).kept[0] == len(sensitivity_of(core).steps):
            catch_up(core)


@unit
def catch_up(core: int) -> None:
    """Let S follow the steps that are kept, and fill its samples in them.

    The last step is in `trial` then; before, an attempt may be that has failed.
    """
    progress, sensitivity, trial = progress_of(core), sensitivity_of(core), trial_of(core)
    kept, at, counts = sensitivity.kept, sensitivity.at, flow_of(core).counts
    if kept[0] == 0:
        return
    end = end_of_trail(core)
    put_step(core, kept[0] - 1)
    for row in range(kept[2], progress.ints[SAMPLED]):
        time, s = progress.times[row], sensitivity.s
        if is_delayed(core):
            follow_all(core, time)
        else:
            reach(core, time, end)
            s = sensitivity.between
        method = step_at(core, time)
        methods.inside(core, method, (time - trial.ends[0]) / trial.ends[1], at)
        if counts[SLIDING] + counts[RESTING]:
            pin(core, time, at)
        sample(core, row, time, at, s)
    follow_all(core, end)
    step_at(core, end)
    kept[0] = 0


@unit
def sample_end(core: int, t: float, x: Vector) -> None:
    """Fill the samples that lie at the end of the run."""
    progress = progress_of(core)
    if is_sensitive(core):
        catch_up(core)
    for row in range(progress.ints[SAMPLED], len(progress.times)):
        _fill(core, row, t, x)
        if is_sensitive(core):
            sample(core, row, t, x, sensitivity_of(core).s)
    progress.ints[SAMPLED] = len(progress.times)


@unit
def _fill(core: int, row: int, t: float, x: Vector) -> None:
    flow = flow_of(core)
    plan = plan_of(core)
    progress = progress_of(core)
    values, computed = progress.samples[row], False
    if flow.counts[SLIDING] + flow.counts[RESTING]:
        pin(core, t, x)
    for state in plan.direct:
        computed = computed or state < 0
    if computed:
        outputs(core, t, x, values)
    for column in range(len(values)):
        if plan.direct[column] >= 0:
            values[column] = x[plan.direct[column]]


@unit
def log(
    core: int, t: float, kind: int, mode: int, direction: int, before: Vector, after: Vector
) -> None:
    """Add an event to the log; the caller has seen to it that there is room."""
    progress = progress_of(core)
    n, row = len(before), progress.ints[LOGGED]
    if row == len(progress.log):
        return
    entry = progress.log[row]
    entry[0], entry[1], entry[2], entry[3] = t, kind, mode, direction
    for i in range(n):
        entry[LOG_HEAD + i], entry[LOG_HEAD + n + i] = before[i], after[i]
    progress.ints[LOGGED] = row + 1
    if is_sensitive(core):
        sensitivity = sensitivity_of(core)
        crossed = crossings_of(core).how[mode] >= 0
        moved = sensitivity.instants[mode] if crossed else sensitivity.moved
        sensitivity.times[row] = moved
