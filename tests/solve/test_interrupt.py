"""Pauses change nothing, and Ctrl-C in a pause keeps what there is."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from solve.models import BALL, OSCILLATOR, made
from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.errors import SimulationError
from tracewire.fit import fit
from tracewire.solve import Interrupted, Limits, Run, integrator, simulate, simulate_many
from tracewire.solve.integrator import next_budget
from tracewire.solve.limits import PAUSE
from tracewire.solve.spans import SpanProblem

PENDULUM = Path(__file__).parents[2] / "diagrams/papers/a_torsion/pendulum.yaml"
STICKING = OSCILLATOR.replace("coulomb, rate: v, level: 0.1", "dry_friction, rate: v, slip: 0.1")
# from the random diagrams: where the friction holds v0 at 0, the guard of the floor is 0, too
ON_A_GUARD = """
span: [0, 3.0]
blocks:
  x0: {type: integrator, of: v0, start: 0.0}
  v0: {type: integrator, of: b14, start: -0.261}
  x1: {type: integrator, of: v1, start: -0.5}
  v1: {type: integrator, of: b22, start: 2.0}
  z0: {type: integrator, of: b25, start: -0.5}
  b0: {type: ramp, slope: 0.792, at: 0.264}
  b1: {type: ramp, slope: 1.0, at: 0.0}
  b3: {type: expression, formula: "floor(2*sin(v0))"}
  b5: {type: saturation, of: b3, low: -0.207, high: 0.134}
  b6: {type: max, of: b1, other: b5}
  b7: {type: sin, of: b6}
  b8: {type: tanh, of: v1}
  b9: {type: gain, of: x0, k: -2.499}
  b10: {type: sum, of: [b8, b9]}
  b11: {type: gain, of: v0, k: -0.535}
  b12: {type: sum, of: [b10, b11]}
  b13: {type: dry_friction, rate: v0, slip: 0.129, stick: 1.406}
  b14: {type: sum, of: [b12, b13]}
  b15: {type: sign, of: b0}
  b16: {type: gain, of: x1, k: -1.342}
  b17: {type: sum, of: [b15, b16]}
  b18: {type: gain, of: v1, k: -0.495}
  b19: {type: sum, of: [b17, b18]}
  b20: {type: sum, of: [v1, -v0]}
  b21: {type: dry_friction, rate: b20, slip: 0.384, stick: 0.525}
  b22: {type: sum, of: [b19, b21]}
  b23: {type: gain, of: z0, k: -0.606}
  b24: {type: sin, of: b7}
  b25: {type: sum, of: [b23, b24]}
