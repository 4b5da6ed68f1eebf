"""What a verdict says of models that predict well for a reason that is no effect."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import tracewire as tw
from tracewire.errors import FitError
from tracewire.trace.choose import verdict
from tracewire.trace.choose.finalists import _extend_without, _takes_all
from tracewire.trace.choose.remainder import error_left
from tracewire.trace.choose.verdict import (
    _only_uncommon,
    is_at_noise,
    is_slow_noise,
    judge_at_noise,
)
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials import bounds
from tracewire.trace.trials.bounds import AtBound

from benchmarks.rigs.records import generate


def model(*names: str, rss: tuple[float, ...] = ()) -> Any:
    """A fitted model with effects, which leaves so much beyond the noise at each horizon."""
    effects = [SimpleNamespace(candidate=SimpleNamespace(effect=name)) for name in names]
    squares = rss or (0.0,)
    trials = [
        SimpleNamespace(effects=effects, rss=100.0 + r, degrees_of_freedom=100) for r in squares
    ]
    return SimpleNamespace(trials=trials)


def pool(best: Any, declared: tuple[float, ...]) -> Any:
    """What of a pool is asked whether its best model takes all."""
    models = {(frozenset(), ()): model(rss=declared)}
    return SimpleNamespace(
        options=TraceOptions(), models=models, best=lambda size, count: [best][:count]
    )


@pytest.mark.parametrize(
    ("best", "all_taken"),
    [
        (model("coulomb", rss=(10.0, 100.0)), True),
        (model("coulomb", rss=(10.0, 200.0)), False),  # 2 % is left at the longer horizon
        (model("cogging", rss=(10.0, 100.0)), False),  # a wave may stand for other laws
    ],
)
def test_no_effect_is_looked_for_where_too_little_is_left(best: Any, all_taken: bool) -> None:
    assert _takes_all(pool(best, (1000.0, 10_000.0)), 1) is all_taken


def test_several_waves_or_drifts_and_nothing_else_are_no_effect() -> None:
    options = TraceOptions()
    assert _only_uncommon(model("parametric", "stiffness_drift"), options)
    assert not _only_uncommon(model("parametric"), options)
    assert not _only_uncommon(model("parametric", "coulomb"), options)


@pytest.mark.parametrize(
    ("names", "subject"),
    [((), "the declared model"), (("coulomb @ net",), "a model with coulomb @ net")],
)
def test_a_model_at_the_noise_that_does_not_run_in_longer_windows_is_told(
    names: tuple[str, ...], subject: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refit(*_: Any) -> Any:
        raise FitError.one("'spring' is not finite")

    monkeypatch.setattr(verdict, "_gate_mean_square", lambda search, best: 1.0)
    trial: Any = SimpleNamespace(reduced_chi2=1.0, degrees_of_freedom=100, length=16, effects=names)
    words: list[str] = []
    search: Any = SimpleNamespace(
        options=TraceOptions(),
        short_length=48,
        windows=lambda sections, length: [],
        data_split=SimpleNamespace(train=()),
        problem=SimpleNamespace(refit=refit),
        note=words.append,
    )
    assert is_at_noise(search, trial)
    assert words == [
        f"in windows of 16 samples {subject} leaves no more than the noise; in longer ones it does"
        " not run: 'spring' is not finite"
    ]


def test_blocks_at_the_noise_do_not_count_in_what_an_effect_leaves() -> None:
    """The later blocks of a decay, where the declared model is right, too."""
    declared = np.array([400.0, 100.0, 1.0, 1.0, 1.1, 0.9])
    named = np.array([4.0, 1.0, 1.0, 1.0, 1.1, 0.9])
    errors = np.stack([declared, named]).reshape(2, 1, 1, -1, 1)
    prediction: Any = SimpleNamespace(
        errors=errors, options=TraceOptions(), choice=SimpleNamespace(chosen=1)
    )
    assert error_left(prediction) == pytest.approx(0.1)


def test_nothing_is_named_where_a_whole_run_is_at_the_noise(tmp_path: Path) -> None:
    """A chamber with nothing hidden, in one horizon and with noise of an input: without its first
    block, where it warms up, the declared model is not determined and predicts it badly."""
    chamber = tw.compile(tw.read(generate("r32_chamber", tmp_path)))
    found = tw.trace(chamber, options={"effects": 1})  # one is one too many
    assert found.verdict == "null"
    assert not found.effects


def test_a_term_that_is_left_out_does_not_come_back_as_an_effect() -> None:
    """Without the declared friction the same friction shows as an effect; another law may."""

    def row(name: str, absorbed: float) -> Any:
        return SimpleNamespace(candidate=name, absorbed_fraction=absorbed)

    def screen(*rows: Any) -> Any:
        return SimpleNamespace(observable=lambda: {row.candidate: row for row in rows})

    same, other = row("viscous @ force", 0.1), row("coulomb @ force", 0.2)
    before = screen(row("coulomb @ force", 0.9))  # the declared term hides the same completely
    asked = [
        SimpleNamespace(rows=rows, names=frozenset(row.candidate for row in rows))
        for rows in ((same,), (other,), (same, other))
    ]
    tried: list[Any] = []
    there: Any = SimpleNamespace(
        options=TraceOptions(),
        horizons=SimpleNamespace(each=[None]),
        first=[before],
        screen=lambda smaller, number: screen(same, other),
        select_promising=lambda *args: asked,
        extend=lambda smaller, number, proposals: tried.extend(proposals),
    )
    smaller: Any = None
    _extend_without(there, smaller)
    assert tried == [asked[1]]


@pytest.mark.parametrize(
    ("before", "after", "effects", "length", "judged"),
    [
        (4.0, 1.1, 1, 900, "effect"),
        (400.0, 52.0, 1, 900, None),  # it is not at the noise any more
        (4.0, 1.9, 1, 900, None),  # three tenths of what was above the noise are left
        (1.6, 1.4, 1, 900, None),
        (1.6, 1.4, 1, 100, "effect"),  # where the declared model does not bear such windows
        (4.0, 1.1, 2, 900, "effect"),
        (4.0, 1.1, 3, 900, None),  # three small laws follow any smooth force
    ],
)
def test_at_the_noise_few_effects_take_most_of_what_was_above_it(
    before: float,
    after: float,
    effects: int,
    length: int,
    judged: str | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    search: Any = SimpleNamespace(options=TraceOptions())
    declared: Any = SimpleNamespace(reduced_chi2=before, length=length, effects=())
    best: Any = SimpleNamespace(
        reduced_chi2=after, length=900, effects=("coulomb",) * effects, degrees_of_freedom=1000
    )
    final = SimpleNamespace(declared=declared, best=best)
    monkeypatch.setattr(verdict, "is_slow_noise", lambda search, trial: False)
    monkeypatch.setattr(verdict, "is_at_noise", lambda search, trial: True)
    monkeypatch.setattr(verdict, "refine", lambda search, first, best: final)
    monkeypatch.setattr(verdict, "upper_shapes", lambda trial: [])
    found = judge_at_noise(search, declared, best)
    assert (found.verdict if found else None) == judged


def test_a_law_whose_shape_is_on_its_upper_bound_must_predict(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    search: Any = SimpleNamespace(options=TraceOptions())
    declared: Any = SimpleNamespace(reduced_chi2=400.0, length=900, effects=())
    best: Any = SimpleNamespace(
        reduced_chi2=1.1, length=900, effects=("cogging @ alpha",), degrees_of_freedom=1000
    )
    final = SimpleNamespace(declared=declared, best=best)
    monkeypatch.setattr(verdict, "is_slow_noise", lambda search, trial: False)
    monkeypatch.setattr(verdict, "is_at_noise", lambda search, trial: True)
    monkeypatch.setattr(verdict, "refine", lambda search, first, best: final)
    for words, judged in (("", "effect"), ("the pitch of cogging sits on its upper bound", None)):
        monkeypatch.setattr(verdict, "_describe_shape_on_bound", lambda trial, words=words: words)
        found = judge_at_noise(search, declared, best)
        assert (found.verdict if found else None) == judged


@pytest.mark.parametrize(("longer", "told"), [(9.0, True), (1.2, False)])
def test_what_longer_windows_show_beside_named_effects_is_told(
    longer: float, told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    search: Any = SimpleNamespace(options=TraceOptions(), words=[])
    declared: Any = SimpleNamespace(reduced_chi2=400.0, length=209, effects=())
    short: Any = SimpleNamespace(reduced_chi2=1.0, length=47, effects=("elastic_load @ alpha",))
    final = SimpleNamespace(
        declared=declared,
        best=SimpleNamespace(reduced_chi2=longer, length=209, effects=short.effects),
    )
    monkeypatch.setattr(verdict, "upper_shapes", lambda trial: [])
    monkeypatch.setattr(verdict, "is_slow_noise", lambda search, trial: False)
    monkeypatch.setattr(verdict, "is_at_noise", lambda search, trial: True)
    monkeypatch.setattr(verdict, "refine", lambda search, first, best: final)
    found = judge_at_noise(search, declared, short)
    assert found is not None
    assert found.verdict == "effect"
    words = (
        "something smaller may be missing, too: with elastic_load @ alpha the residual is 1 σ in"
        " windows of 47 samples, and 3 σ in windows of 209. Apply the change and trace again"
    )
    assert search.words == ([words] if told else [])


@pytest.mark.parametrize(
    ("declared", "again", "reduced_chi2", "whole", "slow"),
    [
        (None, False, 20.0, 5.0, True),
        (None, False, 40.0, 5.0, False),
        (None, False, 20.0, 9.0, False),  # a whole run is 9 sigma off: that is no noise
        (None, True, 20.0, 5.0, False),  # it comes back to where it was
        (0.01, False, 20.0, 5.0, False),  # the user has said how large the noise is
    ],
)
def test_what_is_left_of_a_single_way_may_be_slow_noise_of_a_sensor(
    declared: float | None, again: bool, reduced_chi2: float, whole: float, slow: bool
) -> None:
    series = SimpleNamespace(values={"h": np.zeros(3)}, sigma={"h": declared})
    search: Any = SimpleNamespace(
        options=TraceOptions(),
        has_revisits=again,
        problem=SimpleNamespace(
            measured=[series], residuals_on=lambda trial, windows: [np.full(3, whole)]
        ),
        data_split=SimpleNamespace(whole=list),
        whole_windows=list,
    )
    trial: Any = SimpleNamespace(effects=(), reduced_chi2=reduced_chi2)
    assert is_slow_noise(search, trial) is slow


@pytest.mark.parametrize(
    ("bound", "told"),
    [
        (AtBound("wave.pitch", "shape", 2.0, 0.1, 2.0, True, "rad", "wave @ torque"), True),
        (AtBound("rub.width", "shape", 0.0, 0.0, 2.0, False, "rad/s", "rub @ torque"), False),
        (AtBound("rub.way", "shape", 0.1, 0.1, 2.0, False, "rad", "rub @ torque"), False),
        (AtBound("rub.level", "coefficient", 0.0, 0.0, 9.0, False, "N m", "rub @ torque"), False),
        (AtBound("c", "parameter", 2.0, 0.0, 2.0, True), False),
    ],
)
def test_an_effect_with_a_shape_on_its_upper_bound_stands_for_another_law(
    bound: AtBound, told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At a lower bound it is a simpler law, as an exact one where its smoothing is 0."""
    monkeypatch.setattr(bounds, "at_bounds", lambda trial: [bound])
    found = verdict._describe_shape_on_bound(SimpleNamespace())  # type: ignore[arg-type]
    words = "stands for a law of another form: the pitch of wave @ torque sits on its upper bound"
    assert found == (words if told else "")


