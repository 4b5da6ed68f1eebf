"""The derivatives of the flow in states, time and parameters, exact on slides and in contacts too.

On a slide or in a contact the rates are f(z, u), z = (x, t, p), with the fractions and forces u for
which e(z, u) = 0: the rates of the sliding guards and the second derivatives of the resting ones.
So df = f_z dz + f_u du with e_u du = -e_z dz.
"""

from __future__ import annotations

import numpy as np

from tracewire.solve.core.arrays import Matrix, Vector, flow_of, sensitivity_of
from tracewire.solve.core.flow import (
    CURVES,
    GRADIENTS,
    GUARD_RATES,
    RESTING,
    RHS,
    SLIDING,
    evaluate,
    held,
    patterns,
)
from tracewire.solve.core.linear import dot, factor, substitute
from tracewire.solve.core.memory import invoke
from tracewire.solve.core.units import helper, unit

DERIVATIVES = ("rhs", "guards", "guard_rates", "outputs", "timed", "resets", "starts", "delayed")
OF_RHS, OF_GUARDS, OF_GUARD_RATES, OF_OUTPUTS, OF_TIMED, OF_RESETS, OF_STARTS, OF_DELAYED = range(8)
ASIDE = 1e-5  # of the size of the states: how far the second derivatives of a guard look


@helper
def derive(core: int, which: int, t: float, x: Vector, out: Matrix) -> None:
    """The derivatives of one of the model's functions, row by row, modes as they stand."""
    flow, address = flow_of(core), sensitivity_of(core).address
    out[:] = 0.0
    invoke(address[which], t, x, flow.m, flow.c, flow.k, out)


@unit
def derive_blended(
    core: int, which: int, t: float, x: Vector, fractions: Vector, out: Matrix
) -> None:
    """The derivatives of a function on a slide with its fractions as they are."""
    flow = flow_of(core)
    slides = np.flatnonzero(flow.bound == SLIDING)
    for i in slides:
        flow.m[i] = 0.0
    derive(core, which, t, x, out)
    if len(slides) == 0:
        return
    base, side = out.copy(), np.empty(out.shape)
    for row, i in enumerate(slides):
        flow.m[i] = 1.0
        derive(core, which, t, x, side)
        out += fractions[row] * (side - base)
        flow.m[i] = 0.0


@unit
def derive_read(core: int, which: int, values: int, t: float, x: Vector, out: Matrix) -> None:
    """The derivatives of a function that may read what a slide holds; `values` is the function."""
    flow = flow_of(core)
    some = flow.counts[SLIDING]
    if some == 0:
        derive(core, which, t, x, out)
        return
    both = held(core, t, x)
    derive_blended(core, which, t, x, both, out)
    rows, parts = patterns(core, values, t, x, len(out)), np.empty((len(both), out.shape[1]))
    held_parts(core, t, x, parts)
    for row in range(some):
        for i in range(len(out)):
            if rows[1 + row, i] != 0.0:
                out[i] += rows[1 + row, i] * parts[row]


@unit
def field(core: int, t: float, x: Vector, out: Matrix) -> None:
    """d rates / d z (n, w)."""
    flow = flow_of(core)
    if flow.counts[SLIDING] + flow.counts[RESTING] == 0:
        derive(core, OF_RHS, t, x, out)
        return
    both = held(core, t, x)
    parts = np.empty((len(both), out.shape[1]))
    _held(core, t, x, both, out, parts)
    fields = patterns(core, RHS, t, x, len(x))
    some = flow.counts[SLIDING]
    for row in range(some):
        for i in range(len(x)):
            out[i] += fields[1 + row, i] * parts[row]
    for row, rest in enumerate(np.flatnonzero(flow.bound == RESTING)):
        for i in range(len(x)):
            out[i] += flow.push[rest, i] * parts[some + row]


@unit
def held_parts(core: int, t: float, x: Vector, out: Matrix) -> None:
    """d (fractions, then forces) / d z (slides and rests, w)."""
    frozen = np.empty((len(x), out.shape[1]))
    _held(core, t, x, held(core, t, x), frozen, out)


