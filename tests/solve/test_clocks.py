"""When clocks tick: an offset above zero is the time of the first tick."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from solve.models import kinds, made, run
from tracewire.errors import DiagramError, SimulationError
from tracewire.solve import Held, simulate

CLOCK = """
span: [0, 2]
parameters: {T: 0.5, begin: OFFSET}
blocks:
  n: {type: integrator, of: zero}
  zero: {type: constant, value: 0}
  now: {type: time}
  held: {type: zero_order_hold, of: now, period: T, offset: OFFSET, start: -7}
events:
  - {every: 0.5, offset: begin, set: {n: n + 1}}
record: [n, held]
"""
EVEN = [0.0, 0.5, 1.0, 1.5, 2.0]


@pytest.mark.parametrize(
    ("offset", "ticks"),
    [
        (0, EVEN),
        (0.2, [0.2, 0.7, 1.2, 1.7]),
        (0.3, [0.3, 0.8, 1.3, 1.8]),
        (0.5, EVEN[1:]),
        (1.0, EVEN[2:]),
        (1.3, [1.3, 1.8]),
        (7.25, []),
        (-0.2, [0.3, 0.8, 1.3, 1.8]),
        (-0.5, EVEN),
    ],
)
def test_the_first_tick_is_at_the_offset(offset: float, ticks: list[float]) -> None:
    result = run(CLOCK.replace("OFFSET", str(offset)))
    times = [event.time for event in result.events]
    assert times == pytest.approx([tick for tick in ticks for _ in range(2)], abs=1e-12)
    assert set(kinds(result)) <= {"reset"}
    assert result.final["n"] == len(ticks)
    assert result["held"][-1] == pytest.approx(ticks[-1] if ticks else -7, abs=1e-12)


@pytest.mark.parametrize("period", [0, -0.5])
def test_a_clock_that_would_never_tick_is_refused(period: float) -> None:
    text = CLOCK.replace("period: T", f"period: {period}").replace("OFFSET", "0")
    with pytest.raises(DiagramError, match=f"'period' must be above 0 s, not {period}"):
        made(text)


def test_a_run_that_would_stop_a_clock_is_refused() -> None:
    model = made(CLOCK.replace("OFFSET", "0"))
    wanted = "block 'held': the parameters do not meet 'T > 0': T = 0"
    with pytest.raises(SimulationError, match=wanted):
        simulate(model, parameters={"T": 0})


@pytest.mark.parametrize(
    ("offset", "span", "ticks"),
    [
        (0, (-1, 1), [-1.0, -0.5, 0.0, 0.5, 1.0]),
        (-0.2, (-1, 1), [-0.7, -0.2, 0.3, 0.8]),
        (0.2, (-1, 1), [0.2, 0.7]),
        (0.5, (-1, 1), [0.5, 1.0]),
        (0.5, (0.25, 1), [0.5, 1.0]),
        (0.5, (0.5, 1), [0.5, 1.0]),
        (1.3, (-1, 1), []),
        (0.5, (10, 11), [10.0, 10.5, 11.0]),
        (1.3, (10.3, 11), [10.3, 10.8]),
        (10.3, (10.1, 11), [10.3, 10.8]),
    ],
)
def test_a_span_may_begin_anywhere(
    offset: float, span: tuple[float, float], ticks: list[float]
) -> None:
    result = run(CLOCK.replace("OFFSET", str(offset)), span=span)
    own = [event.time for event in result.events if event.block == "events[0]"]
    assert own == pytest.approx(ticks, abs=1e-12)
    assert result.final["n"] == len(ticks)


def test_an_offset_is_a_parameter_like_any_other() -> None:
    model = made(CLOCK.replace("OFFSET", "0.75"))
    result = simulate(model, parameters={"begin": -0.25}, sensitivities=["begin"])
    ticks = [event for event in result.events if event.block == "events[0]"]
    assert [tick.time for tick in ticks] == pytest.approx([0.25, 0.75, 1.25, 1.75])
    later = simulate(model, sensitivities=["begin"])
    ticks = [event for event in later.events if event.block == "events[0]"]
    assert [tick.time for tick in ticks] == pytest.approx([0.75, 1.25, 1.75])
    assert [tick.sensitivity["begin"] for tick in ticks] == pytest.approx(np.ones(3))


def test_clocks_of_one_instant_read_what_was_before_whatever_their_offsets() -> None:
    text = """
span: [0, 2]
blocks:
  now: {type: time}
  first: {type: zero_order_hold, of: now, period: 0.25, start: -1}
  second: {type: zero_order_hold, of: first, period: 0.5, offset: 0.5, start: -2}