@pytest.mark.parametrize(
    ("short", "long", "explained", "told"),
    [
        ((20.0, 0.96), (60.0, 0.5), 0.8, "96.0 %"),
        ((20.0, 0.86), (60.0, 0.98), 0.8, "98.0 %"),
        ((20.0, 0.86), (60.0, 0.96), 0.8, ""),  # a map of long windows has more freedom
        ((1.1, 1.0), (3.0, 0.9), 0.8, "90.0 %"),  # down to the noise
        ((1.1, 1.0), (1.9, 1.0), 0.8, ""),  # too little is left
        ((20.0, 0.96), (60.0, 0.98), 0.95, ""),  # enough is explained
    ],
)
def test_effects_that_leave_a_law_behind_are_not_named(
    short: tuple[float, float], long: tuple[float, float], explained: float, told: str
) -> None:
    both = short, long
    trials: Any = [SimpleNamespace(reduced_chi2=chi2) for chi2, _ in both]
    shares: Any = [
        [
            SimpleNamespace(place="force", variables=("t",), share=1.0),
            SimpleNamespace(place="force", variables=("q", "v"), share=share),
        ]
        for _, share in both
    ]
    found = verdict._describe_law_left(trials, shares, explained, TraceOptions())
    rest = f"leaves a law of no block's form: {told} of the rest is a function of q and v at force"
    assert found == (rest if told else "")


