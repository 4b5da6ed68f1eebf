from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize
from tracewire.errors import FitError, OptionError
from tracewire.fit.fminsearch import fminsearch
from tracewire.fit.optimset import OptimValues, Options, optimset

X = Any
SILENT = {"Display": "off"}
NAN = math.nan


def rosenbrock(x: X) -> Any:
    a, b = x[1] - x[0] * x[0], 1 - x[0]
    return 100 * a * a + b * b


def helical_valley(x: X) -> float:
    turn = math.atan(x[1] / x[0]) / (2 * math.pi) + (0 if x[0] > 0 else 0.5)
    a, b = 10 * (x[2] - 10 * turn), 10 * (math.sqrt(x[0] * x[0] + x[1] * x[1]) - 1)
    return float(a * a + b * b + x[2] * x[2])


def box(x: X) -> float:
    total = 0.0
    for i in range(1, 11):
        t = i / 10
        fall = math.exp(-t) - math.exp(-10 * t)
        residual = math.exp(-t * x[0]) - math.exp(-t * x[1]) - x[2] * fall
        total += residual * residual
    return total


def powell(x: X) -> Any:
    a, b, c, d = x[0] + 10 * x[1], x[2] - x[3], x[1] - 2 * x[2], x[0] - x[3]
    c, d = c * c, d * d
    return a * a + 5 * b * b + c * c + 10 * d * d


def quadratic(x: X) -> Any:
    return (x[0] - 3) * (x[0] - 3) + 2 * (x[1] + 1) * (x[1] + 1) + x[0] * x[1]


def parabola(x: X) -> Any:
    return (x[0] - 2) * (x[0] - 2)


def corner(x: X) -> Any:
    return abs(x[0]) + abs(x[1])


def flat(x: X) -> int:
    return 0


def stairs(x: X) -> int:
    return int(math.floor(abs(x[0] * 10) - 0.3) + math.floor(abs(x[1] * 7)))


def wall(x: X) -> Any:
    return NAN if x[0] < 0.5 else x[0] + x[1] * x[1]


# What Scilab 6.1.1 returned: x, exit flag, funcCount, iterations, fval; "%.17g".
# Rosenbrock, Powell, helical valley, Box: J. J. Moré, B. S. Garbow, K. E. Hillstrom, ACM TOMS 7
# (1981) 17, with their starts. The last five are full of equal values, shrinks and NaN.
TIGHT = {"MaxFunEvals": 5000, "MaxIter": 5000, "TolX": 1e-8, "TolFun": 1e-8}
SCILAB = [
    (rosenbrock, [-1.2, 1], {}, [1.0000220217835567, 1.0000422197517711], 1, 159, 85,
     8.177661099387146e-10),
    (rosenbrock, [-1.2, 1], {"TolX": 1e-10, "TolFun": 1e-10},
     [0.99999999997583733, 0.99999999995172684], 1, 249, 132, 5.8410699184711435e-22),
    (rosenbrock, [-1.2, 1], {"MaxIter": 10}, [-1.0321875000000014, 1.0578124999999998], 0, 21, 10,
     4.1355598088083374),
    (rosenbrock, [-1.2, 1], {"MaxIter": 1}, [-1.0800000000000005, 1.0749999999999997], 0, 5, 2,
     5.1617960000000291),
    (rosenbrock, [-1.2, 1], {"MaxFunEvals": 10}, [-1.0650000000000006, 1.0999999999999999], 0, 11,
     5, 4.3813600625000122),
    (rosenbrock, [0, 0], {}, [0.9999930910629159, 0.99998611089801825], 1, 124, 67,
     4.8241431990834463e-11),
    (helical_valley, [-1, 0, 0], {},
     [1.0000016153149325, 1.1246848384193323e-05, 1.6765459234595229e-05], 1, 205, 113,
     6.7071775021883791e-10),
    (box, [0, 10, 20], {}, [1.0000013704323261, 9.9999663536300467, 0.99999862368338088], 1, 355,
     197, 7.2792425565741377e-13),
    (powell, [3, -1, 0, 1], {},
     [-0.00018211446442656609, 1.8210773467366913e-05, -8.1119573472388209e-05,
      -8.1086983287491634e-05], 1, 458, 280, 7.4579225192084623e-15),
    (powell, [3, -1, 0, 1], TIGHT,
     [7.3907915455066213e-09, -7.3907900084132084e-10, 3.2362534366680378e-08,
      3.2362535009326684e-08], 1, 821, 495, 2.6682225675596767e-29),
    (quadratic, [0, 0], {}, [3.9999707564128055, -1.9999993883183034], 1, 110, 58,
     -4.9999999991619521),
    (parabola, 0, {}, [1.9999804687499996], 1, 44, 22, 3.8146972657915334e-10),
    (parabola, 5, {}, [2.0], 1, 36, 18, 0.0),
    (corner, [1, 1], {}, [1.1914650999117516e-05, 5.0547841471559155e-06], 1, 90, 45,
     1.6969435146273431e-05),
    (corner, [0, 0], {}, [0.0, 0.0], 1, 33, 17, 0.0),
    (flat, [1, 2, 3, 4], {}, [1.0, 2.0, 3.0, 4.0], 1, 71, 12, 0.0),
    (stairs, [1, 1], {}, [1.0, 1.0], 1, 41, 11, 16.0),
    (wall, [2, 3], {}, [0.5000000121148378, 5.9490291698473198e-05], 1, 171, 92,
     0.50000001565393259),
]  # fmt: skip


