"""The arrays of a run, set to the numbers of a problem."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tracewire.solve.core.arrays import Arrays
from tracewire.solve.core.codes import ABSOLUTE, END, FIXED, LENGTH, LONGEST, METHOD, RTOL, H, T
from tracewire.solve.core.flow import FUNCTIONS
from tracewire.solve.core.memory import invoke
from tracewire.solve.core.methods import NAMES
from tracewire.solve.core.variation import OF_STARTS
from tracewire.solve.options import START
from tracewire.solve.problem import InitialValueProblem

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]


def set_to(arrays: Arrays, problem: InitialValueProblem) -> None:
    """Let the arrays of a run that has not begun be those of a problem."""
    flow, progress, tolerance = arrays.flow, arrays.progress, problem.tolerance
    flow.address[:] = problem.model.addresses(FUNCTIONS)
    flow.c[:], flow.k[:] = problem.constants, problem.tables
    now, (begin, end) = progress.now, problem.span
    now[T], now[H], now[END], now[LENGTH] = begin, 0.0, end, end - begin
    now[RTOL], now[FIXED], now[LONGEST] = tolerance.rtol, tolerance.step, tolerance.longest
    progress.x[:], progress.times[:] = problem.start, problem.times
    progress.given[:] = tolerance.atol
    follows = ABSOLUTE * tolerance.rtol  # till the core knows of what size the states are
    np.copyto(progress.atol, tolerance.atol)
    progress.atol[tolerance.atol <= 0] = follows
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
