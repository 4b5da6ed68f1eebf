"""Nine sensitivities of paper A beside one plain run, and beside finite differences."""

from __future__ import annotations

from collections.abc import Iterator

import tracewire as tw

from benchmarks.cases.paper_a import DIAGRAM
from benchmarks.measure import Entrant, in_turn, seconds_of
from benchmarks.options import Options
from benchmarks.table import Promise, Result, ratio, seconds

NINE = ["alpha", "beta", "T_s2_l", "T_02_l", "T_s2_r", "T_02_r", "k2", "c2_l", "c2_r"]
TITLE = "Paper A, nine sensitivities"
COLUMNS = ("run", "time", "time / plain run")


def measure(options: Options) -> Iterator[Result]:
    """Both barriers."""
    model = tw.compile(tw.read(DIAGRAM))
    for preset in ("consistent", "teaching"):
        yield _one(model, preset, options)


def _one(model: tw.Model, preset: str, options: Options) -> Result:
    title = f"{TITLE}, {preset}"

    def plain() -> object:
        return tw.simulate(model, preset=preset, rtol=options.rtol)

    def nine() -> object:
        return tw.simulate(model, preset=preset, rtol=options.rtol, sensitivities=NINE)

    plain()  # the first runs do not count
    nine()
    entrants = [
        Entrant("plain run", lambda: seconds_of(plain)),
        Entrant("with nine sensitivities", lambda: seconds_of(nine)),
    ]
    in_turn(entrants, options.seconds_each)
    base = entrants[0].seconds
    rows = [(one.name, seconds(one.seconds), ratio(one.seconds / base)) for one in entrants]
    rows.append(("central differences: 18 plain runs", seconds(18 * base), ratio(18.0)))
    over = entrants[1].seconds / base
    promises = [Promise(f"nine sensitivities, {preset}, in plain runs", over, 3.0, most=True)]
    return Result(title, COLUMNS, rows, promises)
