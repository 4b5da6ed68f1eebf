"""A calibration without a unit is in that of its column."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from residual.series_files import message, model_of, wave
from tracewire.residual import load_measured

CLEAN = "    clean: [{{calibrate: {{signal: theta, gain: {}, offset: {}}}}}]\n"


def series(gain: float, offset: float) -> str:
    return (
        "  run:\n    file: run.csv\n    time: t\n    signals: {theta: {column: angle}}\n"
        "    start: {theta: 0, omega: 0}\n" + CLEAN.format(gain, offset)
    )


def test_a_neutral_calibration_changes_nothing(file: Path) -> None:
    wave(file, "t,angle [deg],u")
    (plain,) = load_measured(model_of(file, series(1, 0).partition("    clean")[0]))
    (run,) = load_measured(model_of(file, series(1, 0)))
    assert run.values["theta"].tolist() == plain.values["theta"].tolist()


def test_gain_and_offset_are_in_the_unit_of_the_header(file: Path) -> None:
    wave(file, "t,angle [deg],u")
    (plain,) = load_measured(model_of(file, series(1, 0)))
    (run,) = load_measured(model_of(file, series(-2, 90)))
    assert run.values["theta"] == pytest.approx(math.pi / 2 - 2 * plain.values["theta"])
    assert "theta: calibrated, -2*value + 90 in deg" in run.steps


def test_a_column_of_another_quantity_needs_the_unit_behind_the_calibration(file: Path) -> None:
    wave(file, "t,angle [V],u")
    assert "its column 'angle' in V" in message(model_of(file, series(2, 0)))