@pytest.mark.parametrize(
    ("fun", "x0", "options", "x", "flag", "evaluations", "iterations", "fval"), SCILAB
)
def test_search_is_scilab_s(
    fun: Callable[[X], float],
    x0: Any,
    options: dict[str, Any],
    x: Sequence[float],
    flag: int,
    evaluations: int,
    iterations: int,
    fval: float,
) -> None:
    found = fminsearch(fun, x0, optimset(**SILENT, **options))
    assert (found.exitflag, found.output.funcCount, found.output.iterations) == (
        flag,
        evaluations,
        iterations,
    )
    # Equal to the last bit where exp and atan are, which differ from library to library.
    assert found.x == pytest.approx(x, rel=1e-9, abs=1e-12)
    assert found.fval == pytest.approx(fval, rel=1e-6, abs=1e-27)
    assert found.output.algorithm == "Nelder-Mead simplex direct search"


def test_output_function_sees_the_states_of_scilab() -> None:
    seen: list[tuple[Any, ...]] = []

    def watch(x: X, values: OptimValues, state: str) -> bool:
        seen.append((state, values.iteration, values.funccount, values.procedure, *x))
        return values.iteration >= 3

    found = fminsearch(rosenbrock, [-1.2, 1], optimset(OutputFcn=watch))
    # Scilab 6.1.1, same output function.
    assert seen == [
        ("init", 0, 3, "", -1.2, 1.0),
        ("iter", 1, 3, "initial simplex", -1.2, 1.05),
        ("iter", 2, 5, "expand", -1.0800000000000005, 1.0749999999999997),
        ("iter", 3, 7, "reflect", -1.0800000000000003, 1.125),
        ("done", 3, 7, "", -1.0800000000000003, 1.125),
    ]
    assert (found.exitflag, found.fval) == (-1, 4.4977960000000046)
    assert found.output.message == "Stopped by an output function"


@pytest.mark.parametrize(
    ("state", "evaluations", "iterations"), [("init", 3, 0), ("iter", 3, 1), ("done", 159, 85)]
)
def test_output_function_may_stop_in_every_state(
    state: str, evaluations: int, iterations: int
) -> None:
    def stop(x: X, values: OptimValues, now: str) -> bool:
        return now == state

    functions = [stop, lambda x, values, now: None]
    found = fminsearch(rosenbrock, [-1.2, 1], optimset(OutputFcn=functions))
    assert found.exitflag == -1
    assert (found.output.funcCount, found.output.iterations) == (evaluations, iterations)


