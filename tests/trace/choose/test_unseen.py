"""Effects that unseen data do not confirm are left out, beside those that they do."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from tracewire.residual import Section
from tracewire.trace.choose import prediction as preference
from tracewire.trace.choose import safeguards, unseen, verdict
from tracewire.trace.choose.choice import Entrant, choose, log_scores
from tracewire.trace.choose.prediction import Prediction
from tracewire.trace.choose.unseen import (
    better_unseen,
    describe_better_unseen,
    is_no_better_on_claim,
    lowers_unseen,
    prune_by_other_runs,
    raises_unseen,
    raises_whole_runs,
    share_of_whole_runs,
    simplify_by_unseen,
)
from tracewire.trace.options import TraceOptions
from tracewire.trace.search.refinement import FinalModels

BLOCKS = 8
DRY, DRIFT = "coulomb @ forces", "sensor_drift @ sensor.v"
CURVE, OFFSET = "stribeck @ forces", "sensor_offset @ sensor.v"
HELD_OUT = {(): 100.0, (DRY,): 4.0, (DRIFT,): 60.0, (DRY, DRIFT): 2.0}
"""The mean squared residual on held-out blocks of the fitted record, by the effects of a model."""


def prediction(
    held_out: dict[tuple[str, ...], float] = HELD_OUT,
    numbers: dict[str, int] | None = None,
    imitated: dict[str, str] | None = None,
) -> Prediction:
    """Models with so much left on held-out blocks, of which the best is chosen; effects have one
    number where none is given."""

    def count(names: tuple[str, ...]) -> int:
        return 2 + sum((numbers or {}).get(name, 1) for name in names)

    def imitates(names: tuple[str, ...]) -> frozenset[str]:
        return frozenset(other for name, other in (imitated or {}).items() if name in names)

    options, rng = TraceOptions(), np.random.default_rng(1)
    ripple = 1 + 0.1 * rng.random((len(held_out), 1, 1, BLOCKS, 1))
    errors = ripple * np.reshape(list(held_out.values()), (-1, 1, 1, 1, 1))
    entrants = tuple(
        Entrant(frozenset(names), count(names), imitated=imitates(names)) for names in held_out
    )
    models: Any = tuple(
        SimpleNamespace(names=frozenset(names), trials=[names], numbers=count(names), dropped=())
        for names in held_out
    )
    groups = (tuple((block,) for block in range(BLOCKS)),)
    horizons: Any = SimpleNamespace(each=[SimpleNamespace(length=100)], groups=groups)
    screen: Any = None
    choice = choose(entrants, log_scores(errors), groups, options)
    return Prediction(horizons, models, errors, choice, screen, entrants, options)


class Problem(SimpleNamespace):
    """What models leave in windows, whose starts are not free, is given as `residuals_on`."""

    def windows_on(self, names: Any, windows: Any) -> Any:
        residuals = self.residuals_on(names, windows)
        squares = np.array([float(np.sum(r**2)) for r in residuals])
        return SimpleNamespace(squares=squares, residuals=residuals, starts=[{}] * len(residuals))


def search(left: dict[tuple[str, ...], float], other_runs: tuple[str, ...] = ("cold",)) -> Any:
    """A search with another run of one window, where each model leaves so much."""
    series = SimpleNamespace(other_runs=other_runs)
    problem = Problem(residuals_on=lambda names, windows: [np.full(5, left[names])])
    return SimpleNamespace(
        data_split=series, problem=problem, words=[], windows=lambda sections, length: sections
    )


def test_an_effect_that_lowers_the_unseen_error_stays() -> None:
    """Both effects lower the error, each beside the other."""
    before = prediction()
    assert before.chosen.names == {DRY, DRIFT}
    there = search({(DRY,): 1.5, (DRIFT,): 9.0, (DRY, DRIFT): 1.4})
    assert prune_by_other_runs(there, before) is before
    assert not there.words


@pytest.mark.parametrize("left", [1.6, 1.8])
def test_an_effect_that_does_not_is_left_out_and_told(left: float) -> None:
    """The drift fits the record and not another one; no model with it ties with the rest."""
    there = search({(DRY,): 1.6, (DRIFT,): 9.0, (DRY, DRIFT): left})
    found = prune_by_other_runs(there, prediction())
    assert found.chosen.names == {DRY}
    assert found.choice.sure
    assert not found.choice.ties
    (words,) = there.words
    factor = f"{left / 1.6:.3g}"
    assert words == (
        f"{DRIFT} is not named beside {DRY}: on another run, in windows of 100 samples, that"
        f" multiplies the error by {factor}"
    )


def test_the_end_of_the_same_run_does_not_decide() -> None:
    """There the blocks that were held out do: a swing that dies away is another motion at last."""
    before = prediction()
    there = search({(DRY,): 1.6, (DRIFT,): 9.0, (DRY, DRIFT): 1.8}, other_runs=())
    assert prune_by_other_runs(there, before) is before
    assert not there.words


def test_the_declared_model_is_never_refused() -> None:
    """Not with a model of the same effects, that lacks a declared term."""
    again = prediction().choose_again([frozenset({DRY, DRIFT}), frozenset({DRY}), frozenset()])
    assert again.chosen.names == {DRIFT}
    assert np.isfinite(again.choice.gain)


WHOLE = 400


class Names(tuple[str, ...]):
    """A model by the names of its effects, fitted to whole runs."""

    length = WHOLE

    @property
    def effects(self) -> Names:
        return self


def run_of(left: dict[tuple[str, ...], float]) -> Any:
    """A search with one unseen run of a sine of 1000 sigma, in which a model leaves so many."""
    wave = 1000 * np.sin(np.linspace(0, 20, WHOLE))
    measured: Any = SimpleNamespace(values={"x": wave})
    section = Section(measured, 0, WHOLE)
    problem = Problem(
        residuals_on=lambda names, windows: [np.full(WHOLE, left[names])], sigma={"x": 1.0}
    )
    return SimpleNamespace(
        data_split=SimpleNamespace(unseen=[section], validate=[section]),
        problem=problem,
        windows=lambda sections, length: [length],
        whole_windows=lambda sections: [section.count for section in sections],
        options=TraceOptions(),
        refit_precisely=lambda trial: trial,
    )


@pytest.mark.parametrize(("left", "better"), [(30.0, True), (47.0, False), (70.0, False)])
def test_another_effect_that_does_better_on_unseen_runs_is_told(left: float, better: bool) -> None:
    """The chosen one leaves 50 sigma there; a tenth less may be chance."""
    drag = ("quad_drag @ forces",)
    there, found = run_of({(DRY,): 50.0, drag: left}), prediction({(): 100, (DRY,): 4, drag: 16})
    there.words = []
    assert found.chosen.names == {DRY}
    assert better_unseen(there, found) == ({2: pytest.approx(0.6)} if better else {})


def test_what_does_better_on_unseen_runs_alone_is_told() -> None:
    drag = "quad_drag @ forces"
    assert describe_better_unseen(prediction({(): 100, (DRY,): 4, (drag,): 16}), 2, 0.6) == (
        f"{drag} predicts held-out blocks less well than {DRY}, but leaves 0.6 times its error in"
        " whole unseen runs: these data do not decide between them"
    )


@pytest.mark.parametrize(
    ("left", "imitated", "named"),
    [(30.0, True, DRY), (47.0, True, CURVE), (30.0, False, CURVE)],
)
def test_the_simpler_law_is_named_where_unseen_runs_are_for_it(
    left: float, imitated: bool, named: str
) -> None:
    """A Stribeck curve fits the record better; what it imitates leaves less in another run."""
    found = prediction(
        {(): 100, (CURVE,): 4, (DRY,): 16}, {CURVE: 2}, {CURVE: DRY} if imitated else {}
    )
    assert found.chosen.names == {CURVE}
    there = run_of({(CURVE,): 50.0, (DRY,): left})
    there.words = []
    simpler = simplify_by_unseen(there, found)
    assert simpler.chosen.names == {named}
    if named == CURVE:
        assert not there.words
        return
    assert [simpler.models[number].names for number, _ in simpler.choice.ties] == [{CURVE}]
    assert there.words == [
        f"{CURVE} predicts held-out blocks better than {DRY}, which is simpler and leaves 0.6 times"
        " its error in whole unseen runs"
    ]


def test_what_has_a_number_more_and_does_better_on_unseen_runs_is_told() -> None:
    found = prediction({(): 100, (DRY,): 3.1, (CURVE,): 3}, {CURVE: 2})
    assert found.chosen.names == {DRY}
    assert describe_better_unseen(found, 2, 0.4) == (
        f"{CURVE} has more fitted numbers than {DRY}, and leaves 0.4 times its error in whole"
        " unseen runs: these data do not decide between them"
    )


@pytest.mark.parametrize(
    ("left", "unsigned", "named"),
    [(20.001, 0, DRY), (20.1, 0, OFFSET), (20.001, 1, OFFSET)],
)
def test_of_two_forms_of_one_model_that_with_a_physical_sign_is_named(
    left: float, unsigned: int, named: str
) -> None:
    """The offset of a speed and a dry friction where a wheel turns one way."""
    found = prediction({(): 100, (OFFSET,): 4, (DRY,): 6})
    assert found.chosen.names == {OFFSET}
    declared, offset, dry = found.models
    rss = {id(declared): 100.0, id(offset): 20.0, id(dry): left}
    models: Any = tuple(
        SimpleNamespace(**{**vars(m), "trials": [SimpleNamespace(rss=rss[id(m)])]})
        for m in found.models
    )
    entrants = (
        found.entrants[0],
        replace(found.entrants[1], unsigned=1),
        replace(found.entrants[2], unsigned=unsigned),
    )
    other = replace(found, models=models, entrants=entrants).preferring_signs()
    assert other.chosen.names == {named}
    if named == DRY:
        assert [other.models[number].names for number, _ in other.choice.ties] == [{OFFSET}]


@pytest.mark.parametrize(("on", "named"), [((CURVE,), DRY), ((), CURVE), ((CURVE, DRY), CURVE)])
def test_a_law_on_its_upper_bound_gives_way_to_a_tie(
    on: tuple[str, ...], named: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(preference, "upper_shapes", lambda names: set(names) & {*on})
    found = prediction({(): 100, (DRIFT, CURVE): 4, (DRIFT, DRY): 4.3}, {CURVE: 2}).exchanging(1)
    assert found.preferring_inner_shapes().chosen.names == {DRIFT, named}


def test_a_start_led_astray_refuses_no_model(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the other model begins, this one would leave as little."""
    fewer: Any = Names(())
    more: Any = Names((DRY,))
    there = run_of({(): 10.0, (DRY,): 40.0})
    harm = raises_unseen(there, fewer, more, [WHOLE])
    assert harm == f"multiplies the error on unseen windows of {WHOLE} samples by 4"

    def begin_anew(windows: Any, others: Any) -> Any:
        return SimpleNamespace(squares=np.minimum(windows.squares, others.squares))

    monkeypatch.setattr(unseen, "restart_from_others", begin_anew)
    assert raises_unseen(there, fewer, more, [WHOLE]) == ""


