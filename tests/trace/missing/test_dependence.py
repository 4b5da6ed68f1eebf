"""Records with effects that no block has: the map says where they act and on what they depend."""

from __future__ import annotations

import math
import tracemalloc
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Measured
from tracewire.residual.windows import Section, cut_windows
from tracewire.trace.candidates.places import Place, find_places
from tracewire.trace.found import Dependence, Missing
from tracewire.trace.limits import BATCH
from tracewire.trace.missing.bases import Basis, bases_of
from tracewire.trace.missing.dependence import (
    ScoredBasis,
    _solve_ridge,
    choose_smallest,
    map_dependence,
)
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.trials.trial import TraceProblem, Trial

OPTIONS = TraceOptions()

Law = Callable[[float, float, float], float]
OSCILLATOR = """\
span: [0, 6]
inputs: {u: {unit: rad/s^2}}
parameters: {k: {value: 30, fit: [5, 90]}, c: {value: 0.5, fit: [0, 5]}}
blocks:
  q: {type: integrator, of: v, unit: rad}
  v: {type: integrator, of: torque, unit: rad/s}
  spring: {type: gain, of: q, k: -k}
  damper: {type: gain, of: v, k: -c}
  torque: {type: sum, of: [u, spring, damper]}
"""
STIFFNESS, DAMPING, NOISE = 36.0, 0.6, 2e-4
T = np.arange(0.0, 6.0, 0.01)
DRIVES = ((9.0, 4.2), (6.0, 2.9))
"""Amplitude in rad/s^2 and frequency in rad/s by series."""


def record(number: int, law: Law, memory: Law) -> Measured:
    """A driven oscillator with a further torque law(q, v, z), where z' = memory(q, v, z)."""
    amplitude, omega = DRIVES[number]

    def rates(t: float, x: np.ndarray) -> list[float]:
        q, v, z = x.tolist()
        u = amplitude * math.sin(omega * t)
        return [v, u - STIFFNESS * q - DAMPING * v + law(q, v, z), memory(q, v, z)]

    run = solve_ivp(rates, (0, 6), [0.3, 0.0, 0.0], t_eval=T, rtol=1e-8, atol=1e-9, max_step=0.01)
    noise = NOISE * np.random.default_rng(number).standard_normal(len(T))
    fine = np.linspace(0.0, 6.0, 3001)
    return Measured(
        f"run {number}",
        "train",
        T,
        {"q": run.y[0] + noise},
        inputs={"u": (fine, amplitude * np.sin(omega * fine))},
        start={"q": None, "v": None},
    )


def mapped(
    law: Law, memory: Law = lambda q, v, z: 0.0
) -> tuple[tuple[Dependence, ...], Missing | None]:
    return map_dependence(*linearisation_of(law, memory))


def linearisation_of(
    law: Law, memory: Law = lambda q, v, z: 0.0
) -> tuple[TorqueLinearisation, Trial, list[Place]]:
    model = compile(read_text(OSCILLATOR), record=("q",))
    series = tuple(record(number, law, memory) for number in range(len(DRIVES)))
    problem = TraceProblem(model, series, {"q": NOISE}, 1e-6)
    windows = [w for m in series for w in cut_windows(model, Section(m, 0, len(T)), 40, ("q", "v"))]
    trial = problem.fit((), windows, 40, {})
    places = [*find_places(model), Place("sensor.q", "sensor", "q")]
    return TorqueLinearisation(trial.diagram, trial.windows, places, 1e-6, OPTIONS), trial, places


def test_the_map_is_the_same_however_much_is_worked_on_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    given = linearisation_of(lambda q, v, z: 0.8 * math.sin(12 * q))
    shares, missing = map_dependence(*given)
    monkeypatch.setattr(type(BATCH), "map_rows", 10**9)
    monkeypatch.setattr(type(BATCH), "map_columns", 10**9)
    whole, same = map_dependence(*given)
    known = {(s.place, s.variables): s.share for s in whole}
    found = {(s.place, s.variables): s.share for s in shares}
    assert found == pytest.approx(known, rel=1e-9, abs=1e-9)
    assert missing is not None and same is not None
    np.testing.assert_allclose(missing.torque, same.torque, rtol=1e-6, atol=1e-9)


def test_the_map_never_holds_the_columns_of_all_bases() -> None:
    linearisation, trial, places = linearisation_of(lambda q, v, z: 0.8 * math.sin(12 * q))
    sizes = [
        sum(
            basis.columns[0].shape[1]
            for basis in bases_of(place, linearisation.trajectories, OPTIONS.map)
        )
        for place in places
    ]
    all_columns = 8 * linearisation.size * max(sizes)
    tracemalloc.start()
    map_dependence(linearisation, trial, places)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 3 * all_columns, "with all of them at hand it was eight times as much"


