"""Trials: the declared diagram with effects added, fitted to windows."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from oracles.oscillator import (
    DIAGRAM,
    NOISE,
    candidates_of,
    exact,
    later,
    problem_of,
    record,
    search_of,
    trial_of,
)
from scipy.integrate import solve_ivp
from tracewire.errors import DiagramError, FitError
from tracewire.residual import Measured
from tracewire.residual.windows import Section, cut_windows
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import TraceProblem, Trial, with_fitted_starts

COULOMB = "coulomb @ force"


def rubbed(x: float, v: float) -> float:
    return -0.4 * float(np.tanh(v / 1e-3))


def test_the_declared_model_is_fitted_to_the_truth_of_its_record() -> None:
    trial = trial_of(problem_of(record()))
    assert trial.values == pytest.approx({"k": 25.0, "c": 0.2}, rel=0.05)
    assert trial.reduced_chi2 == pytest.approx(1.0, abs=0.2)
    assert trial.unknowns == 2 + 2 * len(trial.windows.segments)
    assert trial.degrees_of_freedom == trial.count - trial.unknowns


def test_what_nothing_depends_on_stays_as_it_is_declared() -> None:
    """A trace must not drop it for a term that the effects make superfluous."""
    text = DIAGRAM.replace("parameters:\n", "parameters:\n  dead: {value: 3, fit: [0, 9]}\n")
    trial = trial_of(problem_of(record(), text=text))
    assert trial.values["dead"] == 3.0
    assert [name for name in trial.values if trial.depends_on(name)] == ["k", "c"]


def test_an_effect_that_a_declared_parameter_can_make_up_for_is_undetermined() -> None:
    """Its standard error, by the pseudo-inverse, is that of the two together."""
    problem = problem_of(record(rubbed))
    known = candidates_of(problem)
    stiffness = PlacedEffect(known["stiffness @ force"], {"k": 3.0})
    coulomb = PlacedEffect(known[COULOMB], {"level": 0.4})
    trial = trial_of(problem, [stiffness, coulomb])
    assert trial.undetermined == {"k", "stiffness.k"}
    assert trial.standard_errors["stiffness.k"] < 0.05 * abs(stiffness.coefficient)


def test_an_added_effect_is_fitted_with_its_coefficient() -> None:
    problem = problem_of(record(rubbed, end=7.0))
    coulomb = PlacedEffect(candidates_of(problem)[COULOMB], {"level": 0.1})
    without, trial = trial_of(problem), trial_of(problem, [coulomb])
    (effect,) = trial.effects
    assert effect.coefficient == pytest.approx(0.4, rel=0.03)
    assert trial.values["coulomb.level"] == effect.coefficient
    assert trial.reduced_chi2 == pytest.approx(1.0, abs=0.2) and without.reduced_chi2 > 3
    assert "coulomb" in trial.diagram.blocks
    assert problem.declared.diagram.text == without.diagram.text


def test_bic_tells_an_effect_that_is_there_from_one_that_is_not() -> None:
    problem = problem_of(record(rubbed, end=7.0))
    known = candidates_of(problem)
    now = trial_of(problem)
    there = trial_of(problem, [PlacedEffect(known[COULOMB], {"level": 0.1})])
    other = trial_of(
        problem,
        [
            PlacedEffect(known[COULOMB], {"level": 0.1}),
            PlacedEffect(known["cubic_stiffness @ force"], {"k": 0.01}),
        ],
    )
    part = there.effective_fraction
    assert there.bic(part) < now.bic(part) - 100
    assert other.bic(part) > there.bic(part)


def test_an_effect_knows_the_names_of_its_unknowns() -> None:
    known = candidates_of(problem_of(record()))
    coulomb = PlacedEffect(known[COULOMB], {"level": 0.1, "width": 0.2})
    assert [coulomb.unknown(name) for name in coulomb.values] == ["coulomb.level", "coulomb.width"]
    offset = PlacedEffect(known["sensor_offset @ sensor.x"], {"offset": 0.01})
    assert offset.unknown("offset") == "offset.x"
    moved = coulomb.with_values({"coulomb.level": 0.3, "k": 9.0})
    assert moved.values == {"level": 0.3, "width": 0.2}
    sharp = coulomb.with_values({"coulomb.level": 0.3, "coulomb.width": 0.01})
    assert sharp.values["width"] == 0.0, "as narrow as that it sticks, as far as the record shows"


def test_what_is_fixed_is_not_fitted() -> None:
    problem = problem_of(record())
    segments = trial_of(problem).windows.segments
    trial = problem.fit((), segments, 60, {}, fixed={"c": 0.0})
    assert set(trial.values) == {"k"}
    assert problem.all_values(trial) == {**trial.values, "c": 0.0}
    assert problem.refit(trial, segments, 60).values == pytest.approx(trial.values, rel=1e-3)


def test_a_refit_begins_at_the_fitted_starts_of_the_same_windows() -> None:
    """A start that the samples tell may lead to another minimum: a trial of the double torsion
    pendulum left 92 times as much on one of the windows that it had been fitted to."""
    m = record()
    problem = problem_of(m)
    trial = trial_of(problem)
    fitted = trial.windows.segments
    far = [replace(s, start={**s.start, "v": 9e9}) for s in fitted]
    assert [s.start for s in with_fitted_starts(far, trial)] == [s.start for s in fitted]
    assert problem.refit(trial, far, 60).rss == pytest.approx(trial.rss, rel=1e-6)
    held = [replace(s, free=("x",)) for s in far]
    assert all(s.start["v"] == 9e9 for s in with_fitted_starts(held, trial)), "v is not free"
    others = cut_windows(problem.declared, Section(m, 7, 270), 90, problem.states)
    assert with_fitted_starts(others, trial) == others, "they begin at other times"


def test_on_other_windows_only_the_starts_are_fitted() -> None:
    m = record()
    problem = problem_of(m)
    trial = trial_of(problem)
    other = problem.criterion_on(
        trial, cut_windows(problem.declared, Section(m, 90, 270), 90, problem.states)
    )
    assert other.unknowns == () and other.parameters == trial.values
    residuals = problem.residuals_on(
        trial, cut_windows(problem.declared, Section(m, 90, 270), 90, problem.states)
    )
    assert np.mean(np.concatenate(residuals) ** 2) == pytest.approx(1.0, abs=0.3)
    shifted = later(m, slice(90, 270), 0.05)
    worse = problem.residuals_on(
        trial, cut_windows(problem.declared, Section(shifted, 90, 270), 90, problem.states)
    )
    assert np.mean(np.concatenate(worse) ** 2) > 10, "an offset is no start"


def test_a_diagram_that_does_not_run_is_told_with_its_block() -> None:
    text = DIAGRAM.replace("k: -k}", "k: -k/(c - c)}")
    with pytest.raises(FitError, match="'spring' is not finite"):
        trial_of(problem_of(record(end=3.0), text=text))


def test_a_refit_of_what_does_not_run_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    def fit(*_: object, **__: object) -> Trial:
        raise FitError.one("'spring' is not finite")

    problem = problem_of(record(end=3.0))
    trial = trial_of(problem)
    again = problem.try_refit(trial)
    assert again is not None and again.length == trial.length
    assert again.values == pytest.approx(trial.values, rel=1e-3)
    monkeypatch.setattr(TraceProblem, "fit", fit)
    assert problem.try_refit(trial) is None
    with pytest.raises(FitError, match="'spring' is not finite"):
        problem.refit(trial)


def test_a_model_that_takes_too_many_events_is_given_up() -> None:
    """It rattles between two stops a thousandth apart, far more often than it is sampled."""
    text = DIAGRAM + (
        "events:\n"
        "  - {when: x - 0.5, crosses: both, set: {v: 1000 + 0*v}}\n"
        "  - {when: x - 0.501, crosses: both, set: {v: -1000 + 0*v}}\n"
    )
    with pytest.raises(FitError, match="more than 305 events"):
        trial_of(problem_of(record(end=3.0), text=text))


def test_a_record_in_pieces_far_apart_is_fitted_over_its_gaps() -> None:
    """Between the pieces, each of 1 s, the run takes more steps than four short pieces would."""
    t = (np.arange(0.0, 240.0, 60.0)[:, None] + np.arange(0.0, 1.0, 0.03)).ravel()
    fine = np.arange(0.0, 181.02, 0.03)
    x = np.interp(t, fine, exact(fine, 25.0, 0.01, (1.0, 0.0)))
    pieces = replace(record(end=3.0), t=t, values={"x": x})
    problem = problem_of(pieces, sigma=0.01)
    whole = problem.windows_on(
        trial_of(problem, length=len(t)),
        cut_windows(problem.declared, Section(pieces, 0, len(t)), len(t), problem.states),
    )
    assert whole.segments[0].time_in_samples > 40 * len(t)


def test_a_delay_is_found_on_short_windows_too() -> None:
    """A window's first samples show what was before it: its run begins earlier."""
    delay, t = 0.047, np.arange(0.0, 12.0, 0.03)
    drive = "3*sin(2*t) + 2*sin(5.3*t)"

    def rates(t: float, state: np.ndarray) -> list[float]:
        x, v = state.tolist()
        return [v, 3 * math.sin(2 * t) + 2 * math.sin(5.3 * t) - 25 * x - 0.2 * v]

    run = solve_ivp(rates, (-1, 12), [1.0, 0.0], rtol=1e-10, atol=1e-11, dense_output=True)
    x = run.sol(t - delay)[0] + NOISE * np.random.default_rng(3).standard_normal(len(t))
    m = Measured("swing", "train", t, {"x": x}, start={"x": None, "v": None})
    text = DIAGRAM.replace("spring, damper]", "spring, damper, drive]").replace(
        "  damper:", f"  drive: {{type: expression, formula: {drive}}}\n  damper:"
    )
    problem = problem_of(m, text=text)
    late = PlacedEffect(candidates_of(problem)["sensor_delay @ sensor.x"], {"delay": 0.7 * delay})
    trial = trial_of(problem, [late], length=20)
    assert trial.values["delay.x"] == pytest.approx(delay, rel=0.02)
    assert trial.reduced_chi2 == pytest.approx(1.0, abs=0.2)
    begins = [window.begin for window in trial.windows.segments]
    assert all(b < w.t[0] - delay for b, w in zip(begins, trial.windows.segments, strict=True))


