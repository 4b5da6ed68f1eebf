"""Which samples are fitted, which accept, and which are held back for the final claim."""

from __future__ import annotations

import numpy as np
import pytest
from oracles.oscillator import model_of, record
from tracewire.errors import DataError
from tracewire.residual import Measured
from tracewire.residual.windows import Section
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.data_split import DataSplit, split_data

OPTIONS = TraceOptions()


def rows(sections: tuple[Section, ...]) -> np.ndarray:
    return np.concatenate([np.arange(s.first, s.end) for s in sections])


def test_of_a_lone_series_no_sample_is_used_twice() -> None:
    m = record()
    found = split_data([m], OPTIONS.split)
    train, gate, last = rows(found.train), rows(found.gate), rows(found.validate)
    assert len(np.intersect1d(train, gate)) == 0
    np.testing.assert_array_equal(np.sort(np.concatenate((train, gate, last))), np.arange(len(m.t)))
    assert last[0] > max(train.max(), gate.max())
    assert len(last) == pytest.approx(len(m.t) / 6, abs=1)
    assert len(train) == pytest.approx(2 * len(gate), abs=6)
    assert found.words == (
        "the last sixth of 'swing' is held back for the final claim",
        "every third of 9 equal parts of the rest of 'swing' is not fitted: there an effect must "
        "help, too (the gate)",
    )


def test_the_claim_on_a_run_that_ends_at_rest_is_made_where_it_moves() -> None:
    """On the last sixth of all it would be one about a body at rest."""
    still = record(damping=1.0)
    found = split_data([still], OPTIONS.split)
    (claim,) = found.validate
    x = still.values["x"]
    moving = next(n for n in range(len(x)) if np.ptp(x[n:]) <= 0.02 * np.ptp(x))
    assert claim.first == pytest.approx(5 / 6 * moving, rel=0.1)
    assert claim.end - claim.first == pytest.approx(2 / 6 * moving, rel=0.1)
    assert max(rows(found.train).max(), rows(found.gate).max()) < claim.first
    assert found.words[0].startswith("the last sixth of 'swing' before it settles, at ")


def test_noise_on_a_run_at_rest_is_no_motion() -> None:
    """White noise of 2 % of the range goes through 15 % of it."""
    still = record(damping=1.0)
    (claim,) = split_data([still], OPTIONS.split).validate
    noise = 0.02 * np.random.default_rng(1).standard_normal(len(still.t))
    still.values["x"][:] += noise * np.ptp(still.values["x"])
    (noisy,) = split_data([still], OPTIONS.split).validate
    assert noisy.end < len(still.t)
    assert 0.6 * claim.first < noisy.first < 1.1 * claim.first


def test_a_run_that_hardly_moves_before_it_rests_is_cut_as_a_whole() -> None:
    hit = record()
    hit.values["x"][:] = np.where(np.arange(len(hit.t)) < 20, 1.0, 0.0)
    found = split_data([hit], OPTIONS.split)
    (claim,) = found.validate
    assert claim.end == len(hit.t) and claim.first == int(len(hit.t) * 5 / 6)
    said = "nothing moves in the last sixth of 'swing', so that the free runs there tell little"
    (words,) = (words for words in found.words if said in words)
    assert words.endswith("name another run under `measured:`, with `use: validate`")


def test_series_that_have_a_use_keep_it_whole() -> None:
    series = [record(name=use, use=use, end=6.0) for use in ("train", "gate", "validate")]
    found = split_data(series, OPTIONS.split)
    for sections, m in zip((found.train, found.gate, found.validate), series, strict=True):
        assert sections == (Section(m, 0, len(m.t)),) or [
            (s.measured.name, s.first, s.end) for s in sections
        ] == [(m.name, 0, len(m.t))]
    assert found.words == ()


def test_with_a_gate_alone_the_claim_comes_from_the_last_sixth() -> None:
    train, gate = record(), record(name="gate", use="gate")
    found = split_data([train, gate], OPTIONS.split)
    assert [s.measured.name for s in found.gate] == ["gate"]
    assert found.train[0].end == found.validate[0].first
    assert found.validate[0].end == len(train.t)


def test_the_whole_of_the_train_series_leaves_out_what_is_held_back() -> None:
    m, gate = record(), record(name="gate", use="gate")
    alone: DataSplit = split_data([m], OPTIONS.split)
    assert [(s.first, s.end) for s in alone.whole()] == [(0, alone.validate[0].first)]
    assert {s.measured.name for s in split_data([m, gate], OPTIONS.split).whole()} == {"swing"}


def test_windows_of_sections_never_cross_their_edges() -> None:
    found = split_data([record()], OPTIONS.split)
    windows = found.windows(model_of(), found.train, 40, ("x", "v"))
    np.testing.assert_array_equal(np.concatenate([w.rows for w in windows]), rows(found.train))
    assert found.longest == max(s.end - s.first for s in found.train)


def test_a_signal_that_no_train_series_measures_is_refused() -> None:
    m = record(name="other", use="validate")
    other = Measured("other", "validate", m.t, {"v": m.values["x"]})
    with pytest.raises(DataError, match="'other' measures 'v', which no train series measures"):
        split_data([record(), other], OPTIONS.split)
