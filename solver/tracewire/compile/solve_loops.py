"""Algebraic loops on the tape: solved once and for all where that is possible, else searched.

A loop is opened at its unknowns, z = g(z). Where g is affine the solution is written out; else the
tape searches the root of r = z - g(z) (op `newton`). Modes are frozen: a loop through a sign or a
saturation is affine in each of its modes, its guards read the solution, and the run finds the modes
that agree with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tracewire.compile.differentiate import jacobian_of, linear_in_t, search, substitute_all
from tracewire.compile.flat import Loop
from tracewire.compile.linear import solve_linear
from tracewire.compile.lowering import Lowering
from tracewire.compile.tape import Tape
from tracewire.errors import DiagramError, Problem
from tracewire.formula import Number


def lower_loop(lowering: Lowering, loop: Loop) -> None:
    """Put the entries of an algebraic loop on the tape: with its unknowns open, and then solved.

    Raises DiagramError: no values, or any, solve the loop.
    """
    flat, out, tape = lowering.flat, lowering.out, lowering.tape
    leaves = [tape.unknown() for _ in loop.unknowns]
    guesses = [lowering.lower(flat.guesses.get(name, Number(0.0))) for name in loop.unknowns]
    old = len(out.modes)
    out.entries |= dict(zip(loop.unknowns, leaves, strict=True))
    values = {}
    for name in (*loop.names[len(leaves) :], *loop.unknowns):
        lowering.signal = name
        values[name] = lowering.lower(flat.signals[name])
        out.entries.setdefault(name, values[name])
    found = solve_loop(tape, loop, leaves, [values[name] for name in loop.unknowns], guesses)
    changes = dict(zip(leaves, found, strict=True))
    entries = substitute_all(tape, [out.entries[name] for name in loop.names], changes)
    out.entries |= dict(zip(loop.names, entries, strict=True))
    opened = out.modes[old:]
    if opened:
        out.loops.append(tuple(range(old, len(out.modes))))
    guards = substitute_all(tape, [mode.guard for mode in opened], changes)
    for key in [key for key, index in lowering.by_guard.items() if index >= old]:
        del lowering.by_guard[key]
    for base, (relay, _) in list(lowering.by_multiple.items()):
        if lowering.side(relay)[0] >= old:
            del lowering.by_multiple[base]
    for index, (mode, guard) in enumerate(zip(opened, guards, strict=True), old):
        needed = tape.needed([guard])
        known = lowering.t in needed and mode.leaf not in needed  # its own mode moves no known time
        timed = linear_in_t(tape, guard, lowering.t) if known else None
        out.modes[index] = replace(mode, guard=guard, timed=timed)
        kind = mode.kind if mode.table < 0 else f"{mode.kind}{mode.table}"
        lowering.by_guard.setdefault((kind, guard), index)


def solve_loop(
    tape: Tape,
    loop: Loop,
    unknowns: Sequence[int],
    values: Sequence[int],
    guesses: Sequence[int],
) -> list[int]:
    """The entries that solve z = g(z).

    unknowns: leaves of `Tape.unknown`, z; values: entries of g, which read them; guesses: entries
    where a search begins. Raises DiagramError: no values, or any, solve the loop.
    """
    residuals = [tape.push("-", z, g) for z, g in zip(unknowns, values, strict=True)]
    matrix = jacobian_of(tape, residuals, unknowns)
    _check(tape, loop, matrix)
    if set(unknowns).isdisjoint(tape.needed(matrix)):
        zeros = dict.fromkeys(unknowns, tape.constant(0.0))
        return solve_linear(tape, matrix, substitute_all(tape, values, zeros))
    newton = search(tape, unknowns, residuals, guesses)
    return [tape.push("pick", newton, payload=j) for j in range(len(unknowns))]


def _check(tape: Tape, loop: Loop, matrix: Sequence[int]) -> None:
    """Raise where the matrix is singular whatever the run brings."""
    size = len(loop.unknowns)
    found = [tape.value(entry) for entry in matrix]
    known = [value for value in found if value is not None]
    if len(known) == len(found):
        rank = int(np.linalg.matrix_rank(np.reshape(known, (size, size))))
    else:
        filled = np.reshape([value != 0 for value in found], (size, size))
        from scipy.sparse import csr_array  # a tenth of a second that only loops pay
        from scipy.sparse.csgraph import structural_rank

        rank = int(structural_rank(csr_array(filled.astype(float))))
    if rank < size:
        loops = "algebraic loop" if size == 1 else f"algebraic loops of {size} signals"
        what = f"{loops} without a solution, or with any: {loop.text}"
        reason = "The gain round the loop is exactly 1" if size == 1 else "They say too little"
        hint = f"{reason}: change it, or break it with a state, such as an integrator."
        raise DiagramError([Problem(what, loop.place, (), hint)])
