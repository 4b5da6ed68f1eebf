"""Analyses of a signal are shown in the unit in which the user has it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tracewire.analyse import growth_rate, invariant_drift, scalogram, spectrum
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.show import present
from tracewire.solve import Run, simulate

TEXT = """\
span: [0, 20]
blocks:
  x: {type: integrator, of: v, start: 0.1, unit: mm}
  v: {type: integrator, of: a, unit: m/s}
  a: {type: expression, formula: -40*x - 0.1*v, unit: m/s^2}
"""


@pytest.fixture(scope="module")
def run() -> Run:
    return simulate(compile(read_text(TEXT)))


def test_a_spectrum_is_shown_in_the_unit_of_the_signal(run: Run) -> None:
    found = spectrum(run, "x")
    table = found.table()
    assert table.header[1] == "amplitude [mm]"
    assert float(table.rows[0][1]) == pytest.approx(1000 * found.lines[0].amplitude, rel=1e-3)
    assert found.unit == "m"


def test_a_scalogram_is_shown_in_the_unit_of_the_signal(run: Run) -> None:
    found = scalogram(run, "x", low=0.5, high=2)
    assert found.text().endswith(" mm")
    assert f"{1000 * found.amplitude.max():.6g} mm" in found.text()


def test_a_drift_is_shown_in_the_unit_of_the_signal(run: Run) -> None:
    (found,) = invariant_drift(run, ["x"])
    assert found.table().rows[0][1:3] == ("mm", "100")
    assert found.start == 0.1


def test_a_growth_is_drawn_in_the_unit_of_the_signal(run: Run, tmp_path: Path) -> None:
    found = growth_rate(run, "x")
    shown = found.as_shown
    assert shown.size == pytest.approx(1000 * found.size)
    line = np.exp(shown.level + shown.rate * shown.t)
    assert line == pytest.approx(shown.size, rel=0.01)
    assert found.figure().axes[0].get_ylabel() == "size of x [mm]"
    assert present(found).data["rate"] == found.rate
