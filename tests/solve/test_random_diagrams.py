"""Random diagrams: every back end and method, and an independent integration, say the same.

A run may also end in a SimulationError, then in the same one whatever computes it; never in another
exception, in NaN, or not at all.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
import tracewire as tw
import tracewire.solve
from hypothesis import HealthCheck, event, given, settings
from numpy.typing import NDArray
from oracles.switching import Unclear, integrate
from solve.wiring import END, Wiring, wirings
from tracewire.errors import SimulationError
from tracewire.solve import Limits

RTOL = 1e-9
NUDGE = 1e-6
MOST_STEPS = 5000  # some 150 are enough for such diagrams; a run that creeps has failed
ADAPTIVE = [
    name
    for name in getattr(tracewire.solve, "METHODS", ("auto", "dormand_prince", "rosenbrock"))
    if name != "rk4"  # of a fixed step
]
BACKENDS: tuple[Any, ...] = ("llvm", "quick", "python")
Vector = NDArray[np.float64]
# EXPLORE=1 make test ARGS=tests/solve/test_random_diagrams.py looks for new cases. What it finds
# differs from run to run, as weak corners are known that it may hit; a find goes to test_shrunk.py.
EXPLORING = "EXPLORE" in os.environ
QUIET = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


class Ended:
    """How a run ended: its last states and its log, or its error."""

    def __init__(self, model: tw.Model, method: str, start: dict[str, float] | None = None) -> None:
        self.error = ""
        self.final = np.zeros(0)
        self.log: list[tuple[str, str]] = []
        self.times = np.zeros(0)
        limits = Limits(steps=MOST_STEPS, seconds=20.0)
        try:
            run = tw.simulate(model, method=method, start=start, rtol=RTOL, limits=limits)
        except SimulationError as error:
            self.error = str(error)
            assert re.search(r"t = \S+ s", self.error), self.error
            assert not re.search("more than .* (steps|wall time)", self.error), self.error
            return
        self.final = np.array(list(run.final.values()))
        assert np.isfinite(self.final).all()
        assert all(np.isfinite(run[name]).all() for name in run.signals)
        self.log = [(entry.kind, entry.guard) for entry in run.events]
        self.times = np.array([entry.time for entry in run.events])
        assert (np.diff(self.times) >= 0).all()
        assert ((self.times >= 0) & (self.times <= END)).all()

    @property
    def words(self) -> str:
        """The error without its numbers."""
        return re.sub(r"-?\d[\d.e+-]*", "#", self.error)

    def instants(self) -> list[float]:
        """The times at which anything happens."""
        return [t for n, t in enumerate(self.times) if n == 0 or t > self.times[n - 1] + NUDGE]

    def alone(self, since: float = 0.0) -> list[tuple[str, str]]:
        """The log without the instants where several things happen: there its order is free."""
        apart = np.diff(self.times, prepend=-np.inf, append=np.inf) > NUDGE
        return [
            entry
            for entry, time, before, after in zip(
                self.log, self.times, apart, apart[1:], strict=False
            )
            if before and after and time >= since
        ]


def compared(first: Ended, second: Ended, tolerance: float, logs: bool, who: str) -> None:
    """Assert that two ways to compute one run agree."""
    assert (first.error == "") == (second.error == ""), (who, first.error or second.error)
    if first.error:
        return
    assert second.final == pytest.approx(first.final, abs=tolerance), who
    if logs:
        assert second.alone() == first.alone(), who
        assert second.instants() == pytest.approx(first.instants(), abs=100 * tolerance), who


def check(wiring: Wiring) -> None:
    """Compare all that can compute this diagram."""
    diagram = tw.read_text(wiring.text())
    models = [tw.compile(diagram, backend=backend) for backend in BACKENDS]
    base = Ended(models[0], ADAPTIVE[0])
    # How far a small change of the start is carried tells what may be asked of two computations.
    nudged = [
        Ended(
            models[0],
            ADAPTIVE[0],
            {name: start + sign * NUDGE for name, (_, start) in wiring.states.items()},
        )
        for sign in (1, -1)
    ]
    if base.error or any(other.error for other in nudged):
        event("error")
        stretch, logs = 1.0, False
    else:
        stretch = max(float(np.abs(other.final - base.final).max()) for other in nudged) / NUDGE
        logs = all(other.alone(1e-2) == base.alone(1e-2) for other in nudged)
    event("stretch below 100" if stretch < 100 else "stretch")
    tolerance = 1000 * RTOL * (1 + stretch)
    for method in ADAPTIVE:
        ends = [Ended(model, method) for model in models]
        for other in ends[1:]:
            compared(ends[0], other, tolerance, logs, f"back ends with {method}")
            assert other.words == ends[0].words
        if not any(other.error for other in nudged):
            compared(base, ends[0], tolerance, logs, f"{ADAPTIVE[0]} and {method}")
    if base.error or stretch > 100:
        return
    known = wiring.known()
    try:
        final, times = integrate(wiring.rates, wiring.starts(), known, END)
    except Unclear as reason:
        event(f"not judged: {reason}")
        return
    event("judged")
    assert base.final == pytest.approx(final, abs=tolerance)
    if "relay" not in wiring.text():  # the thresholds of a relay are crossed in vain, too
        assert all_near(base.times, [*times, *known], 100 * tolerance)
    assert all_near(times, base.times, 100 * tolerance)


def all_near(times: Iterable[float], others: Iterable[float], tolerance: float) -> bool:
    """Whether each time is one of the others."""
    found = np.array([*others, np.inf])
    return all(np.abs(found - time).min() <= tolerance for time in times)


@given(wirings())
@settings(
    max_examples=400 if EXPLORING else 25,
    deadline=None,
    derandomize=not EXPLORING,
    suppress_health_check=QUIET,
)
def test_random_diagrams(wiring: Wiring) -> None:
    check(wiring)
