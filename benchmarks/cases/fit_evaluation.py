"""One evaluation of a fit of paper A, for which an optimiser waits, beside one run in C."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import tracewire as tw
from tracewire.residual import Criterion, Segment, free_unknowns

from benchmarks.cases.paper_a import DIAGRAM, problem
from benchmarks.measure import Entrant, in_turn, seconds_of
from benchmarks.options import Options
from benchmarks.peers.native import Native
from benchmarks.peers.peer import Problem
from benchmarks.table import Promise, Result, ratio, seconds

FREE = ("k2", "c2_l", "c2_r")
COLUMNS = ("what", "time", "/ evaluation", "")


def measure(options: Options) -> Iterator[Result]:
    """Both barriers."""
    for c1, preset in ((120.0, "consistent"), (1.2, "teaching")):
        yield _one(problem(c1, preset), preset, options)


def criterion_of(problem: Problem, preset: str, rtol: float) -> Criterion:
    """The criterion of a fit of three parameters to both angles, at the times of the C program."""
    model = tw.compile(tw.read(DIAGRAM), record=("phi1", "phi2"))
    times = problem.system.times
    run = tw.simulate(model, preset=preset, times=times, rtol=1e-9)
    noise = 1e-3 * np.random.default_rng(1).standard_normal((2, len(times)))
    values = {name: run[name] + e for name, e in zip(("phi1", "phi2"), noise, strict=True)}
    measured = tw.Measured("record", "train", times, values, preset=preset)
    segment = Segment(measured, float(times[0]), np.arange(len(times)))
    unknowns = free_unknowns(model, FREE, run.parameters)
    return Criterion(model, [segment], unknowns, {}, rtol)


def _one(problem: Problem, preset: str, options: Options) -> Result:
    title = f"{problem.title}: an evaluation of a fit"
    criterion = criterion_of(problem, preset, options.rtol)
    z = np.array([unknown.value for unknown in criterion.unknowns]) / criterion.scales
    moved = iter(range(1_000_000))  # no two evaluations have the same parameters

    def evaluate() -> float:
        return criterion.value(z * (1 + 1e-9 * next(moved)))

    evaluate()  # the first does not count
    evaluation = Entrant("an evaluation, by tracewire", lambda: seconds_of(evaluate))
    entrants, why = [evaluation], Native().missing(problem)
    if not why:
        solve = Native().prepare(problem)
        entrants.append(
            Entrant("a run, C, same algorithm", lambda: seconds_of(lambda: solve(options.rtol)))
        )
    in_turn(entrants, options.seconds_each)
    base = evaluation.seconds
    rows = [(one.name, seconds(one.seconds), ratio(one.seconds / base), "") for one in entrants]
    if why:
        return Result(title, COLUMNS, [*rows, ("a run, C, same algorithm", "", "", why)], [])
    over = base / entrants[1].seconds
    return Result(title, COLUMNS, rows, [Promise(f"{title}, in runs of C", over, 1.25, most=True)])
