"""How far a model is from its data."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tracewire.trace.trials.relative_error import relative_error


@pytest.mark.parametrize("slope", [0.0, 50.0])
def test_the_error_is_a_part_of_what_a_signal_moves_beside_a_straight_line(slope: float) -> None:
    """As an angle that goes round does: its turns are no motion that a model is good at."""
    t = np.linspace(0.0, 7.0, 701)
    samples = np.column_stack([slope * t + np.sin(2 * np.pi * t), 3 * np.cos(2 * np.pi * t)])
    parts = [np.arange(0, 300), np.arange(300, 701)]
    measured = SimpleNamespace(name="run")
    segments = [
        SimpleNamespace(measured=measured, t=t[rows], samples=lambda rows=rows: samples[rows])
        for rows in parts
    ]
    residuals = [np.full((len(rows), 2), [4.0, 1.0]) for rows in parts]
    criterion = SimpleNamespace(sigma={"run": np.array([0.01, 0.02])})
    trial: Any = SimpleNamespace(
        windows=SimpleNamespace(segments=segments, residuals=residuals, criterion=criterion)
    )
    moves = np.sqrt(0.5)  # of the sine: its line has a slope of 3/(pi*T), which takes a little away
    assert relative_error(trial) == pytest.approx(0.04 / moves, rel=0.02)
