"""Standard errors beside the textbook's, and how often intervals hold the truth."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from residual.made_noise import autoregression
from residual.models import LINE, made
from scipy.stats import linregress
from scipy.stats import t as student
from tracewire.fit import fit
from tracewire.fit.identify import ParameterColumns
from tracewire.fit.uncertainty import Uncertainty, uncertainty_from
from tracewire.residual import Measured

Vector = NDArray[np.float64]
COUNT = 200
T = np.linspace(0.0, 1.0, COUNT)
SHORT = np.linspace(0.0, 6.0, 60)
LINEAR = made(LINE)


def columns_of(names: str, values: Vector, **more: Any) -> ParameterColumns:
    n = len(values)
    return ParameterColumns(
        tuple(names),
        more.get("count", n),
        values,
        more.get("sizes", np.ones(n)),
        more.get("low", np.full(n, -np.inf)),
        more.get("high", np.full(n, np.inf)),
    )


def linear(
    matrix: Vector, data: Vector, names: str = "ab", correlated: bool = True, **more: Any
) -> Uncertainty:
    """The uncertainty of a linear model, one series and one signal."""
    values = np.linalg.lstsq(matrix, data)[0]
    columns = columns_of(names, values, **more)
    residual = (matrix @ values - data)[:, None]
    weight = np.full(residual.shape, len(data) ** -0.5)
    return uncertainty_from(
        [residual],
        [matrix * columns.sizes],
        [weight],
        [("run", ["x"])],
        columns,
        correlated=correlated,
    )


@settings(deadline=None, max_examples=50)
@given(st.integers(0, 10_000), st.integers(8, 40), st.floats(1e-3, 1e3))
def test_errors_of_a_line_are_the_textbooks(seed: int, count: int, size: float) -> None:
    rng = np.random.default_rng(seed)
    t = np.sort(rng.uniform(0, 1, count))
    data = 2.0 + 3.0 * t + 0.1 * rng.standard_normal(count)
    found = linear(
        np.stack([np.ones(count), t], axis=1), data, correlated=False, sizes=np.array([size, 1.0])
    )
    known = linregress(t, data)
    assert found.errors["a"] == pytest.approx(known.intercept_stderr, rel=1e-9)
    assert found.errors["b"] == pytest.approx(known.stderr, rel=1e-9)
    assert found.degrees == count - 2
    half = student.ppf(0.975, count - 2) * known.stderr
    assert found.intervals["b"] == pytest.approx((known.slope - half, known.slope + half))
    assert np.diag(found.correlation) == pytest.approx([1.0, 1.0])


def test_each_signal_has_the_noise_of_its_own_residual() -> None:
    """Two signals of one level each, the noise 0.1 and 10: each error as if fitted alone."""
    rng = np.random.default_rng(5)
    noise = rng.standard_normal((COUNT, 2)) * [0.1, 10.0]
    noise -= noise.mean(axis=0)
    first, second = np.zeros((COUNT, 2)), np.zeros((COUNT, 2))
    first[:, 0], second[:, 1] = 1.0, 1.0
    matrix = np.stack([first.ravel(), second.ravel()], axis=1)
    found = uncertainty_from(
        [noise], [matrix], [np.ones(2)], [("run", ["x", "y"])], columns_of("ab", np.ones(2)),
        correlated=False,
    )  # fmt: skip
    samples = 2 * COUNT
    expected = noise.std(axis=0) * np.sqrt(samples / (samples - 2) / COUNT)
    assert list(found.errors.values()) == pytest.approx(expected)


def test_several_series_count_by_their_weights() -> None:
    """A level from two series, the second with weight 0: its noise does not matter."""
    rng = np.random.default_rng(6)
    parts = [rng.standard_normal((COUNT, 1)), 50 * rng.standard_normal((COUNT, 1))]
    found = uncertainty_from(
        parts,
        [np.ones((COUNT, 1))] * 2,
        [np.ones((1, 1)), np.zeros((1, 1))],
        [("one", ["x"]), ("two", ["x"])],
        columns_of("a", np.ones(1)),
        correlated=False,
    )
    level = np.sqrt(np.sum(parts[0] ** 2) / (COUNT - 1))
    assert found.errors["a"] == pytest.approx(level / np.sqrt(COUNT))


def coverage(coefficients: tuple[float, ...], correlated: bool, repeats: int = 300) -> float:
    """How often the 95 % interval of a slope holds the true one."""
    rng = np.random.default_rng(8)
    matrix = np.stack([np.ones(COUNT), T], axis=1)
    hits = 0
    for _ in range(repeats):
        data = matrix @ [1.0, 2.0] + 0.1 * autoregression(coefficients, COUNT, rng)
        low, high = linear(matrix, data, correlated=correlated).intervals["b"]
        hits += low <= 2.0 <= high
    return hits / repeats


def test_intervals_cover_the_truth_where_noise_is_white() -> None:
    assert 0.92 <= coverage((), True) <= 0.98
    assert 0.92 <= coverage((), False) <= 0.98


def test_intervals_cover_the_truth_where_noise_is_correlated_and_the_textbooks_do_not() -> None:
    assert 0.89 <= coverage((0.8,), True) <= 0.98
    assert coverage((0.8,), False) < 0.6


def test_a_value_on_a_bound_is_held_and_has_no_error() -> None:
    rng = np.random.default_rng(9)
    matrix = np.stack([np.ones(COUNT), T], axis=1)
    data = matrix @ [1.0, 0.0] + 0.1 * rng.standard_normal(COUNT)
    residual = (matrix @ [data.mean(), 0.0] - data)[:, None]
    low, high = np.array([-np.inf, 0.0]), np.array([np.inf, 10.0])
    columns = columns_of("ab", np.array([data.mean(), 1e-7]), low=low, high=high)
    found = uncertainty_from(
        [residual], [matrix], [np.ones(1)], [("run", ["x"])], columns, correlated=False
    )
    assert found.at_bounds == ("b",)
    assert np.isnan(found.errors["b"])
    assert found.errors["a"] == pytest.approx(data.std() / np.sqrt(COUNT - 1))
    assert "b sits on its lower bound 0" in found.words[0]


@pytest.mark.parametrize("size", [1e-12, 1e-8, 1e-3])
def test_a_small_value_between_wide_bounds_is_on_none(size: float) -> None:
    matrix = np.stack([np.ones(COUNT), T / size], axis=1)
    data = matrix @ [1.0, 5 * size] + 0.1 * np.random.default_rng(9).standard_normal(COUNT)
    low, high, sizes = np.array([-np.inf, 0.0]), np.array([np.inf, 1.0]), np.array([1.0, size])
    found = linear(matrix, data, correlated=False, low=low, high=high, sizes=sizes)
    assert found.at_bounds == ()
    assert found.errors["b"] == pytest.approx(0.1 * (12 / COUNT) ** 0.5 * size, rel=0.2)


def test_what_the_data_do_not_depend_on_is_told() -> None:
    rng = np.random.default_rng(10)
    matrix = np.stack([np.ones(COUNT), np.zeros(COUNT), 1e-3 * T], axis=1)
    data = 1.0 + 0.1 * rng.standard_normal(COUNT)
    values = np.array([data.mean(), 0.5, 0.5])
    found = uncertainty_from(
        [(matrix @ values - data)[:, None]], [matrix], [np.ones(1)], [("run", ["x"])],
        columns_of("abc", values),
    )  # fmt: skip
    assert found.unmoved == ("b", "c")
    assert np.isnan(found.errors["b"]) and np.isnan(found.errors["c"])
    assert found.errors["a"] == pytest.approx(0.1 / np.sqrt(COUNT), rel=0.2)
    assert "the data do not depend on it" in found.words[0]


def test_a_large_error_that_no_other_parameter_causes_keeps_its_interval() -> None:
    """A slope that is zero within its error is known to be so."""
    rng = np.random.default_rng(11)
    matrix = np.stack([np.ones(COUNT), T - 0.5], axis=1)
    data = 1.0 + 0.1 * rng.standard_normal(COUNT)
    found = linear(matrix, data, sizes=np.array([1.0, 0.01]))
    value, error = found.values[1], found.errors["b"]
    assert error > 2 * max(abs(value), 0.01)
    assert found.words == ()


def test_a_perfect_fit_has_errors_of_zero() -> None:
    matrix = np.stack([np.ones(COUNT), T], axis=1)
    found = uncertainty_from(
        [np.zeros((COUNT, 1))], [matrix], [np.ones(1)], [("run", ["x"])],
        columns_of("ab", np.ones(2)),
    )  # fmt: skip
    assert list(found.errors.values()) == pytest.approx([0.0, 0.0], abs=1e-100)


def test_errors_of_a_robust_fit_are_those_of_repeated_fits() -> None:
    """Huber's loss on noise with one outlier in ten."""
    rng = np.random.default_rng(12)
    slopes, errors = [], []
    for _ in range(60):
        noise = (
            0.1 * rng.standard_normal(len(SHORT)) * rng.choice([1.0, 8.0], len(SHORT), p=[0.9, 0.1])
        )
        run = Measured("run", "train", SHORT, {"x": 2 * SHORT + 1 + noise}, {"x": 0.1})
        found = fit(LINEAR, [run], method="least_squares", loss="huber", correlated=False)
        slopes.append(found.values["a"])
        errors.append(found.errors["a"])
    assert np.mean(errors) == pytest.approx(np.std(slopes), rel=0.25)


def test_wide_errors_of_a_published_problem_are_the_certified_ones() -> None:
    """MGH09 of the NIST statistical reference data: b2 is known to +-100 % only, and is known."""
    x = np.array([4, 2, 1, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625])
    y = np.array([
        0.1957, 0.1947, 0.1735, 0.16, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246,
    ])  # fmt: skip
    b = np.array([1.9280693458e-01, 1.9128232873e-01, 1.2305650693e-01, 1.3606233068e-01])
    below = x**2 + b[2] * x + b[3]
    shape = (x**2 + b[1] * x) / below
    slopes = [shape, b[0] * x / below, -b[0] * shape * x / below, -b[0] * shape / below]
    found = uncertainty_from(
        [(b[0] * shape - y)[:, None]],
        [np.stack(slopes, axis=1) * b],
        [np.ones(1)],
        [("MGH09", ["y"])],
        columns_of("abcd", b, sizes=b),
        correlated=False,
    )
    certified = [1.1435312227e-02, 1.9633220911e-01, 8.0842031232e-02, 9.0025542308e-02]
    assert list(found.errors.values()) == pytest.approx(certified, rel=1e-6)
    assert found.words == ()