def test_a_rival_that_is_worse_in_windows_is_not_told() -> None:
    drag = ("quad_drag @ forces",)
    there, found = run_of({}), prediction({(): 100, (DRY,): 4, drag: 16})
    left = {(DRY, WHOLE): 50.0, (drag[0], WHOLE): 30.0, (DRY, 100): 2.0, (drag[0], 100): 3.0}
    there.problem.residuals_on = lambda names, windows: [np.full(WHOLE, left[names[0], windows[0]])]
    there.words = []
    assert better_unseen(there, found) == {}


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        (50.0, 40.0, ""),
        (50.0, 50.5, ""),  # by chance
        (50.0, 60.0, "multiplies the error of whole unseen runs by 1.2"),
        (600.0, 900.0, ""),  # both have lost track of the sine
        (0.7, 0.9, ""),  # both are at the noise
        (1.3, 1.5, "multiplies the error of whole unseen runs by 1.15"),
    ],
)
def test_whole_unseen_runs_refuse_an_approximation(before: float, after: float, words: str) -> None:
    fewer: Any = ()
    more: Any = (DRY,)
    assert raises_whole_runs(run_of({(): before, (DRY,): after}), fewer, more) == words


@pytest.mark.parametrize(
    ("before", "after", "share"),
    [
        (50.0, 10.0, 1 - 99 / 2499),
        (50.0, 49.0, 1 - 2400 / 2499),
        (50.0, 60.0, 1 - 3599 / 2499),
        (1.2, 1.2, 1.0),  # at the noise
        (600.0, 590.0, 1.0),  # both have lost track of the sine
    ],
)
def test_the_part_of_whole_unseen_runs_that_a_model_takes(
    before: float, after: float, share: float
) -> None:
    fewer: Any = ()
    more: Any = (DRY,)
    found = share_of_whole_runs(run_of({(): before, (DRY,): after}), fewer, more)
    assert found == pytest.approx(share)