record: [second]
"""
    result = run(text, times=[0.4, 0.5, 0.9, 1.0])
    assert result["second"] == pytest.approx([-2, 0.25, 0.25, 0.75], abs=1e-12)


@pytest.mark.parametrize(
    ("clock", "said"),
    [
        ("every: 1, offset: -1e300", "do not meet 'abs(-1e+300) <= 1000000000*1'. Give the clock"),
        ("every: T, offset: far", "'abs(far) <= 1000000000*T': far = -1e+12, T = 1e-06. Give the"),
    ],
)
def test_ticks_that_numbers_cannot_tell_apart_are_refused(clock: str, said: str) -> None:
    text = f"""
parameters: {{T: 1e-6, far: -1e12}}
blocks:
  x: {{type: integrator, of: x}}
events: [{{{clock}, set: {{x: 1}}}}]
"""
    with pytest.raises(SimulationError) as error:
        simulate(made(text))
    assert said in str(error.value)


def test_a_block_whose_ticks_numbers_cannot_tell_apart_is_refused() -> None:
    block = "{type: unit_delay, of: u, period: 1e-6, offset: -1e6}"
    text = f"blocks:\n  u: {{type: time}}\n  y: {block}\n"
    with pytest.raises(
        SimulationError, match=r"block .y.: the parameters do not meet .abs\(-1000000"
    ):
        simulate(made(text))


KNOWN_TIMES = """
span: [0, 2]
inputs: [u]
parameters: {T: 0.1}
blocks:
  now: {type: time}
  jump: {type: expression, formula: "SOURCE"}
  kept: {type: relay, of: jump, on_at: 0.5, off_at: -0.5}
  loop: {type: expression, formula: "min(max(jump - 0.5*loop, -1), 1)"}
  seen: {type: expression, formula: "SEEN"}
  taken: {type: zero_order_hold, of: seen, period: T, start: -7}
  late: {type: unit_delay, of: seen, period: T}
record: [seen, taken, late]
"""
SOURCES = (
    "2.0*(1 if t - 3*T >= 0 else 0) - 3.0*(1 if t - 7*T >= 0 else 0)",
    "floor(t/T) - 5",
    "2*floor(t/(2*T)) - 5",
    "u",
    "u + floor(t/(2*T))",
)
SEEN = (
    "jump",
    "min(max(jump, -1), 1)",
    "1 if jump > 0.5 else -1",
    "abs(jump) + now",
    "kept",
    "loop",
)


@pytest.mark.parametrize("method", ["auto", "rosenbrock"])
@pytest.mark.parametrize("seen", SEEN)
@settings(max_examples=4, deadline=None)
@given(
    source=st.sampled_from(SOURCES),
    values=st.lists(st.integers(-3, 3), min_size=12, max_size=12),
    period=st.sampled_from([0.1, 0.07, 0.125]),
)
@example(source="u", values=[0, 0, 2, 2, -3, -3, 1, 1, 0, 0, 0, 0], period=0.1)
@example(source=SOURCES[0], values=[0] * 12, period=0.1)
def test_a_clock_reads_what_jumps_at_its_tick_behind_the_jump(
    method: str, seen: str, source: str, values: list[int], period: float
) -> None:
    """Whatever makes it jump, and whatever lies between: the sample is what a run keeps there.

    Xcos 6.1 samples a step at a tick of its clock so (STEP_FUNCTION, SampleCLK, SAMPHOLD_m).
    """
    ticks = period * np.arange(12.0)
    found = simulate(
        made(KNOWN_TIMES.replace("SOURCE", source).replace("SEEN", seen)),
        parameters={"T": period},
        times=ticks,
        span=(0.0, 11 * period),
        inputs={"u": Held(ticks, np.array(values, dtype=float))},
        method=method,
    )
    assert found["taken"] == pytest.approx(found["seen"], abs=1e-12)
    assert found["late"][2:] == pytest.approx(found["seen"][1:-1], abs=1e-12)


@pytest.mark.parametrize("samples", [1, 3])
def test_a_delay_of_some_periods_between_clocks_is_as_many_samples(samples: int) -> None:
    text = """
span: [0, 1]
parameters: {T: 0.07, D: DELAY}
blocks:
  count: {type: expression, formula: t/T}
  held: {type: zero_order_hold, of: count, period: T}
  sent: {type: delay, of: held, time: D}
  again: {type: zero_order_hold, of: sent, period: T}
record: [again]
"""
    text = text.replace("DELAY", str(samples * 0.07))
    found = run(text, times=0.07 * (np.arange(12) + 0.5))["again"]
    assert found[samples:] == pytest.approx(np.arange(12.0 - samples), abs=1e-9)