"""


def paused(monkeypatch: pytest.MonkeyPatch, steps: int) -> None:
    monkeypatch.setattr(integrator, "first_budget", lambda model: steps)
    monkeypatch.setattr(integrator, "next_budget", lambda budget, done, seconds: steps)


@pytest.mark.parametrize("budget", [1, 7, 1000])
@pytest.mark.parametrize("method", ["auto", "dop853", "rosenbrock"])
@pytest.mark.parametrize(
    "model",
    [made(BALL), made(STICKING), compile(read(PENDULUM)), made(ON_A_GUARD)],
    ids=["ball", "friction", "paper A", "on a guard"],
)
def test_pauses_change_no_bit(
    model: Model, method: str, budget: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    options: dict[str, Any] = {"method": method, "rtol": 1e-6}
    paused(monkeypatch, 10**9)
    whole = simulate(model, **options)
    paused(monkeypatch, budget)
    parts = simulate(model, **options)
    assert all(np.array_equal(whole[name], parts[name]) for name in model.recorded)
    assert whole.events == parts.events
    assert whole.final == parts.final
    assert (whole.statistics.steps, whole.statistics.rejected) == (
        parts.statistics.steps,
        parts.statistics.rejected,
    )


def test_the_next_pause_comes_in_time() -> None:
    assert next_budget(1000, 1000, 1.0) == pytest.approx(1000 * PAUSE.seconds)
    assert next_budget(10, 10, 1e-6) == 80  # it grows step by step
    assert next_budget(4, 4, 60.0) == 1


def test_progress_is_told_while_a_run_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    paused(monkeypatch, 10)
    monkeypatch.setattr(integrator.PAUSE, "seconds", 0.0)
    told: list[tuple[float, float]] = []
    simulate(made(BALL), progress=lambda part, left: told.append((part, left)))
    parts = [part for part, _ in told]
    assert len(parts) > 3
    assert parts == sorted(parts)
    assert all(0 <= part <= 1 and left >= 0 for part, left in told)


@pytest.fixture(autouse=True)
def _left_as_it_was(_ctrl_c: None) -> Iterator[None]:
    yield
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def after(parts: int) -> Callable[[float, float], None]:
    """Presses Ctrl-C when the progress is told for the n-th time."""
    told: list[float] = []

    def tell(part: float, left: float) -> None:
        told.append(part)
        if len(told) == parts:
            signal.raise_signal(signal.SIGINT)

    return tell


def interrupted(monkeypatch: pytest.MonkeyPatch, model: Model, **options: Any) -> Interrupted:
    paused(monkeypatch, 40)
    monkeypatch.setattr(integrator.PAUSE, "seconds", 0.0)
    with pytest.raises(Interrupted) as caught:
        simulate(model, progress=after(5), **options)
    return caught.value


def test_an_interrupted_run_is_the_first_part_of_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    model = compile(read(PENDULUM))
    error = interrupted(monkeypatch, model)
    part, whole = error.run, simulate(model)
    assert isinstance(error, SimulationError)
    assert part is not None
    n, events = len(part.t), len(part.events)
    assert 0 < n < len(whole.t)
    assert np.array_equal(part.t, whole.t[:n])
    assert all(np.array_equal(part[name], whole[name][:n]) for name in model.recorded)
    assert 0 < events < len(whole.events)
    assert part.events == whole.events[:events]
    reached = float(str(error).split("t = ")[1].split(" s")[0])
    assert part.t[-1] < reached <= whole.t[n]
    assert "on the way from 0 to " in str(error)
    assert "What there is of the run is in `.run`." in str(error)


def test_an_interrupt_at_the_very_end_is_not_lost(monkeypatch: pytest.MonkeyPatch) -> None:

    model, code = made(BALL), integrator.library()
    whole = simulate(model)

    def last(core: int) -> int:
        status = int(code.advance(core))
        signal.raise_signal(signal.SIGINT)
        return status

    paused(monkeypatch, 10**9)
    monkeypatch.setattr(integrator, "library", lambda: replace(code, advance=last))
    with pytest.raises(Interrupted, match="interrupted at t = 12 s") as caught:
        simulate(model)
    assert caught.value.run is not None
    assert caught.value.run.final == whole.final


def test_the_second_interrupt_ends_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    def press(part: float, left: float) -> None:
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)

    paused(monkeypatch, 10)
    with pytest.raises(KeyboardInterrupt):
        simulate(made(BALL), progress=press)


def test_who_handles_the_signal_himself_keeps_that(monkeypatch: pytest.MonkeyPatch) -> None:
    heard: list[int] = []
    signal.signal(signal.SIGINT, lambda number, frame: heard.append(number))
    paused(monkeypatch, 10)
    monkeypatch.setattr(integrator.PAUSE, "seconds", 0.0)
    run = simulate(made(BALL), progress=after(2))
    assert run.t[-1] == 12
    assert heard == [signal.SIGINT]
    signal.signal(signal.SIGINT, signal.default_int_handler)


def test_rows_that_are_done_survive_an_interrupt() -> None:
    def press(run: Run) -> float:
        if run.parameters["restitution"] == 0.5:
            signal.raise_signal(signal.SIGINT)
        return 1.0

    model, rows = made(BALL), {"restitution": [0.3, 0.4, 0.5, 0.6, 0.7]}
    with pytest.raises(Interrupted, match="interrupted when 3 of 5 runs were done") as caught:
        simulate_many(model, rows, workers=1, observe=["samples", press])
    runs = caught.value.runs
    assert runs is not None
    assert runs.criterion[:3].tolist() == [1.0] * 3
    alone = simulate(model, parameters={"restitution": 0.4})
    assert np.array_equal(runs["x"][1], alone["x"])
    assert runs.errors == dict.fromkeys((3, 4), "interrupted before it began.")


def test_threads_stop_soon_after_an_interrupt(monkeypatch: pytest.MonkeyPatch) -> None:
    """The other rows would take for ever."""
    model = made(BALL.replace("span: [0, 12]", "span: [0, 12]\nrecord: [x]"))
    rows = [{"start.x": 10.0}] + [{"start.x": 10.0 + n} for n in range(1, 200)]
    with pytest.raises(Interrupted) as caught:
        simulate_many(model, rows, workers=2, rtol=1e-11, progress=after(1))
    assert caught.value.runs is not None
    assert len(caught.value.runs.errors) > 100


def test_the_limit_of_events_names_the_guard_that_crossed_most() -> None:
    text = """
span: [0, 100]
blocks:
  x: {type: integrator, of: one}
  one: {type: constant, value: 1}
  slow: {type: expression, formula: sign(sin(x))}
  fast: {type: expression, formula: sign(sin(9*x))}
"""
    pattern = (
        r"block 'fast': the run stopped at t = (\S+) s: more than 20 events, 19 of them where the "
        r"guard 'sin\(9\*x\)' crosses; x = \S+\. Give the block hysteresis, shorten the span"
    )
    with pytest.raises(SimulationError, match=pattern):
        simulate(made(text), limits=Limits(events=20))
    whole = simulate(made(text))
    count = len(whole.events)
    assert len(simulate(made(text), limits=Limits(events=count)).events) == count
    with pytest.raises(SimulationError, match=f"more than {count - 1} events"):
        simulate(made(text), limits=Limits(events=count - 1))


def test_the_limits_of_steps_and_time_name_the_state_that_needs_them() -> None:
    text = """
span: [0, 1000]
blocks:
  slow: {type: integrator, of: one}
  one: {type: constant, value: 1}
  fast: {type: integrator, of: wave}
  wave: {type: expression, formula: cos(1e4*t)}
"""
    said = r"block 'fast': .* steps, the smallest because of 'fast'; slow = .* Loosen rtol"
    with pytest.raises(SimulationError, match=said):
        simulate(made(text), limits=Limits(steps=500))
    said = r"block 'fast': .* of wall time, the smallest because of 'fast'; .* raise the limit"
    began = time.perf_counter()
    with pytest.raises(SimulationError, match=said):
        simulate(made(text), limits=Limits(seconds=0.05))
    assert time.perf_counter() - began < 30


def test_a_fit_is_interrupted_not_penalised(monkeypatch: pytest.MonkeyPatch) -> None:
    def stop(*_: object, **__: object) -> None:
        raise Interrupted([])

    monkeypatch.setattr(SpanProblem, "run", stop)
    with pytest.raises(KeyboardInterrupt):
        fit(compile(read(PENDULUM)))
