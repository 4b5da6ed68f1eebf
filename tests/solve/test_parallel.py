"""Work side by side has the same results in threads and wherever an executor runs it."""

from __future__ import annotations

import os
import re
import signal
import struct
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest
from solve.models import BALL, made
from tracewire import Interrupted, Plane, Run, bifurcation, simulate_many, stability_chart, sweep
from tracewire.errors import OptionError, SimulationError, TracewireError
from tracewire.solve import PartProgress, carry_out
from tracewire.solve.interrupt import StopFlag

MATHIEU = """
span: [0, 10]
parameters: {a: 1, q: 0.2}
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: rate}
  rate: {type: expression, formula: "-(a - 2*q*cos(2*t))*x - 0.05*v"}
"""
RESTITUTION = np.linspace(0.5, 0.9, 23)


@pytest.fixture(scope="module")
def processes() -> Iterator[Executor]:
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        yield pool


def highest(run: Run) -> float:
    return float(run["x"].max())


def squared(number: int, stop_flag: StopFlag) -> int:
    if number == 5:
        raise SimulationError.one("five is refused")
    return number**2


def slept(number: int, stop_flag: StopFlag) -> int:
    """The first one is done at once, and none of the others."""
    time.sleep(600 if number else 0)
    return number


def killed(number: int, stop_flag: StopFlag) -> int:
    if number == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


@pytest.mark.parametrize("here", [True, False])
def test_a_job_is_done_for_each_number_and_may_fail(processes: Executor, here: bool) -> None:
    found = {}

    def take(arguments: tuple[int], result: int | TracewireError) -> None:
        found[arguments[0]] = result

    executor = None if here else processes
    assert not carry_out(squared, [(n,) for n in range(9)], take, workers=2, executor=executor)
    assert sorted(found) == list(range(9))
    assert isinstance(found[5], TracewireError)
    assert "five is refused" in str(found[5])
    assert [found[n] for n in (0, 2, 8)] == [0, 4, 64]


def test_a_task_that_follows_from_another_is_done_behind_it() -> None:
    order: list[tuple[int, object]] = []

    def take(arguments: tuple[int], result: object) -> tuple[int] | None:
        order.append((arguments[0], result))
        return (arguments[0] + 10,) if arguments[0] < 20 else None

    told: list[float] = []
    progress = PartProgress(lambda part, left: told.append(part), 6, 0)
    stopped = carry_out(squared, [(1,), (2,)], take, workers=1, progress=progress)
    assert not stopped
    assert order == [(1, 1), (11, 121), (21, 441), (2, 4), (12, 144), (22, 484)]
    assert told[-1] == 1.0


def test_many_runs_are_the_same_to_the_last_bit(processes: Executor) -> None:
    model, rows = made(BALL), {"restitution": RESTITUTION}
    here = simulate_many(model, rows, observe=["samples", highest])
    there = simulate_many(model, rows, observe=["samples", highest], executor=processes)
    assert np.array_equal(here.samples, there.samples)
    assert np.array_equal(here.final, there.final)
    assert np.array_equal(here.criterion, there.criterion)
    assert np.array_equal(here.event_counts, there.event_counts)


def test_sweeps_and_charts_are_the_same_to_the_last_bit(processes: Executor) -> None:
    model = made(BALL)
    grid = {"restitution": RESTITUTION, "start.x": [5.0, 10.0]}
    here = sweep(model, grid, ["max(x)", "count()"])
    there = sweep(model, grid, ["max(x)", "count()"], executor=processes)
    assert all(np.array_equal(here[name], there[name]) for name in here.values)
    mathieu, x, y = made(MATHIEU), ("a", [0.5, 1.0, 1.5]), ("q", [0.0, 0.3])
    one = stability_chart(mathieu, x, y, np.pi)
    assert np.array_equal(
        stability_chart(mathieu, x, y, np.pi, executor=processes).radius, one.radius
    )


