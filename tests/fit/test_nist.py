"""NIST's nonlinear regression problems as diagrams without states, from both starts of each.

Certified values to 6 digits, certified standard deviations to 4.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest
from fit import strd
from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.fit import Fit, fit
from tracewire.residual import Measured
from tracewire.solve import simulate

LONG = ("Bennett5", 0)
"""A flat valley: more than a thousand steps of a trust region."""
CASES = [
    pytest.param(*case, marks=pytest.mark.slow if case == LONG else ())
    for case in ((name, start) for name in strd.NAMES for start in (0, 1))
]


def text_of(problem: strd.Problem) -> str:
    """The problem as a diagram; row k of its data is at t = k s, where its x are inputs."""
    inputs = ", ".join(f"{name}: {{}}" for name in problem.x)
    begin = problem.starts[0]
    lines = [
        f"span: [0, {len(problem.y) - 1}]",
        f"inputs: {{{inputs}}}",
        "parameters:",
        *(f"  {name}: {{value: {begin[name]!r}, fit: free}}" for name in begin),
        "blocks:",
        f"  y: {{type: expression, formula: '{problem.formula}'}}",
    ]
    return "\n".join(lines)


@lru_cache
def made(name: str) -> tuple[strd.Problem, Model, Measured]:
    problem = strd.problem(name)
    t = np.arange(len(problem.y), dtype=float)
    inputs = {predictor: (t, values) for predictor, values in problem.x.items()}
    measured = Measured("nist", "train", t, {"y": problem.y}, inputs=inputs)
    return problem, compile(read_text(text_of(problem)), record=["y"]), measured


@lru_cache
def fitted(name: str, start: int) -> Fit:
    """NIST's standard deviations take residuals as independent."""
    problem, model, measured = made(name)
    return fit(
        model,
        [measured],
        method="least_squares",
        parameters=problem.starts[start],
        correlated=False,
    )


def test_all_27_problems_are_there() -> None:
    assert len(strd.NAMES) == 27


@pytest.mark.parametrize("name", strd.NAMES)
def test_the_diagram_is_the_problem(name: str) -> None:
    """At the certified values: the residual, and standard deviations from the sensitivities."""
    problem, model, measured = made(name)
    run = simulate(
        model,
        parameters=problem.values,
        times=measured.t,
        inputs=measured.inputs,
        sensitivities=list(problem.values),
    )
    residual = run["y"] - problem.y
    # The eleven certified digits of Lanczos1 leave 1e-11 of a residual that is 1e-13.
    assert float(residual @ residual) == pytest.approx(problem.rss, rel=1e-9, abs=1e-20)
    jacobian = np.stack([run.sensitivities[b]["y"] for b in problem.values], axis=1)
    sizes = np.linalg.norm(jacobian, axis=0)
    upper = np.linalg.qr(jacobian / sizes, mode="r")
    shape = np.linalg.norm(np.linalg.inv(upper), axis=1) / sizes
    sigma = np.sqrt(problem.rss / (len(problem.y) - len(sizes)))
    assert sigma * shape == pytest.approx(list(problem.errors.values()), rel=1e-4, abs=0)


@pytest.mark.parametrize(("name", "start"), CASES)
def test_values_are_the_certified_ones_to_six_digits(name: str, start: int) -> None:
    assert fitted(name, start).values == pytest.approx(made(name)[0].values, rel=1e-6, abs=0)


@pytest.mark.parametrize(("name", "start"), CASES)
def test_standard_errors_are_the_certified_ones_to_four_digits(name: str, start: int) -> None:
    """Or to what the residual has in double precision, where the model's values are rounded.

    That is less than four digits for Lanczos1 alone: its residuals are 1e-13 of values of 1.
    """
    problem = made(name)[0]
    rounded = np.finfo(float).eps * float(np.linalg.norm(problem.y)) / np.sqrt(problem.rss)
    assert (rounded > 1e-4) == (name == "Lanczos1")
    assert fitted(name, start).errors == pytest.approx(
        problem.errors, rel=max(1e-4, rounded), abs=0
    )
