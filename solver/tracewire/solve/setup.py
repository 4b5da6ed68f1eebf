"""The arrays of a run, which the core works on: made for a model, then set to a problem."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.solve.core.arrays import Arrays, Crossings, Flow, Plan, Progress, Spans, Trial, Watch
from tracewire.solve.core.codes import (
    ALWAYS,
    CHATTER_EVENTS,
    DIRECTIONS,
    EVENTS,
    KINDS,
    LOG_HEAD,
    NEVER,
    PACED,
    WHILE_HELD,
)
from tracewire.solve.core.flow import FREE, FUNCTIONS, READING
from tracewire.solve.core.methods import METHODS
from tracewire.solve.core.quiet import SAMPLES
from tracewire.solve.history import new_history
from tracewire.solve.limits import MEMORY
from tracewire.solve.once_per_model import once_per_model
from tracewire.solve.sensitivities import new_sensitivity

Records = Literal["signals", "states", "both"]
"""What a sample has: the recorded signals, the states, or the states behind the signals."""


class Kind(NamedTuple):
    """Which runs a workspace fits: the number of samples and what they have, the numbers in the
    tables, the sensitivities, and the parameters that move with these."""

    samples: int
    records: Records
    tables: int
    asked: tuple[str, ...]
    moved: tuple[str, ...]


@once_per_model
def plan_of(model: Model) -> Plan:
    """The modes, resets and transitions of a model as arrays."""
    modes, low = model.modes, model.lowered
    first, resets = 0, []
    for reset in low.resets:
        count = len(reset.values)
        kind = EVENTS.index(reset.kind)
        resets.append((reset.trigger, DIRECTIONS[reset.direction], first, count, kind))
        first += count
    position = {name: i for i, name in enumerate(model.states)}
    moves = [
        (m.memory, m.source, m.trigger, m.target, m.reset, m.level, int(m.at_zero))
        for m in low.transitions
    ]

    loop = np.full(len(modes), -1, dtype=np.int64)
    for number, members in enumerate(low.loops):
        loop[list(members)] = number

    terms = [states or () for states in model.routines.straight]

    def ints(values: Sequence[int]) -> NDArray[np.int64]:
        return np.array(values, dtype=np.int64)

    return Plan(
        kind=ints([KINDS.index(mode.kind) for mode in modes]),
        at_zero=ints([mode.at_zero for mode in modes]),
        compares=ints([int(mode.compares) for mode in modes]),
        can_hold=ints([int(mode.holds) for mode in modes]),
        table=ints([mode.table for mode in modes]),
        is_timed=ints([int(mode.timed is not None) for mode in modes]),
        timed=ints([i for i, mode in enumerate(modes) if mode.timed is not None]),
        resets=np.array(resets, dtype=np.int64).reshape(-1, 5),
        writes=ints([state for reset in low.resets for state in reset.values]),
        transitions=np.array(moves, dtype=np.int64).reshape(-1, 7),
        direct=ints([position.get(name, -1) for name in model.recorded]),
        loop=loop,
        straight=ints([int(terms is not None) for terms in model.routines.straight]),
        first_term=ints([*accumulate(map(len, terms), initial=0)]),
        term_state=ints([state for states in terms for state in states]),
    )


def _plan_for(model: Model, records: Records) -> Plan:
    """The plan of a model with what its samples have."""
    plan, states = plan_of(model), np.arange(len(model.states))
    if records == "signals":
        return plan
    return plan._replace(direct=states if records == "states" else np.append(plan.direct, states))


def _new_flow(model: Model, numbers: int) -> Flow:
    """The field of a model, with its modes as they are by default; its tables have `numbers`."""
    sizes, count = model.routines.sizes, len(model.modes)
    return Flow(
        address=np.empty(len(FUNCTIONS), dtype=np.int64),
        m=model.routines.usual_modes.copy(),
        c=np.zeros(max(1, sizes.constants)),
        k=np.zeros(numbers),
        weights=np.zeros(len(plan_of(model).term_state)),
        bound=np.full(count, FREE, dtype=np.int64),
        push=np.zeros((count, sizes.states)),
        grip=np.zeros(count),
        counts=np.zeros(4, dtype=np.int64),
    )


def _new_progress(model: Model, count: int, columns: int) -> Progress:
    """A run that has not begun, with `count` samples of `columns` numbers."""
    n, modes = model.routines.sizes.states, len(model.modes)
    width = LOG_HEAD + 2 * n
    progress = Progress(
        now=np.zeros(10),
        x=np.empty(n),
        atol=np.empty(n),
        ints=np.zeros(15, dtype=np.int64),
        times=np.zeros(count),
        samples=np.full((count, columns), np.nan),
        log=np.empty((max(8 * (modes + 2), MEMORY.log // width), width)),
        stiff=np.empty((MEMORY.stiff, 3 * modes)),
        recent=np.zeros((CHATTER_EVENTS, 2)),
        flights=np.tile([np.inf, 0.0], (modes, 1)),
        info=np.zeros(4),
        which=np.zeros(modes + 8, dtype=np.int64),
        overlooked=np.zeros(len(model.lowered.resets), dtype=np.int64),
        undetermined=np.full(modes, np.inf),
        beyond=np.zeros(n),
        given=np.empty(n),
        largest=np.zeros(n),
        least=np.zeros(n),
        sizes=np.zeros(2 * n),
    )
    return progress


def new_arrays(model: Model, kind: Kind) -> Arrays:
    """The arrays of a run that has not begun."""
    n, modes = len(model.states), len(model.modes)
    plan = _plan_for(model, kind.records)
    flow = _new_flow(model, kind.tables)
    progress = _new_progress(model, kind.samples, len(plan.direct))
    flow.counts[READING] = model.routines.reads_held
    guards_turn, forces_turn = model.routines.has_pace
    progress.now[PACED] = ALWAYS if guards_turn else WHILE_HELD if forces_turn else NEVER
    most = 3 * modes  # a guard has two levels at most, and held it has a force or two fractions

    def ints(size: int) -> NDArray[np.int64]:
        return np.zeros(size, dtype=np.int64)

    trial = Trial(
        ends=np.zeros(3),
        x=np.zeros(n),
        x_end=np.zeros(n),
        rate_end=np.zeros(n),
        error=np.zeros(n),
        inner=np.zeros((max(method.inner for method in METHODS), n)),
        stages=np.zeros((max(method.stages for method in METHODS), n)),
        matrix=np.zeros((n, n + 1)),
        factors=np.zeros((n, n)),
        pivots=ints(n),
        rate=np.zeros(n),
        at=np.zeros(n),
        guards=np.zeros(modes),
        paces=np.zeros(2),
    )
    watch = Watch(
        mode=ints(most),
        kind=ints(most),
        to=np.zeros(most),
        level=np.zeros(most),
        sign=np.zeros(most),
        armed=ints(most),
        rows=np.zeros((SAMPLES, most)),
        start=np.zeros(most),
        found=np.full(most, np.inf),
        hit=ints(most),
        grip=np.zeros(modes),
    )
    crossings = Crossings(
        how=np.full(modes, -1),
        to=np.zeros(modes),
        up=ints(modes),
        x=np.zeros(n),
        m=np.zeros(len(flow.m)),
        bound=ints(modes),
        due=ints(len(plan.resets)),
        known=ints(1),
    )
    columns = n if kind.records == "states" else len(model.recorded)
    sensitivity = new_sensitivity(model, progress, trial, kind.asked, kind.moved, columns)
    history = new_history(model, sensitivity)
    return Arrays(flow, plan, progress, trial, watch, crossings, sensitivity, history)


def new_spans(arrays: Arrays, count: int, samples: int, block: Vector, first: Vector) -> Spans:
    """The arrays of runs over `count` spans with so many samples in all; they are still to be set.

    `arrays` are those of one run, `block` and `first` as `Spans` has them.
    """
    n, q = arrays.sensitivity.s.shape
    columns = len(arrays.plan.direct)

    def ints(size: int) -> NDArray[np.int64]:
        return np.zeros(size, dtype=np.int64)

    return Spans(
        at=ints(5),
        ends=np.zeros((count, 2)),
        rows=ints(count + 1),
        x=np.zeros((count, n)),
        s=np.zeros((count, n * q)),
        floor=np.zeros((n, q)),
        follows=ints(count),
        kept=ints(n),
        lasting=ints(q),
        times=np.zeros(samples),
        samples=np.zeros((samples, columns)),
        answers=np.zeros((samples, columns * q)),
        final=np.zeros((count, n)),
        final_s=np.zeros((count, n * q)),
        steps=ints(count),
        block=block,
        first=first,
    )
