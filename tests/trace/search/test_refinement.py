"""The end of a search: rivals once more, and what is superfluous goes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from oracles.oscillator import candidates_of, problem_of, record, search_of, trial_of
from tracewire.trace.candidates.places import find_places
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.screening import Proposal, screen_candidates
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.search.refinement import (
    FinalModels,
    _drop_trifles,
    _errors_from_nothing,
    _is_tied,
    _prune,
    largest_first,
    refine,
)
from tracewire.trace.search.refits import RefitResult
from tracewire.trace.search.search import Search, Step
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import Trial

OPTIONS = TraceOptions()

Law = Callable[[float, float], float]
COULOMB, DRAG, CUBIC = "coulomb @ force", "quad_drag @ force", "cubic_damping @ force"


def rubbed(x: float, v: float) -> float:
    return -0.4 * float(np.tanh(v / 1e-3))


def dragged(x: float, v: float) -> float:
    return -0.1 * v * abs(v)


def ended(
    law: Law, names: Sequence[str], screen: Sequence[str], damping: float = 0.2
) -> tuple[Search, FinalModels]:
    """The end of a search that has accepted `names`, after a screen of `screen`."""
    problem = problem_of(
        record(law, damping=damping, end=7.0),
        record(law, damping=damping, end=6.0, use="gate", name="gate", seed=1),
    )
    search = search_of(problem)
    known = candidates_of(problem)
    now = search.fit_declared()
    search.first = now
    best = now
    for name in names:
        linearisation = TorqueLinearisation(
            best.diagram, best.windows, find_places(problem.declared), 1e-6, OPTIONS
        )
        shown = screen_candidates(linearisation, best, [known[other] for other in screen])
        rows = {str(row.candidate): row for row in shown.best()}
        tried = []
        for other in screen:
            added = PlacedEffect(known[other], {known[other].parameter: 0.02})
            refit = search.refits.prepare(best, [*best.effects, added], now.windows.segments)
            (trial,) = search.refits.run(best, [refit])
            if trial is not None and other in rows:
                tried.append(RefitResult(trial, Proposal((rows[other],), 1.0), 0.0, 0.0))
        ranked = search.refits.rank(best, tried)
        after: Trial = next(one.trial for one in ranked if str(one.trial.effects[-1]) == name)
        search.steps.append(Step(best, shown, 0.0, tuple(ranked), after, ""))
        best = after
    search.best = best
    return search, refine(search, now, best)


def names_of(trial: Trial) -> list[str]:
    return [str(effect) for effect in trial.effects]


def test_a_wrong_effect_is_exchanged_for_its_better_rival() -> None:
    _, final = ended(dragged, [CUBIC], [DRAG, CUBIC])
    assert names_of(final.best) == [DRAG]
    assert final.best.effects[0].coefficient == pytest.approx(0.1, rel=0.03)
    (rival,) = final.rivals[DRAG]
    assert str(rival.effect) == CUBIC and not rival.tied
    assert 0.9 < rival.correlation < 1.0


@pytest.mark.parametrize(
    ("delta_bic", "where", "tied"),
    [
        (9.0, slice(None), True),  # next to nothing
        (40.0, slice(None), False),  # everywhere
        (40.0, slice(100, 150), True),  # in one block of time
        (350.0, slice(100, 150), True),  # a third more, in one block
        (450.0, slice(100, 150), False),  # clearly more, however few blocks show it
        (8000.0, slice(100, 150), False),
    ],
)
def test_a_rival_is_tied_that_is_not_surely_behind(
    delta_bic: float, where: slice, tied: bool
) -> None:
    noise = np.random.default_rng(5).normal(size=(1000, 1))
    law = np.zeros((1000, 1))
    law[where] = np.sin(np.arange(1000.0))[where, None]
    law *= (delta_bic / np.sum(law**2)) ** 0.5
    best, rival = (
        SimpleNamespace(
            windows=SimpleNamespace(residuals=[residual]), rss=float(np.sum(residual**2))
        )
        for residual in (noise, noise + law)
    )
    assert _is_tied(best, rival, delta_bic, OPTIONS.search) is tied  # type: ignore[arg-type]


def test_the_right_effect_stays_on_long_windows() -> None:
    search, final = ended(rubbed, [COULOMB], [COULOMB, DRAG])
    assert names_of(final.best) == [COULOMB]
    assert final.best.length == search.data_split.longest
    assert final.best.reduced_chi2 == pytest.approx(1.0, abs=0.2)
    assert final.declared.effects == () and final.declared.reduced_chi2 > 3


def test_an_effect_that_the_others_make_superfluous_is_pruned() -> None:
    _, final = ended(dragged, [CUBIC, DRAG], [DRAG, CUBIC])
    assert names_of(final.best) == [DRAG]


def test_an_effect_that_a_declared_parameter_makes_up_for_is_pruned_however_sure_it_looks() -> None:
    """A mass beside declared forces that are all free was named with an error of 0.004 %."""
    problem = problem_of(record(rubbed, end=7.0))
    known = candidates_of(problem)
    stiffness = PlacedEffect(known["stiffness @ force"], {"k": 3.0})
    best = trial_of(problem, [stiffness, PlacedEffect(known[COULOMB], {"level": 0.4})])
    assert _errors_from_nothing(best, best.effects[0]) > OPTIONS.search.certain
    assert names_of(_prune(search_of(problem), best)) == [COULOMB]


def test_a_declared_term_that_the_effects_make_superfluous_is_dropped() -> None:
    _, final = ended(rubbed, [COULOMB], [COULOMB, DRAG], damping=0.0)
    assert final.dropped == ("c",)
    assert "c" not in final.best.values
    assert final.best.values["k"] == pytest.approx(25.0, rel=0.01)


def test_a_declared_term_that_is_there_is_kept() -> None:
    _, final = ended(rubbed, [COULOMB], [COULOMB, DRAG])
    assert final.dropped == ()
    assert final.best.values["c"] == pytest.approx(0.2, rel=0.1)


def test_without_effects_the_declared_model_is_the_end() -> None:
    problem = problem_of(record(end=7.0), record(end=6.0, use="gate", name="gate", seed=1))
    search = search_of(problem)
    now = search.fit_declared()
    final = refine(search, now, now)
    assert final.best is final.declared and final.best.effects == ()
    assert final.rivals == {} and final.dropped == ()
    assert final.best.length == search.data_split.longest


def test_effects_are_told_the_largest_first_and_not_the_surest() -> None:
    """In whatever order they were found, the one whose absence leaves most comes first."""

    def both(x: float, v: float) -> float:
        return rubbed(x, v) + 1.5 * dragged(x, v)

    search, final = ended(both, [DRAG, COULOMB], [DRAG, COULOMB, CUBIC])
    best = final.best
    assert {*names_of(best)} == {COULOMB, DRAG}
    left = {}
    for effect in best.effects:
        (other,) = [e for e in best.effects if e is not effect]
        alone = search.problem.fit([other], best.windows.segments, best.length, best.values)
        left[str(effect)] = alone.rss
    wanted = sorted(left, key=lambda name: -left[name])
    for effects in (best.effects, best.effects[::-1]):
        ordered = largest_first(search, replace(final, best=replace(best, effects=effects)))
        assert names_of(ordered.best) == wanted
        bare = search.problem.fit([], best.windows.segments, best.length, best.values).rss
        for name, share in ordered.shares.items():
            assert share == pytest.approx((left[name] - best.rss) / (bare - best.rss), rel=0.1)
    known = replace(final, shares={DRAG: 0.01})
    assert largest_first(search, known).shares[DRAG] == 0.01
    alone = FinalModels(final.declared, final.declared)
    assert largest_first(search, alone) is alone


def test_a_tiny_effect_that_is_surer_is_told_last(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the dead zone, known to 0.3 % beside its width, all is lost; without the other, known
    to 0.1 %, hardly anything; a model that does not run without an effect needs it most."""
    search, final = ended(rubbed, [COULOMB], [COULOMB, DRAG])
    effects = [Sized(candidate=SimpleNamespace(effect=name)) for name in ("tiny", "large", "vital")]
    best = replace(final.best, effects=tuple(effects))
    left = {"tiny": 1.1, "large": 100.0, "vital": None}

    def run(self: Any, now: Any, tasks: Any) -> list[Any]:
        assert tasks[0] == []
        left_out = [next(iter({*left} - {str(e) for e in task})) for task in tasks[1:]]
        sizes = [200.0, *(left[name] for name in left_out)]
        return [None if rss is None else SimpleNamespace(rss=rss) for rss in sizes]

    refits = type(search.refits)
    monkeypatch.setattr(refits, "prepare", lambda self, now, effects, *_, **__: effects)
    monkeypatch.setattr(refits, "run", run)
    ordered = largest_first(search, replace(final, best=best))
    assert names_of(ordered.best) == ["vital", "large", "tiny"]
    assert set(ordered.shares) == {"large", "tiny"}


