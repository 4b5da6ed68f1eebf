"""A trace whose refits an executor carries out: the same result, also where a worker is killed."""

from __future__ import annotations

import os
import pickle
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import replace
from itertools import pairwise
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pytest
from oracles.oscillator import candidates_of, problem_of, record, search_of, trial_of
from oracles.swing import write_pendulum
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.errors import DataError
from tracewire.trace import Found, trace
from tracewire.trace.found import data_of
from tracewire.trace.search.workers import Workers
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import Trial


@pytest.fixture
def processes() -> Iterator[ProcessPoolExecutor]:
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        yield pool


@pytest.fixture(scope="module")
def swing(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_pendulum(tmp_path_factory.mktemp("swing"), end=6.0, f_c=0.3)


@pytest.fixture(scope="module")
def here(swing: Path) -> Found:
    return traced(swing)


def traced(
    path: Path, executor: Executor | None = None, tell: Callable[[str], None] | None = None
) -> Found:
    only = {"only": ["acceleration"], "effects": 1}
    return trace(compile(read(path)), options=only, executor=executor, progress=tell)


def data(found: Found) -> dict[str, Any]:
    """All that a trace has found, but for the words, which name a lost worker."""
    return {**data_of(found), "words": None}


def test_a_trace_by_processes_is_that_of_this_process(
    swing: Path, here: Found, processes: ProcessPoolExecutor
) -> None:
    told: list[str] = []
    found = traced(swing, processes, told.append)
    assert data_of(found) == data_of(here)
    assert found.diagram == here.diagram
    assert processes._processes, "the executor was used"
    numbers = [text.rpartition(" (")[2] for text in told if text.startswith("refitting with")]
    assert numbers[0].startswith("1 of") and len(set(numbers)) > 3


def test_a_worker_that_is_killed_loses_nothing(
    swing: Path, here: Found, processes: ProcessPoolExecutor
) -> None:
    killed: list[int] = []

    def kill(text: str) -> None:
        if text.startswith("refitting with") and not killed:
            killed.extend(processes._processes)
            for process in killed:
                os.kill(process, signal.SIGKILL)

    found = traced(swing, processes, kill)
    assert killed
    assert data(found) == data(here)
    assert [w for w in found.words if w not in here.words] == [
        next(w for w in found.words if w.endswith("what was left was done without the executor"))
    ]


def refits(executor: Executor | None) -> list[Trial | None]:
    """Two refits of an oscillator, of which the first has an effect that no wire reaches."""
    search = search_of(problem_of(record(end=6.0), record(use="gate", name="gate")))
    search.workers = Workers(executor)
    now = search.fit_declared()
    coulomb = candidates_of(search.problem)["coulomb @ force"]
    nowhere = replace(coulomb, signals={"rate": "nowhere"})
    asked = [
        search.refits.prepare(now, [PlacedEffect(c, {"level": 0.1})], now.windows.segments)
        for c in (nowhere, coulomb)
    ]
    trials = search.refits.run(now, asked)
    assert [words.partition(":")[0] for words in search.words] == ["coulomb @ force was not tried"]
    return trials


def test_an_effect_that_cannot_be_run_elsewhere_is_left_out_with_a_reason(
    processes: ProcessPoolExecutor,
) -> None:
    failed, trial = refits(processes)
    _, other = refits(None)
    assert failed is None and trial is not None and other is not None
    assert (trial.rss, trial.values, trial.effects) == (other.rss, other.values, other.effects)


def test_windows_that_came_back_follow_those_that_were_sent() -> None:
    """What a worker sends back is a copy. Its windows go on where the one before them ends."""
    problem = problem_of(record(end=6.0), record(end=6.0, name="second", seed=1))
    trial = trial_of(problem)
    sent, back = trial.windows.segments, pickle.loads(pickle.dumps(trial)).windows.segments
    mixed = [pair[n % 2] for n, pair in enumerate(zip(sent, back, strict=True))]
    expected = [later.continues(before) for before, later in pairwise(sent)]
    assert [later.continues(before) for before, later in pairwise(mixed)] == expected
    assert expected.count(False) == 1


class Refusing(Executor):
    """An executor whose work always ends with one error."""

    def __init__(self, error: Exception) -> None:
        self.error = error

    def submit(self, function: Any, /, *arguments: Any, **named: Any) -> Any:
        from concurrent.futures import Future

        future: Future[Any] = Future()
        future.set_result(([self.error] * len(arguments[2]), 1.0))
        return future


def test_an_error_that_is_no_refusal_ends_the_trace() -> None:
    with pytest.raises(DataError, match="unreadable"):
        refits(Refusing(DataError.one("unreadable")))
