"""The choice by held-out errors: the simplest of those that predict as well as the best."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tracewire.trace.choose.choice import (
    Choice,
    Entrant,
    choose,
    floor_of,
    is_sure,
    log_scores,
    take_away_what_stands_out,
)
from tracewire.trace.options import TraceOptions

BLOCKS = 10
FOLDS = ((tuple(range(0, 10, 2)), tuple(range(1, 10, 2))), (tuple(range(5)), tuple(range(5, 10))))
OPTIONS = TraceOptions()


def scores(*costs: float | np.ndarray) -> np.ndarray:
    """S of models whose T is 1 + cost in each block, (models, 2 horizons, 2 families, blocks)."""
    rows = [np.broadcast_to(1.0 + np.asarray(cost), (2, 2, BLOCKS)) for cost in costs]
    return np.stack(rows)


def model(*effects: str, numbers: int | None = None, uncommon: int = 0) -> Entrant:
    return Entrant(frozenset(effects), 2 + len(effects) if numbers is None else numbers, uncommon)


def chosen(entrants: list[Entrant], *costs: float | np.ndarray) -> Choice:
    return choose(entrants, scores(*costs), FOLDS, OPTIONS)


def wobble(size: float) -> np.ndarray:
    """A difference over blocks with this standard deviation and no mean."""
    x = np.array([1.0, -1.0] * (BLOCKS // 2))
    return size * x * ((BLOCKS - 1) / BLOCKS) ** 0.5


def test_a_score_is_half_the_logarithm_of_error_and_floor() -> None:
    errors = np.array([[4.0, 8.0, 2.0], [1.0, 3.0, 2.0]]).reshape(2, 1, 1, 3, 1)
    assert floor_of(errors).item() == 2.0, "the median of the least errors 1, 3 and 2"
    expected = 0.5 * np.log(np.array([[6.0, 10.0, 4.0], [3.0, 5.0, 4.0]]))
    assert log_scores(errors)[:, 0, 0] == pytest.approx(expected)


def test_channels_count_alike_whatever_their_noise() -> None:
    rng = np.random.default_rng(1)
    errors = rng.uniform(1, 2, size=(3, 2, 2, BLOCKS, 2))
    scaled = errors * np.array([1.0, 1e6])
    before, after = (log_scores(e).mean(axis=(1, 2, 3)) for e in (errors, scaled))
    assert np.diff(after) == pytest.approx(np.diff(before))


def test_of_models_within_five_percent_the_one_of_fewest_numbers_is_taken() -> None:
    entrants = [model(), model("a"), model("a", "b"), model("a", "b", "c")]
    assert chosen(entrants, 1.0, 0.04, 0.0, -0.005).chosen == 1
    assert chosen(entrants, 1.0, 0.2, 0.0, -0.005).chosen == 2


def test_a_model_with_as_many_more_numbers_as_blocks_is_not_taken() -> None:
    """So many numbers follow what a handful of blocks show, whatever it is."""
    entrants = [model(), model("a"), model("b", "c", numbers=2 + BLOCKS)]
    assert chosen(entrants, 1.0, 0.4, 0.0).chosen == 1
    entrants[2] = model("b", "c", numbers=1 + BLOCKS)
    assert chosen(entrants, 1.0, 0.4, 0.0).chosen == 2


def test_one_block_that_is_extrapolated_does_not_hide_a_law() -> None:
    """A plateau is predicted from fast switching alone: a right model is off there by a factor."""
    plateau = np.r_[-1.5, np.full(BLOCKS - 1, 0.6) + 0.1 * np.arange(BLOCKS - 1)]
    raw = plateau.mean() / (plateau.std(ddof=1) / BLOCKS**0.5)
    assert raw < OPTIONS.sure
    found = chosen([model(), model("coulomb")], plateau, 0.0)
    assert (found.chosen, found.sure) == (1, True)


@pytest.mark.parametrize("blocks", [1, 2, 3, 6])
def test_of_few_blocks_none_is_left_out(blocks: int) -> None:
    """One that is left of three has no standard error to be sure by."""
    change = np.r_[-0.5, np.full(blocks - 1, 0.5)] if blocks > 1 else np.array([-0.5])
    totals = np.stack([1.0 + change, np.ones(blocks)])
    assert not is_sure(totals, 0, 1, OPTIONS)


def test_a_model_that_has_more_squared_error_is_not_taken() -> None:
    """The logarithm may prefer it for many small blocks."""
    worse = replace(model("a"), left=(3.0, 1.2))
    assert chosen([model(), worse], 1.0, 0.0).chosen == 0
    assert chosen([model(), replace(worse, left=(3.0, 0.9))], 1.0, 0.0).chosen == 1


def test_a_part_that_predicts_as_well_as_a_sure_model_is_as_sure() -> None:
    """Alone it is 2.9 standard errors from the declared model, with another one 3.1."""
    entrants = [model(), model("drag"), model("drag", "friction")]
    rest = 0.3 * (1 + wobble(3.1**-1 * BLOCKS**0.5))
    alone = rest - 0.02
    assert not chosen(entrants[:2], alone, 0.0).sure
    found = choose(entrants, scores(rest, 0.02 + 0 * rest, 0.0), FOLDS, OPTIONS)
    assert (found.chosen, found.sure) == (1, True)


def test_a_gain_within_one_standard_error_is_none() -> None:
    entrants = [model(), model("a"), model("b", "c")]
    steady, shaky = 0.12, 0.12 + wobble(0.6)
    assert chosen(entrants, 1.0, steady, 0.0).chosen == 2
    assert chosen(entrants, 1.0, shaky, 0.0).chosen == 1


def test_a_common_law_goes_before_a_wave_of_as_many_numbers() -> None:
    entrants = [model(), model("wave", uncommon=1), model("coulomb")]
    assert chosen(entrants, 1.0, 0.0, 0.04).chosen == 2
    assert chosen(entrants, 1.0, 0.0, 0.2).chosen == 1, "where it predicts better it is taken"


def test_an_effect_that_costs_less_than_two_standard_errors_is_dropped() -> None:
    entrants = [model(), model("a", "b", numbers=3), model("a", numbers=3)]
    # more than the tolerance and than one error, less than two
    choice = chosen(entrants, 1.0, 0.0, 0.1 + wobble(0.2))
    assert choice.chosen == 2


def test_what_is_not_three_errors_better_than_the_declared_model_is_not_sure() -> None:
    entrants = [model(), model("a")]
    sure = chosen(entrants, 0.4 + wobble(0.3), 0.0)
    assert sure.sure and sure.z == pytest.approx(0.4 / (0.3 / BLOCKS**0.5), rel=0.01)
    assert not chosen(entrants, 0.4 + wobble(0.6), 0.0).sure
    assert not chosen(entrants, 0.04, 0.0).sure, "less than the tolerance, however sure"


def test_a_model_that_is_sure_goes_before_a_better_one_that_is_not() -> None:
    entrants = [model(), model("a"), model("a", "b")]
    declared = 0.4 + wobble(0.05)
    choice = chosen(entrants, declared, 0.1, 0.0 + wobble(1.0))
    assert choice.sure and choice.chosen == 1


def test_a_model_that_does_not_run_somewhere_is_never_taken() -> None:
    broken = np.zeros(BLOCKS)
    broken[3] = np.inf
    choice = chosen([model(), model("a"), model("b")], 1.0, broken, 0.5)
    assert choice.chosen == 2 and choice.sure


def test_models_as_near_with_at_most_one_number_more_are_ties() -> None:
    entrants = [model(), model("a"), model("b"), model("c"), model("a", "d", "e")]
    choice = chosen(entrants, 1.0, 0.0, 0.02, 0.4, -0.01)
    assert choice.chosen == 1
    assert [number for number, _ in choice.ties] == [2]
    assert choice.ties[0][1] == pytest.approx(0.02)


def test_an_exchange_that_leaves_little_more_is_a_tie() -> None:
    """The 95 % point of F for ten and ten degrees of freedom is 2.98."""
    named = replace(model("a", "b"), left=(0.02, 0.02))

    def tied(*effects: str, left: tuple[float, float], numbers: int = 4) -> bool:
        other = replace(model(*effects, numbers=numbers), left=left)
        choice = chosen([replace(model(), left=(1.0, 1.0)), named, other], 1.0, 0.0, 0.4)
        return choice.ties == ((2, pytest.approx(0.4)),)

    assert tied("a", "c", left=(0.03, 0.059))
    assert not tied("a", "c", left=(0.02, 0.061)), "three times as much at one horizon"
    assert not tied("a", "c", left=(0.05, 0.055)), "3.25 % of the declared model's error more"
    assert not tied("d", "c", left=(0.03, 0.03)), "another model altogether"
    assert not tied("a", "c", left=(0.03, 0.03), numbers=6)
    assert not tied("a", left=(0.03, 0.03), numbers=3), "the same model without an effect"


def test_the_tolerance_is_an_option() -> None:
    entrants = [model(), model("a"), model("a", "b")]
    strict = choose(entrants, scores(1.0, 0.04, 0.0), FOLDS, replace(OPTIONS, near=0.02))
    assert strict.chosen == 2


def test_a_simpler_effect_takes_the_place_of_one_that_imitates_it() -> None:
    stribeck = Entrant(frozenset({"stribeck", "drag"}), 5, imitated=frozenset({"coulomb"}))
    coulomb = Entrant(frozenset({"coulomb", "drag"}), 4)
    better = model("stribeck", "drag", "gain")
    # both are pruned one after the other, though the last is 6 % worse than the best
    assert chosen([model(), better, stribeck, coulomb], 1.0, 0.0, 0.03, 0.06).chosen == 3
    foreign = replace(stribeck, imitated=frozenset())
    assert chosen([model(), better, foreign, coulomb], 1.0, 0.0, 0.03, 0.06).chosen == 2


def test_an_effect_that_takes_next_to_nothing_of_the_squares_is_dropped() -> None:
    """The logarithm counts the last per cent as much as the first half."""
    small = [replace(model(), left=(1.0, 1.0))]
    small += [replace(model("a"), left=(0.03, 0.05)), replace(model("a", "b"), left=(0.01, 0.03))]
    assert chosen(small, 2.0, 0.5, 0.0).chosen == 1
    large = [*small[:1], replace(model("a"), left=(0.03, 0.1)), small[2]]
    assert chosen(large, 2.0, 0.5, 0.0).chosen == 2, "in the mean over horizons it takes a part"
    rest = [*small[:2], replace(model("a", "b"), left=(0.01, 0.004))]
    assert chosen(rest, 2.0, 0.5, 0.0).chosen == 2, "it takes nearly all of what is left without it"


def test_effects_that_take_a_part_together_are_not_dropped_one_after_the_other() -> None:
    parts = [
        replace(model(), left=(1.0,)),
        replace(model("a", "b", "c"), left=(0.01,)),
        replace(model("a", "b"), left=(0.03,)),
        replace(model("a"), left=(0.05,)),
    ]
    assert chosen(parts, 2.0, 0.0, 0.4, 0.8).chosen == 2


def test_a_wave_gives_way_to_the_common_law_that_it_imitates() -> None:
    """It has a number more for what little is left."""
    wave = Entrant(frozenset({"wave"}), 5, 1, imitated=frozenset({"coulomb"}), left=(0.02,))
    coulomb = Entrant(frozenset({"coulomb"}), 3, left=(0.04,))
    declared = replace(model(), left=(1.0,))
    assert chosen([declared, wave, coulomb], 2.0, 0.0, 0.3).chosen == 2
    far = replace(coulomb, left=(0.1,))
    assert chosen([declared, wave, far], 2.0, 0.0, 0.3).chosen == 1


def test_common_effects_with_fewer_numbers_go_before_a_wave_that_takes_little_more() -> None:
    """Whatever they are: a wave of three numbers follows what a law that is nearly right leaves."""
    declared = replace(model(), left=(1.0, 1.0))
    wave = replace(model("a", "wave", numbers=8, uncommon=1), left=(0.04, 0.05))
    common = replace(model("b", "c", numbers=4), left=(0.06, 0.07))
    worse = replace(model("d", numbers=3), left=(0.065, 0.075))
    assert chosen([declared, wave, common, worse], 2.0, 0.0, 0.2, 0.4).chosen == 2
    far = replace(common, left=(0.08, 0.09))
    assert chosen([declared, wave, far], 2.0, 0.0, 0.2).chosen == 1, "it takes a part away"
    decisive = replace(wave, left=(0.002, 0.002))
    few = replace(common, left=(0.03, 0.03))
    assert chosen([declared, decisive, few], 2.0, 0.0, 1.0).chosen == 1, "it takes all but a tenth"


def test_a_decay_that_shows_nearly_all_in_its_first_blocks_is_sure() -> None:
    """That these differ from the later ones is no doubt; one block alone would be."""
    decay = np.array([3.0, 1.0, 0.5, 0.3, 0.2, 0.1, 0.1, 0.05, 0.02, 0.0])
    entrants = [model(), model("a")]
    choice = chosen(entrants, decay, 0.0)
    assert choice.z < 3 and choice.sure
    assert not chosen(entrants, np.where(decay > 2, decay, 0.0), 0.0).sure


def errors_of(*squares: list[float]) -> np.ndarray:
    """E/n of models in two channels, of which the second is at the noise, 2 horizons, 2 folds."""
    rows = np.array(squares, dtype=float)
    quiet = np.ones_like(rows)
    stacked = np.stack([rows, quiet], axis=-1)
    return np.broadcast_to(stacked[:, None, None], (len(rows), 2, 2, *stacked.shape[1:])).copy()


def test_what_shows_at_the_start_of_each_decay_alone_is_sure() -> None:
    """Ten blocks of two signals, of which three of one signal show a law: the blocks at the noise
    outweigh them."""
    errors = errors_of([36, 19, 1, 1, 1, 280, 1, 1, 1, 1], [1.1, 1, 1, 1, 1, 1.4, 1, 1, 1, 1])
    assert take_away_what_stands_out(errors, OPTIONS).tolist() == [False, True]
    entrants = [model(), model("bent")]
    assert choose(entrants, log_scores(errors), FOLDS, OPTIONS).chosen == 0
    entrants[1] = replace(entrants[1], clears=True)
    found = choose(entrants, log_scores(errors), FOLDS, OPTIONS)
    assert (found.chosen, found.sure) == (1, True)


@pytest.mark.parametrize(
    ("declared", "other"),
    [
        pytest.param([36, 1, 1, 1, 1, 280, 1], [1, 1, 1, 1, 1, 1, 1], id="two blocks"),
        pytest.param([4, 4, 4, 1, 1, 1, 1], [1, 1, 1, 1, 1, 1, 1], id="nothing stands out"),
        pytest.param([36, 19, 9, 1, 1, 1, 1], [1, 1, 4, 1, 1, 1, 1], id="half of a block is left"),
        pytest.param([36, 19, 9, 1, 1, 1, 1], [1, 1, 1, 1, 1, 2, 1], id="another becomes worse"),
        pytest.param([36, 19, 9, 1, 1, 1, 1], [1, 1, 1, 1, np.inf, 1, 1], id="it does not run"),
        pytest.param([36, 19, np.inf, 1, 1, 1, 1], [1] * 7, id="the declared one does not run"),
    ],
)
def test_what_stands_out_must_be_taken_away_wherever_it_does(
    declared: list[float], other: list[float]
) -> None:
    assert not take_away_what_stands_out(errors_of(declared, other), OPTIONS).any()
