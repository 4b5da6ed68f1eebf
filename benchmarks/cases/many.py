"""simulate_many: rows of parameters at once, beside as many single runs."""

from __future__ import annotations

import os
from collections.abc import Iterator

import numpy as np
import tracewire as tw

from benchmarks.cases.paper_a import DIAGRAM
from benchmarks.measure import Entrant, in_turn, seconds_of
from benchmarks.options import Options
from benchmarks.table import Result, ratio, seconds

ROWS = 64
TITLE = f"Paper A, {ROWS} rows of parameters"
COLUMNS = ("run", "time", "time / simulate_many")


def measure(options: Options) -> Iterator[Result]:
    """Rows that differ in the stiffness of the disk's springs."""
    model = tw.compile(tw.read(DIAGRAM))
    rows = [{"k2": float(value)} for value in np.linspace(0.5, 0.9, ROWS)]

    def at_once() -> object:
        return tw.simulate_many(model, rows, preset="consistent", rtol=options.rtol)

    def singly() -> object:
        return [
            tw.simulate(model, parameters=row, preset="consistent", rtol=options.rtol)
            for row in rows
        ]

    at_once()  # the first run does not count
    entrants = [
        Entrant("simulate_many", lambda: seconds_of(at_once)),
        Entrant(f"{ROWS} single runs", lambda: seconds_of(singly)),
    ]
    in_turn(entrants, options.seconds_each)
    base = entrants[0].seconds
    table = [(one.name, seconds(one.seconds), ratio(one.seconds / base)) for one in entrants]
    yield Result(TITLE, COLUMNS, table, remarks=[f"{os.cpu_count()} cores"])
