"""The paragraph of a trace says in plain words what was found, how sure it is, and what is open."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from show.traces import FOUND, NULL, SIGMA, TEXT, UNEXPLAINED, errors, missing_of_two
from tracewire.diagram import read_text
from tracewire.show.trace_experiments import experiment_words, setting_unit, settings_words
from tracewire.show.trace_summary import (
    details_of,
    headline_of,
    limits_words,
    open_words,
    paragraph_of,
    rest_words,
    ties_words,
)
from tracewire.show.trace_tables import power_table
from tracewire.show.trace_text import answer_lines
from tracewire.show.trace_words import (
    chance_words,
    excess_words,
    in_sigma,
    missing_places,
    percent,
    place_words,
    share_words,
    to_its_interval,
    told_once,
    unseen_errors,
    value_words,
)
from tracewire.trace.found import Dependence, Explained, FoundEffect, HeldOut, Power, Remainder, Tie
from tracewire.trace.options import TraceOptions
from tracewire.trace.units import users_unit

EXPLAINED = replace(
    FOUND,
    explained=Explained(0.98, 0.96, 0.99),
    remainder=(Remainder("theta", "rad", 0.005, 1.25, 0.04, 0.0045),),
    remainder_depends=(Dependence("torque", ("q", "v"), 0.35),),
)


def test_the_headline_has_effect_place_value_share_and_error_in_the_unit_of_the_signal() -> None:
    assert headline_of(EXPLAINED) == (
        "The diagram lacks 'coulomb' at the sum 'torque', level = 0.2500 N m (95 %: 0.2430 to "
        "0.2570); it explains 98 % (95 % interval: 96 to 99 %) of the excess error and leaves 4 % "
        "of the rms error on held-out blocks, and on unseen data the error of free runs falls for "
        "theta from 0.184 to 0.00408 rad."
    )
    assert paragraph_of(EXPLAINED).startswith(headline_of(EXPLAINED))


def test_a_headline_without_a_floor_or_unseen_data_claims_neither() -> None:
    bare = headline_of(replace(FOUND, errors=errors(validated=False)))
    assert bare.endswith("level = 0.2500 N m (95 %: 0.2430 to 0.2570).")
    told = paragraph_of(replace(FOUND, errors=errors(validated=False)))
    assert "No data were kept back for a final test." in told
    assert "excess" not in told


def test_an_error_that_rises_is_not_said_to_fall() -> None:
    assert "rises for theta from 0.184 to 0.8 rad" in headline_of(
        replace(FOUND, errors=errors(after=200.0))
    )


def test_two_effects_explain_together() -> None:
    two = replace(EXPLAINED, effects=(*FOUND.effects, replace(FOUND.effects[0], name="bias")))
    assert "(95 %: 0.2430 to 0.2570) and 'bias' at the sum" in headline_of(two)
    assert "together they explain 98 %" in headline_of(two)


def test_the_error_is_told_in_the_unit_of_the_users_file(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("t,a\n0,0\n1,0\n", encoding="utf-8")
    text = TEXT + (
        "measured:\n  swing_3: {file: a.csv, time: t,"
        " signals: {theta: {column: a, unit: deg}}, start: {theta: 0}}\n"
    )
    found = replace(FOUND, original=read_text(text, tmp_path / "swing.yaml"))
    assert users_unit(found, "theta") == ("deg", pytest.approx(math.radians(1)))
    assert "for theta from 10.5 to 0.234 deg" in headline_of(found)
    assert users_unit(FOUND, "theta") == ("rad", 1.0)


def test_the_details_have_the_fit_the_meaning_and_what_remains() -> None:
    text = " ".join(details_of(EXPLAINED))
    assert text.startswith(
        "'Swing & rest' was first fitted to 'swing_1' as it stands: it leaves a residual of 9 σ"
    )
    assert "'coulomb': dry friction of one level, which holds" in text
    assert "With it in the diagram, and all free parameters refitted, 1 σ are left." in text
    assert "remain: 0.005 rad of theta (1.25 σ, 4 % of the rms error before)." in text
    assert (
        "A smooth function of the coordinate theta and the rate omega at the sum 'torque' explains "
        "35 %" in text
    )


def test_the_rest_at_another_place_is_told_where_it_explains_as_much() -> None:
    shares = [("sensor.theta", "t", 0.71), ("torque", "t", 0.69), ("torque", "q", 0.68)]
    depends = tuple(Dependence(place, (name,), share) for place, name, share in shares)
    assert rest_words(replace(EXPLAINED, remainder_depends=depends)) == (
        "A smooth function of the time t in the sensor of 'theta' explains 71 % of that, and one "
        "of the time t at the sum 'torque' 69 %"
    )
    far = (depends[0], replace(depends[1], share=0.5))
    said = rest_words(replace(EXPLAINED, remainder_depends=far))
    assert said.endswith("explains 71 % of that")
    assert rest_words(replace(EXPLAINED, remainder_depends=())) == ""


def test_ties_and_the_experiment_that_separates_them_are_told() -> None:
    text = paragraph_of(FOUND)
    assert (
        "cannot tell 'coulomb' from 'bias' at the sum 'torque' (1 fitted number fewer) or" in text
    )
    assert "To decide between coulomb @ torque and bias @ torque: release it from rest at" in text


def test_an_experiment_is_told_with_what_else_was_searched() -> None:
    one = FOUND.experiments[0]
    rows = ({"F amplitude": 2, "F frequency": 3, "separation": 4.0},
            {"F amplitude": 1, "F frequency": 3, "separation": 1.5},
            {"start.theta": 1, "separation": 0.1})  # fmt: skip
    settings = {"F amplitude": 2, "F frequency": 3}
    driven = replace(one, settings=settings, separation=4.0, map=rows, words="Drive it. By 4.")
    assert experiment_words(FOUND, driven) == (
        "Drive it. By 4 (by 1.5 to 4 at the settings that were searched)."
    )
    blunt = replace(one, separation=0.3, words="No experiment within reach tells them apart")
    assert experiment_words(FOUND, blunt) == "No experiment within reach tells them apart."


def test_settings_have_the_units_of_the_users_files() -> None:
    found = replace(
        FOUND, units={**FOUND.units, "F": "N"}, users_units={"theta": ("deg", math.pi / 180)}
    )
    settings = {"start.theta": math.pi / 6, "F mean": 1.0, "F amplitude": 2.0, "F frequency": 3.0}
    assert settings_words(found, settings) == (
        "start.theta = 30 deg, F mean = 1 N, F amplitude = 2 N, F frequency = 3 Hz"
    )
    assert settings_words(found, {"F held": 0.25}) == "F held = 0.25 N"
    assert [setting_unit(found, name) for name in settings] == ["rad", "N", "N", "Hz"]


def test_a_tie_is_told_once() -> None:
    twice = replace(FOUND.effects[0], ties=(*FOUND.effects[0].ties, *FOUND.effects[0].ties))
    assert ties_words(twice) == ties_words(FOUND.effects[0])


def test_an_error_far_below_the_noise_is_none() -> None:
    still = replace(FOUND, errors=errors(after=1e-14))
    assert "falls for theta from 0.184 to 0 rad" in headline_of(still)
    assert in_sigma(unseen_errors(still), "after") == 0.0


def test_what_declared_parameters_had_absorbed_is_told() -> None:
    text = paragraph_of(FOUND)
    assert text.endswith(
        "A fitted parameter had absorbed part of the missing effect: "
        "'c' moves from 0.3 to 0.051 N m s/rad."
    )
    assert "'k'" not in text  # it moved by one standard error
    far = replace(FOUND, moved=tuple(replace(m, after=9.0, error=1.0) for m in FOUND.moved))
    assert (
        "Fitted parameters had absorbed part of the missing effect: 'k' moves from 4.01 to 9 N "
        "m/rad (5 standard errors) and 'c'" in paragraph_of(far)
    )
    assert paragraph_of(far).endswith(
        "'k' is 2.2 times as large and 'c' is 30 times as large with what was found: is that "
        "possible? Fix what you know better, and trace again."
    )


def test_growth_from_a_bound_is_not_doubted() -> None:
    """On its bound the declared value said nothing that a larger one could contradict."""
    held = replace(FOUND.moved[1], before=0.01, after=0.3, at_bound=True)
    assert "is that possible" not in paragraph_of(replace(FOUND, moved=(held,)))
    assert "is that possible" in paragraph_of(
        replace(FOUND, moved=(replace(held, at_bound=False),))
    )


def test_a_parameter_that_comes_back_to_its_declared_value_is_not_doubted() -> None:
    """The fit without the effects had taken it away from there."""
    back = replace(FOUND.moved[1], before=0.003, after=0.51, declared=0.5)
    assert "is that possible" not in paragraph_of(replace(FOUND, moved=(back,)))
    beyond = replace(back, declared=0.2)
    assert "is that possible" in paragraph_of(replace(FOUND, moved=(beyond,)))


def test_a_parameter_that_went_to_zero_is_told() -> None:
    text = paragraph_of(replace(FOUND, dropped=("c",)))
    assert text.endswith(
        "'c' is left out, as 0: beside the effects the data do not need it, and the intervals "
        "suppose that."
    )
    assert "absorbed" not in text  # 'c' is told once


def test_nothing_missing_is_told_with_what_would_have_been_seen() -> None:
    text = paragraph_of(NULL)
    assert text.startswith("Nothing is missing that these data could show; on unseen data a free")
    assert "is wrong by 0.00408 rad in theta (1.02 σ)." in text
    assert "would have shown, for example, coulomb at the sum 'torque' from level = 0.0021 N m" in (
        text
    )
    assert "absorbed" not in text


def test_a_null_far_from_the_noise_says_what_that_may_be() -> None:
    far = replace(NULL, s2_before=25.0, s2_after=25.0)
    assert "a residual of 5 σ" in paragraph_of(far)
    assert "It is more than the noise that was assumed" in paragraph_of(far)
    assert "more than the noise" not in paragraph_of(NULL)


def test_a_sensor_that_explains_hardly_more_than_a_sum_does_not_lead() -> None:
    """Nobody believes that an encoder bends: a sensor imitates what a sum does."""
    assert UNEXPLAINED.missing is not None
    of_sensor = replace(UNEXPLAINED.missing, place="sensor.theta", variables=("y",), share=0.70)
    shares = {"sensor.theta": ("y", 0.70), "torque": ("q", 0.62), "drive.u": ("u", 0.35)}
    near = tuple(Dependence(place, (name,), share) for place, (name, share) in shares.items())
    found = replace(UNEXPLAINED, missing=of_sensor, dependences=near)
    told = (
        "at the sum 'torque' or in the sensor of 'theta', which this record cannot tell apart; at "
        "the sum 'torque' it depends on the coordinate theta (62 % of the excess"
    )
    assert paragraph_of(found).startswith(f"Something is missing {told} error); no effect")
    assert answer_lines(found)[0].startswith(f"VERDICT unexplained: something is missing {told}; ")
    far = replace(found, missing=replace(of_sensor, share=0.95))
    assert "missing in the sensor of 'theta' that depends on the signal theta" in paragraph_of(far)


def test_of_several_sums_the_best_leads() -> None:
    assert UNEXPLAINED.missing is not None
    shares = {"sensor.theta": 0.71, "arm": 0.66, "torque": 0.70, "far": 0.59}
    near = tuple(Dependence(place, ("q",), share) for place, share in shares.items())
    best = replace(UNEXPLAINED.missing, share=0.70)
    found = replace(UNEXPLAINED, missing=best, dependences=near)
    assert missing_places(found) == ["torque", "arm", "sensor.theta"]


def test_what_nothing_explains_is_told_with_place_and_variables() -> None:
    text = paragraph_of(UNEXPLAINED)
    assert text.startswith(
        "Something is missing at the sum 'torque' that depends on the coordinate theta (97 % of "
        "the excess error); no effect of the library explains it, and on unseen data a free run is "
        "wrong by 0.00408 rad in theta."
    )
    both = paragraph_of(replace(UNEXPLAINED, missing=missing_of_two()))
    assert "depends on the coordinate theta and the rate omega" in both
    nowhere = paragraph_of(replace(UNEXPLAINED, missing=None))
    assert nowhere.startswith("Something is missing, and its place is not known; no effect")
    assert "depends on nothing that was tried: it may be a random disturbance" in nowhere
    assert "random disturbance" not in text
    assert UNEXPLAINED.missing is not None
    little = paragraph_of(replace(UNEXPLAINED, missing=replace(UNEXPLAINED.missing, share=0.31)))
    assert "The rest depends on no variable that was tried" in little
    assert "process noise" in little


@pytest.mark.parametrize(("share", "told"), [(0.83, False), (0.35, True)])
def test_a_rest_that_a_variable_explains_is_not_said_to_depend_on_none(
    share: float, told: bool
) -> None:
    assert UNEXPLAINED.missing is not None
    found = replace(
        UNEXPLAINED,
        effects=FOUND.effects,
        missing=replace(UNEXPLAINED.missing, share=0.24),
        remainder_depends=(Dependence("sensor.theta", ("y",), share),),
    )
    assert ("depends on no variable that was tried" in open_words(found)) is told


def test_a_parameter_that_moves_by_less_than_a_hundredth_absorbed_nothing() -> None:
    slightly = replace(FOUND.moved[0], before=4.01, after=4.0, error=1e-4)
    assert slightly.significant
    assert "absorbed" not in paragraph_of(replace(FOUND, moved=(slightly,)))


def test_a_partial_approximation_is_not_called_an_explanation() -> None:
    partial = replace(
        UNEXPLAINED, effects=FOUND.effects, s2_after=16.0, explained=Explained(0.3, 0.1, 0.5)
    )
    partial = replace(partial, reason="a model with it leaves a half")
    text = paragraph_of(partial)
    assert "The best approximation is 'coulomb' at the sum 'torque', level = 0.2500 N m" in text
    assert "4 σ are left. That is not enough." in text
    assert "; the best approximation is not enough: a model with it leaves a half." in text
    assert "It explains 30 % (95 % interval: 10 to 50 %) of the excess error." in text
    assert "The diagram lacks" not in text


def test_an_excess_that_is_a_small_part_of_the_error_is_told_to_be_so() -> None:
    """The best smooth force leaves 58 % of the error: the effects take all that it could take."""
    blocks = np.ones(8)
    held = HeldOut(1.0, ("a",) * 8, blocks, 10 * blocks, 5.8 * blocks, 5.8 * blocks)
    found = replace(
        EXPLAINED, explained=Explained(0.99999, 0.99999, 1.0), held_out=(held,),
        remainder=(Remainder("theta", "rad", 0.1, 6.0, 0.58, 0.1),),
    )  # fmt: skip
    whole = (
        "> 99.99 % of the error that a smooth force could take away (42 % of the rms error on "
        "held-out blocks)"
    )
    assert f"it explains {whole} and leaves 58 % of the rms error" in headline_of(found)
    assert f"  explained: {whole}" in answer_lines(found)
    assert f"It explains {whole}." in paragraph_of(replace(found, verdict="unexplained"))
    assert "The excess error is" not in paragraph_of(found)
    near = replace(held, floor=2 * blocks)
    assert excess_words(replace(found, held_out=(near,))) == "> 99.99 % of the excess error"
    useless = replace(held, floor=11 * blocks)
    assert "(none of the error on" in excess_words(replace(found, held_out=(useless,)))


def test_a_residual_that_depends_on_nothing_gets_a_next_step() -> None:
    text = paragraph_of(replace(UNEXPLAINED, missing=None))
    assert "it may be a random disturbance" in text
    assert "or a law that depends on the time or on a drive. Do the same run twice" in text


def test_the_effect_of_a_sensor_is_called_by_what_it_does() -> None:
    effect = FoundEffect(
        "sensor_offset", "sensor.theta", {"offset": 0.02}, (Tie("bias", "torque", 0.999),)
    )
    found = replace(FOUND, effects=(effect,), units={"offset.theta": "rad"})
    assert "lacks an offset in the sensor of 'theta', offset = 0.02 rad" in paragraph_of(found)
    degrees = replace(found, users_units={"theta": ("deg", math.radians(1))})
    assert "offset = 1.146 deg" in paragraph_of(degrees)


def test_what_would_have_been_seen_of_a_sensor_is_in_the_unit_of_its_column() -> None:
    powers = (
        Power("sensor_offset", "sensor.theta", "offset.theta", math.radians(0.5)),
        Power("sensor_quad", "sensor.theta", "quad.theta", math.degrees(0.25)),
    )
    own = {"theta": ("deg", math.radians(1))}
    found = replace(NULL, power=powers, users_units=own)
    rows = [row[2:] for row in power_table(found).rows]
    assert rows == [("offset", "0.5", "deg"), ("quad", "0.25", "1/deg")]
    assert "sensor_offset @ sensor.theta offset = 0.5 deg" in " ".join(answer_lines(found))


def test_an_interrupted_trace_says_so_first() -> None:
    assert paragraph_of(replace(NULL, interrupted=True)).startswith("The trace was interrupted")
    assert "Nothing is missing" not in paragraph_of(replace(NULL, interrupted=True))
    text = paragraph_of(replace(UNEXPLAINED, interrupted=True))
    assert "no effect was accepted by then" in text
    assert "no effect of the library" not in text


def test_what_the_user_asked_for_is_told() -> None:
    asked = TraceOptions(
        only=("torque", "drive.u"), without=("cogging",), effects=1, horizon=2.5, budget=60
    )
    assert limits_words(asked) == (
        "Limits of this search: effects were tried only at 'torque' and 'drive.u', 'cogging' was "
        "not tried, at most 1 effect could be added, models were compared over 2.5 s and the "
        "search had a budget of 60 s."
    )
    assert paragraph_of(replace(FOUND, options=asked)).endswith(limits_words(asked))
    assert limits_words(TraceOptions()) == ""


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
    effect = replace(FOUND.effects[0], intervals={"level": (math.nan, math.nan)}, name="own")
    found = replace(FOUND, units={})
    assert value_words(found, effect, "level") == "level = 0.25"


@pytest.mark.parametrize(
    ("value", "low", "high", "shown"),
    [
        (1.19970, 1.19952, 1.19988, ("1.19970", "1.19952", "1.19988")),
        (0.1479, 0.1467, 0.1491, ("0.1479", "0.1467", "0.1491")),
        (12345.6, 12000.0, 12700.0, ("12350", "12000", "12700")),
        (0.0, -0.1, 0.1, ("0", "-0.10", "0.10")),
        (3e-7, 2e-7, 4e-7, ("3.0e-07", "2.0e-07", "4.0e-07")),
        (1.0, 1.0, 1.0, ("1", "1", "1")),
    ],
)
def test_a_value_has_so_many_digits_that_its_interval_is_seen(
    value: float, low: float, high: float, shown: tuple[str, str, str]
) -> None:
    assert to_its_interval(value, low, high) == shown


def test_a_share_that_is_not_all_is_not_called_100_percent() -> None:
    assert [percent(x) for x in (0.0, 0.001, 0.62, 0.994, 0.9999, 1.0, math.nan)] == [
        "0 %", "< 0.5 %", "62 %", "99 %", "> 99.5 %", "100 %", ""
    ]  # fmt: skip
    assert share_words(Explained(0.9991, 0.9988, 0.9994)) == (
        "99.91 % (95 % interval: 99.88 to 99.94 %)"
    )
    assert share_words(Explained(0.997, 0.98, 1.0)) == "> 99.5 % (95 % interval: 98 to 100 %)"
    assert share_words(Explained(1.0, 0.99999, 1.00001)) == "> 99.99 %"
    assert share_words(Explained(-0.86, -3.1, 1.0)) == "0 % (95 % interval: 0 to 100 %)"
    assert share_words(Explained(0.62, 0.62, 0.62)) == "62.00 %"


def test_a_remark_of_several_series_is_told_once() -> None:
    words = ["the last sixth of 'a' is held back", "the last sixth of 'b' is held back",
             "a: x shows nothing above its noise", "'c' is odd", "a general remark"]  # fmt: skip
    assert told_once(words, ["a", "b"]) == (
        "the last sixth of 'a' and 'b' is held back",
        "a: x shows nothing above its noise",
        "'c' is odd",
        "a general remark",
    )
    assert told_once(words, ["a", "b", "c"])[2] == "'c' is odd"


def test_probabilities_are_told_as_far_as_they_mean_something() -> None:
    assert [chance_words(p) for p in (0.0, 1e-13, 0.0123, 0.4)] == [
        "p < 1e-12", "p < 1e-12", "p = 0.012", "p = 0.4"
    ]  # fmt: skip
