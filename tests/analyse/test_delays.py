"""Steady states, characteristic roots and transfer functions of diagrams with delays."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import lambertw
from tracewire.analyse import linearise, periodic_orbit, steady_state
from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.errors import AnalysisError, OptionError

LATE = """
parameters: {a: 1, T: 1}
inputs: {u: {default: 0}}
record: [x]
blocks:
  x: {type: integrator, of: rate, start: 0.3}
  late: {type: delay, of: x, time: T, before: 1}
  rate: {type: expression, formula: u - a*late}
"""


def made(text: str) -> Model:
    return compile(read_text(text))


@pytest.mark.parametrize(
    ("a", "time"), [(1.0, 1.0), (0.3, 0.5), (1.6, 1.0), (-0.5, 2.0), (40, 0.1)]
)
def test_the_roots_are_those_of_lamberts_function(a: float, time: float) -> None:
    """s = -a exp(-s T) has the roots W_k(-a T)/T."""
    found = linearise(made(LATE), at={"x": 0.0}, parameters={"a": a, "T": time})
    exact = np.array([lambertw(-a * time, k) / time for k in range(-9, 10)])
    exact = exact[np.lexsort((-exact.imag, -exact.real))][: len(found.eigenvalues)]
    assert len(found.eigenvalues) >= 8
    assert np.abs(found.eigenvalues - exact).max() < 1e-8
    stable = 0 < a * time < np.pi / 2  # Hayes
    assert found.verdict == ("stable" if stable else "unstable")


def test_the_logistic_equation_with_a_delay() -> None:
    """Hutchinson: x' = r x (1 - x(t-1)) rests at 1, where the roots are those of s = -r exp(-s)."""
    model = made(
        """
        parameters: {r: 1.5}
        blocks:
          x: {type: integrator, of: rate, start: 0.7}
          late: {type: delay, of: x, time: 1, before: 0.7}
          rate: {type: expression, formula: r*x*(1 - late)}
        """
    )
    for r, verdict in ((1.5, "stable"), (1.6, "unstable")):
        found = steady_state(model, parameters={"r": r})
        assert found["x"] == pytest.approx(1.0, abs=1e-12)
        assert found.eigenvalues[0] == pytest.approx(lambertw(-r), abs=1e-8)
        assert (found.verdict, found.jacobian[0, 0]) == (verdict, pytest.approx(-r))


TWO = """
parameters: {k: 2}
inputs: {u: {default: 0}}
record: [y, first]
blocks:
  first: {type: delay, of: drive, time: 0.3}
  second: {type: delay, of: first, time: 0.2}
  drive: {type: sum, of: [u, -y]}
  x: {type: integrator, of: rate}
  rate: {type: expression, formula: k*second - x}
  y: {type: delay, of: x, time: 0.5}
"""


def test_the_transfer_function_has_the_exponentials_of_its_delays() -> None:
    """y/u = G/(1 + G) with G = k exp(-s)/(s + 1), as the delays in a row add up."""
    found = linearise(made(TWO), inputs=["u"])
    for s in (0.5j, 2.0 + 3.0j, -0.1 + 9.0j):
        g = 2.0 * np.exp(-s) / (s + 1.0)
        closed = np.exp(-0.3 * s) * (1 - g / (1 + g))
        assert found.transfer(s) == pytest.approx(np.array([[g / (1 + g)], [closed]]), abs=1e-12)
    for root in found.eigenvalues:
        assert abs(root + 1.0 + 2.0 * np.exp(-root)) < 1e-8
    assert found.eigenvalues[0] == pytest.approx(lambertw(-2.0 * np.e) - 1.0, abs=1e-8)


def test_a_vector_is_delayed_by_a_time_that_changes() -> None:
    """Beside a rest only the time at the rest counts: x' = -x(t - T(x)), T(0) = 1/2."""
    found = linearise(
        made(
            """
            blocks:
              x: {type: integrator, of: rate, start: [0, 0]}
              time: {type: expression, formula: "0.5 + x[0]"}
              late: {type: variable_delay, of: x, time: time, shortest: 0.1, longest: 2}
              rate: {type: gain, of: late, k: -1}
            """
        )
    )
    exact = [lambertw(-0.5, k) / 0.5 for k in (-1, -1, 0, 0)]  # double roots
    assert np.abs(np.sort(found.eigenvalues[:4].imag) - np.imag(exact)).max() < 1e-8
    assert np.abs(found.eigenvalues[:4].real - np.real(exact)).max() < 1e-8
    assert found.delays is not None and found.delays.times.tolist() == [0.5, 0.5]


def test_without_a_state_behind_it_a_delay_has_no_roots_of_its_own() -> None:
    model = made(LATE.replace("formula: u - a*late", "formula: u - x"))
    assert linearise(model).eigenvalues == pytest.approx([-1.0])


def test_a_loop_of_a_delay_alone_is_at_rest_and_has_no_eigenvalues() -> None:
    model = made(
        """
        inputs: {u: {default: 3}}
        blocks:
          x: {type: integrator, of: rate}
          echo: {type: delay, of: whole, time: 1}
          whole: {type: expression, formula: u + x - 0.5*echo}
          rate: {type: expression, formula: 4 - echo - x}
        """
    )
    # at rest echo = whole = (3 + x)/1.5, and 4 - echo - x = 0
    with pytest.raises(AnalysisError) as error:
        steady_state(model)
    assert "'whole' is delayed and comes back to its delay without a state" in str(error.value)
    found = linearise(model, at={"x": 1.2}, inputs=["u"])
    assert found.rates == pytest.approx([0.0], abs=1e-12)
    e = np.exp(-0.7j)
    gain = e / (1 + 0.5 * e)  # echo by u + x
    assert found.transfer(0.7j) == pytest.approx(np.array([[-gain / (0.7j + 1 + gain)]]), abs=1e-12)


def test_orbits_and_other_tools_are_refused_in_words() -> None:
    with pytest.raises(OptionError, match="the delay needs what 'x' was before"):
        periodic_orbit(made(LATE), 1.0)
    with pytest.raises(AnalysisError, match="python-control has no delays"):
        linearise(made(LATE)).to_control()
