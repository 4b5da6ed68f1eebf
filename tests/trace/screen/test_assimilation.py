"""Effects that are judged along the data where the declared model is far from these."""

from __future__ import annotations

import numpy as np
import pytest
from oracles.oscillator import candidates_of, problem_of, record, trial_of
from scipy.optimize import lsq_linear
from tracewire.trace.candidates.places import find_places
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.assimilation import assimilate, candidates_along_data
from tracewire.trace.screen.screening import Screen, screen_candidates
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.trials.statistics import BoundedColumns
from tracewire.trace.trials.trial import TraceProblem, Trial

OPTIONS = TraceOptions()
LEVEL, BIAS = 1.5, 4.0


def far_trial() -> tuple[TraceProblem, Trial]:
    """An oscillator with friction and a constant force that are not declared, in long windows."""
    problem = problem_of(record(lambda x, v: -LEVEL * np.tanh(v / 1e-3) + BIAS, end=6.0))
    return problem, trial_of(problem, length=100)


def along() -> tuple[Trial, TorqueLinearisation, Screen]:
    problem, trial = far_trial()
    places = find_places(problem.declared)
    linearisation = TorqueLinearisation(trial.diagram, trial.windows, places, 1e-6, OPTIONS)
    found = assimilate(problem, trial, linearisation)
    assert found is not None
    names = ("bias @ force", "coulomb @ force", "cubic_stiffness @ force", "quad_drag @ force")
    candidates = [candidates_of(problem)[name] for name in names]
    return trial, found, screen_candidates(found, trial, candidates)


def test_the_windows_follow_the_data() -> None:
    trial, linearisation, _ = along()
    x = linearisation.trajectories[0].signals["x"]
    measured = trial.windows.segments[0].measured.values["x"]
    assert np.std(x - measured) < 5e-3, "the noise is 1e-3"
    plain = TorqueLinearisation(trial.diagram, trial.windows, linearisation.places, 1e-6, OPTIONS)
    assert np.std(plain.trajectories[0].signals["x"] - measured) > 0.03


def test_a_pair_is_promised_with_the_values_that_belong_to_it() -> None:
    _, _, screen = along()
    best = screen.pairs()[0]
    assert {str(row.candidate) for row in best.rows} == {"bias @ force", "coulomb @ force"}
    promised = {str(row.candidate): row.values["level"] for row in best.rows}
    assert promised["coulomb @ force"] == pytest.approx(LEVEL, rel=0.2)
    assert promised["bias @ force"] == pytest.approx(BIAS, rel=0.1)
    values = screen.with_values(best).values
    assert values["k"] == pytest.approx(25.0, rel=0.05)
    assert values["c"] == pytest.approx(0.2, abs=0.15)


def test_what_drives_a_sum_is_not_judged_along_the_data() -> None:
    problem, _ = far_trial()
    kept = {
        str(candidate) for candidate in candidates_along_data(list(candidates_of(problem).values()))
    }
    assert "coulomb @ force" in kept
    assert not any(name.endswith(("@ sensor.x", "@ drive.u")) for name in kept)
    assert "inertia @ force" not in kept and "load_friction @ force" not in kept


def test_columns_beside_bounded_unknowns_are_those_of_bounded_least_squares() -> None:
    rng = np.random.default_rng(4)
    unknowns, whole = rng.standard_normal((60, 2)), rng.standard_normal((60, 5))
    rest = 3 * unknowns[:, 0] - 2 * whole[:, 1] + 0.1 * rng.standard_normal(60)
    room = np.array([-1.0, -1.0]), np.array([1.0, 1.0])
    columns = BoundedColumns(
        rest, whole, np.zeros(5), 1.0, 50, OPTIONS.screen, whole, unknowns, rest, room
    )
    alone = lsq_linear(unknowns, -rest, room)
    for chosen in ([1], [0, 3]):
        both = np.hstack((unknowns, whole[:, chosen]))
        free = np.full(len(chosen), np.inf)
        right = lsq_linear(both, -rest, (np.r_[room[0], -free], np.r_[room[1], free]))
        fall, values = columns.score(chosen)
        assert values == pytest.approx(right.x[2:], abs=1e-8)
        assert fall == pytest.approx(2 * (alone.cost - right.cost), rel=1e-8)
        assert columns.left(chosen) == pytest.approx(right.fun, abs=1e-8)
        assert columns.unknown_changes(chosen) == pytest.approx(right.x[:2], abs=1e-8)
