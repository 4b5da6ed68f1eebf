"""The torque that takes the residual away, at fewer nodes than samples and at each sample."""

from __future__ import annotations

import numpy as np
import pytest
from oracles.oscillator import problem_of, record, trial_of
from tracewire.trace.candidates.places import find_places
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.screen.torques import missing_torques

OPTIONS = TraceOptions()
STIFFNESS = 3.0  # of the cubic spring that is not declared


@pytest.mark.parametrize("nodes", [20, 500])
def test_a_missing_spring_is_the_needed_torque(nodes: int) -> None:
    problem = problem_of(record(lambda x, v: -STIFFNESS * x**3, end=6.0))
    trial = trial_of(problem, length=100)
    places = [place for place in find_places(problem.declared) if place.kind == "sum"]
    linearisation = TorqueLinearisation(trial.diagram, trial.windows, places, 1e-6, OPTIONS)
    needed = missing_torques(linearisation, places, lambda y: 0.3 * float(np.std(y)), 1e-3, nodes)
    (run,), (torque,) = linearisation.trajectories, needed["force"]
    inside = np.isfinite(torque)
    assert inside.sum() > 0.9 * len(torque)
    x, v = run.signals["x"][inside], run.signals["v"][inside]
    # what a linear spring and a damper take of it is theirs: the declared ones were fitted
    shapes = np.column_stack([x, v, x**3])
    *_, cubic = np.linalg.lstsq(shapes, torque[inside], rcond=None)[0]
    assert cubic == pytest.approx(-STIFFNESS, rel=0.1)
