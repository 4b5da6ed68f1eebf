"""Steady states and linearisation against what can be written down."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from analyse.models import DRY, DUFFING, MEISSNER, OSCILLATOR, PENDULUM, made
from tracewire.analyse import linearise, steady_state
from tracewire.errors import AnalysisError, OptionError

KINK = """
span: [0, 1]
parameters: {k: 2}
blocks:
  x: {type: integrator, of: r}
  r: {type: expression, formula: "1 - x - FORCE"}
"""
INSIDE = """
span: [0, 1]
inputs: {u: {default: 0}}
blocks:
  body: {type: cart, push: u}
subsystems:
  cart:
    inputs: [push]
    outputs: {way: x}
    blocks:
      x: {type: integrator, of: v}
      v: {type: integrator, of: a}
      a: {type: expression, formula: "push - 9*x - 0.4*v"}
"""


def test_the_matrices_of_an_oscillator() -> None:
    found = linearise(made(OSCILLATOR), inputs=["u", "k", "pull"], outputs=["x", "energy", "pull"])
    assert found.states == ("x", "v")
    assert found.A.tolist() == [[0, 1], [-4, -0.1]]
    # at x = 1, v = 0: d a/d u = 3, d a/d k = -x
    assert found.B.tolist() == [[0, 0, 0], [3, -1, 1]]
    assert found.C.tolist() == [[1, 0], [4, 0], [0, 0]]
    assert found.D.tolist() == [[0, 0, 0], [0, 0.5, 0], [0, 0, 1]]
    assert found.rates.tolist() == [0, -4]
    assert found.eigenvalues == pytest.approx(np.roots([1, 0.1, 4]))
    assert found.verdict == "not a steady state"
    assert found.told == "the rates are v' = -4"
    assert linearise(made(OSCILLATOR), at={"x": 0}).verdict == "stable"


def test_a_linearisation_predicts_small_changes() -> None:
    """dx' = A dx + B du against differences of the rates of the nonlinear model."""
    model = made(DUFFING)
    at = {"x": 0.7, "v": -0.4}
    base = linearise(model, at=at, t=0.3, inputs=["f"])
    for name in ("x", "v"):
        near = linearise(model, at={**at, name: at[name] + 1e-6}, t=0.3)
        column = model.states.index(name)
        assert (near.rates - base.rates) / 1e-6 == pytest.approx(base.A[:, column], abs=1e-5)
    near = linearise(model, at=at, t=0.3, parameters={"f": 0.3 + 1e-6})
    assert (near.rates - base.rates) / 1e-6 == pytest.approx(base.B[:, 0], abs=1e-5)


@pytest.mark.parametrize(
    ("force", "said"),
    [
        ("abs(x)", "'x' of r is at its level"),
        ("max(x, 0)", "is at its level"),
        ("(k if x > 0 else 1)", "'x' of r is held at zero"),  # both sides lead there
    ],
)
def test_a_kink_is_refused_by_name(force: str, said: str) -> None:
    model = made(KINK.replace("FORCE", force))
    with pytest.raises(AnalysisError, match="there are no slopes at t = 0 s") as caught:
        linearise(model)
    assert said in str(caught.value)
    assert "Give states on one side of it" in str(caught.value)
    assert linearise(model, at={"x": 0.1}).A.shape == (1, 1)


def test_a_guard_that_makes_no_difference_is_no_kink() -> None:
    smooth = made(KINK.replace("FORCE", "x*abs(x)*abs(x)"))
    assert linearise(smooth).A.tolist() == [[-1.0]]


def test_a_switch_of_a_source_does_not_matter_unless_slopes_change() -> None:
    wave = "{type: square, amplitude: force, frequency: omega}"
    drive = made(OSCILLATOR.replace("{type: expression, formula: force*cos(omega*t)}", wave))
    assert linearise(drive, parameters={"force": 2}).A.tolist() == [[0, 1], [-4, -0.1]]
    with pytest.raises(AnalysisError, match="is at its level"):
        linearise(made(MEISSNER), t=float(np.pi))
    assert linearise(made(MEISSNER), t=0.1).A.tolist() == [[0, 1], [-1.5, 0]]


def test_a_sticking_body_has_no_linearisation() -> None:
    with pytest.raises(AnalysisError, match="'v' of friction is held at zero"):
        linearise(made(DRY))


