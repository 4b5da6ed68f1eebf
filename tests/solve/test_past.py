"""Runs that begin in the middle: what delayed signals were before is given, and not declared."""

from __future__ import annotations

import numpy as np
import pytest
import tracewire as tw
from tracewire.errors import OptionError
from tracewire.solve import Held, Span, simulate_spans

LOOP = """
span: [0, 6]
record: [x]
parameters: {T: {value: 0.5, unit: s}}
blocks:
  x: {type: integrator, of: rate, start: 1}
  late: {type: delay, of: x, time: T, before: 0.8}
  rate: {type: expression, formula: -late - x/2}
"""
INTEGRAL = """
span: [1, 2]
record: [y]
parameters: {T: {value: 0.75, unit: s}}
blocks:
  y: {type: integrator, of: late, start: 0}
  u: {type: sum, of: [y]}
  late: {type: delay, of: u, time: T, before: 100}
"""


@pytest.mark.parametrize("backend", ["llvm", "python"])
def test_a_run_goes_on_where_another_was(backend: str) -> None:
    model = tw.compile(tw.read_text(LOOP), backend=backend)  # type: ignore[arg-type]
    t = np.linspace(0, 6, 6001)
    whole = tw.simulate(model, times=t, rtol=1e-10)
    half = t[3000:]
    part = tw.simulate(
        model, times=half, span=(3.0, 6.0), start={"x": whole["x"][3000]},
        past={"x": (t[:3001], whole["x"][:3001])}, rtol=1e-10,
    )  # fmt: skip
    # straight lines between samples 1 ms apart miss a curve by 1.3e-7 of its bend
    assert part["x"] == pytest.approx(whole["x"][3000:], abs=2e-7)


def test_the_past_counts_from_its_first_time_on() -> None:
    """y' = 100 before the record, then the straight line 4 (s - 0.5) of it: by hand."""
    model = tw.compile(tw.read_text(INTEGRAL))
    past = {"u": ([0.5, 1.0], [0.0, 2.0])}
    run = tw.simulate(model, times=[1.25, 1.75], past=past, rtol=1e-10)
    assert run["y"] == pytest.approx([25.0, 25.0 + 0.5], rel=1e-6)


def test_a_past_that_is_held_jumps() -> None:
    model = tw.compile(tw.read_text(INTEGRAL))
    held = Held(np.array([0.25, 0.5, 0.9]), np.array([3.0, 5.0, 7.0]))
    run = tw.simulate(model, times=[1.25, 1.65, 1.75], past={"u": held}, rtol=1e-10)
    assert run["y"] == pytest.approx([0.75, 2.75, 3.45], rel=1e-6)


def test_a_delay_of_the_past_has_its_sensitivity() -> None:
    """y(1.5) of the line 4 s from 0.25 to 0.75 is 1; d/dT = -(u(0.75) - u(0.25)) = -2."""
    model = tw.compile(tw.read_text(INTEGRAL))
    past = {"u": ([0.0, 1.0], [0.0, 4.0])}
    run = tw.simulate(model, times=[1.5], past=past, sensitivities=["T"])
    assert run["y"] == pytest.approx([1.0], rel=1e-6)
    assert run.sensitivities["T"]["y"] == pytest.approx([-2.0], rel=1e-6)


def test_a_span_may_follow_another_where_the_past_is_given() -> None:
    model = tw.compile(tw.read_text(LOOP))
    spans = [Span(1.0, 2.0, np.array([2.0]), {"x": 1.0}), Span(2.0, 3.0, np.array([3.0]), {}, True)]
    with pytest.raises(OptionError, match="a span that follows another begins at states"):
        simulate_spans(model, spans)
    runs = simulate_spans(model, spans, past={"x": ([0.0, 5.0], [1.0, 1.0])})
    assert not runs.errors


@pytest.mark.parametrize(
    ("past", "said"),
    [
        ({"rate": ([0, 1], [0, 1])}, "unknown delayed signal 'rate'; there are: x"),
        ({"x": ([0], [1])}, "the past of 'x' is not usable. Give two times or more that ascend"),
        ({"x": ([0, 1], [1, np.nan])}, "the past of 'x' is not usable"),
        ({"x": ([1, 0], [1, 1])}, "the past of 'x' is not usable"),
    ],
)
def test_a_past_that_does_not_fit_is_refused(past: dict[str, object], said: str) -> None:
    model = tw.compile(tw.read_text(LOOP))
    with pytest.raises(OptionError) as error:
        tw.simulate(model, past=past)  # type: ignore[arg-type]
    assert said in str(error.value)


def test_the_past_of_all_delays_is_given_or_of_none() -> None:
    text = INTEGRAL + "  later: {type: delay, of: late, time: 0.1}\n"
    model = tw.compile(tw.read_text(text.replace("[y]", "[y, later]")))
    with pytest.raises(OptionError, match="the past of 'late' is not told, and that of others is"):
        tw.simulate(model, past={"u": ([0, 1], [0, 1])})