def test_where_the_text_has_no_room_for_an_effect_none_is_tried() -> None:
    """What a search finds is written into the text at its end."""
    folded = "force:\n    type: sum\n    of: >\n      spring"
    text = DIAGRAM.replace("force: {type: sum, of: [spring, damper]}", folded)
    problem = problem_of(record(end=3.0), text=text)
    for name in ("coulomb @ force", "bias @ force"):
        effect = candidates_of(problem)[name]
        with pytest.raises(DiagramError, match="laid out here in a way that cannot be edited"):
            trial_of(problem, [PlacedEffect(effect, {effect.parameter: 0.1})])
    assert [*problem.unwritable] == ["force"], "the text is tried once"


def test_a_sum_of_a_row_is_told_and_no_end_of_a_search() -> None:
    """It is no place; where a candidate is there all the same, its change is refused."""
    text = DIAGRAM.replace("of: [spring, damper]}", "of: [spring, damper], replicate: 1}")
    problem = problem_of(record(end=6.0), text=text.replace("of: force", "of: force_1"))
    search = search_of(problem)
    now = search.fit_declared()
    assert "coulomb @ force_1" not in candidates_of(problem)
    plain = candidates_of(problem_of(record(end=6.0), text=DIAGRAM))["coulomb @ force"]
    place = replace(plain.place, name="force_1", definition="force_1")
    coulomb = PlacedEffect(replace(plain, place=place), {"level": 0.1})
    refit = search.refits.prepare(now, [coulomb], now.windows.segments)
    assert search.refits.run(now, [refit]) == [None]
    assert "coulomb @ force_1 was not tried: block 'force_1' is one of the row" in search.words[0]