def test_an_event_that_is_due_is_named() -> None:
    ball = made("""
span: [0, 1]
blocks:
  x: {type: integrator, of: v, start: 0}
  v: {type: integrator, of: g, start: 1}
  g: {type: constant, value: -9.81}
events: [{when: x, crosses: down, set: {v: -v}}]
""")
    with pytest.raises(AnalysisError, match=r"'x' .* is at zero, where an event fires"):
        linearise(ball)
    assert linearise(ball, at={"x": 0.5}).A.tolist() == [[0, 1], [0, 0]]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"inputs": ["w"]}, "unknown input 'w'"),
        ({"outputs": ["w"]}, "unknown signal 'w'"),
        ({"at": {"y": 1}}, "unknown state 'y'"),
        ({"parameters": {"K": 1}}, "unknown parameter 'K'"),
        ({"preset": "P"}, "unknown preset 'P'"),
    ],
)
def test_names_that_do_not_exist(options: dict[str, Any], said: str) -> None:
    with pytest.raises(OptionError, match=said):
        linearise(made(OSCILLATOR), **options)


def test_a_constant_is_no_input() -> None:
    model = made(KINK.replace("FORCE", "x*c") + "  c: {type: constant, value: 2}\n")
    with pytest.raises(OptionError, match=r"'c' is a constant.*Make it a parameter, or an input"):
        linearise(model, inputs=["c"])


def test_slopes_that_are_not_finite_are_told() -> None:
    with pytest.raises(AnalysisError, match="the matrix A is not finite"):
        linearise(made(KINK.replace("FORCE", "sqrt(x)")))


def test_a_linear_model_goes_on_in_control() -> None:
    control = pytest.importorskip("control")
    found = linearise(made(INSIDE), inputs=["u"], outputs=["body.x"])
    system = found.to_control()
    assert system.state_labels == ["body_x", "body_v"]
    assert (system.input_labels, system.output_labels) == (["u"], ["body_x"])
    np.testing.assert_allclose(np.sort_complex(control.poles(system)), np.roots([1, 0.4, 9])[::-1])
    assert control.dcgain(system) == pytest.approx(1 / 9)


def test_control_is_asked_for_where_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    found = linearise(made(OSCILLATOR), inputs=["u"], outputs=["x"])
    monkeypatch.setitem(sys.modules, "control", None)
    with pytest.raises(AnalysisError, match=r"not installed. Install it: pip install control"):
        found.to_control()


def test_a_pendulum_hangs_stably_and_stands_unstably() -> None:
    model = made(PENDULUM)
    hanging = steady_state(model, parameters={"b": 0.2})
    assert hanging.x == pytest.approx([0, 0], abs=1e-9)
    assert hanging.verdict == "stable"
    upright = steady_state(model, guess={"phi": 3.0}, parameters={"b": 0.2})
    assert upright["phi"] == pytest.approx(np.pi, abs=1e-9)
    assert upright.verdict == "unstable"
    assert upright.eigenvalues == pytest.approx(np.sort(np.roots([1, 0.2, -9.81]))[::-1])
    assert steady_state(model).verdict == "neutral"


def test_the_three_steady_states_of_duffing() -> None:
    model = made(DUFFING)
    for guess, root in ((0.1, 0.0), (0.8, 1.0), (-0.8, -1.0)):
        found = steady_state(model, guess={"x": guess}, parameters={"f": 0})
        assert found.x == pytest.approx([root, 0], abs=1e-9)
        assert found.verdict == ("unstable" if root == 0 else "stable")
        assert found.residual < 1e-8


def test_a_body_that_sticks_is_steady_but_nonsmooth() -> None:
    found = steady_state(made(DRY))
    assert found.x.tolist() == [0.05, 0.0]
    assert (found.verdict, len(found.eigenvalues)) == ("nonsmooth", 0)
    assert "held at zero" in found.guards[0]


def test_a_driven_model_has_no_steady_state() -> None:
    for model in (made(DUFFING), made(MEISSNER)):
        with pytest.raises(AnalysisError, match="change with time by themselves") as caught:
            steady_state(model)
        assert "Set its drive to zero" in str(caught.value)