@pytest.mark.parametrize("direction", ["both", "down_up", "apart"])
def test_bifurcations_are_the_same_to_the_last_bit(processes: Executor, direction: str) -> None:
    model, plane = made(MATHIEU), Plane(period=np.pi)
    options = {"skip": 3, "keep": 4, "direction": direction}
    here = bifurcation(model, "a", [0.8, 1.0, 1.2], plane, **options)  # type: ignore[arg-type]
    there = bifurcation(model, "a", [0.8, 1.0, 1.2], plane, executor=processes, **options)  # type: ignore[arg-type]
    for one, other in zip(here.branches, there.branches, strict=True):
        assert np.array_equal(one.points, other.points)


def test_what_cannot_be_sent_is_told(processes: Executor) -> None:
    with pytest.raises(OptionError, match="cannot be sent to another process"):
        simulate_many(
            made(BALL),
            {"restitution": RESTITUTION},
            observe=lambda run: 1.0,
            executor=processes,
        )


def test_a_worker_that_is_killed_is_told() -> None:
    done: set[int] = set()

    def take(arguments: tuple[int], result: object) -> None:
        done.add(arguments[0])

    def work() -> None:
        with ProcessPoolExecutor(1, get_context("spawn")) as pool:
            carry_out(killed, [(n,) for n in range(9)], take, executor=pool)

    with pytest.raises(SimulationError, match=r"a worker of the executor has ended .* new exec"):
        work()
    assert done <= {0, 1, 2}


def last_words(run: Run) -> float:
    if run.parameters["restitution"] > 0.8:
        os.kill(os.getpid(), signal.SIGKILL)
    return 1.0


@pytest.mark.parametrize("count", [1, 2])
def test_a_worker_that_is_killed_in_the_middle_of_a_message_is_told(count: int) -> None:
    """The pool alone would wait for the rest of the message, and never end."""
    with ProcessPoolExecutor(count, get_context("spawn")) as pool:

        def take(task: tuple[int], result: int | TracewireError) -> None:
            begun = struct.pack("!i", 1000) + b"a part"
            os.write(pool._result_queue._writer.fileno(), begun)
            next(iter(pool._processes.values())).kill()

        with pytest.raises(SimulationError, match="a worker of the executor has ended"):
            carry_out(slept, [(n,) for n in range(9)], take, executor=pool)


def test_runs_that_were_done_before_a_worker_was_killed_are_kept() -> None:
    with (
        ProcessPoolExecutor(1, get_context("spawn")) as pool,
        pytest.raises(Interrupted, match=r"a worker of the executor has ended") as caught,
    ):
        simulate_many(made(BALL), {"restitution": RESTITUTION}, observe=last_words, executor=pool)
    assert caught.value.runs is not None
    assert np.isfinite(caught.value.runs.criterion).any()


def test_a_sweep_goes_on_with_another_executor(tmp_path: Path, processes: Executor) -> None:
    """What was done before a worker was killed is in the partial file."""
    model, grid, file = made(BALL), {"restitution": RESTITUTION}, tmp_path / "sweep.npz"
    told = []

    def kill(part: float, left: float) -> None:
        told.append(part)
        for process in pool._processes.values():
            process.kill()

    with ProcessPoolExecutor(1, get_context("spawn")) as pool, pytest.raises(SimulationError):
        sweep(model, grid, ["max(x)"], executor=pool, partial=file, progress=kill)
    with np.load(file) as kept:
        assert 0 < kept["done"].sum() < len(RESTITUTION)
    again = sweep(model, grid, ["max(x)"], executor=processes, partial=file)
    assert np.array_equal(again["max(x)"], sweep(model, grid, ["max(x)"])["max(x)"])


def test_the_example_of_the_page_runs(tmp_path: Path) -> None:
    root = Path(__file__).parents[2]
    page = (root / "docs" / "parallel.md").read_text(encoding="utf-8")
    (example, *_) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    program = tmp_path / "study.py"
    program.write_text(f"{example}    print(len(runs.final), runs.errors)\n", encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    done = subprocess.run(
        [sys.executable, str(program)], cwd=root, env=environment, capture_output=True, text=True
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "100 {}\n", "")
