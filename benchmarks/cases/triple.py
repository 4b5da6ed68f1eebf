"""Paper B: the triple pendulum under a square-wave torque."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.accuracy import Reference
from benchmarks.cases.side_by_side import compare
from benchmarks.options import Options
from benchmarks.peers.peer import Problem
from benchmarks.systems.hybrid import Modes, Vector
from benchmarks.systems.triple import Triple
from benchmarks.table import Result

DIAGRAM = Path(__file__).parents[1] / "diagrams/triple.yaml"
FREQUENCY = 0.6  # Hz: the response is periodic, so that errors do not grow
STATES = ("psi1", "psi2", "psi3", "psi1_dot", "psi2_dot", "psi3_dot")


def problem(end: float) -> Problem:
    """The pendulum from rest until `end` s."""
    return Problem(
        title=f"Triple pendulum, {FREQUENCY} Hz, {end:g} s",
        system=Triple(FREQUENCY, end),
        names=STATES,
        judged=(0, 1, 2),
        stiff=False,
        diagram=DIAGRAM,
        parameters={"f": FREQUENCY},
        script="triple.sce",
    )


def reference(end: float) -> Reference:
    """DOP853 at 1e-13, half period by half period, with its own dense output."""
    system = Triple(FREQUENCY, end)
    x, on = system.begin()
    edges, pieces = [0.0], []
    while edges[-1] < end:
        stop = min(system.due(on), end)
        rates: Any = partial(_rates, system, on)
        run: Any = solve_ivp(
            rates,
            (edges[-1], stop),
            x,
            method="DOP853",
            rtol=1e-13,
            atol=1e-15,
            dense_output=True,
        )
        pieces.append(run.sol)
        edges.append(stop)
        x, on = run.y[:, -1], system.tick(on)

    def states(times: Vector) -> Vector:
        which = np.clip(np.searchsorted(edges, times, side="right") - 1, 0, len(pieces) - 1)
        found = np.empty((len(times), len(x)))
        for index in np.unique(which):
            here = which == index
            found[here] = pieces[index](times[here]).T
        return found

    return states


def _rates(system: Triple, on: Modes, t: float, x: Vector) -> tuple[float, ...]:
    return system.rates(t, x, on)


def measure(options: Options) -> Iterator[Result]:
    """One table. The error is that of the angles, in rad."""
    end = 20.0 if options.quick else 100.0
    yield compare(problem(end), reference(end), options, {"C, same algorithm": (2.0, True)})
