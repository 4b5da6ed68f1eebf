"""Horizons: windows of two lengths that tile common blocks, and the folds that leave them out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.oscillator import DIAGRAM, model_of
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.residual import Measured
from tracewire.residual.windows import Section
from tracewire.trace.choose.horizons import REST, Horizons, horizons_of, restrict
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.period import dominant_period

FREE = ("x", "v")
OPTIONS = TraceOptions()


def sine(period: int = 40, count: int = 4000, name: str = "swing", step: float = 0.03) -> Measured:
    t = step * np.arange(count)
    x = np.sin(2 * np.pi * np.arange(count) / period)
    return Measured(name, "train", t, {"x": x}, start={"x": None, "v": None})


def of(*series: Measured, gate: tuple[Measured, ...] = (), free: tuple[str, ...] = FREE,
       options: TraceOptions = OPTIONS) -> Horizons:  # fmt: skip
    sections, judging = ([Section(m, 0, len(m.t)) for m in some] for some in (series, gate))
    return horizons_of(model_of(), sections, judging, free, {"x": 1e-3}, options)


def test_the_horizons_are_a_third_of_a_period_and_five_periods() -> None:
    short, long = of(sine(period=40)).each
    assert (short.length, long.length) == (12, 200)
    assert len(long.segments) == 20


def test_a_turn_is_the_period_of_an_angle_that_goes_round() -> None:
    model = compile(read_text(DIAGRAM.replace("unit: m}", "unit: rad}")))
    t = 0.03 * np.arange(4000)
    angle = 2 * np.pi * (t / 1.2 - 1e-3 * t**2)  # 85 turns in 120 s
    turning = Measured("run", "train", t, {"x": angle}, start={"x": None, "v": None})
    short, long = horizons_of(
        model, [Section(turning, 0, 4000)], [], FREE, {"x": 1e-3}, OPTIONS
    ).each
    assert (short.length, long.length) == (14, 233)


def test_in_a_record_of_few_periods_long_runs_go_over_several_blocks() -> None:
    found = of(sine(count=400), sine(count=200, name="other"))
    short, long = found.each
    assert (short.length, long.length) == (12, 200)
    assert found.count == OPTIONS.least_blocks
    assert [len(segment.rows) for segment in long.segments] == [200, 200, 200]
    for segment, blocks in zip(long.segments, long.blocks, strict=True):
        assert len(set(blocks.tolist())) >= 2 and REST not in blocks
        assert (np.diff(segment.rows) == 1).all()
    many = of(
        sine(count=400), sine(count=200, name="other"), options=replace(OPTIONS, most_samples=500)
    )
    assert {len(segment.rows) for segment in many.each[1].segments} <= {80, 100, 66, 67}
    judging = of(sine(count=400), gate=(sine(count=400, name="judge"),)).gate[1]
    assert {len(segment.rows) for segment in judging.segments} == {200}


@given(st.floats(1e-6, 1e6), st.floats(1e-6, 1e6))
def test_they_do_not_depend_on_units(in_time: float, in_size: float) -> None:
    m = sine(count=600)
    scaled = replace(m, t=in_time * m.t, values={"x": in_size * m.values["x"]})
    assert dominant_period(Section(scaled, 0, 600)) == dominant_period(Section(m, 0, 600))


@pytest.mark.parametrize("count", [300, 700, 4000, 30000])
def test_there_are_seven_to_twenty_blocks(count: int) -> None:
    found = of(sine(count=count))
    assert OPTIONS.least_blocks <= found.count <= OPTIONS.most_blocks


def test_windows_of_both_horizons_tile_the_same_blocks() -> None:
    found = of(sine(), sine(period=50, name="other"))
    rows = []
    for horizon in found.each:
        block: dict[tuple[str, int], int] = {}
        for segment, blocks in zip(horizon.segments, horizon.blocks, strict=True):
            for row, number in zip(segment.rows.tolist(), blocks.tolist(), strict=True):
                block[segment.measured.name, row] = number
        rows.append(block)
    assert rows[0].keys() == rows[1].keys() and len(rows[0]) == 2 * 4000
    assert rows[0] == rows[1]


def test_of_a_long_record_the_short_windows_are_some_of_each_block() -> None:
    m = sine(count=40_000)
    x = m.values["x"].copy()
    x[30_000:] = x[30_000] + 1e-3 * np.random.default_rng(0).standard_normal(10_000)
    found = of(replace(m, values={"x": x}))
    short, long = found.each
    size = sum(len(blocks) for blocks in short.blocks)
    assert 0.9 * OPTIONS.most_short <= size <= 1.1 * OPTIONS.most_short
    assert sum(len(blocks) for blocks in long.blocks) == 40_000
    assert set(np.concatenate(short.blocks)) == set(np.concatenate(long.blocks)), "and at rest"


def test_each_family_of_folds_leaves_every_block_out_once() -> None:
    found = of(sine())
    for family in found.folds:
        assert sorted(block for group in family for block in group) == list(range(found.count))
    scattered, thirds = found.folds
    assert len(scattered) == OPTIONS.folds and len(thirds) == OPTIONS.thirds
    assert all(np.diff(group).tolist() == [1] * (len(group) - 1) for group in thirds)


def test_of_three_series_whole_ones_are_left_out() -> None:
    found = of(*(sine(name=name, count=1000) for name in ("a", "b", "c")))
    for group in found.folds[1]:
        assert len({found.series[block] for block in group}) == 1


def test_series_that_judge_have_blocks_that_no_fold_leaves_out() -> None:
    found = of(sine(), gate=(replace(sine(name="judge", count=1000), use="gate"),))
    judging = list(range(found.fitted, found.count))
    assert [found.series[n] for n in judging] == ["judge"] * 5
    assert all(family[-1] == tuple(judging) for family in found.groups)
    assert max(max(group) for family in found.folds for group in family) < found.fitted


def test_without_a_period_or_free_starts_there_is_one_run_in_pieces() -> None:
    fall = replace(sine(count=60), values={"x": np.linspace(0, 1, 60) ** 2})
    for found in (of(fall), of(sine(), free=())):
        (horizon,) = found.each
        assert len(horizon.segments) == 1
        assert found.count >= OPTIONS.least_blocks
        assert sorted(set(horizon.blocks[0].tolist())) == list(range(found.count))


def test_the_user_sets_the_longer_horizon_in_seconds() -> None:
    _, long = of(sine(), options=replace(OPTIONS, horizon=7.5)).each
    assert long.length == pytest.approx(250, abs=1)


def test_a_window_keeps_the_rows_that_count() -> None:
    (horizon,) = of(sine(), free=()).each
    segment = restrict(horizon.segments[0], np.array([3, 5]))
    assert segment.rows.tolist() == horizon.segments[0].rows[[3, 5]].tolist()


def test_where_a_body_rests_for_good_there_are_no_blocks() -> None:
    m = sine(count=3000)
    x = m.values["x"].copy()
    x[1000:] = x[1000] + 1e-3 * np.random.default_rng(0).standard_normal(2000)
    found = of(replace(m, values={"x": x}))
    for horizon in found.each:
        resting = [np.all(blocks == REST) for blocks in horizon.blocks]
        rows = np.concatenate(
            [s.rows for s, rest in zip(horizon.segments, resting, strict=True) if rest]
        )
        assert 1000 <= rows.min() <= 1010 and rows.max() == 2999
        kept = horizon.without(range(found.count))
        assert [number for number, _ in kept] == np.flatnonzero(resting).tolist()
