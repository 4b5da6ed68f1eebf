"""What the compiled core is given: a model, values and tables as plain arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.solve.core.arrays import (
    Arrays,
    Crossings,
    Flow,
    Plan,
    Progress,
    Sensitivity,
    Trial,
    Watch,
)
from tracewire.solve.core.codes import (
    ABSOLUTE,
    CHATTER_EVENTS,
    DIRECTIONS,
    END,
    EVENTS,
    FIXED,
    KINDS,
    LENGTH,
    LOG_HEAD,
    LONGEST,
    METHOD,
    PACED,
    RTOL,
    H,
    T,
)
from tracewire.solve.core.flow import FREE, FUNCTIONS
from tracewire.solve.core.locate import SAMPLES
from tracewire.solve.core.memory import invoke
from tracewire.solve.core.methods import METHODS, NAMES
from tracewire.solve.held import Held
from tracewire.solve.history import new_history

Vector = NDArray[np.float64]
MOST_STIFF = 64  # mode combinations of a run that are remembered as stiff
LOG_VALUES = 1_000_000  # numbers that the log of the core may hold before it is emptied
NOTHING: Vector = np.zeros(1)
Table = tuple[Vector, Vector]


@dataclass(frozen=True)
class Tolerance:
    """How exact a run is: relative, absolute per state (n,), the step of a fixed method, and the
    longest step in s that any may take. An absolute one of 0 follows the size of the state.
    """

    rtol: float
    atol: Vector
    step: float = np.inf
    longest: float = np.inf


def kept_plan(model: Model) -> Plan:
    """The modes, resets and transitions of a model as arrays, made once."""
    found = model.kept.get("plan")
    if found is None:
        found = model.kept["plan"] = new_plan(model)
    return cast(Plan, found)


def new_plan(model: Model) -> Plan:
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
    )


def new_flow(model: Model, parameters: Vector, tables: Vector) -> Flow:
    """The field of a model for one set of parameters, with its modes as they are by default.

    `tables` are packed.
    """
    sizes, count = model.sizes, len(model.modes)
    flow = Flow(
        address=np.empty(len(FUNCTIONS), dtype=np.int64),
        m=np.array([*(mode.at_zero for mode in model.modes), *[0.0] * count], dtype=float),
        c=np.zeros(max(1, sizes.constants)),
        k=tables,
        bound=np.full(count, FREE, dtype=np.int64),
        push=np.zeros((count, sizes.states)),
        counts=np.array([int(model.reads_held), 0, 0, 0], dtype=np.int64),
    )
    prepare(model, flow, parameters)
    return flow


def prepare(model: Model, flow: Flow, parameters: Vector) -> None:
    """Let a field whose constants are zero have these parameters, and the functions as they are."""
    flow.address[:] = model.addresses(FUNCTIONS)
    invoke(model.address("prepare"), 0.0, parameters, NOTHING, NOTHING, NOTHING, flow.c)


def starts(model: Model, flow: Flow) -> Vector:
    """The start values of the states, as the diagram says."""
    out = np.zeros(model.sizes.states)
    address = model.address("starts")
    invoke(address, 0.0, NOTHING, flow.m, flow.c, flow.k, out)
    return out


def packed(tables: Sequence[Table]) -> Vector:
    """All tables in one array: their offsets, then of each its length, points, values, slopes.

    One that is held has slopes of 0: it jumps at its points.
    """
    out = np.zeros(len(tables) + sum(3 * len(x) for x, _ in tables) + 1)
    steps: dict[int, Vector] = {}  # many tables have the same x
    offset = len(tables)
    for number, table in enumerate(tables):
        x, y = table
        count = len(x)
        if id(x) not in steps:
            steps[id(x)] = x[1:] - x[:-1]
        out[number], out[offset] = offset, count
        out[offset + 1 : offset + 1 + count] = x
        out[offset + 1 + count : offset + 1 + 2 * count] = y
        slopes = out[offset + 1 + 2 * count : offset + 3 * count]
        if not isinstance(table, Held):
            np.divide(y[1:] - y[:-1], steps[id(x)], out=slopes)
        offset += 3 * count
    return out


def new_progress(
    model: Model,
    x: Vector,
    span: tuple[float, float],
    times: Vector,
    method: str,
    tolerance: Tolerance,
) -> Progress:
    """A run that has not begun."""
    n, count = len(x), len(model.modes)
    width = LOG_HEAD + 2 * n
    progress = Progress(
        now=np.zeros(10),
        x=np.empty(n),
        atol=np.empty(n),
        ints=np.zeros(15, dtype=np.int64),
        times=np.empty(len(times)),
        samples=np.full((len(times), len(model.recorded)), np.nan),
        log=np.empty((max(4 * count + 16, LOG_VALUES // width), width)),
        stiff=np.empty((MOST_STIFF, 3 * count)),
        recent=np.zeros((CHATTER_EVENTS, 2)),
        flights=np.tile([np.inf, 0.0], (count, 1)),
        info=np.zeros(4),
        which=np.zeros(count + 8, dtype=np.int64),
        overlooked=np.zeros(len(model.lowered.resets), dtype=np.int64),
        undetermined=np.full(len(model.modes), np.inf),
        given=np.empty(n),
        largest=np.zeros(n),
        least=np.zeros(n),
        sizes=np.zeros(2 * n),
    )
    progress.now[PACED] = float(model.has_pace)
    set_up(progress, x, span, times, method, tolerance)
    return progress


def set_up(
    progress: Progress,
    x: Vector,
    span: tuple[float, float],
    times: Vector,
    method: str,
    tolerance: Tolerance,
) -> None:
    """Let a run that has not begun be this one."""
    now = progress.now
    now[T], now[H], now[END], now[LENGTH] = span[0], 0.0, span[1], span[1] - span[0]
    now[RTOL], now[FIXED], now[LONGEST] = tolerance.rtol, tolerance.step, tolerance.longest
    progress.x[:], progress.given[:], progress.times[:] = x, tolerance.atol, times
    follows = ABSOLUTE * tolerance.rtol  # till the core knows of what size the states are
    progress.atol[:] = np.where(tolerance.atol > 0, tolerance.atol, follows)
    progress.ints[METHOD] = -1 if method == "auto" else NAMES.index(method)


def new_arrays(
    model: Model, flow: Flow, plan: Plan, progress: Progress, sensitivity: Sensitivity
) -> Arrays:
    """All arrays of a run, with the work space."""
    n, modes = len(progress.x), len(plan.kind)
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
    )
    crossings = Crossings(
        how=np.full(modes, -1),
        to=np.zeros(modes),
        up=ints(modes),
        x=np.zeros(len(progress.x)),
        m=np.zeros(len(flow.m)),
        bound=ints(modes),
        due=ints(len(plan.resets)),
        known=ints(1),
    )
    history = new_history(model, sensitivity)
    return Arrays(flow, plan, progress, trial, watch, crossings, sensitivity, history)
