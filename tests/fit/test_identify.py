"""What is not identifiable is named, and what is stays untouched."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from residual.models import T, made, oscillation, series
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.fit import Fit, fit
from tracewire.fit.identify import ParameterColumns
from tracewire.fit.uncertainty import Uncertainty, uncertainty_from
from tracewire.residual import Measured, Sensor

APPENDIX = Path(__file__).parents[2] / "diagrams" / "papers" / "a_torsion" / "pendulum.yaml"
OPEN = ("alpha", "beta", "T_s2_l", "T_s2_r")


def fitted(stiffness: str, start: str = "1", **bounds: str) -> Fit:
    """x'' = -stiffness*x - c*x' from `start`, to its motion with k = 4, c = 0.3 and noise."""
    parameters = "".join(f"  {name}: {{value: {text}}}\n" for name, text in bounds.items())
    text = (
        f"span: [0, 6]\nparameters:\n{parameters}  c: {{value: 0.2, fit: [0, 2]}}\n"
        "blocks:\n"
        f"  x: {{type: integrator, of: v, start: {start}}}\n"
        "  v: {type: integrator, of: a}\n"
        f"  a: {{type: expression, formula: -({stiffness})*x - c*v}}\n"
    )
    noise = 0.01 * np.random.default_rng(3).standard_normal(len(T))
    return fit(made(text), [series(oscillation(T) + noise)], method="least_squares")


K = "3, fit: [0.1, 50]"
J = "1.2, fit: [0.1, 20]"


@pytest.mark.parametrize(
    ("stiffness", "words"),
    [
        ("k/J", "only k/J is determined: fix J or k"),
        ("k*J", "only k*J is determined: fix J or k"),
        ("k/J**2", "only k/J^2 is determined: fix J or k"),
        ("k + J", "only k + J is determined: fix J or k"),
        ("2*k - J", "only 2*k - J is determined: fix J or k"),
    ],
)
def test_a_redundant_pair_is_named_with_what_it_makes(stiffness: str, words: str) -> None:
    found = fitted(stiffness, k=K, J=J)
    assert found.uncertainty.words == (words,)
    assert np.isnan(found.errors["k"]) and np.isnan(found.errors["J"])
    alone = fitted("k", k=K)
    assert alone.uncertainty.words == ()
    assert found.errors["c"] == pytest.approx(alone.errors["c"], rel=0.05)


@pytest.mark.parametrize("stiffness", ["k*J", "k + J"])
def test_equal_values_do_not_hide_whether_it_is_a_sum_or_a_product(stiffness: str) -> None:
    found = fitted(stiffness, k="2, fit: [0.1, 50]", J="2, fit: [0.1, 50]")
    assert found.uncertainty.words == (f"only {stiffness} is determined: fix J or k",)


def test_of_three_parameters_in_one_product_two_are_to_be_fixed() -> None:
    found = fitted("k*J*m", k=K, J=J, m="1.1, fit: [0.1, 10]")
    assert found.uncertainty.words == ("only k*J*m is determined: fix two of k, J and m",)
    assert len(found.uncertainty.directions) == 2


def test_a_common_factor_of_three_parameters_is_named() -> None:
    """J x'' = -k x - d x': all three times a factor is the same motion."""
    text = (
        "span: [0, 6]\nparameters:\n  J: {value: 1.2, fit: [0.1, 20]}\n"
        "  k: {value: 3, fit: [0.1, 50]}\n  d: {value: 0.2, fit: [0.01, 9]}\n"
        "blocks:\n  x: {type: integrator, of: v, start: 1}\n  v: {type: integrator, of: a}\n"
        "  a: {type: expression, formula: (-k*x - d*v)/J}\n"
    )
    noise = 0.01 * np.random.default_rng(6).standard_normal(len(T))
    found = fit(made(text), [series(oscillation(T) + noise)], method="least_squares")
    assert found.uncertainty.words == ("only J/d and k/d are determined: fix one of J, k and d",)


def test_a_small_part_of_a_sum_is_open_and_the_large_one_is_not() -> None:
    found = fitted("k + J", k="4, fit: [0.1, 50]", J="0.02, fit: [0.001, 2]")
    assert found.uncertainty.words == ("only k + J is determined: fix J or k",)
    assert np.isnan(found.errors["J"])
    assert found.errors["k"] < 0.1


def test_what_hides_behind_a_parameter_without_being_its_like_is_told_alone() -> None:
    """a is known, b does nearly what a does, and far less of it."""
    rng = np.random.default_rng(7)
    column = rng.standard_normal(200)
    like = column + 0.004 * rng.standard_normal(200)
    slopes = np.stack([column, like, rng.standard_normal(200)], axis=1)
    found = _of(slopes, 0.01 * rng.standard_normal(200), np.array([1.0, 0.01, 1.0]))
    (words,) = found.words
    assert words.startswith("b cannot be told from a: changing b by +10 % and a by -0.")
    assert words.endswith("fix b")
    assert np.isnan(found.errors["b"]) and found.errors["a"] < 0.1


def test_two_redundant_pairs_are_two_sentences() -> None:
    found = fitted("k/J", "g*A", k=K, J=J, g="1.1, fit: [0.1, 9]", A="1.2, fit: [0.1, 9]")
    assert set(found.uncertainty.words) == {
        "only k/J is determined: fix J or k",
        "only g*A is determined: fix A or g",
    }


