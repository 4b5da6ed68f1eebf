"""What a user has in hand can be copied, and sent to another process."""

from __future__ import annotations

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest
import tracewire
from solve.models import BALL
from tracewire import Found, Model, Run, load_measured, read, read_text, simulate

LESSON = Path(__file__).parents[1] / "diagrams" / "lessons" / "pendulum.yaml"
OWN = """\
from tracewire.library import Block, Input, Output

twice = Block("twice", "Twice a signal.", inputs=[Input("of")], outputs=[Output("out", "2*of")])
"""


@pytest.fixture(scope="module")
def ball() -> Model:
    return tracewire.compile(read_text(BALL))


def sent(value: object) -> object:
    return pickle.loads(pickle.dumps(value))


def test_a_model_runs_in_another_process_as_here(ball: Model) -> None:
    run = simulate(ball)
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        there = pool.submit(simulate, ball).result()
    assert there.final == run.final
    assert there.events == run.events
    assert np.array_equal(there["x"], run["x"])


@pytest.mark.parametrize("make", [sent, copy.deepcopy, copy.copy])
def test_diagrams_and_models_are_equal_to_their_copies(make: object, ball: Model) -> None:
    assert callable(make)
    simulate(ball)
    diagram = read(LESSON)
    assert make(diagram) == diagram
    assert make(ball) == ball
    assert simulate(make(ball)).final == simulate(ball).final


@pytest.mark.parametrize("make", [sent, copy.deepcopy])
def test_a_run_keeps_its_events(make: object, ball: Model) -> None:
    assert callable(make)
    run = simulate(ball)
    same = make(run)
    assert isinstance(same, Run)
    assert same.events == run.events
    assert len(same.events) > 2


def test_a_library_travels_without_its_files(tmp_path: Path) -> None:
    file = tmp_path / "own.py"
    file.write_text(OWN, encoding="utf-8")
    text = "span: [0, 1]\nblocks:\n  x: {type: integrator, of: y, start: 1}\n"
    diagram = read_text(text + "  y: {type: twice, of: x}\n", libraries=[file])
    content = pickle.dumps(diagram)
    file.unlink()
    run = simulate(tracewire.compile(pickle.loads(content)))
    assert run.final["x"] == pytest.approx(np.exp(2), rel=1e-6)


def test_measured_data_and_a_fit_travel() -> None:
    model = tracewire.compile(read(LESSON))
    (measured, *_) = load_measured(model)
    same = sent(measured)
    assert np.array_equal(same.t, measured.t)  # type: ignore[attr-defined]
    fit = tracewire.fit(model)
    again = sent(fit)
    assert isinstance(again, tracewire.Fit)
    assert again.values == fit.values
    assert str(again) == str(fit)


@pytest.mark.slow
def test_what_a_trace_found_travels() -> None:
    found = tracewire.trace(tracewire.compile(read(LESSON)))
    same = sent(found)
    assert isinstance(same, Found)
    assert same.effects == found.effects
    assert same.values == found.values
