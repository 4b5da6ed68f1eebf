"""The memory of what delayed signals were: made before a run, and made larger while it goes on."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.array_types import Matrix
from tracewire.compile import Model
from tracewire.errors import Location, OptionError, Problem, SimulationError, unknown
from tracewire.solve.core.arrays import FIRST, Arrays, History, Sensitivity
from tracewire.solve.core.codes import T
from tracewire.solve.core.history import DEGREE, EACH, HEAD, ROOM
from tracewire.solve.held import Driving, Held, values_at
from tracewire.solve.limits import MEMORY
from tracewire.solve.once_per_model import once_per_model

Ints = NDArray[np.int64]
FIRST_PIECES = 3 * ROOM
GROWING = ("points", "ranks", "shifts", "pieces", "moves")


def new_history(model: Model, sensitivity: Sensitivity) -> History:
    """The arrays of the delays of a model, for a run with these sensitivities."""
    delays, q = model.lowered.delays, len(sensitivity.moved)
    count, w = len(delays), sensitivity.nodes.shape[1]
    some = int(bool(count))
    mode, order, seen = _delays_of(model)
    return History(
        mode=mode,
        order=order,
        seen=seen,
        lag=np.zeros(2 * count),
        size=np.zeros(count),
        points=np.empty((count, MEMORY.first_points)),
        ranks=np.empty((count, MEMORY.first_points), dtype=np.int64),
        shifts=np.empty((count, MEMORY.first_points * q)),
        counts=np.zeros((count, 2), dtype=np.int64),
        along=np.zeros(2, dtype=np.int64),
        pieces=np.empty((some * FIRST_PIECES, HEAD + EACH * count)),
        moves=np.empty((some * MEMORY.first_moves, HEAD + count + 5 * count * q)),
        first=np.array([len(model.parameters)], dtype=np.int64),
        at=np.zeros((DEGREE + 1, max(count, count * q))),
        rows=np.zeros((count, w)),
        node_lags=np.zeros((4, count)),
    )


class Past(NamedTuple):
    """What is told of delayed signals before the start of a run, from the time `begin` in s on, as
    the rows that the functions of a model read (see `compile.past`)."""

    begin: float
    rows: Matrix

    @property
    def address(self) -> float:
        """Where the rows are; 0 where there are none."""
        return float(self.rows.__array_interface__["data"][0]) if self.rows.size else 0.0


UNTOLD = Past(math.inf, np.empty((0, 0)))


def past_of(model: Model, given: Mapping[str, tuple[ArrayLike, ArrayLike]]) -> Past:
    """What is told of delayed signals, by the names of these: times and values of all of them.

    Its jumps are no events: steps become as short there as their error asks for.

    Raises OptionError: a signal that is not delayed, one that is left out, what is no table.
    """
    if not given:
        return UNTOLD
    texts = [delay.text for delay in model.lowered.delays]
    problems = [unknown("delayed signal", name, texts) for name in given if name not in texts]
    for text in dict.fromkeys(texts):
        if text not in given:
            what = f"the past of '{text}' is not told, and that of others is"
            problems.append(Problem(what, hint="Give all of them, or none."))
    if problems:
        raise OptionError(problems)
    known = {name: _as_driving(name, one) for name, one in given.items()}
    begin = max(float(one[0][0]) for one in known.values())
    times = np.unique(np.concatenate([one[0] for one in known.values()]))
    times = np.append(times[times >= begin], times[-1] + 1.0)  # the last value stays
    left, right = times[:-1], times[1:]
    rows = np.zeros((len(times), HEAD + EACH * len(texts)))
    rows[0, :2] = len(left), rows.shape[1]
    pieces = rows[1:]
    pieces[:, 0], pieces[:, 1], pieces[:, 2] = left, (left + right) / 2, 2 / (right - left)
    for number, text in enumerate(texts):
        one, own = known[text], HEAD + EACH * number + 1
        first = values_at(one, left)
        last = first if isinstance(one, Held) else values_at(one, right)
        pieces[:, own], pieces[:, own + 1] = (first + last) / 2, (last - first) / 2
    return Past(begin, rows)


def _as_driving(name: str, given: tuple[ArrayLike, ArrayLike]) -> Driving:
    """The past of a signal as arrays. Raises OptionError."""
    t, u = (np.asarray(part, dtype=float).ravel() for part in given)
    if not (len(t) == len(u) > 1 and np.isfinite([t, u]).all() and (t[1:] > t[:-1]).all()):
        hint = "Give two times or more that ascend, as many values, and no NaN."
        raise OptionError([Problem(f"the past of '{name}' is not usable", hint=hint)])
    return Held(t, u) if isinstance(given, Held) else (t, u)


def refuse_delays(model: Model, what: str) -> None:
    """Raises OptionError where a model has delays, for `what` begins runs at states and no more."""
    problems = []
    for delay in model.lowered.delays:
        name = model.modes[delay.mode].signal
        block = model.flat.blocks.get(name)
        said = f"{what} begins at states, and the delay needs what '{delay.text}' was before"
        place = replace(block.place if block else Location(), block=name)
        hint = "Take a block of type pade_delay in its place, whose states are its past."
        problems.append(Problem(said, place, (), hint))
    if problems:
        raise OptionError(problems)


@once_per_model
def _delays_of(model: Model) -> tuple[Ints, Ints, Ints]:
    """The modes of the delays, how far jumps get, and which of them guards read."""
    delays = model.lowered.delays
    count, leaves = len(delays), len(model.modes) + len(model.states)
    order = model.routines.jump_orders() if count else []
    return (
        np.array([delay.mode for delay in delays], dtype=np.int64),
        np.array(order, dtype=np.int64).reshape(leaves if count else 0, count),
        np.array([int(j in model.routines.watched_delays) for j in range(count)], dtype=np.int64),
    )


def has_grown(arrays: Arrays) -> bool:
    """Whether a run has needed more memory than most."""
    return len(arrays.history.pieces) > FIRST_PIECES


def grow(arrays: Arrays, table: Ints) -> None:
    """Let a run that has no room left go on with twice as much.

    The arrays stay the same objects, whoever holds them; `table` is told where they are now. Raises
    SimulationError where that would be too much.
    """
    history = arrays.history
    if 2 * sum(getattr(history, name).size for name in GROWING) > MEMORY.past:
        what = f"the past of what is delayed takes more than {8e-9 * MEMORY.past:.0f} GB"
        t = arrays.progress.now[T]
        hint = "Loosen rtol, or shorten the longest delay."
        raise SimulationError([Problem(f"{what} at t = {t:.9g} s", hint=hint)])
    for name in GROWING:
        array = getattr(history, name)
        if not array.size:
            continue
        old, (rows, columns) = array.copy(), array.shape
        by_rows = name in ("pieces", "moves")
        array.resize((2 * rows, columns) if by_rows else (rows, 2 * columns), refcheck=False)
        array[:rows, :columns] = old
        place = 3 * (FIRST[History] + History._fields.index(name))
        data = array.__array_interface__["data"][0]
        table[place : place + 3] = data, *array.shape
