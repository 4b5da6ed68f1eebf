"""The arrays of runs, kept with the model: to make them takes as long as a short run."""

from __future__ import annotations

from collections import deque
from typing import Any
from weakref import ref

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.solve.core.arrays import Arrays, Spans, table_of
from tracewire.solve.core.codes import END, FIXED, LENGTH, LONGEST, METHOD, RTOL, H, T
from tracewire.solve.core.flow import FUNCTIONS
from tracewire.solve.core.memory import invoke
from tracewire.solve.core.methods import NAMES
from tracewire.solve.core.variation import OF_STARTS
from tracewire.solve.history import GROWING, has_grown
from tracewire.solve.limits import MEMORY
from tracewire.solve.once_per_model import once_per_model
from tracewire.solve.options import START
from tracewire.solve.problem import InitialValueProblem
from tracewire.solve.setup import Kind, Records, new_arrays, new_spans

ONLY_WRITTEN = (
    *("address", "c", "k", "weights", "log", "stiff", "times"),
    *("change", "between", "right", "parts", "system", "steps"),  # of sensitivities
    *GROWING,
)
"""What is written before each run, or not read before the run has written it."""


class Workspace:
    """The arrays of one run, and their table for the core; those of runs over spans, if it had any.

    `block` is the memory of all that a run changes, `first` what was there before.
    """

    def __init__(self, kind: Kind, arrays: Arrays) -> None:
        self.kind = kind
        self.arrays, self.block = _in_one_block(arrays)
        self.table, self.first = table_of(self.arrays), self.block.copy()
        self.address: int = self.table.__array_interface__["data"][0]
        self.spans: Spans | None = None
        self.layout: object = None
        """What the arrays for spans are laid out for, so that the next run need not do it again."""
        self._table_of_spans = np.empty(0, dtype=np.int64)
        progress, sensitivity = self.arrays.progress, self.arrays.sensitivity
        self.size = progress.samples.size + sensitivity.samples.size + kind.tables
        """The numbers in its samples and tables."""

    def renew(self) -> None:
        """Let the arrays be as they were before their run."""
        self.block[:] = self.first

    def keep(self) -> None:
        """Let them be before each further run as they are now."""
        self.first[:] = self.block

    def for_spans(self, count: int, samples: int) -> Spans:
        """The arrays for so many spans with so many samples in all; each of them is to be set."""
        spans = self.spans
        if spans is None or (len(spans.ends), len(spans.times)) != (count, samples):
            spans = self.spans = new_spans(self.arrays, count, samples, self.block, self.first)
            self._table_of_spans, self.layout = table_of([spans]), None
            self.size = spans.samples.size + spans.answers.size + self.kind.tables
        return spans

    @property
    def address_of_spans(self) -> int:
        """That of the table of what `for_spans` has given."""
        address: int = self._table_of_spans.__array_interface__["data"][0]
        return address


def _in_one_block(arrays: Arrays) -> tuple[Arrays, Vector]:
    """The arrays with all that a run changes in one block of memory, and that block."""
    groups: list[Any] = list(arrays)
    fields = [
        (number, name, array)
        for number, group in enumerate(groups)
        for name, array in group._asdict().items()
        if group is not arrays.plan and name not in ONLY_WRITTEN
    ]
    block = np.empty(sum(array.size for *_, array in fields))
    first = 0
    for number, name, array in fields:
        part = block[first : first + array.size].view(array.dtype).reshape(array.shape)
        part[...] = array
        groups[number] = groups[number]._replace(**{name: part})
        first += array.size
    return Arrays(*groups), block


def acquire(problem: InitialValueProblem, records: Records) -> Workspace:
    """A workspace for a problem, set to its numbers: one that is kept and free, or a new one."""
    moved = problem.moving.names
    kind = Kind(len(problem.times), records, len(problem.tables), problem.sensitivities, moved)
    try:
        space = _kept(problem.model)[kind].pop()  # at once, as another thread may want it too
        space.renew()
    except (KeyError, IndexError):
        space = Workspace(kind, new_arrays(problem.model, kind))
    set_to(space.arrays, problem)
    return space


def set_to(arrays: Arrays, problem: InitialValueProblem) -> None:
    """Let the arrays of a run that has not begun be those of a problem."""
    flow, progress, tolerance = arrays.flow, arrays.progress, problem.tolerance
    flow.address[:] = problem.model.routines.addresses(FUNCTIONS)
    flow.c[:], flow.k[:] = problem.constants, problem.tables
    now, (begin, end) = progress.now, problem.span
    now[T], now[H], now[END], now[LENGTH] = begin, 0.0, end, end - begin
    now[RTOL], now[FIXED], now[LONGEST] = tolerance.rtol, tolerance.step, tolerance.longest
    progress.x[:], progress.times[:] = problem.start, problem.times
    progress.given[:], progress.atol[:] = tolerance.atol, tolerance.first
    progress.ints[METHOD] = -1 if problem.method == "auto" else NAMES.index(problem.method)
    if problem.sensitivities:
        _set_sensitivities(arrays, problem)


def _set_sensitivities(arrays: Arrays, problem: InitialValueProblem) -> None:
    """The derivatives of the start values: those that are given follow no parameter."""
    flow, sensitivity, moving = arrays.flow, arrays.sensitivity, problem.moving
    states, given = problem.model.states, problem.given.get("start") or {}
    n, s = len(states), sensitivity.s
    if moving.names:
        sensitivity.chain[: len(moving.names)] = moving.rates
        rows, nothing = np.zeros((n, n + 1 + len(sensitivity.chain))), np.zeros(1)
        address = sensitivity.address[OF_STARTS]
        invoke(address, 0.0, nothing, flow.m, flow.c, flow.k, rows.reshape(-1))
        s[:] = rows[:, n + 1 :] @ sensitivity.chain
        if given:
            s[[state in given for state in states]] = 0.0
    for j, name in enumerate(problem.sensitivities):
        if name not in problem.model.flat.parameters:
            s[:, j] = 0.0
            s[states.index(name.removeprefix(START)), j] = 1.0
    sensitivity.peak[:] = np.maximum(np.abs(s), least_peak(arrays, problem))
    sensitivity.now[0] = arrays.progress.now[T]


def least_peak(arrays: Arrays, problem: InitialValueProblem) -> Matrix:
    """The sensitivities (n, q) below which they need not be followed closely: all of a parameter's
    value moves a state less than its tolerance there, as far from rest of exp(-(rate/speed)^2)."""
    values = problem.parameters
    sizes = np.array([abs(values.get(name, 0.0)) or 1.0 for name in problem.sensitivities])
    return np.asarray(arrays.progress.atol[:, None] / sizes)


def give_back(model: Model, space: Workspace) -> None:
    """Let the next run have a workspace; nobody may look into its arrays any more."""
    kept = _kept(model)
    if space.size > MEMORY.workspace or has_grown(space.arrays):
        return
    if not kept:
        _holders.append(ref(model))
        while len(_holders) > MEMORY.models:
            oldest = _holders.popleft()()
            if oldest is not None and oldest is not model:
                release(oldest)
    if space.kind not in kept and len(kept) >= MEMORY.workspaces:
        kept.clear()
    kept.setdefault(space.kind, []).append(space)


def release(model: Model) -> None:
    """Free the memory that runs of a model keep for the next one."""
    _kept(model).clear()


_holders: deque[ref[Model]] = deque()
"""The models that keep workspaces, in the order in which they began to."""


@once_per_model
def _kept(model: Model) -> dict[Kind, list[Workspace]]:
    return {}