@pytest.mark.parametrize(
    ("after", "excess", "verdict"),
    [(30.0, 1.0, "effect"), (48.0, 1.0, "unexplained"), (48.0, 0.05, "effect")],
)
def test_effects_that_hardly_help_on_whole_unseen_runs_are_an_approximation(
    after: float, excess: float, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """But where these runs hardly have what the effects take elsewhere."""
    there = run_of({(): 50.0, (DRY,): after})
    there.words, there.short_length = [], WHOLE
    monkeypatch.setattr(safeguards, "is_no_better_on_claim", lambda search, fewer, more: False)
    monkeypatch.setattr(safeguards, "excess_of_whole_runs", lambda search, fewer, more: excess)
    final: Any = SimpleNamespace(declared=(), best=Names((DRY,)))
    monkeypatch.setattr(safeguards, "undetermined_effects", lambda trial, confidence: [])
    monkeypatch.setattr(safeguards, "residual_map", lambda search, trial: ((), None))
    monkeypatch.setattr(safeguards, "describe_own_rhythm", lambda search, trial: "")
    found = safeguards.safeguard(there, safeguards.Judgement("effect", final))
    assert found.verdict == verdict
    assert found.final is final
    told = f"a model with {DRY} takes 8 % of the excess squared error of whole unseen runs away"
    assert found.reason == (told if verdict == "unexplained" else "")
    assert bool(there.words) == (excess < TraceOptions().excited)


@pytest.mark.parametrize(
    ("before", "after", "in_windows", "no_better"),
    [
        (50.0, 58.0, 1.04, True),
        (50.0, 50.0, 1.0, True),
        (50.0, 49.0, 1.04, True),  # a twenty-fifth
        (50.0, 47.0, 1.04, False),
        (50.0, 58.0, 0.97, True),
        (50.0, 58.0, 0.9, False),  # long runs depend on everything
        (1.2, 1.3, 1.04, False),  # at the noise nothing is told
        (600.0, 700.0, 1.01, False),  # both have lost track of the sine
        (600.0, 700.0, 1.04, True),  # and windows show more than chance
    ],
)
def test_an_effect_lowers_some_error_where_the_claim_is_made(
    before: float,
    after: float,
    in_windows: float,
    no_better: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fewer: Any = Names(())
    more: Any = Names((DRY,))
    more.length = 200
    there = run_of({})
    there.short_length, there.shortest = 50, 10
    windowed, free = {(): 10.0, (DRY,): 10 * in_windows}, {(): before, (DRY,): after}
    there.problem.residuals_on = lambda names, windows: [np.full(50, windowed[tuple(names)])]

    def run_freely(problem: Any, names: Names, whole: Any, shortest: int) -> np.ndarray:
        return np.full(WHOLE, free[tuple(names)])

    monkeypatch.setattr(unseen, "free_run", run_freely)
    assert is_no_better_on_claim(there, fewer, more) == no_better


def test_effects_that_do_not_help_where_the_claim_is_made_are_an_approximation(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    there = run_of({(): 50.0, (DRY,): 30.0})
    there.words, there.short_length = [], WHOLE
    final: Any = SimpleNamespace(declared=(), best=Names((DRY,)))
    monkeypatch.setattr(safeguards, "undetermined_effects", lambda trial, confidence: [])
    monkeypatch.setattr(safeguards, "is_no_better_on_claim", lambda search, fewer, more: True)
    monkeypatch.setattr(safeguards, "excess_of_whole_runs", lambda search, fewer, more: 1.0)
    monkeypatch.setattr(safeguards, "residual_map", lambda search, trial: ((), None))
    found = safeguards.safeguard(there, safeguards.Judgement("effect", final))
    assert (found.verdict, found.final) == ("unexplained", final)
    assert found.reason == (
        f"a model with {DRY} takes less than 10% of the excess squared error of windows and of"
        " free runs away in the part of the data that played no part"
    )


@pytest.mark.parametrize(("left", "verdict"), [(1.0, "null"), (4.0, "unexplained")])
def test_an_effect_whose_coefficient_may_be_zero_is_not_named(
    left: float, verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    there = run_of({})
    there.words, there.short_length = [], 50
    declared: Any = SimpleNamespace(reduced_chi2=left, effects=())
    final: Any = SimpleNamespace(declared=declared, best=Names((DRY,)))
    monkeypatch.setattr(safeguards, "undetermined_effects", lambda trial, confidence: [DRY])
    monkeypatch.setattr(safeguards, "residual_map", lambda search, trial: ((), None))
    found = safeguards.safeguard(there, safeguards.Judgement("effect", final))
    assert (found.verdict, found.final.best) == (verdict, declared)
    told = f"{DRY} is not named: the 95% interval of its coefficient holds zero"
    assert there.words == [told]


DELAY = "sensor_delay @ sensor.v"


def test_what_is_left_without_such_an_effect_is_asked_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Beside a delay the friction is sure, and alone it is not."""
    there = run_of({})
    there.words, there.short_length = [], 50
    declared: Any = SimpleNamespace(reduced_chi2=1.0, effects=())
    final = safeguards.FinalModels(declared, cast(Any, Names((DRY, DELAY))))
    monkeypatch.setattr(safeguards, "undetermined_effects", lambda trial, confidence: [trial[-1]])
    monkeypatch.setattr(safeguards, "_refit_with", lambda search, trial, kept: Names(kept))
    found = safeguards.safeguard(there, safeguards.Judgement("effect", final))
    assert (found.verdict, found.final.best) == ("null", declared)
    what = "is not named: the 95% interval of its coefficient holds zero"
    assert there.words == [f"{name} {what}" for name in (DELAY, DRY)]


@pytest.mark.parametrize(
    ("left", "in_windows", "kept"),
    [
        (60.0, 10.0, {DRY}),
        (60.0, 9.0, {DRY, DELAY}),  # windows say otherwise
        (50.5, 10.0, {DRY, DELAY}),  # by chance
        (40.0, 10.0, {DRY, DELAY}),
    ],
)
def test_an_effect_beside_others_that_harms_whole_unseen_runs_is_not_named(
    left: float, in_windows: float, kept: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = {(DRY,): 50.0, (DELAY,): 400.0, (DRY, DELAY): left}
    windowed = {(DRY,): 10.0, (DELAY,): 10.0, (DRY, DELAY): in_windows}
    there = run_of({})
    there.words, there.short_length = [], 50
    there.problem.residuals_on = lambda names, windows: [
        np.full(windows[0], (whole if windows[0] == WHOLE else windowed)[tuple(names)])
    ]
    monkeypatch.setattr(safeguards, "_refit_with", lambda search, best, names: Names(tuple(names)))
    none: Any = Names(())
    both: Any = Names((DRY, DELAY))
    found: Any = safeguards._without_harmful(there, FinalModels(none, both))
    assert set(found.best) == kept
    told = f"{DELAY} is not named beside {DRY}: it multiplies the error of whole unseen runs by 1.2"
    assert there.words == ([told] if kept == {DRY} else [])


@pytest.mark.parametrize(("after", "lowers"), [(9.0, True), (9.9, False), (11.0, False)])
def test_an_unseen_error_is_lower_by_more_than_chance(after: float, lowers: bool) -> None:
    fewer: Any = ()
    more: Any = (DRY,)
    assert lowers_unseen(run_of({(): 10.0, (DRY,): after}), fewer, more, 50) == lowers


@pytest.mark.parametrize("runs", [(), ("cold",)])
def test_where_only_the_end_of_the_run_refuses_another_run_is_asked_for(
    runs: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(verdict, "raises_unseen", lambda *given: "multiplies the error by 9")
    there = search({}, runs)
    there.options = TraceOptions()
    _, reason = verdict._harmless(there, prediction())
    assert reason.endswith("multiplies the error by 9")
    asked = [words for words in there.words if "with `use: validate`" in words]
    assert len(asked) == (not runs)


@pytest.mark.parametrize(
    ("left", "wave", "verdict", "told"),
    [
        (6.25, True, "effect", True),
        (1.5, True, "effect", False),  # at the noise nothing is left
        (6.25, False, "effect", False),
        (6.25, True, "unexplained", False),
    ],
)
def test_another_wave_of_a_named_kind_takes_another_trace(
    left: float, wave: bool, verdict: str, told: bool
) -> None:
    """A motor has ripples of several pitches; one cogging is tried at a place."""

    class Effect:
        shapes = ("pitch", "phase") if wave else ("period", "damping")  # a resonance
        lines = () if wave else ("period",)
        candidate = SimpleNamespace(waves=shapes[:1] if wave else (), lines=lines, shapes=shapes)

        def __str__(self) -> str:
            return "cogging @ shaft"

    search: Any = SimpleNamespace(options=TraceOptions(), words=[])
    best = SimpleNamespace(effects=(Effect(),), reduced_chi2=left)
    judgement: Any = SimpleNamespace(verdict=verdict, final=SimpleNamespace(best=best))
    safeguards.tell_waves_tried_once(search, judgement)
    words = "cogging @ shaft is tried once, and 2.5 σ are left, where 1 is the noise: for another"
    words += " wave of this kind apply the change and trace again"
    assert search.words == [words] * told