def test_where_there_is_none_the_rates_that_are_left_are_told() -> None:
    model = made("span: [0, 1]\nblocks:\n  x: {type: integrator, of: r}\n"
                 "  r: {type: expression, formula: 1 + x*x}\n")  # fmt: skip
    with pytest.raises(AnalysisError, match=r"no steady state was found: at x = .* x' = 1"):
        steady_state(model, guess={"x": 0.3})


@pytest.mark.parametrize("start", [0.1, 0.8, 1.4, 1.56, -1.5])
def test_a_pendulum_that_is_let_go_has_its_steady_state_below(start: float) -> None:
    """At 1.4 Newton's whole step leads to -4.4."""
    found = steady_state(made(PENDULUM), guess={"phi": start}, parameters={"b": 0.2})
    assert found.x == pytest.approx([0, 0], abs=1e-9)
    assert found.verdict == "stable"


STOPS = """
span: [0, 10]
parameters: {push: 0, c: 0.1}
blocks:
  stop: {type: hard_stop, force: force, high: 0.5236, low: -1.5708, start: 0.3}
  force: {type: expression, formula: push - 9.81*sin(stop.x) - c*stop.v}
"""


@pytest.mark.parametrize("start", [-1.57, -1.0, 0.3, 0.52])
def test_a_pendulum_between_stops_has_its_steady_state_between_them(start: float) -> None:
    found = steady_state(made(STOPS), guess={"stop.x": start})
    assert found.x == pytest.approx([0, 0], abs=1e-9)
    assert found.verdict == "stable"


@pytest.mark.parametrize(("push", "side"), [(6, 0.5236), (30, 0.5236), (-12, -1.5708)])
@pytest.mark.parametrize("rate", [0.0, 0.7])
def test_a_body_that_is_pressed_against_a_stop_lies_on_it(
    push: float, side: float, rate: float
) -> None:
    guess = {"stop.v": rate}
    found = steady_state(made(STOPS), guess=guess, parameters={"push": push})
    assert found.x == pytest.approx([side, 0], abs=1e-12)
    assert found.verdict == "nonsmooth"
    assert "is held at zero" in found.guards[0]


def test_a_start_beyond_a_stop_is_refused() -> None:
    with pytest.raises(AnalysisError, match=r"beyond a contact: 'stop.x - 0.5236' is 0.4764"):
        steady_state(made(STOPS), guess={"stop.x": 1.0})


KINKED = """
span: [0, 1]
parameters: {c: 0.3, u: 1}
blocks:
  x: {type: integrator, of: v, start: 2}
  v: {type: integrator, of: a}
  a: {type: expression, formula: "FORCE"}
"""


@pytest.mark.parametrize(
    ("force", "start", "rest"),
    [
        ("-x - v - c*sign(v)", 2.0, 0.3),  # creeps to where the friction just holds it
        ("-x - v - c*sign(v)", 0.2, 0.2),
        ("u - v - max(2*x, 0) - 0.1*x", -3.0, 1 / 2.1),
        ("u - v - 2*max(x, 0) + min(x + 1, 0)", 3.0, 0.5),
    ],
)
def test_guards_on_the_way_are_passed_or_hold(force: str, start: float, rest: float) -> None:
    found = steady_state(made(KINKED.replace("FORCE", force)), guess={"x": start})
    assert found.x == pytest.approx([rest, 0], abs=1e-9)


def test_an_event_on_the_way_is_named() -> None:
    text = KINKED.replace("FORCE", "-x - v") + (
        "events: [{when: x - 1, crosses: down, set: {x: 3}}]\n"
    )
    with pytest.raises(AnalysisError, match=r"ends where 'x - 1' is zero, where events.0. fires"):
        steady_state(made(text))
    assert steady_state(made(text), guess={"x": 0.5}).x == pytest.approx([0, 0], abs=1e-9)


@pytest.mark.parametrize("unit", [1e-12, 1.0, 1e9])
def test_a_steady_state_is_one_in_any_unit(unit: float) -> None:
    text = KINKED.replace("FORCE", f"-x - v + c*{unit}*cos(x/{unit})")
    text = text.replace("start: 2", f"start: {2 * unit}")
    found = steady_state(made(text), guess={"x": 2 * unit})
    assert found["x"] / unit == pytest.approx(0.28761, abs=1e-4)
    assert found.verdict == "stable"
    assert linearise(made(text), at={"x": 2 * unit}).verdict == "not a steady state"
    assert linearise(made(text), at=found.values).verdict == "stable"
