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
  body: {type: mass, push: u}
subsystems:
  mass:
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
    assert found.verdict == "stable"


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
        ("(k if x > 0 else 1)", "is at its level"),
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


def test_where_there_is_none_the_rate_that_is_left_is_told() -> None:
    model = made("span: [0, 1]\nblocks:\n  x: {type: integrator, of: r}\n"
                 "  r: {type: expression, formula: 1 + x*x}\n")  # fmt: skip
    with pytest.raises(AnalysisError, match="the rate of 'x' is still 1"):
        steady_state(model)