@pytest.mark.parametrize(
    ("kinds", "dropped", "share", "told"),
    [
        (["coulomb"], (), 0.7, ""),
        (["coulomb"], (), 0.55, "takes 55 % of the excess error on held-out blocks away"),
        (
            ["parametric"],
            (),
            0.7,
            "takes 70 % of the excess error on held-out blocks away, and a wave or a drift, which"
            " follows a part of anything, needs 80 %",
        ),
        (["cogging"], (), 0.88, ""),
        (
            ["quad_drag", "cogging"],
            (),
            0.89,
            "takes 89 % of the excess error on held-out blocks away, and a wave or a drift beside"
            " another effect, which follows a part of anything, needs 95 %",
        ),
        (["coulomb", "cogging"], (), 0.96, ""),
        (["coulomb", "cogging"], ("level",), 0.85, ""),
        (
            ["bias", "inertia", "cogging"],
            (),
            0.94,
            "takes 94 % of the excess error on held-out blocks away, and 3 effects, which together"
            " follow a part of anything, need 95 %",
        ),
        (["bias", "inertia", "cogging"], (), 0.96, ""),
        (["quad_drag", "coulomb", "asym_viscous"], ("c",), 0.76, ""),
    ],
)
def test_waves_and_many_effects_must_explain_more_than_laws(
    kinds: list[str],
    dropped: tuple[str, ...],
    share: float,
    told: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A law in place of a declared one, which is dropped, is no law more."""
    effects = [SimpleNamespace(candidate=SimpleNamespace(effect=kind)) for kind in kinds]
    trial = SimpleNamespace(effects=effects, reduced_chi2=9.0)
    model = SimpleNamespace(trials=[trial], dropped=dropped)
    chosen: Any = SimpleNamespace(options=TraceOptions(), chosen=model, models=[model])
    monkeypatch.setattr(verdict, "error_left", lambda prediction: 0.4)
    monkeypatch.setattr(verdict, "relative_error", lambda trial: 0.1)
    assert verdict._describe_shortfall(chosen, share, share - 0.04) == told


@pytest.mark.parametrize(
    ("kind", "dropped", "error", "share", "needs"),
    [
        ("coulomb", (), 0.05, 0.8, ""),
        ("coulomb", (), 0.01, 0.96, ""),
        ("coulomb", (), 0.012, 0.94, "an effect behind an error of 1.2 % of the motion needs 95 %"),
        ("cogging", (), 0.01, 0.9, "an effect behind an error of 1 % of the motion needs 95 %"),
        ("quad_drag", ("c",), 0.003, 0.76, ""),
    ],
)
def test_effects_behind_an_error_as_small_as_any_rig_has_must_explain_nearly_all(
    kind: str,
    dropped: tuple[str, ...],
    error: float,
    share: float,
    needs: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    trial = SimpleNamespace(
        effects=[SimpleNamespace(candidate=SimpleNamespace(effect=kind))], reduced_chi2=9.0
    )
    model = SimpleNamespace(trials=[trial], dropped=dropped)
    chosen: Any = SimpleNamespace(options=TraceOptions(), chosen=model, models=[model])
    monkeypatch.setattr(verdict, "error_left", lambda prediction: 0.4)
    monkeypatch.setattr(verdict, "relative_error", lambda trial: error)
    told = verdict._describe_shortfall(chosen, share, share - 0.04)
    taken = f"takes {100 * share:.0f} % of the excess error on held-out blocks away, and {needs}"
    assert told == (taken if needs else "")


@pytest.mark.parametrize(("cost", "words"), [(0.5, "65 % more"), (-0.5, "39 % less")])
def test_how_much_more_or_less_another_model_leaves(cost: float, words: str) -> None:
    assert verdict._as_good_words({"bias @ force"}, cost, 1) == (
        f"bias @ force predicts as well: {words} error, 1 fitted number more"
    )
