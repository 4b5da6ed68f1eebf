from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from solve.models import BALL, OSCILLATOR, made, run
from tracewire.errors import OptionError
from tracewire.solve import Held, simulate

DRIVEN = "span: [0, 1]\ninputs: [u]\nblocks: {x: {type: integrator, of: u}}"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"method": "rk45"}, r"'rk45'; there are: auto, dop853, dormand_prince, rk4, rosenbrock"),
        ({"rtol": 0.0}, r"rtol = 0 and atol = 0 cannot be met.*Take rtol between"),
        ({"rtol": 2.0}, r"rtol = 2 "),
        ({"rtol": float("nan")}, r"rtol = nan "),
        ({"atol": -1.0}, r"rtol = 1e-06 and atol = -1 cannot be met"),
        ({"atol": float("inf")}, r"atol = inf cannot be met"),
        ({"atol": {"x": 1e-9, "v": 0.0}}, r"atol = {x: 1e-09, v: 0} cannot be met.*atol above 0"),
        ({"atol": {"x": 1e-9, "y": 1e-9}}, r"unknown state 'y'; there are: v, x"),
        ({"span": (1, 1)}, r"the span from 1 to 1 s is empty"),
        ({"span": (0, float("inf"))}, r"the span from 0 to inf s is empty"),
        ({"times": [0.0, 0.0]}, r"the sample times do not ascend"),
        ({"times": [1.0, 0.5]}, r"the sample times do not ascend"),
        ({"times": []}, r"the sample times do not ascend"),
        (
            {"span": (0, 1), "times": [0.5, 2.0]},
            r"sample times from 0.5 to 2 s are not within the span from 0 to 1 s",
        ),
        ({"every": 0.0}, r"an output every 0 s from 0 to .* s cannot be kept"),
        ({"every": 0.5, "times": [0.0, 1.0]}, r"an output every 0.5 s\. Give times= or every="),
        ({"parameters": {"restitutoin": 1.0}}, r"unknown parameter.*Did you mean 'restitution'"),
        ({"parameters": {"restitution": float("nan")}}, r"'restitution' is given as nan"),
        ({"start": {"y": 1.0}}, r"unknown state 'y'; there are: v, x"),
        ({"start": {"x": float("inf")}}, r"the start of 'x' is inf"),
        ({"preset": "late"}, r"unknown preset 'late'; there is no preset here"),
        ({"inputs": {"u": ([0.0], [1.0])}}, r"unknown input 'u'; there is no input here"),
    ],
)
def test_an_option_that_does_not_fit_is_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(OptionError, match=message):
        simulate(made(BALL), **options)


def test_the_time_between_samples_may_be_given() -> None:
    own, given = OSCILLATOR + "\nevery: 0.5\n", run(OSCILLATOR, span=(0, 2), every=0.25)
    assert given.t.tolist() == [0.25 * n for n in range(9)]
    assert run(own, span=(0, 2), every=0.25).t.tolist() == given.t.tolist()
    assert run(own, span=(0, 2)).t.tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]


def test_an_absolute_tolerance_may_be_given_by_state() -> None:
    """A state that nobody cares about does not hold up the others."""
    text = """
span: [0, 10]
blocks:
  x: {type: integrator, of: a, start: 1}
  a: {type: gain, of: x, k: -1}
  y: {type: integrator, of: b}
  b: {type: expression, formula: 1e-3*sin(300*t)}
"""
    both = run(text, atol=1e-9).statistics.steps
    one = run(text, atol={"y": 1.0})
    assert one.statistics.steps < both / 10
    assert one.final["x"] == pytest.approx(np.exp(-10), rel=1e-4)
    usual = run(text, atol={"x": 1e-9, "y": 1e-9})
    assert usual.statistics.steps == both


def test_what_is_left_out_of_the_tolerances_is_as_usual() -> None:
    finals = [run(OSCILLATOR, rtol=1e-5, atol=atol).final for atol in (None, {}, {"x": 1e-8})]
    assert finals[0] == finals[1] == finals[2]


@pytest.mark.parametrize(
    "table",
    [([0.0, 1.0], [1.0]), ([1.0, 0.0], [1.0, 2.0]), ([0.0, 1.0], [1.0, float("nan")]), ([], [])],
)
def test_a_measured_input_that_is_not_usable_is_refused(table: tuple[Any, Any]) -> None:
    with pytest.raises(OptionError, match="table of the input 'u' is not usable"):
        run(DRIVEN, inputs={"u": table})


def test_an_input_without_a_source_is_refused() -> None:
    with pytest.raises(OptionError, match="the input 'u' has no source") as caught:
        run(DRIVEN)
    assert "`--series`" in str(caught.value)
    assert "inputs: {u: {default: 0}}" in str(caught.value)


def test_all_problems_are_told_together() -> None:
    with pytest.raises(OptionError) as caught:
        simulate(made(BALL), parameters={"a": 1.0, "b": 2.0})
    assert len(caught.value.problems) == 2


@pytest.mark.parametrize("every", [0.0, -1.0, 1e-9])
def test_an_output_interval_must_be_usable(every: float) -> None:
    with pytest.raises(OptionError, match="an output every"):
        run(OSCILLATOR + "every: dt\nparameters: {dt: 1}\n", parameters={"dt": every})


def test_an_output_interval_beyond_the_span_is_refused() -> None:
    with pytest.raises(OptionError, match="every 31 s has one sample only from 0 to 30 s"):
        run(OSCILLATOR + "every: 31\n")
    assert run(OSCILLATOR + "every: 30\n").t.tolist() == [0.0, 30.0]


def test_samples_follow_the_diagram_or_the_options() -> None:
    assert len(run(OSCILLATOR).t) == 1001
    assert run(OSCILLATOR + "every: 0.1\n").t == pytest.approx(np.arange(301) * 0.1)
    result = run(OSCILLATOR, times=[1.0, 2.0], start={"x": 0.0, "v": 1.0})
    assert result.t.tolist() == [1.0, 2.0]
    assert result.start == {"x": 0.0, "v": 1.0}
    assert run(OSCILLATOR, span=(5, 6)).t[0] == 5.0


def test_arguments_are_left_as_they_were() -> None:
    times, start = np.array([0.5, 1.0]), {"x": 0.5}
    run(OSCILLATOR, times=times, start=start)
    assert times.tolist() == [0.5, 1.0]
    assert start == {"x": 0.5}


@pytest.mark.parametrize(
    ("span", "known"),
    [((0, 3), True), ((-1, 2), True), ((-2, 2), False), ((0, 3.5), False)],
)
def test_a_run_tells_where_its_input_is_not_known(span: tuple[float, float], known: bool) -> None:
    drive = ([0.0, 1.0, 2.0], [0.0, 1.0, 2.0])
    for given in (drive, Held(*map(np.array, drive))):
        told = run(DRIVEN, inputs={"u": given}, span=span).warnings
        assert bool(told) is not known
        for text in told:
            assert text.startswith("the input 'u' is known from 0 to 2 s, and the run goes from ")


def test_a_constant_input_is_known_at_all_times() -> None:
    assert run(DRIVEN, inputs={"u": ([0.0], [1.0])}, span=(0, 99)).warnings == ()