def test_a_ripple_in_the_coordinate_depends_on_it_alone() -> None:
    shares, missing = mapped(lambda q, v, z: 0.8 * math.sin(12 * q))
    assert missing is not None
    assert (missing.place, missing.variables) == ("torque", ("q",))
    assert missing.share > 0.95
    (grid,) = missing.grid
    seen = missing.density > 4
    torque = missing.torque[seen]
    # what the declared spring can imitate is no part of it
    line = np.stack([grid[seen], np.ones(seen.sum())], axis=1)
    ripple = 0.8 * np.sin(12 * grid[seen])
    difference = torque - ripple
    difference = difference - line @ np.linalg.lstsq(line, difference, rcond=None)[0]
    assert float(np.std(difference)) < 0.1 * float(np.std(ripple))
    assert shares == tuple(sorted(shares, key=lambda s: -s.share))


@pytest.mark.slow
def test_where_nothing_is_missing_no_torque_is_shown() -> None:
    shares, missing = mapped(lambda q, v, z: 0.0)
    assert missing is None
    assert max(s.share for s in shares) < 0.2


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "memory", "variables"),
    [
        (lambda q, v, z: -0.8 * q * v**2, lambda q, v, z: 0.0, ("q", "v")),
        (
            lambda q, v, z: -0.8 * math.exp(-(((q - 0.15) / 0.08) ** 2)) * math.tanh(v / 0.05),
            lambda q, v, z: 0.0,
            ("q", "v"),
        ),
        (lambda q, v, z: -6 * (q - z), lambda q, v, z: (q - z) / 0.2, ("history",)),
        (lambda q, v, z: -0.7 * math.tanh(v / 0.02), lambda q, v, z: 0.0, ("v",)),
    ],
    ids=["q v^2", "friction in a patch", "Maxwell branch", "dry friction"],
)
def test_variables_of_other_effects(law: Law, memory: Law, variables: tuple[str, ...]) -> None:
    _, missing = mapped(law, memory)
    assert missing is not None
    assert (missing.place, missing.variables) == ("torque", variables)


# --- the choice -----------------------------------------------------------------------------------


def scored(place: Place, variables: tuple[str, ...], share: float) -> ScoredBasis:
    return ScoredBasis(place, Basis(variables, ()), share, 1e4 * share, np.zeros(0))


SUM, OTHER = Place("torque", "sum", "torque"), Place("force", "sum", "force")
DRIVE = Place("drive.u", "drive", "u")


def chosen(*rows: ScoredBasis) -> tuple[str, tuple[str, ...]] | None:
    best = choose_smallest(rows, OPTIONS.map)
    return None if best is None else (best.place.name, best.basis.variables)


@pytest.mark.parametrize("alike", [1.0, 3e-5])
def test_a_ridge_is_solved_however_alike_the_columns_are(alike: float) -> None:
    """Where a body hardly moves, what is left of a basis without the starts is rounding, and a
    factor of Cholesky is none: a trace ended in that."""
    rng = np.random.default_rng(0)
    first = rng.standard_normal((400, 1))
    known = np.hstack([first, first + alike * rng.standard_normal((400, 1))])
    own = 1.0 if alike == 1.0 else 1e-7
    basis = known @ rng.standard_normal((2, 30)) + own * rng.standard_normal((400, 30))
    residual = rng.standard_normal((400, 1))
    columns = np.hstack([known, basis, residual])
    ridges = np.array([1e-6, 1.0])
    found = _solve_ridge(columns.T @ columns, 2, ridges)
    assert np.isfinite(found).all()
    unit = np.sum(basis**2) / 30
    for values, ridge in zip(found, ridges, strict=True):
        penalty = np.hstack([np.zeros((30, 2)), np.sqrt(ridge * unit) * np.eye(30)])
        whole = np.vstack([columns[:, :-1], penalty])
        target = np.concatenate([-residual[:, 0], np.zeros(30)])
        exact = np.linalg.lstsq(whole, target)[0]
        assert whole @ values == pytest.approx(whole @ exact, abs=1e-3)


def test_fewer_variables_are_preferred_within_five_percent() -> None:
    both = scored(SUM, ("q", "v"), 0.99)
    assert chosen(both, scored(SUM, ("q",), 0.95)) == ("torque", ("q",))
    assert chosen(both, scored(SUM, ("q",), 0.90)) == ("torque", ("q", "v"))


def test_memory_is_the_last_explanation() -> None:
    rows = scored(SUM, ("history",), 0.99), scored(SUM, ("q", "v"), 0.97)
    assert chosen(*rows) == ("torque", ("q", "v"))


def test_another_place_must_come_closer_to_be_preferred() -> None:
    both = scored(SUM, ("q", "v"), 0.99)
    assert chosen(both, scored(OTHER, ("q",), 0.95)) == ("torque", ("q", "v"))
    assert chosen(both, scored(OTHER, ("q",), 0.98)) == ("force", ("q",))


def test_what_depends_on_the_drive_is_sought_at_the_drive() -> None:
    rows = scored(SUM, ("u",), 0.97), scored(DRIVE, ("u",), 0.97)
    assert chosen(*rows) == ("drive.u", ("u",))


def test_a_small_share_is_nothing() -> None:
    assert chosen(scored(SUM, ("q",), 0.09)) is None
    assert chosen() is None