def test_the_gain_of_a_sensor_and_the_amplitude_are_a_pair() -> None:
    text = (
        "span: [0, 6]\nparameters: {A: {value: 1.3, fit: [0.1, 9]}, k: {value: 3, fit: [1, 9]}}\n"
        "blocks:\n  x: {type: integrator, of: v, start: A}\n  v: {type: integrator, of: a}\n"
        "  a: {type: expression, formula: -k*x - 0.3*v}\n"
    )
    noise = 0.01 * np.random.default_rng(4).standard_normal(len(T))
    run = series(oscillation(T) + noise, sensors={"x": Sensor(free={"gain": (0.1, 10.0)})})
    found = fit(made(text), [run], method="least_squares")
    assert found.uncertainty.words == ("only A*gain.x is determined: fix gain.x or A",)
    assert found.errors["k"] < 0.1


def test_a_combination_that_is_no_product_is_told_near_the_values() -> None:
    (words,) = fitted("k*(1 + J)", k=K, J=J).uncertainty.words
    assert "k and J: the data determine one combination of these two" in words
    assert "changing J by +" in words and words.endswith("fix J or k")


def test_a_parameter_that_does_nothing_is_told() -> None:
    found = fitted("k", k=K, m="1.1, fit: [0.1, 10]")
    assert found.uncertainty.unmoved == ("m",)
    assert np.isnan(found.errors["m"]) and found.errors["k"] > 0


def test_a_start_value_that_does_what_a_parameter_does_is_named() -> None:
    text = (
        "span: [0, 6]\nparameters: {b: {value: 0.5, fit: [-9, 9]}, k: {value: 3, fit: [1, 9]}}\n"
        "blocks:\n  x: {type: integrator, of: v, start: 1}\n  v: {type: integrator, of: a}\n"
        "  a: {type: expression, formula: -k*x}\n"
        "  s: {type: integrator, of: nothing}\n  nothing: {type: constant, value: 0}\n"
        "  y: {type: expression, formula: x + b + s}\n"
    )
    rng = np.random.default_rng(5)
    values = np.cos(2 * T) + 0.7 + 0.01 * rng.standard_normal(len(T))
    run = Measured("run", "train", T, {"y": values}, start={"s": None})
    found = fit(made(text, ("y",)), [run], method="least_squares")
    assert found.uncertainty.words == ("only b + start.s is determined: fix start.s or b",)


@settings(deadline=None, max_examples=50)
@given(st.integers(0, 10_000), st.floats(-4, 4), st.floats(-4, 4), st.integers(-2, 2))
def test_the_words_do_not_depend_on_how_the_parameters_are_scaled(
    seed: int, one: float, other: float, power: int
) -> None:
    """A residual that depends on log a + power*log b alone."""
    rng = np.random.default_rng(seed)
    values = np.array([10.0**one, 3 * 10.0**other, 1.0])
    column, third = rng.standard_normal((2, 100))
    slopes = np.stack([column / values[0], power * column / values[1], third], axis=1)
    found = _of(slopes, rng.standard_normal(100) * 1e-3, values)
    if power == 0:
        assert found.unmoved == ("b",)
        return
    sign, size = ("*", power) if power > 0 else ("/", -power)
    expected = f"only a{sign}b{'' if size == 1 else f'^{size}'} is determined: fix b or a"
    assert found.words == (expected,)
    assert found.errors["c"] == pytest.approx(1e-4, rel=0.5)


@settings(deadline=None, max_examples=50)
@given(st.integers(0, 10_000), st.floats(0, 0.9))
def test_parameters_with_columns_of_their_own_are_all_determined(seed: int, mix: float) -> None:
    rng = np.random.default_rng(seed)
    slopes = rng.standard_normal((100, 3))
    slopes[:, 0] += mix * 5 * slopes[:, 1]
    found = _of(slopes, 0.01 * rng.standard_normal(100), np.ones(3))
    assert found.words == () and found.directions == ()
    assert np.isfinite(found.covariance).all()


def _of(slopes: np.ndarray, residual: np.ndarray, values: np.ndarray) -> Uncertainty:
    infinite = np.full(len(values), np.inf)
    columns = ParameterColumns(tuple("abc"), 3, values, values, -infinite, infinite)
    return uncertainty_from(
        [residual[:, None]], [slopes * values], [np.ones(1)], [("run", ["x"])], columns
    )


@pytest.fixture(scope="module")
def appendix() -> Fit:
    return fit(compile(read(APPENDIX)), method="least_squares")


def test_the_appendix_of_paper_a_does_not_determine_four_of_its_nine(appendix: Fit) -> None:
    """alpha, beta and the two T_s2 act almost only through alpha*(1 + beta)*T_s2."""
    (words,) = appendix.uncertainty.words
    assert all(name in words.split(":")[0] for name in OPEN)
    assert "the data determine two combinations of these four" in words
    assert "T_s2_l*alpha*beta^0." in words and "T_s2_r*alpha*beta^0." in words
    assert "fix two of them, for example alpha and beta" in words
    assert "T_02_l and T_02_r move with these: they have no errors until then" in words
    undetermined = {name for name, error in appendix.errors.items() if np.isnan(error)}
    assert undetermined == {*OPEN, "T_02_l", "T_02_r"}


def test_with_two_of_them_fixed_the_appendix_determines_the_rest() -> None:
    found = fit(compile(read(APPENDIX)), method="least_squares", fixed=("alpha", "beta"))
    assert found.uncertainty.words == ()
    assert all(found.errors[name] < 0.15 * found.values[name] for name in found.values)
