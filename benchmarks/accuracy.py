"""Equal accuracy: the tolerance at which a peer's error is that of tracewire."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.peers.peer import Answer, Problem, Solve, TooSlow
from benchmarks.systems.hybrid import Vector

Reference = Callable[[Vector], Vector]  # of times (N,): the states (N, n), tight
FACTOR = 3.0
TRIALS = 12
LOOSEST, TIGHTEST = -2.0, -13.3  # decimal exponents of rtol
UNUSABLE = 3.0  # decades of error that a run which breaks down counts as


@dataclass(frozen=True)
class Match:
    """A tolerance, the error there, and the time of the one run that it was found with."""

    rtol: float
    error: float
    seconds: float
    equal: bool
    why: str = ""  # not empty: no usable run
    steps: int | None = None


def error_of(answer: Answer, problem: Problem, reference: Reference) -> float:
    """The largest error of the judged states at the peer's times; an event has its right limit."""
    times, first = np.unique(answer.times[::-1], return_index=True)
    states = answer.states[::-1][first]
    columns = list(problem.judged)
    return float(np.max(np.abs(states - reference(times))[:, columns]))


def timed(solve: Solve, rtol: float) -> tuple[Answer, float]:
    """One run and its time in s, by the peer's own clock if it keeps one."""
    began = time.perf_counter()
    answer = solve(rtol)
    seconds = time.perf_counter() - began
    return answer, seconds if answer.seconds is None else answer.seconds


def match(
    solve: Solve,
    problem: Problem,
    reference: Reference,
    target: float,
    first: float,
    budget: float,
) -> Match:
    """Search rtol, from `first` on, until the error is within a factor of 3 of `target`.

    At most `budget` s, and one run more.

    The error falls about as the tolerance does, but with jumps: a secant, held in its bracket.
    """
    loose, tight = LOOSEST, TIGHTEST  # errors are too large at `loose`, too small at `tight`
    exponent, began = math.log10(first), time.perf_counter()
    best = Match(math.nan, math.nan, math.nan, False, "no run within the time")
    closest = math.inf
    for _ in range(TRIALS):
        rtol = 10.0**exponent
        try:
            answer, seconds = timed(solve, rtol)
            error = error_of(answer, problem, reference)
            off = math.log10(max(error, 1e-300) / target) if math.isfinite(error) else UNUSABLE
        except TooSlow as slow:
            return best if best.why == "" else Match(rtol, math.nan, math.nan, False, str(slow))
        except (RuntimeError, ArithmeticError, ValueError, np.linalg.LinAlgError) as failure:
            off, error, seconds = UNUSABLE, math.nan, math.nan
            if best.why:
                best = Match(rtol, error, seconds, False, f"fails: {failure}"[:60])
        equal = abs(off) <= math.log10(FACTOR)
        if abs(off) < closest and math.isfinite(error):
            best = Match(rtol, error, seconds, equal, steps=answer.steps)
            closest = abs(off)
        if equal or time.perf_counter() - began > budget:
            break
        if off > 0:
            loose = exponent
        else:
            tight = exponent
        proposal = exponent - off
        if not min(tight, loose) < proposal < max(tight, loose):
            proposal = 0.5 * (tight + loose)
        if abs(proposal - exponent) < 0.02:
            break
        exponent = proposal
    return best