def test_plot_functions_are_called_and_cannot_stop() -> None:
    states = []

    def plot(x: X, values: OptimValues, state: str) -> bool:
        states.append(state)
        return True

    found = fminsearch(parabola, 5, optimset(PlotFcns=plot))
    assert found.exitflag == 1
    assert states == ["init", *["iter"] * 18, "done"]


def test_callbacks_cannot_change_the_search() -> None:
    def spoil(x: X, *_: object) -> float:
        value = float(parabola(x))
        x[:] = 77
        return value

    found = fminsearch(spoil, 5, optimset(PlotFcns=spoil))
    assert found.x == pytest.approx([2.0])


def test_table_of_iterations(capsys: pytest.CaptureFixture[str]) -> None:
    fminsearch(rosenbrock, [-1.2, 1], optimset(Display="iter", MaxIter=4))
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["Iteration", "Func-count", "min", "f(x)", "Procedure"]
    assert [line.split(maxsplit=3) for line in lines[1:6]] == [
        ["0", "3", "24.2"],
        ["1", "3", "20.05", "initial simplex"],
        ["2", "5", "5.161796", "expand"],
        ["3", "7", "4.497796", "reflect"],
        ["4", "9", "4.497796", "contract outside"],
    ]
    assert lines[6:] == [
        "",
        "fminsearch: Maximum number of iterations has been exceeded: 4",
        " - increase MaxIter, which is 4.",
        " Current function value: 4.497796",
    ]


@pytest.mark.parametrize(
    ("display", "converged", "limited"),
    [("off", "", ""), ("notify", "", "MaxFunEvals"), ("final", "TolX = 0.0001", "MaxFunEvals")],
)
def test_what_display_tells(
    display: str, converged: str, limited: str, capsys: pytest.CaptureFixture[str]
) -> None:
    for limit, expected in ((500, converged), (10, limited)):
        fminsearch(rosenbrock, [-1.2, 1], optimset(Display=display, MaxFunEvals=limit))
        told = capsys.readouterr().out
        assert (expected in told) if expected else told == ""


@given(
    st.lists(st.floats(-50, 50), min_size=1, max_size=4),
    st.lists(st.floats(-5, 5), min_size=4, max_size=4),
)
@settings(max_examples=40, deadline=None)
def test_search_never_ends_above_its_start(x0: list[float], centre: list[float]) -> None:
    values: list[float] = []

    def bowl(x: X) -> float:
        values.append(float(sum((x - centre[: len(x)]) ** 2)))
        return values[-1]

    found = fminsearch(bowl, x0, optimset(**SILENT))
    assert found.fval == min(values) <= values[0]
    assert found.output.funcCount == len(values)
    assert found.fval == float(sum((found.x - centre[: len(x0)]) ** 2))


def test_another_nelder_mead_finds_the_same_minimum() -> None:
    theirs = minimize(rosenbrock, [-1.2, 1], method="Nelder-Mead")
    ours = fminsearch(rosenbrock, [-1.2, 1])
    assert ours.x == pytest.approx(theirs.x, abs=1e-4)


@pytest.mark.parametrize(("limit", "flag"), [(200, 0), (1e4, 1)])
def test_function_without_minimum_ends_within_the_numbers(limit: float, flag: int) -> None:
    options = optimset(**SILENT, MaxFunEvals=limit, MaxIter=limit)
    found = fminsearch(lambda x: -x[0], 1, options)
    # With 1e4 evaluations the simplex shrinks against the largest number there is.
    assert found.exitflag == flag
    assert np.isfinite(found.x).all()
    assert found.fval < -1e25


def test_an_interrupt_goes_through() -> None:
    def interrupted(x: X) -> float:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fminsearch(interrupted, 1)


