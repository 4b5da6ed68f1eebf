from __future__ import annotations

import time
from typing import Any

import pytest
from solve.models import BALL, LIMITS, made, one, run
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import OptionError, SimulationError
from tracewire.solve import Limits, simulate


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            one("-1 - sqrt(x)", 1.0),
            r"t = 0\.6137056\d+ s: 'x' is not finite \(nan\).*root of a neg",
        ),
        (one("1/(x - 2)", 2.0), r"'rate' is not finite \(nan|inf\).*division by zero"),
        (one("x*x", 4.0), r"t = 0\.2500\d* s: the step became smaller than.*because of 'x'"),
        (one("exp(x*x*x)", 5.0), r"t = .* s: .*'x'"),
        (one("log(t - 0.5)", 0.0), r"t = 0 s: 'rate' is not finite \(nan\)"),
    ],
)
def test_a_run_that_cannot_go_on_names_block_and_time(text: str, message: str) -> None:
    with pytest.raises(SimulationError, match=message) as caught:
        run(text)
    assert "the run stopped at t = " in str(caught.value)
    assert "; x = " in str(caught.value)


@pytest.mark.parametrize("method", ["dormand_prince", "rosenbrock"])
def test_another_method_is_proposed_unless_it_is_in_use(method: str) -> None:
    magnet = """
span: [0, 5]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: pull}
  pull: {type: expression, formula: -1e-3/(0.05 + x)**2}
"""
    with pytest.raises(SimulationError, match="the step became smaller") as caught:
        run(magnet, method=method)
    proposed = "; try the method 'rosenbrock'." in str(caught.value)
    assert proposed == (method != "rosenbrock")


def test_a_recorded_signal_that_is_not_finite_is_refused() -> None:
    text = one("1", 0.0, "  y: {type: expression, formula: 1/(t - 0.5)}")
    with pytest.raises(
        SimulationError, match=r"block 'y': the recorded signal 'y' is not finite.*t = 0.5 s"
    ):
        run(text, record=("y",), times=[0.0, 0.5, 1.0])


def test_the_step_limit() -> None:
    with pytest.raises(SimulationError, match=r"t = .* s: more than 10 steps.*Loosen rtol"):
        run(one("cos(50*t)"), limits=Limits(steps=10))


@pytest.mark.parametrize(
    "given", [{"method": "rk4", "step": 1e-9}, {"limits": Limits(max_step=1e-9)}]
)
def test_more_steps_than_a_run_may_take_are_refused_before_the_first(given: Any) -> None:
    said = r"1 s in steps of at most 1e-09 s are 1e\+09 steps\. A run takes at most 5e\+07: take"
    with pytest.raises(OptionError, match=said):
        simulate(made(one("cos(t)")), **given)


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ("max_step: 1e-9", r"<text>:2:11: 1 s in steps of at most 1e-09 s are 1e\+09 steps"),
        ("max_step: h", r"<text>:2:11: steps of -1 s at most lead nowhere"),
        ("every: 1e-9", r"<text>:2:8: an output every 1e-09 s from 0 to 1 s cannot be kept"),
        ("every: 2", r"<text>:2:8: an output every 2 s has one sample only from 0 to 1 s"),
    ],
)
def test_what_the_diagram_sets_is_refused_with_its_place(key: str, said: str) -> None:
    blocks = "blocks: {x: {type: integrator, of: y}, y: {type: time}}"
    text = f"span: [0, 1]\n{key}\nparameters: {{h: 1}}\n{blocks}\n"
    with pytest.raises(OptionError, match=said):
        simulate(compile(read_text(text)), parameters={"h": -1})


def test_the_limit_of_wall_time() -> None:
    began = time.perf_counter()
    with pytest.raises(SimulationError, match=r"more than 0.05 s of wall time.*Shorten the span"):
        run(one("cos(1e6*t)"), rtol=1e-10, limits=Limits(seconds=0.05))
    assert time.perf_counter() - began < 30


@pytest.mark.parametrize("restitution", [0.97, 0.8, 0.5, 0.1, 0.01, 0.0])
@pytest.mark.parametrize("rtol", [1e-4, 1e-8])
@pytest.mark.parametrize("method", ["dormand_prince", "rosenbrock"])
def test_a_ball_never_falls_through_the_floor(restitution: float, rtol: float, method: str) -> None:
    values = {"restitution": restitution}
    result = simulate(
        made(BALL), parameters=values, span=(0, 150), rtol=rtol, method=method, limits=LIMITS
    )
    assert result["x"].min() > -1e-9
    assert result.final["x"] == pytest.approx(0.0, abs=1e-9)


def test_a_spiral_of_ever_faster_switches_is_refused_where_it_ends() -> None:
    """Twisting: x and v shrink with each switch, and both are zero after finite time."""
    text = """
span: [0, 3]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: expression, formula: -sign(x + 0.2*v*abs(v))}
"""
    said = r"block 'a': no consistent mode at t = 6\.92\d* s for the guards 'v' in a, 'x \+ 0\.2"
    with pytest.raises(SimulationError, match=said):
        run(text, span=(0, 20))
