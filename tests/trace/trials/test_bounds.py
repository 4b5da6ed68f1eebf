"""Numbers on a bound, and such as no record determines, are told before any effect is believed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from oracles.oscillator import DIAGRAM, candidates_of, problem_of, record, trial_of
from tracewire.fit import describe_undetermined
from tracewire.residual.sensor import Sensor
from tracewire.trace.trials.bounds import AtBound, at_bounds, describe_bounds
from tracewire.trace.trials.placed_effect import PlacedEffect


def test_a_fit_inside_its_bounds_has_nothing_on_one() -> None:
    assert at_bounds(trial_of(problem_of(record()))) == []


def test_a_declared_parameter_on_its_bound_is_told_with_the_bound() -> None:
    narrow = DIAGRAM.replace("fit: [5, 80]", "fit: [5, 24]")
    trial = trial_of(problem_of(record(), text=narrow))
    (one,) = at_bounds(trial)
    assert (one.name, one.kind, one.upper, one.bound, one.absent) == (
        "k",
        "parameter",
        True,
        24,
        False,
    )
    assert one.words == (
        "'k' sits on its bound 24 1/s^2: widen its `fit: [5, 24]`, or an effect may be named that "
        "only makes up for it"
    )


def test_a_term_that_goes_to_zero_is_not_used() -> None:
    trial = trial_of(problem_of(record(lambda x, v: 0.5 * v)))  # more than the damping takes
    (one,) = at_bounds(trial)
    assert one.absent
    assert one.words == "'c' sits on its bound 0 1/s: the fit does not use it"


def test_a_bound_that_only_the_declared_fit_met_is_told_of_that_alone() -> None:
    problem = problem_of(record(lambda x, v: 0.5 * v))
    declared = trial_of(problem)
    values = {**declared.windows.values, "c": 1.0}
    inside = replace(declared, windows=replace(declared.windows, values=values))
    assert describe_bounds(declared, declared) == [one.words for one in at_bounds(declared)]
    assert describe_bounds(declared, inside) == ["without the effects, 'c' sits on its bound 0 1/s"]


def test_a_small_value_far_from_zero_by_its_size_is_on_no_bound() -> None:
    wide = DIAGRAM.replace("fit: [0, 2]", "fit: [0, 5000]")
    assert at_bounds(trial_of(problem_of(record(), text=wide))) == []


def test_an_offset_on_its_bound_is_told_as_that_of_a_sensor() -> None:
    offset = "signals: {x: {column: x, offset: {value: 0, fit: [-0.01, 0.01]}}}"
    text = DIAGRAM.replace("signals: {x: x}", offset)
    problem = problem_of(record(), text=text)
    (series,) = problem.measured
    shifted = {"x": series.values["x"] + 0.05}
    sensor = {"x": Sensor(free={"offset": (-0.01, 0.01)})}
    problem = problem_of(replace(series, values=shifted, sensors=sensor), text=text)
    (one,) = at_bounds(trial_of(problem))
    assert (one.name, one.kind) == ("offset.x", "sensor")
    assert one.words.startswith(
        "the offset of the sensor of 'x' sits on its bound 0.01 m: widen its `fit: [-0.01, 0.01]`"
    )


def test_a_shape_on_its_bound_says_that_the_record_ends_there() -> None:
    problem = problem_of(record(lambda x, v: -0.5 * np.tanh(v / 1e-3)))
    stribeck = candidates_of(problem)["stribeck @ force"]
    stribeck = replace(stribeck, limits={**stribeck.limits, "speed": (0.05, 1.0)})
    fast = PlacedEffect(stribeck, {"level": 0.4, "speed": 0.9, "width": 0.0})
    found = at_bounds(trial_of(problem, [fast]))
    (one,) = [one for one in found if one.kind == "shape"]
    assert one.bound == 1.0, "what is there is a Coulomb friction"
    assert one.words == (
        "the speed of stribeck @ force sits on its bound 1 m/s: the record tells nothing above it; "
        "take a simpler law in its place, or a record that goes further"
    )


def test_a_phase_comes_round_and_has_no_bound() -> None:
    problem = problem_of(record(lambda x, v: -0.5 * np.sin(12 * x + 1.0)))
    cogging = candidates_of(problem)["cogging @ force"]
    limits = {**cogging.limits, "phase": (0.0, 1e-3)}
    narrow = PlacedEffect(
        replace(cogging, limits=limits), {"amplitude": 0.5, "pitch": 0.52, "phase": 1e-3}
    )
    trial = trial_of(problem, [narrow])
    assert trial.values["cogging.phase"] in (0.0, 1e-3)
    assert [one for one in at_bounds(trial) if one.name == "cogging.phase"] == []


def test_the_smoothing_of_a_law_at_zero_is_the_exact_law() -> None:
    low = AtBound("stribeck.width", "shape", 0.0, 0.0, 1.0, False, "m/s", "stribeck @ net")
    assert low.exact
    assert not replace(low, name="stribeck.speed").exact
    assert not replace(low, value=1.0, upper=True).exact


def test_a_bound_is_told_in_the_users_unit() -> None:
    one = AtBound("k", "parameter", 1e7, 0.0, 1e7, True, "bar/(s V)", factor=1e5)
    assert one.words.startswith("'k' sits on its bound 100 bar/(s V): widen its `fit: [0, 100]`")


def test_a_coefficient_at_zero_is_an_effect_that_is_not_used() -> None:
    one = AtBound("coulomb.level", "coefficient", 0.0, 0.0, 10.0, False, "", "coulomb @ force")
    assert one.absent
    assert one.words == "the level of coulomb @ force sits on its bound 0: the fit does not use it"


def test_declared_parameters_that_the_record_cannot_separate_are_told() -> None:
    """The record depends on the product alone."""
    assert describe_undetermined(trial_of(problem_of(record())).windows) == ()
    twice = DIAGRAM.replace("parameters:", "parameters:\n  s: {value: 1, fit: [0.5, 2]}")
    twice = twice.replace("k: -k}", "k: -s*k}")
    (words,) = describe_undetermined(trial_of(problem_of(record(), text=twice)).windows)
    assert words == "only s*k is determined: fix k or s"


def test_a_model_with_nothing_free_leaves_nothing_open() -> None:
    known = DIAGRAM.replace("fit: [5, 80]", "").replace("fit: [0, 2]", "")
    assert describe_undetermined(trial_of(problem_of(record(), text=known)).windows) == ()