@pytest.mark.parametrize(
    ("x0", "message"),
    [
        ([[1, 2]], r"x0 is an array of shape \(1, 2\)\. Give a number or a one-dimensional array"),
        ([], r"x0 is empty\. Give a number"),
        ("abc", r"x0 is not made of real numbers: 'abc'\. Give a number"),
        ([1, [2, 3]], r"x0 is not made of real numbers: \[1, \[2, 3\]\]"),
        (1j, r"x0 is not made of real numbers: 1j"),
        ([1, NAN], r"x0\[1\] is nan\. Start from finite numbers\."),
    ],
)
def test_a_start_without_meaning(x0: Any, message: str) -> None:
    with pytest.raises(OptionError, match=message):
        fminsearch(parabola, x0)


@pytest.mark.parametrize("value", [NAN, math.inf, -math.inf])
def test_function_not_finite_at_the_start(value: float) -> None:
    with pytest.raises(FitError, match=r"not finite at x0 = \[1\.0, 2\.0\]\. Start where"):
        fminsearch(lambda x: value, [1, 2])


@pytest.mark.parametrize("value", [None, "3", [1.0, 2.0], 1j, [1, [2]]])
def test_function_that_returns_no_number(value: Any) -> None:
    with pytest.raises(FitError, match=r"returned .* at x = \[1\.0\]\. It must return one real"):
        fminsearch(lambda x: value, 1)


def test_options_that_are_no_options() -> None:
    options: Any = [1e-3]
    with pytest.raises(OptionError, match=r"options of fminsearch are a list. Give a dictionary"):
        fminsearch(parabola, 1, options)


def test_options_may_be_a_dictionary() -> None:
    whole = fminsearch(parabola, 1)
    loose = fminsearch(parabola, 1, {"TolX": 1.0, "TolFun": 1.0})
    assert loose.output.funcCount < whole.output.funcCount
    with pytest.raises(OptionError, match=r"unknown option of fminsearch 'tolx'.*Write 'TolX'"):
        fminsearch(parabola, 1, {"tolx": 1.0})


def test_forms_of_optimset_agree() -> None:
    expected = Options(TolX=1e-3, MaxIter=50)
    assert optimset(TolX=1e-3, MaxIter=50) == expected
    assert optimset("TolX", 1e-3, "MaxIter", 50) == expected
    assert optimset(optimset("MaxIter", 50), TolX=1e-3) == expected
    assert optimset("fminsearch") == optimset() == Options()


def test_limits_by_number_of_variables() -> None:
    assert Options().iterations(3) == Options().evaluations(3) == 600
    assert optimset(MaxIter="50 * numberOfVariables").iterations(2) == 100


@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        ((), {"tolx": 1}, r"unknown option 'tolx'; there are: Display, .*It is written 'TolX'\."),
        (("MaxItr", 1), {}, r"unknown option 'MaxItr'.*Did you mean 'MaxIter'\?"),
        (("TolX",), {}, r"optimset got 'TolX' where .* pairs of a name and a value"),
        ((), {"Display": "fnal"}, r"unknown value of Display 'fnal'.*Did you mean 'final'\?"),
        ((), {"MaxIter": 0}, r"MaxIter is 0\. Give a number of at least 1"),
        ((), {"MaxFunEvals": "many"}, r"MaxFunEvals is 'many'\. Give a number of at least 1"),
        ((), {"MaxIter": NAN}, r"MaxIter is nan"),
        ((), {"TolX": -1}, r"TolX is -1\. Give a tolerance of at least 0"),
        ((), {"TolFun": NAN}, r"TolFun is nan"),
        ((), {"OutputFcn": 3}, r"OutputFcn is neither a function nor a list of functions"),
        ((), {"PlotFcns": ["plot"]}, r"PlotFcns is neither a function nor a list of functions"),
    ],
)
def test_options_without_meaning(
    arguments: tuple[Any, ...], options: dict[str, Any], message: str
) -> None:
    with pytest.raises(OptionError, match=message):
        optimset(*arguments, **options)


def test_all_bad_options_are_told_at_once() -> None:
    with pytest.raises(OptionError) as caught:
        optimset(Display="loud", TolX="small", MaxIter=None)
    assert len(caught.value.problems) == 3