@unit
def _held(core: int, t: float, x: Vector, both: Vector, frozen: Matrix, out: Matrix) -> None:
    """The derivatives of fractions and forces; in `frozen` those of the rates without them."""
    flow = flow_of(core)
    n, modes, w = len(x), len(flow.bound), out.shape[1]
    slides = np.flatnonzero(flow.bound == SLIDING)
    rests = np.flatnonzero(flow.bound == RESTING)
    some, count = len(slides), len(both)
    derive_blended(core, OF_RHS, t, x, both, frozen)
    along, moves = np.empty((modes, w)), patterns(core, GUARD_RATES, t, x, modes)
    derive_blended(core, OF_GUARD_RATES, t, x, both, along)
    matrix, right = np.empty((count, count)), np.empty((w, count))
    for row in range(some):
        right[:, row] = -along[slides[row]]
        for column in range(some):
            matrix[row, column] = moves[1 + column, slides[row]]
    if len(rests):
        fields, pushed = patterns(core, RHS, t, x, n), np.zeros(n)
        curves, gradients = np.empty((modes, n + 1)), np.empty((modes, n))
        evaluate(core, CURVES, t, x, curves)
        evaluate(core, GRADIENTS, t, x, gradients)
        for row, i in enumerate(rests):
            _turn(core, i, both[some + row], frozen)
            pushed += both[some + row] * flow.push[i]
        whole = fields[0] + pushed
        for row in range(some):
            whole += both[row] * fields[1 + row]
        bent, bent_rates = np.empty((modes, w)), np.empty((modes, w))
        _second(core, OF_GUARDS, t, x, pushed, 0.0, bent)
        _second(core, OF_GUARD_RATES, t, x, whole, 1.0, bent_rates)
        for row in range(count):
            i = slides[row] if row < some else rests[row - some]
            slope = gradients[i] if row < some else curves[i, :n]
            for column in range(some, count):
                matrix[row, column] = dot(slope, flow.push[rests[column - some]])
            if row < some:
                turned = np.zeros(w)
                for column, j in enumerate(rests):
                    _add_turn(core, j, both[some + column], slope, turned)
                right[:, row] -= bent[i] + turned
            else:
                for column in range(some):
                    matrix[row, column] = dot(slope, fields[1 + column])
                right[:, row] = -bent_rates[i]
                for j in range(n):
                    if slope[j] != 0.0:
                        right[:, row] -= slope[j] * frozen[j]
    pivots = np.empty(count, dtype=np.int64)
    if factor(matrix, pivots) == 0.0:
        out[:] = 0.0
        return
    for column in range(w):
        substitute(matrix, pivots, right[column])
        out[:, column] = right[column]


@helper
def _turn(core: int, i: int, force: float, frozen: Matrix) -> None:
    """Add how the push of a contact turns with the parameters, times its force, to the rates."""
    turns = sensitivity_of(core).push[i]
    n, w = frozen.shape
    a = w - n - 1
    for j in range(n):
        for column in range(a):
            frozen[j, n + 1 + column] += force * turns[j * a + column]


@helper
def _add_turn(core: int, i: int, force: float, slope: Vector, out: Vector) -> None:
    """The same, of the rate of a guard with the gradient `slope`."""
    turns = sensitivity_of(core).push[i]
    n = len(slope)
    a = len(out) - n - 1
    for j in range(n):
        for column in range(a):
            out[n + 1 + column] += slope[j] * force * turns[j * a + column]


@unit
def _second(
    core: int, which: int, t: float, x: Vector, way: Vector, later: float, out: Matrix
) -> None:
    """The change of the derivatives of the guards (or of their rates) along a direction.

    By differences: it is exactly zero where they are constant, as for most contacts.
    """
    size = max(np.max(np.abs(way)), later)
    if size == 0.0:
        out[:] = 0.0
        return
    part = ASIDE * (1.0 + np.max(np.abs(x))) / size
    back = np.empty(out.shape)
    derive(core, which, t + part * later, x + part * way, out)
    derive(core, which, t - part * later, x - part * way, back)
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            out[i, j] = (out[i, j] - back[i, j]) / (2.0 * part)
