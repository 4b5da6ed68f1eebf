"""Which modes hold when guards are zero: the joint derivative test, and the entry of a slide.

The modes of all guards that are zero are decided together. A combination is consistent when the
first derivative that is not zero of each of these guards along the field of that combination has
the sign of its mode. None consistent: slide. Several: the stored one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from tracewire.errors import Place, Problem, SimulationError
from tracewire.solve.flow import Flow

Vector = NDArray[np.float64]
HIGHEST_ORDER = 4
MOST_TOGETHER = 6
NOTHING = 1e-12
SLACK = 1e-9
BLOCK_ROUNDS = 6
MOST_ROUNDS = 500
Assignment = tuple[int | None, ...]  # 1, 0, or None: on the surface


def decide(flow: Flow, t: float, x: Vector, zero: Sequence[int], fresh: bool = False) -> bool:
    """Set the modes of the guards `zero`, all of kind sign; whether the choice was unique.

    Every guard on which the flow slides must be among them. The stored modes are unique wherever
    they are consistent, unless the run is `fresh`. Raises SimulationError where no combination and
    no slide is consistent.
    """
    stored = tuple(None if i in flow.sliding else int(flow.modes[i]) for i in zero)
    search = _combinations if len(zero) <= MOST_TOGETHER else _pivots
    found: list[Assignment] = []
    for assignment in search(flow, t, x, zero, stored):
        if found and None in assignment:
            break
        _assign(flow, zero, assignment)
        if _consistent(flow, t, x, zero, assignment, stored):
            found.append(assignment)
            if None in assignment or (assignment == stored and not fresh):
                break
    if not found:
        raise _refused(flow, t, zero, "no consistent mode")
    chosen = stored if stored in found else found[0]
    _assign(flow, zero, chosen)
    if len(flow.sliding) > 1 and not flow.is_affine(t, x):
        raise _refused(flow, t, flow.sliding, "no unique slide where modes multiply each other")
    return len(found) == 1 or (stored in found and not fresh)


def _refused(flow: Flow, t: float, guards: Sequence[int], what: str) -> SimulationError:
    modes = [flow.model.modes[i] for i in guards]
    texts = ", ".join(f"'{mode.text}' in {mode.signal}" for mode in modes)
    hint = "A guard reads what its own mode changes: use hysteresis or a block with memory."
    place = Place(block=modes[0].signal)
    return SimulationError(
        [Problem(f"{what} at t = {t:.9g} s for the guards {texts}", place, (), hint)]
    )


def _combinations(
    flow: Flow, t: float, x: Vector, zero: Sequence[int], stored: Assignment
) -> Iterator[Assignment]:
    """Every assignment: friction that can hold first, then signs, then slides of few surfaces."""
    holds = [flow.model.modes[i].holds for i in zero]

    def rank(assignment: Assignment) -> tuple[int, int, int]:
        plain = sum(a is None and not hold for a, hold in zip(assignment, holds, strict=True))
        loose = sum(a is not None and hold for a, hold in zip(assignment, holds, strict=True))
        changed = sum(a != b for a, b in zip(assignment, stored, strict=True))
        return plain, loose, changed

    yield from sorted(product((1, 0, None), repeat=len(zero)), key=rank)


def _pivots(
    flow: Flow, t: float, x: Vector, zero: Sequence[int], stored: Assignment
) -> Iterator[Assignment]:
    """Assignments on the way to the solution of the complementarity problem of many surfaces.

    All guards whose rate depends on their own mode begin on the surface; a fraction outside [0, 1]
    leaves it, a mode against its guard's rate comes back. After a few rounds only the first of
    these changes, which ends for friction between bodies (K. G. Murty, Note on a Bard-type scheme
    for solving the complementarity problem, Opsearch 11, 1974).
    """
    held: list[int | None] = [None] * len(zero)
    _assign(flow, zero, held)
    _, changes = flow.patterns("guard_rates", t, x)
    rows = {i: row for row, i in enumerate(flow.sliding)}
    now = [None if changes[rows[i], i] else old for i, old in zip(zero, stored, strict=True)]
    free = [n for n, value in enumerate(now) if value is None]
    for round_ in range(MOST_ROUNDS):
        yield tuple(now)
        _assign(flow, zero, now)
        rates = flow.guard_rates(t, x)
        fractions = dict(zip(flow.sliding, flow.fractions(t, x).tolist(), strict=True))
        wrong: list[tuple[int, int | None]] = []
        for n in free:
            i, value = zero[n], now[n]
            if value is None and not -SLACK <= fractions[i] <= 1 + SLACK:
                wrong.append((n, int(fractions[i] > 0.5)))
            elif value is not None and (rates[i] > 0) != bool(value):
                wrong.append((n, None))
        for n, value in wrong if round_ < BLOCK_ROUNDS else wrong[:1]:
            now[n] = value


def _assign(flow: Flow, zero: Sequence[int], assignment: Sequence[int | None]) -> None:
    for i, value in zip(zero, assignment, strict=True):
        flow.holds[i] = 1.0 if value is None and flow.model.modes[i].holds else 0.0
        flow.modes[i] = 0.0 if value is None else float(value)
    flow.sliding = tuple(sorted(i for i, a in zip(zero, assignment, strict=True) if a is None))


def _consistent(
    flow: Flow,
    t: float,
    x: Vector,
    zero: Sequence[int],
    assignment: Assignment,
    stored: Assignment,
) -> bool:
    if flow.sliding:
        fractions = flow.fractions(t, x)
        inside = (fractions >= -SLACK) & (fractions <= 1 + SLACK)
        if not inside.all() or not flow.is_independent(t, x):  # NaN is outside too
            return False
    rates = flow.guard_rates(t, x)
    tolerance = NOTHING * max(float(np.max(np.abs(flow.rates(t, x)), initial=0.0)), 1e-300)
    for n, (i, value) in enumerate(zip(zero, assignment, strict=True)):
        if value is None:
            continue
        rate = float(rates[i])
        if abs(rate) <= tolerance:
            rate = 0.0 if flow.sliding or flow.rests else _first_higher(flow, t, x, i, tolerance)
        if rate == 0.0:  # it stays on the surface: what was stored goes on
            if stored[n] is not None and value != stored[n]:
                return False
        elif (rate > 0) != bool(value):
            return False
    return True


def _first_higher(flow: Flow, t: float, x: Vector, mode: int, tolerance: float) -> float:
    """The first derivative of a guard, from the second on, that is not zero; 0 if none is."""
    for order in range(2, HIGHEST_ORDER + 1):
        function = flow.model.guard_derivative(mode, order)
        frozen = (flow.modes, flow.holds)
        (value,) = function(t, x.tolist(), frozen, flow.parameters, flow.tables)
        if abs(value) > tolerance:
            return value
    return 0.0
