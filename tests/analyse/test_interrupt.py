"""Ctrl-C in long work: it ends soon, says what there is, and what is done is kept."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from analyse.models import LORENZ, MATHIEU, made
from tracewire.analyse import Plane, bifurcation, lyapunov, stability_chart, sweep
from tracewire.solve import Interrupted


@pytest.fixture(autouse=True)
def _tell_each(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tracewire.solve.progress.PAUSE.told_every", 0.0)


class Stop:
    """Presses Ctrl-C once some of the work is done."""

    def __init__(self) -> None:
        self.pressed = False

    def __call__(self, part: float, left: float) -> None:
        if part > 0.2 and not self.pressed:
            self.pressed = True
            os.kill(os.getpid(), signal.SIGINT)


def test_charts_and_sweeps_say_how_far_they_are(tmp_path: Path) -> None:
    model = made(MATHIEU)
    axes: Any = (("a", np.linspace(0, 3, 20)), ("q", np.linspace(0, 1, 10)))
    file = tmp_path / "chart.npz"
    with pytest.raises(Interrupted, match=r"interrupted when \d+ of 200 points were done") as told:
        stability_chart(model, *axes, "pi", progress=Stop(), partial=file)
    assert f"They are in '{file}'" in str(told.value)
    with np.load(file) as kept:
        assert 40 <= kept["done"].sum() < 200
    assert np.isfinite(stability_chart(model, *axes, "pi", partial=file).radius).all()
    with pytest.raises(Interrupted, match=r"Name a partial file .* to keep them"):
        sweep(model, {"a": np.linspace(0, 3, 50)}, ["end(y)"], progress=Stop())


def test_a_bifurcation_diagram_keeps_its_points(tmp_path: Path) -> None:
    model, file = made(MATHIEU), tmp_path / "b.npz"
    options: Any = {"skip": 5, "keep": 5, "partial": file, "parameters": {"q": 0.0}}
    arguments: Any = ("a", np.linspace(1, 3, 60), Plane(period="pi"))
    with pytest.raises(Interrupted, match=r"interrupted when \d+ of 60 points were done"):
        bifurcation(model, *arguments, progress=Stop(), **options)
    found = bifurcation(model, *arguments, **options)
    assert np.array_equal(
        found["up"].points,
        bifurcation(model, *arguments, **(options | {"partial": None}))["up"].points,
    )


def test_exponents_end_where_they_are() -> None:
    with pytest.raises(Interrupted, match="interrupted at t = "):
        lyapunov(made(LORENZ), 1000.0, interval=0.5, progress=Stop())
