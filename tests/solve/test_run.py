from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from solve.models import BALL, OSCILLATOR, run
from tracewire.errors import OptionError


def test_samples_are_saved_as_csv_to_the_last_bit(tmp_path: Path) -> None:
    result = run(OSCILLATOR, times=[0.1, 0.7, 1.3])
    path = result.save(tmp_path / "run.csv")
    with path.open(newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["t", "x", "v"]
    values = np.array(rows, dtype=float)
    assert values[:, 0].tolist() == result.t.tolist()
    assert values[:, 1].tolist() == result["x"].tolist()


def test_samples_and_events_are_saved_as_npz(tmp_path: Path) -> None:
    result = run(BALL)
    with np.load(result.save(tmp_path / "run.npz")) as saved:
        assert saved["x"].tolist() == result["x"].tolist()
        assert saved["event_time"].tolist() == [event.time for event in result.events]
        assert set(saved["event_kind"]) == {"reset"}


def test_another_ending_is_refused(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"cannot be saved as 'run.xls'.*\.csv or \.npz"):
        run(BALL, times=[0.0, 1.0]).save(tmp_path / "run.xls")


def test_a_signal_that_is_not_recorded_says_what_is() -> None:
    with pytest.raises(OptionError, match=r"unknown recorded signal 'g'; there are: v, x.*record"):
        run(BALL, times=[0.0, 1.0])["g"]


def test_a_run_is_shown_in_other_units_and_stays_in_si() -> None:
    plain = run(OSCILLATOR, times=[0.0, 1.0])
    shown = plain.in_units({"x": "mm"})
    assert shown["x"].tolist() == plain["x"].tolist()
    assert shown.as_shown("x") == pytest.approx(1e3 * plain["x"], rel=1e-15)
    assert (shown.look("x").unit, shown.look("x").label) == ("mm", "x")
    with pytest.raises(OptionError, match="unknown recorded signal 'y'"):
        plain.in_units({"y": "mm"})
    with pytest.raises(OptionError, match=r"'x' is in mm?, and 'kg' is another quantity"):
        replace(plain, units={"x": "m"}).in_units({"x": "kg"})
    derived = run("parameters: {v: {value: 1, unit: m/s}}\nblocks: {x: {type: integrator, of: y}, "
                  "y: {type: constant, value: v}}", times=[0.0, 1.0], record=("x",))  # fmt: skip
    assert derived.in_units({"x": "mm"}).as_shown("x")[1] == pytest.approx(1e3)
    with pytest.raises(OptionError, match="'x' is in m, and 'bar' is another quantity"):
        derived.in_units({"x": "bar"})


def test_a_run_knows_what_it_cost_and_how_it_ended() -> None:
    result = run(OSCILLATOR)
    counted = result.statistics
    assert counted.steps > 20
    assert counted.evaluations >= 6 * counted.steps
    assert result.final["x"] == result["x"][-1]
    assert result.parameters == {}
