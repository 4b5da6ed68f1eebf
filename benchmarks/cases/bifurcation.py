"""A slice of paper B's bifurcation diagram: 300 periods at some frequencies, on one core."""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np
import tracewire as tw

from benchmarks.cases.triple import DIAGRAM, STATES
from benchmarks.options import Options
from benchmarks.peers.native import Native
from benchmarks.peers.peer import Problem
from benchmarks.systems.triple import Triple
from benchmarks.table import Promise, Result, ratio, seconds

FREQUENCIES = (0.6, 0.73, 0.45, 0.87, 0.31)  # Hz
PERIODS, KEPT, WHOLE = 300, 100, 800
ALL = PERIODS * float(np.sum(1.0 / np.linspace(0.3, 0.9, WHOLE)))  # simulated s
MOST_SECONDS = 20.0


def measure(options: Options) -> Iterator[Result]:
    """The time of a few frequencies, and what all 800 would take at this rate."""
    model = tw.compile(tw.read(DIAGRAM))
    tw.simulate(model, span=(0.0, 0.1), rtol=options.rtol)
    own, hand, done, covered, absent = 0.0, 0.0, 0, 0.0, ""
    native = Native()
    for frequency in FREQUENCIES:
        edges = (np.arange(PERIODS - KEPT, PERIODS) + 0.5) / frequency
        began = time.perf_counter()
        tw.simulate(
            model,
            parameters={"f": frequency},
            span=(0.0, PERIODS / frequency),
            times=edges,
            rtol=options.rtol,
        )
        own += time.perf_counter() - began
        system = Triple(frequency, PERIODS / frequency)
        system.times = np.concatenate(([0.0], edges))
        problem = Problem("", system, STATES, (0, 1, 2), False, DIAGRAM)
        absent = native.missing(problem)
        if not absent:
            solve = native.prepare(problem)
            began = time.perf_counter()
            solve(options.rtol)
            hand += time.perf_counter() - began
        done += 1
        covered += PERIODS / frequency
        if own > MOST_SECONDS / (4 if options.quick else 1):
            break
    all_of_it = own / covered * ALL
    rows = [("tracewire", str(done), seconds(own), seconds(all_of_it), "1x")]
    if hand:
        whole = hand / covered * ALL
        rows.append(
            ("C, same algorithm", str(done), seconds(hand), seconds(whole), ratio(hand / own))
        )
    else:
        rows.append((native.name, "", "", "", absent))
    yield Result(
        f"Bifurcation diagram, {PERIODS} periods at each frequency, rtol {options.rtol:g}",
        ("solver", "frequencies", "time", f"all {WHOLE}, extrapolated", "time / tracewire"),
        rows,
        [Promise(f"bifurcation diagram, {WHOLE} x {PERIODS} periods", all_of_it, 80.0, "s", True)],
        [
            "extrapolated by simulated time",
            "each frequency starts from rest here; in the paper the state is carried along",
        ],
    )
