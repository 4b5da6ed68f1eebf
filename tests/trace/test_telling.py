"""The paragraph of a trace says in plain words what was found, how sure it is, and what is open."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from show.traces import FOUND, NULL, SIGMA, UNEXPLAINED, errors, missing_of_two
from tracewire.trace.found import FoundEffect, Tie
from tracewire.trace.telling import (
    chance_words,
    in_sigma,
    paragraph_of,
    place_words,
    unseen_errors,
    value_words,
)


def test_an_effect_is_told_with_place_meaning_and_interval() -> None:
    text = paragraph_of(FOUND)
    assert text.startswith(
        "'Swing & rest' was fitted to 'swing_1' as it stands. What the fit left "
    )
    assert "left over is 9 times the noise" in text
    assert "'coulomb' at the sum 'torque' (dry friction of one level" in text
    assert "level = 0.25 N m (95 %: 0.243 to 0.257)" in text
    assert "what is left is as small as the noise" in text


def test_the_error_on_unseen_data_is_told_in_sigma() -> None:
    text = paragraph_of(FOUND)
    assert "On data that played no part, a run of the diagram was wrong by 46 σ and is now" in text
    assert "wrong by 1.02 σ" in text
    unseen = replace(FOUND, errors=errors(validated=False))
    assert "There were no data to test that on which played no part in it." in paragraph_of(unseen)
    assert "46" not in paragraph_of(unseen)


def test_ties_and_the_experiment_that_separates_them_are_told() -> None:
    text = paragraph_of(FOUND)
    assert "cannot tell 'coulomb' from 'bias' at the sum 'torque' or 'sensor_offset' in" in text
    assert "would tell coulomb from bias by 6.9 σ." in text


def test_what_declared_parameters_had_absorbed_is_told() -> None:
    text = paragraph_of(FOUND)
    assert text.endswith(
        "A declared parameter had stood in for what was missing: 'c' from 0.3 to 0.051 N m s/rad."
    )
    assert "'k'" not in text  # it moved by one standard error
    far = replace(FOUND, moved=tuple(replace(m, after=9.0) for m in FOUND.moved))
    assert "Declared parameters had stood in for what was missing: 'k' from 4.01 to 9 N" in (
        paragraph_of(far)
    )


def test_a_parameter_that_went_to_zero_is_told() -> None:
    assert paragraph_of(replace(FOUND, dropped=("c",))).endswith(
        "'c' went to zero: the data do not need what the diagram declares there."
    )


def test_nothing_missing_is_told_with_what_would_have_been_seen() -> None:
    text = paragraph_of(NULL)
    assert "What the fit left over is as small as the noise of the sensors." in text
    assert "nothing is missing that these data could show" in text
    assert "a run of the diagram is wrong by 1.02 σ" in text
    assert "would have shown, for example, coulomb at the sum 'torque' from level = 0.0021" in text
    assert "stood in" not in text


def test_what_nothing_explains_is_told_with_place_and_variables() -> None:
    text = paragraph_of(UNEXPLAINED)
    assert "Something is missing at the sum 'torque'. It depends on the coordinate q" in text
    assert "explains 97 % of what is above the noise" in text
    assert "No effect of the library explains it." in text
    both = paragraph_of(replace(UNEXPLAINED, missing=missing_of_two()))
    assert "It depends on the coordinate q and the rate v" in both
    nowhere = paragraph_of(replace(UNEXPLAINED, missing=None))
    assert "where it comes from cannot be said: a random disturbance" in nowhere
    assert "random disturbance" not in text
    assert UNEXPLAINED.missing is not None
    little = paragraph_of(replace(UNEXPLAINED, missing=replace(UNEXPLAINED.missing, share=0.31)))
    assert "explains 31 % of what is above the noise. The rest depends on no variable" in little
    assert "process noise" in little


def test_what_is_unexplained_is_never_called_as_small_as_the_noise() -> None:
    text = paragraph_of(replace(UNEXPLAINED, s2_before=1.21, missing=None))
    assert "left over is 1.1 times the noise" in text


def test_a_parameter_that_moves_by_less_than_a_hundredth_stood_in_for_nothing() -> None:
    slightly = replace(FOUND.moved[0], before=4.01, after=4.0, error=1e-4)
    assert slightly.significant
    assert "stood in" not in paragraph_of(replace(FOUND, moved=(slightly,)))


def test_a_partial_approximation_is_not_called_an_explanation() -> None:
    partial = replace(UNEXPLAINED, effects=FOUND.effects, s2_after=16.0)
    text = paragraph_of(partial)
    assert "best approximation is coulomb at the sum 'torque': 4 times the noise is left" in text
    assert "not enough" in text
    assert "It is no noise: it has the shape" not in text


def test_the_effect_of_a_sensor_is_called_by_what_it_does() -> None:
    effect = FoundEffect(
        "sensor_offset", "sensor.theta", {"offset": 0.02}, (Tie("bias", "torque", 0.999),)
    )
    found = replace(FOUND, effects=(effect,), units={"offset.theta": "rad"})
    assert "an offset in the sensor of 'theta', offset = 0.02 rad" in paragraph_of(found)


def test_an_interrupted_trace_says_so_first() -> None:
    assert paragraph_of(replace(NULL, interrupted=True)).startswith("The trace was interrupted")
    assert "nothing is missing" not in paragraph_of(replace(NULL, interrupted=True))
    text = paragraph_of(replace(UNEXPLAINED, interrupted=True))
    assert "No effect was accepted by then; not all were tried." in text
    assert "No effect of the library" not in text


@pytest.mark.parametrize(
    ("place", "said"),
    [
        ("torque", "at the sum 'torque'"),
        ("bearing.total", "at the sum 'bearing.total'"),
        ("sensor.theta", "in the sensor of 'theta'"),
        ("drive.u", "in the drive 'u'"),
    ],
)
def test_a_place_is_called_by_what_it_is(place: str, said: str) -> None:
    assert place_words(place) == said


def test_errors_of_several_signals_are_one_in_sigma() -> None:
    one, *_ = unseen_errors(FOUND)
    other = replace(one, signal="omega", after=7 * SIGMA)
    blind = replace(one, signal="blind", sigma=0.0)
    both = in_sigma([replace(one, after=SIGMA), other, blind], "after")
    assert both == pytest.approx(5.0)
    assert math.isnan(in_sigma([], "after"))


def test_a_value_without_interval_or_unit_is_a_number() -> None:
    effect = replace(FOUND.effects[0], intervals={"level": (math.nan, math.nan)}, block="x")
    assert value_words(FOUND, effect, "level") == "level = 0.25"


def test_probabilities_are_told_as_far_as_they_mean_something() -> None:
    assert [chance_words(p) for p in (0.0, 1e-13, 0.0123, 0.4)] == [
        "p < 1e-12", "p < 1e-12", "p = 0.012", "p = 0.4"
    ]  # fmt: skip
