"""Runs over many spans, one after the other, without a return to Python between them."""

from __future__ import annotations

import math

import numpy as np

from tracewire.solve.core.arrays import (
    FIRST,
    Progress,
    Sensitivity,
    Spans,
    copy,
    is_sensitive,
    progress_of,
    sensitivity_of,
    spans_of,
)
from tracewire.solve.core.codes import (
    END,
    FINISHED,
    LENGTH,
    LOGGED,
    PAUSED,
    REJECTED,
    STEPS,
    STIFF_ROWS,
    WARNINGS,
    T,
)
from tracewire.solve.core.integrate import advance
from tracewire.solve.core.memory import ints_at
from tracewire.solve.core.units import helper, unit

SPAN, INSIDE, LEFT, EVENTS, STIFF = range(5)  # places in Spans.at
TIMES = FIRST[Progress] + Progress._fields.index("times")
SAMPLES = FIRST[Progress] + Progress._fields.index("samples")
ANSWERS = FIRST[Sensitivity] + Sensitivity._fields.index("samples")
OF_TIMES = Spans._fields.index("times")


@unit
def advance_spans(core: int, spans: int) -> int:
    """Go on with the spans until all are done, the budget of steps is used up, or one is odd.

    Returns FINISHED or PAUSED between two spans; INSIDE of a span what `advance` returns, also
    FINISHED where there is something to say of it: its end is then for the caller to keep.
    """
    many = spans_of(spans)
    at, progress = many.at, progress_of(core)
    while at[SPAN] < len(many.ends):
        number = at[SPAN]
        _begin(core, spans, number)
        at[INSIDE] = 1
        status = advance(core)
        if status != FINISHED or _is_odd(core, at[EVENTS]):
            return status
        keep_end(core, spans)
        at[SPAN], at[INSIDE] = number + 1, 0
        at[LEFT] -= progress.ints[STEPS]
        if at[LEFT] <= 0:
            return PAUSED
    return FINISHED


@unit
def keep_end(core: int, spans: int) -> None:
    """Keep where the run over a span has ended."""
    many, progress = spans_of(spans), progress_of(core)
    number = many.at[SPAN]
    copy(progress.x, many.final[number])
    many.at[STIFF] = progress.ints[STIFF_ROWS]
    many.steps[number] = progress.ints[STEPS] - progress.ints[REJECTED]
    if is_sensitive(core):
        s = sensitivity_of(core).s
        for i in range(s.shape[0]):
            copy(s[i], many.final_s[number, i * s.shape[1] : (i + 1) * s.shape[1]])


@unit
def _begin(core: int, spans: int, number: int) -> None:
    """Let a run that has not begun be that over one of the spans."""
    many = spans_of(spans)
    copy(many.first, many.block)
    table = ints_at(core, (3 * (ANSWERS + 1),))
    there = ints_at(spans, (3 * (OF_TIMES + 3),))
    row = many.rows[number]
    for place in range(3):
        field = TIMES if place == 0 else (SAMPLES if place == 1 else ANSWERS)
        width = 1 if place == 0 else there[3 * (OF_TIMES + place) + 2]
        table[3 * field] = there[3 * (OF_TIMES + place)] + 8 * row * width
        table[3 * field + 1] = many.rows[number + 1] - row
    progress = progress_of(core)
    now, x = progress.now, progress.x
    now[T], now[END] = many.ends[number, 0], many.ends[number, 1]
    now[LENGTH] = now[END] - now[T]
    progress.ints[STIFF_ROWS] = many.at[STIFF]  # what was found stiff is so in other spans, too
    copy(many.x[number], x)
    if is_sensitive(core):
        s = sensitivity_of(core).s
        for i in range(s.shape[0]):
            copy(many.s[number, i * s.shape[1] : (i + 1) * s.shape[1]], s[i])
    if many.follows[number]:
        _go_on(core, spans, number)
    if is_sensitive(core):
        s, peak = sensitivity_of(core).s, sensitivity_of(core).peak
        for i in range(s.shape[0]):
            for j in range(s.shape[1]):
                peak[i, j] = max(abs(s[i, j]), many.floor[i, j])


@unit
def _go_on(core: int, spans: int, number: int) -> None:
    """Let states that are kept begin where the span before has ended, unless its run has failed."""
    many, x = spans_of(spans), progress_of(core).x
    for state in range(len(x)):
        if not (many.kept[state] and math.isfinite(many.final[number - 1, state])):
            continue
        x[state] = many.final[number - 1, state]
        if is_sensitive(core):
            s = sensitivity_of(core).s
            for j in range(s.shape[1]):
                if many.lasting[j]:
                    s[state, j] = many.final_s[number - 1, state * s.shape[1] + j]


@helper
def _is_odd(core: int, events: int) -> bool:
    """Whether there is something to say of a run that has ended."""
    progress = progress_of(core)
    odd = progress.ints[WARNINGS] != 0 or progress.ints[LOGGED] > events
    for mark in progress.overlooked:
        odd = odd or mark != 0
    for since in progress.undetermined:
        odd = odd or since < np.inf
    if is_sensitive(core):
        flags = sensitivity_of(core).flags
        for kind in range(len(flags)):
            odd = odd or flags[kind, 0] != 0
    return odd