class Sized(SimpleNamespace):
    """An effect by its name, whose coefficient is so many standard errors."""

    def __str__(self) -> str:
        return str(self.candidate.effect)


def sized(s2: float, **errors: float) -> Any:
    """A model of effects, each so many standard errors large, that leaves 1000 residuals."""
    effects = [
        Sized(
            candidate=SimpleNamespace(effect=name, coefficient=name, neutral=0.0), coefficient=size
        )
        for name, size in errors.items()
    ]
    return SimpleNamespace(
        effects=effects,
        reduced_chi2=s2,
        count=1000,
        rss=1000.0 * s2,
        standard_errors=dict.fromkeys(errors, 1.0),
    )


def without_trifles(
    best: Any,
    missing: float,
    monkeypatch: pytest.MonkeyPatch,
    chance: float = 1.0,
    rivals: Mapping[str, Sequence[Any]] | None = None,
    rise: float = 0.0,
) -> tuple[list[str], list[str]]:
    """The effects that stay and what is said, where the declared model leaves so much more, what is
    left has this chance to be noise, and the sum of squares rises so much without one."""
    search: Any = SimpleNamespace(
        options=OPTIONS,
        tell=lambda _: None,
        words=[],
        screen=lambda _: SimpleNamespace(p_value=lambda: chance),
    )
    monkeypatch.setattr(
        import_module("tracewire.trace.search.refinement"),
        "_run_refit",
        lambda search, best, kept: SimpleNamespace(effects=kept, rss=best.rss + rise),
    )
    declared: Any = SimpleNamespace(reduced_chi2=best.reduced_chi2 + missing)
    found = _drop_trifles(search, best, declared, rivals or {})
    return [str(effect) for effect in found.effects], search.words


