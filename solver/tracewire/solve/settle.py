"""The modes at an instant: by the values of the guards, and by decision where these are zero."""

from __future__ import annotations

import bisect
import math
from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Mode
from tracewire.errors import Place, Problem, SimulationError
from tracewire.solve.decide import decide
from tracewire.solve.flow import Flow

Vector = NDArray[np.float64]
NOISE = 1e-14
JUMP = 1e-9


def noise(x: Vector) -> float:
    """How large a guard may be and still count as zero."""
    return NOISE * (1.0 + float(np.max(np.abs(x), initial=0.0)))


def mode_value(flow: Flow, mode: Mode, guard: float) -> float:
    """The mode that belongs to the value of a guard."""
    if mode.kind == "sign":
        return 1.0 if guard > 0 or (guard == 0 and mode.at_zero) else 0.0
    if mode.kind == "floor":
        return float(math.floor(guard))
    return float(bisect.bisect_right(flow.tables[mode.table][0], guard))


def right_limit(flow: Flow, mode: Mode, slope: float, guard: float) -> float:
    """The mode of a timed guard just after now."""
    if mode.kind == "sign":
        if abs(guard) <= NOISE:
            return 1.0 if slope > 0 or (slope == 0 and mode.at_zero) else 0.0
        return 1.0 if guard > 0 else 0.0
    near = NOISE * 100 * max(1.0, abs(guard))
    moved = guard + near if slope >= 0 else guard - near
    return mode_value(flow, mode, moved)


def settle(
    flow: Flow,
    t: float,
    x: Vector,
    zero: Collection[int] = (),
    left: Collection[int] = (),
    fresh: bool = False,
) -> bool:
    """Set every mode that is not timed; whether the choice was unique.

    `zero` are guards that are known to be zero although rounding may hide it; `left` are those
    whose slide has just ended: their stored mode stays. `fresh`: nothing is stored yet, so that
    two consistent modes are not unique. Raises SimulationError where the modes do not come to rest.
    """
    modes = flow.model.modes
    level = noise(x)
    known = set(zero)
    unique = True
    seen: set[tuple[object, ...]] = set()
    while True:
        guards = flow.guards(t, x)
        at_zero = set(known)
        for i, mode in enumerate(modes):
            if mode.timed is not None or i in known or i in left or flow.is_bound(i):
                continue
            if mode.kind == "sign" and abs(guards[i]) <= level:
                at_zero.add(i)
            elif _margin(flow, i, guards[i]) < -level:
                flow.modes[i] = mode_value(flow, mode, guards[i])
        undecided = sorted(at_zero | set(flow.sliding))
        if undecided:
            before = [guards[i] for i in undecided]
            unique = decide(flow, t, x, undecided, fresh) and unique
            after = flow.guards(t, x)
            jumped = [
                i
                for i, old in zip(undecided, before, strict=True)
                if abs(after[i] - old) > JUMP * (1.0 + abs(old))
            ]
            known -= set(jumped)
        if flow.rests:  # a contact that would have to pull opens
            _, forces = flow.held(t, x)
            open_ = {r.mode for r, f in zip(flow.rests, forces, strict=True) if not f >= -level}
            if open_:
                flow.release(open_)
                left = {*left, *open_}
                continue
        fixed = at_zero.union(left)
        wrong = [modes[i] for i in _outside(flow, t, x, level) if i not in fixed]
        if not wrong:
            return unique
        key = flow.key()
        if key in seen:
            texts = ", ".join(f"'{mode.text}' in {mode.signal}" for mode in wrong)
            what = f"no consistent mode at t = {t:.9g} s: {texts} changes with its own mode"
            hint = "A guard reads a signal that jumps with its mode: use hysteresis."
            raise SimulationError([Problem(what, Place(block=wrong[0].signal), (), hint)])
        seen.add(key)


def _margin(flow: Flow, i: int, guard: float) -> float:
    """How far a guard is inside the range of its mode; negative where it is outside."""
    mode, value = flow.model.modes[i], flow.modes[i]
    if mode.timed is not None or flow.is_bound(i):
        return math.inf
    if mode.kind == "sign":
        return guard if value else -guard
    if mode.kind == "floor":
        return min(guard - value, value + 1.0 - guard)
    points, piece = flow.tables[mode.table][0], int(value)
    low = points[piece - 1] if piece > 0 else -math.inf
    high = points[piece] if piece < len(points) else math.inf
    return min(guard - low, high - guard)


def _outside(flow: Flow, t: float, x: Vector, level: float) -> list[int]:
    """The modes whose guard is outside their range by more than `level`."""
    guards = flow.guards(t, x)
    return [i for i, guard in enumerate(guards) if not _margin(flow, i, guard) >= -level]
