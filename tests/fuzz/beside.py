"""A random system with and without a table beside it whose points lie at the events of the system.

The table drives nothing, so the system is the same. Where its points are exact, what happens in the
system happens at an instant at which a step ends anyway.
"""

from __future__ import annotations

import random

import numpy as np
import tracewire as tw
from fuzz.compare import METHODS, RTOL, Tally, kind_of, linear
from fuzz.elements import Unclear
from fuzz.systems import draw, text_of
from tracewire.errors import SimulationError
from tracewire.solve import Limits

AGREES = 1e-4  # of the size of a state: an event that is lost changes more in nearly all systems
APART = 1e-7  # of the span, between two points of the table
FINER, SETTLED = 1e-10, 0.1  # a tolerance, and the part of a difference that it may explain
SHIFTS = (0.0, 0.0, 1e-16, 1e-15, 1e-14, 1e-12)  # of the span, of a point from its event


def check_beside(seed: int, tally: Tally) -> None:
    """Compare one system with itself beside a table; what comes of it goes to the tally."""
    draft, rng = draw(seed), random.Random(seed + 2)
    text, method, shift = text_of(draft), rng.choice(METHODS), rng.choice(SHIFTS)
    try:
        alone = _run(text, method)
    except SimulationError as error:
        tally.unclear[kind_of(str(error))] += 1
        return
    end = float(alone.t[-1])
    points = [[0.0, 0.0]]
    for time in sorted({event.time for event in alone.events}):
        if APART * end < time - points[-1][0] and time < end * (1 - APART):
            points.append([time + shift * end * rng.choice((-1, 1)), float(len(points) % 2)])
    table = (
        f"  beside: {{type: table, points: {[*points, [2 * end, 0.0]]}}}\n"
        "  sum_beside: {type: integrator, of: beside}\n"
    )
    try:
        both = _run(text.replace("blocks:\n", "blocks:\n" + table, 1), method)
    except SimulationError as error:
        if reason := _unclear(seed):
            tally.unclear[reason] += 1
            return
        tally.refused[kind_of(str(error))] += 1
        tally.refusals.append((seed, f"{method}, shift {shift}: {error}"))
        return
    tally.judged += 1
    for name, value in alone.final.items():
        size = max(float(np.abs(alone[name]).max()), abs(value))
        allowed = AGREES * (max(size, 1.0) if name.startswith("c") else size)  # one count
        off = abs(both.final[name] - value)
        if off > allowed:
            reason = _unclear(seed)
            if abs(_run(text, method, FINER).final[name] - value) > SETTLED * off:
                reason = "too sensitive"
            if reason:
                tally.unclear[reason] += 1
                return
            said = f"{name} ends {off:.3g} off, {method}, shift {shift}, {sorted(draft.said)}"
            tally.wrong.append((seed, said))
            return


def _unclear(seed: int) -> str:
    """Why the theory leaves open what a system does, as with several frictions on one surface."""
    case = linear(seed)
    try:
        case.solve(np.zeros(len(case.names)), np.array([case.end]))
    except Unclear as reason:
        return str(reason)
    return ""


def _run(text: str, method: str, rtol: float = RTOL) -> tw.Run:
    model = tw.compile(tw.read_text(text), backend="quick")
    limits = Limits(steps=200_000, seconds=20.0)
    return tw.simulate(model, rtol=rtol, method=method, limits=limits)