@pytest.mark.parametrize(
    ("errors", "second", "ties", "told"),
    [
        (10.0, "viscous_drift", (), ""),
        (300.0, "viscous_drift", (), None),
        (10.0, "backlash", ("barrier",), ", as barrier would"),
        (300.0, "backlash", ("barrier",), None),
        (10.0, "backlash", (), None),
    ],
)
def test_what_explains_next_to_nothing_and_may_be_another_law_is_a_refinement(
    errors: float,
    second: str,
    ties: Sequence[str],
    told: str | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of 1e6 variances 10 standard errors explain 1e-4, 300 errors 9 %."""
    best = sized(1.0, coulomb=errors, **{second: errors})
    rivals = {second: [SimpleNamespace(effect=name, tied=True) for name in ties]}
    kept, said = without_trifles(best, 1000.0, monkeypatch, rivals=rivals)
    assert kept == ["coulomb", second][: 1 if told is not None else 2]
    words = (
        f"{second} would be a refinement: it takes only 0.01 % of the squared error that was"
        f" missing{told}, so it may stand for anything, and is not named"
    )
    assert said == ([words] if told is not None else [])


@pytest.mark.parametrize(("rise", "stays"), [(1400.0, False), (1600.0, True)])
def test_an_effect_without_which_the_error_rises_is_no_trifle(
    rise: float, stays: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its coefficient is uncertain, as others hold it: 500 of 1e6 variances are a trifle."""
    best = sized(1.0, coulomb=3000.0, viscous_drift=10.0)
    kept, said = without_trifles(best, 1000.0, monkeypatch, rise=rise)
    assert kept == ["coulomb", "viscous_drift"][: 1 + stays]
    assert len(said) == 1 - stays


@pytest.mark.parametrize(
    ("second", "errors", "s2", "chance", "stays"),
    [
        ("harmonic", 8.0, 1.0, 1e-6, False),
        ("harmonic", 8.0, 1.0, 0.2, True),  # what is left is noise
        ("harmonic", 15.0, 1.0, 1e-6, True),  # 22 % of the squared error of the noise
        ("backlash", 8.0, 1.0, 1e-6, False),
        ("harmonic", 8.0, 3.0, 1e-6, True),  # far above the noise
    ],
)
def test_a_slight_effect_beside_what_is_no_noise_is_a_part_of_that(
    second: str,
    errors: float,
    s2: float,
    chance: float,
    stays: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    best = sized(s2, coulomb=100.0, **{second: errors})
    kept, said = without_trifles(best, 2.0, monkeypatch, chance)
    assert kept == ["coulomb", second][: 1 + stays]
    assert len(said) == 1 - stays


@pytest.mark.parametrize(("chance", "stays"), [(0.2, True), (1e-6, False)])
def test_a_wave_above_the_noise_that_leaves_nothing_is_no_trifle(
    chance: float, stays: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It takes 1600 variances of 1e7 that were missing, and the noise has 1000."""
    best = sized(1.0, quad_stiffness=3000.0, harmonic=40.0)
    kept, _ = without_trifles(best, 10000.0, monkeypatch, chance)
    assert kept == ["quad_stiffness", "harmonic"][: 1 + stays]
