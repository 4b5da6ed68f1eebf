"""The shipped records are what their script makes, and hold what they promise."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from oracles import double_torsion, make_records

FOLDER = make_records.DIAGRAMS


def read(name: str) -> NDArray[np.float64]:
    lines = [line for line in (FOLDER / name).read_text().splitlines() if line[0] != "#"]
    return np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]]).T


@pytest.mark.parametrize("name", make_records.RECORDS)
def test_record_is_reproduced_to_the_byte(name: str) -> None:
    assert make_records.RECORDS[name]().encode() == (FOLDER / name).read_bytes()


def test_check_names_the_record_that_differs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(make_records, "DIAGRAMS", tmp_path)
    monkeypatch.setattr(make_records, "RECORDS", {"same.csv": lambda: "1\n", "b.csv": lambda: "2"})
    monkeypatch.setattr(sys, "argv", ["make_records.py", "--check"])
    (tmp_path / "same.csv").write_bytes(b"1\n")
    (tmp_path / "b.csv").write_bytes(b"1\n")
    assert make_records.main() == 1
    assert capsys.readouterr().out == "differs: diagrams/b.csv\n"
    (tmp_path / "b.csv").write_bytes(b"2")
    assert make_records.main() == 0


def test_torsion_parameters_are_changed_by_30_to_40_percent_both_ways() -> None:
    factors = np.array(list(make_records.TORSION_FACTORS.values()))
    changes = np.abs(factors - 1.0)
    assert changes.min() > 0.3 - 1e-12 and changes.max() < 0.4 + 1e-12
    assert 3 <= np.count_nonzero(factors > 1.0) <= 6


def test_torsion_criterion_falls_by_300_from_the_start_to_the_truth() -> None:
    _, _, phi2 = read("papers/a_torsion/measured.csv")
    floor = make_records.criterion(phi2, make_records.torsion_parameters())
    assert floor <= make_records.criterion(phi2, make_records.TORSION_START) / 300.0


def test_torsion_noise_is_that_of_the_header() -> None:
    """Variance 0.02^2 + 0.044^2/12 deg2, and every value a multiple of 0.044 deg."""
    _, *angles = read("papers/a_torsion/measured.csv")
    states = double_torsion.solve(make_records.torsion_parameters()).states[[0, 2]]
    noise = np.degrees(np.array(angles) - states)
    assert np.std(noise) == pytest.approx(np.sqrt(0.02**2 + 0.044**2 / 12.0), rel=0.1)
    steps = np.degrees(np.array(angles)) / 0.044
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-4)


@pytest.mark.parametrize("side", ["+", "-"])
def test_torsion_disk_meets_both_springs(side: str) -> None:
    """In each of the two full periods: an untouched spring hides its damper's parameter."""
    solution = double_torsion.solve(make_records.torsion_parameters())
    begins = np.array([begin for begin, _ in solution.intervals("disk contact", side)])
    period = 2.0 * np.pi / double_torsion.PARAMETERS["omega"]
    assert {0, 1} <= set((begins // period).astype(int))


@pytest.mark.parametrize("name", ["lessons/pendulum_swing.csv", "lessons/pendulum_swing_2.csv"])
def test_pendulum_still_swings_when_most_of_the_record_is_over(name: str) -> None:
    t, theta = read(name)
    assert t.size == 2001
    np.testing.assert_allclose(np.diff(t), 0.01, atol=1e-9)
    assert np.ptp(theta[t > 15.0]) > 50 * make_records.PENDULUM_NOISE
