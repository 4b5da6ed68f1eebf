"""A fit finds the parameters behind exact data, and says how well these determine them."""

from __future__ import annotations

import sys
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from residual.models import LINE, OSCILLATOR, PENDULUM, C, K, T, made, oscillation, series, swing
from tracewire.errors import DataError, FitError, OptionError
from tracewire.fit import Fit, Progress, fit, optimset
from tracewire.fit.kept import EXACT
from tracewire.fit.methods import METHODS as FIT_METHODS
from tracewire.fit.remarks import raises_unseen, rises, unfinished
from tracewire.residual import Measured, Sensor

METHODS = ("fminsearch", "least_squares")
FINE = optimset(TolX=1e-7, TolFun=1e-16, Display="off")
NOISE = 0.01 * np.random.default_rng(3).standard_normal(T.size)


def fitted(text: str, *measured: Measured, method: str = "least_squares", **more: Any) -> Fit:
    record = tuple(measured[0].values)
    if method == "fminsearch":
        more.setdefault("options", FINE)
    return fit(made(text, record), measured, method=method, rtol=1e-9, **more)


@pytest.mark.parametrize("method", METHODS)
def test_a_linear_oscillator_is_recovered(method: str) -> None:
    found = fitted(OSCILLATOR, series(oscillation(T, 0.9)), method=method)
    assert found.values == pytest.approx({"k": K, "c": C}, rel=1e-4)
    assert found.began == {"k": 3.0, "c": 0.1}
    assert found.criterion < 1e-8 * found.criterion_before
    assert found.exitflag == 1
    assert found.method == method


@pytest.mark.parametrize("method", METHODS)
def test_a_pendulum_at_large_angles_is_recovered(method: str) -> None:
    theta = swing(T, 12.0, np.radians(100))
    found = fitted(PENDULUM, Measured("run", "train", T, {"theta": theta}), method=method)
    assert found.values["w0_squared"] == pytest.approx(12, rel=1e-4)
    assert found.values["amplitude"] == pytest.approx(np.radians(100), rel=1e-4)


@pytest.mark.parametrize("method", METHODS)
def test_bounds_are_respected(method: str) -> None:
    text = OSCILLATOR.replace("fit: [0.5, 20]", "fit: [0.5, 3.5]")
    found = fitted(text, series(oscillation(T, 0.9)), method=method)
    assert found.bounds["k"] == (0.5, 3.5)
    assert 0.5 <= found.values["k"] <= 3.5
    assert found.values["k"] == pytest.approx(3.5, rel=1e-3)


def test_the_simplex_finds_a_free_start() -> None:
    measured = series(oscillation(T, 1.0, -0.5), start={"x": 1.0, "v": None})
    found = fitted(OSCILLATOR, measured, method="fminsearch")
    assert found.starts["run"] == pytest.approx({"v": -0.5}, abs=1e-4)
    assert found.values == pytest.approx({"k": K, "c": C}, rel=1e-4)


def test_free_starts_are_found_for_each_series() -> None:
    free = {"x": None, "v": None}
    runs = [
        series(oscillation(T, 1.0, -0.5), "run_1", start=free),
        series(oscillation(T, 0.2, 2.0), "run_2", start=free),
    ]
    found = fitted(OSCILLATOR, *runs)
    assert found.values == pytest.approx({"k": K, "c": C}, rel=1e-3)
    assert found.starts["run_1"] == pytest.approx({"x": 1.0, "v": -0.5}, abs=1e-3)
    assert found.starts["run_2"] == pytest.approx({"x": 0.2, "v": 2.0}, abs=1e-3)


def test_a_declared_start_is_kept() -> None:
    late = T[20:]
    start = {"x": 1.0, "v": -0.5}
    found = fitted(OSCILLATOR, series(oscillation(late - late[0], x0=1.0, v0=-0.5), t=late,
                                      start=start))  # fmt: skip
    assert found.values == pytest.approx({"k": K, "c": C}, rel=1e-4)
    assert found.starts == {"run": {}}


@pytest.mark.parametrize("method", METHODS)
def test_a_free_offset_is_found(method: str) -> None:
    measured = series(
        oscillation(T, 0.9) + 0.07, sensors={"x": Sensor(free={"offset": (-0.5, 0.5)})}
    )
    found = fitted(OSCILLATOR, measured, method=method)
    assert found.values == pytest.approx({"k": K, "c": C, "offset.x": 0.07}, rel=1e-3)


def test_each_series_runs_with_its_preset() -> None:
    runs = [
        series(oscillation(T, 0.9), "plain"),
        series(oscillation(T, 1.5), "pulled", preset="pulled"),
    ]
    found = fitted(OSCILLATOR, *runs)
    assert found.values == pytest.approx({"k": K, "c": C}, rel=1e-4)
    assert found.criterion < 1e-12


def test_a_fit_begins_at_the_values_of_the_preset() -> None:
    text = OSCILLATOR.replace("pulled: {x0: 1.5}", "pulled: {x0: 1.5, k: 4.5}")
    found = fitted(text, series(oscillation(T, 1.5), preset="pulled"))
    assert found.began["k"] == 4.5
    assert found.values["k"] == pytest.approx(K, rel=1e-4)
    assert fitted(text, series(oscillation(T, 0.9)), parameters={"k": 5.0}).began["k"] == 5.0


def test_other_uses_are_compared_and_do_not_pull() -> None:
    wrong = series(oscillation(T, 0.9, k=9.0), "check", use="validate")
    train = series(oscillation(T, 0.9) + NOISE)
    alone, both = fitted(OSCILLATOR, train), fitted(OSCILLATOR, train, wrong)
    assert both.values == alone.values
    assert both.criterion == alone.criterion
    assert [(c.series, c.use, c.signal, c.unit) for c in both.comparisons] == [
        ("run", "train", "x", "m"),
        ("check", "validate", "x", "m"),
    ]
    compared = both.comparisons[1]
    assert compared.after == pytest.approx(oscillation(T, 0.9, **both.values), abs=1e-6)
    assert compared.before == pytest.approx(oscillation(T, 0.9, k=3.0, c=0.1), abs=1e-6)
    assert compared.rmse_after == pytest.approx(
        np.sqrt(np.mean((oscillation(T, 0.9, k=9.0) - compared.after) ** 2))
    )


def test_a_validation_series_gets_its_own_start_and_the_fitted_offset() -> None:
    free, offset = {"x": None, "v": None}, {"x": Sensor(free={"offset": (-0.5, 0.5)})}
    train = series(oscillation(T, 1.0) + 0.07, start=free, sensors=offset)
    check = series(oscillation(T, 0.5, 1.0) + 0.07, "check", use="validate", start=free,
                   sensors=offset)  # fmt: skip
    found = fitted(OSCILLATOR, train, check)
    assert list(found.starts) == ["run"]
    assert found.comparisons[1].rmse_after < 1e-4


def test_named_parameters_are_fitted_instead_of_the_declared() -> None:
    found = fitted(OSCILLATOR, series(oscillation(T, 1.2)), free=["x0", "k", "k"],
                   parameters={"c": C})  # fmt: skip
    assert found.values == pytest.approx({"x0": 1.2, "k": K}, rel=1e-4)
    assert found.bounds["x0"] == (-np.inf, np.inf)


def test_a_signal_that_is_not_recorded_is_recorded_for_the_fit() -> None:
    model = made("record: [v]\n" + OSCILLATOR, ("a",))
    found = fit(model, [series(oscillation(T, 0.9))], method="least_squares")
    assert found.model.recorded == ("v", "a", "x")
    with pytest.raises(OptionError, match="unknown signal 'y'"):
        fit(model, [Measured("run", "train", T, {"y": 0 * T})])


def test_two_series_of_one_name_are_refused() -> None:
    model, one = made(OSCILLATOR, ("a",)), series(oscillation(T, 0.9))
    with pytest.raises(DataError, match="several series are called 'run'"):
        fit(model, [one, one], method="least_squares")


@pytest.mark.parametrize("method", METHODS)
def test_standard_errors_of_a_line_are_the_textbooks(method: str) -> None:
    """y = a t + b + e: the variances are s^2 (X'X)^-1, s^2 = sum of squares/(N - 2)."""
    y = 2 * T + 1 + NOISE
    X = np.stack([T, np.ones_like(T)], axis=1)
    best, total, *_ = np.linalg.lstsq(X, y)
    exact = np.sqrt(np.diag(np.linalg.inv(X.T @ X)) * total / (T.size - 2))
    found = fitted(LINE, series(y), method=method)
    assert found.values == pytest.approx({"a": best[0], "b": best[1]}, abs=1e-5)
    assert found.errors == pytest.approx({"a": exact[0], "b": exact[1]}, rel=1e-3)


def test_standard_errors_see_the_noise_of_each_series() -> None:
    """y1 = a t + e1, y2 = a t + e2 of equal length, e2 ten times e1, both with equal weight."""
    rng = np.random.default_rng(5)
    e1, e2 = 0.01 * rng.standard_normal(T.size), 0.1 * rng.standard_normal(T.size)
    found = fitted(LINE, series(T + e1, "first"), series(T + e2, "second"), free=["a"])
    weight = T / (2 * T @ T)
    exact = np.sqrt(weight @ weight * (np.mean(e1**2) + np.mean(e2**2)))
    assert found.errors["a"] == pytest.approx(exact, rel=0.02)


def test_standard_errors_cover_the_truth_as_often_as_they_should() -> None:
    """Within two standard errors in about 95 % of repetitions."""
    rng = np.random.default_rng(11)
    model = made(OSCILLATOR)
    hits = 0
    for _ in range(20):
        noisy = series(oscillation(T, 0.9) + 0.02 * rng.standard_normal(T.size))
        found = fit(model, [noisy], method="least_squares")
        hits += abs(found.values["k"] - K) < 2 * found.errors["k"]
    assert hits >= 16  # fewer have a probability of 0.0018


def test_a_pair_that_the_data_cannot_tell_apart_has_no_errors() -> None:
    """J x'' = -k x - J c x': only k/J and c are seen."""
    text = OSCILLATOR.replace("k: {value: 3,", "J: {value: 1.5, fit: [0.1, 9]}\n  k: {value: 4,")
    text = text.replace("-k*x", "-k/J*x")
    found = fitted(text, series(oscillation(T, 0.9) + NOISE))
    assert found.values["k"] / found.values["J"] == pytest.approx(K, rel=0.01)
    assert np.isnan([found.errors["k"], found.errors["J"]]).all()
    assert 0 < found.errors["c"] < 0.02


def test_an_unused_parameter_has_no_error() -> None:
    found = fitted(OSCILLATOR, series(oscillation(T) + NOISE, start={"x": 1.0, "v": 0.0}),
                   free=["k", "x0"])  # fmt: skip
    assert np.isnan(found.errors["x0"])
    assert found.errors["k"] > 0


def test_options_reach_the_simplex_and_progress_tells() -> None:
    told: list[Progress] = []
    found = fitted(
        OSCILLATOR,
        series(oscillation(T, 0.9)),
        method="fminsearch",
        options=optimset(MaxIter=6, Display="off"),
        progress=told.append,
    )
    assert (found.iterations, found.exitflag) == (6, 0)
    assert "MaxIter" in found.message
    assert [now.evaluations for now in told] == sorted(now.evaluations for now in told)
    assert told[-1].best == pytest.approx(found.criterion)
    assert told[-1].remaining == 0


def test_least_squares_tells_its_progress() -> None:
    told: list[Progress] = []
    found = fitted(OSCILLATOR, series(oscillation(T, 0.9)), progress=told.append)
    assert told[-1].best == pytest.approx(found.criterion)
    assert told[-1].remaining == 0
    evaluations = [now.evaluations for now in told]
    assert evaluations == sorted(evaluations)
    assert evaluations[-1] <= found.evaluations


def refused(kind: type[Exception], text: str = OSCILLATOR, **more: Any) -> str:
    with pytest.raises(kind) as caught:
        fit(made(text), more.pop("measured", [series(oscillation(T))]), **more)
    return str(caught.value)


def test_an_unknown_method_is_told_with_the_nearest() -> None:
    told = refused(OptionError, method="fminserch")
    assert told == (
        "unknown method 'fminserch'; there are: fminsearch, growing_windows, least_squares, "
        "multiple_shooting, multistart, shooting. Did you mean 'fminsearch'?"
    )


def test_unknown_names_are_told_with_the_nearest() -> None:
    told = refused(OptionError, free=["x00"])
    assert told == "unknown parameter 'x00'; there are: c, k, x0. Did you mean 'x0'?"
    assert "unknown parameter 'kk'" in refused(OptionError, parameters={"kk": 1.0})


@pytest.mark.parametrize("method", FIT_METHODS)
def test_start_values_alone_are_fitted_too(method: str) -> None:
    """A finished diagram on a new record: only where that begins is not known."""
    measured = series(oscillation(T, 1.0, -0.5), start={"x": None, "v": None})
    found = fitted(OSCILLATOR, measured, method=method, free=[], parameters={"k": K, "c": C})
    assert found.values == {}
    assert found.starts["run"] == pytest.approx({"x": 1.0, "v": -0.5}, abs=1e-4)
    assert found.criterion < 1e-6 * found.criterion_before


def test_nothing_free_is_told() -> None:
    told = refused(OptionError, LINE.replace(", fit: free", ""))
    assert told == (
        "no parameter of the diagram is free. "
        "Give a parameter bounds, as in k: {value: 1, fit: [0, 10]}, or name it as free."
    )
    assert "no parameter of the diagram is free" in refused(OptionError, free=[])


def test_a_start_outside_its_bounds_is_told() -> None:
    told = refused(OptionError, parameters={"k": 30.0, "c": 3.0})
    assert "'k' begins at 30, outside its bounds 0.5 to 20 (SI). Begin inside them" in told
    assert "'c' begins at 3, outside its bounds 0 to 2 (SI)" in told
    assert [line.split(":")[1] for line in told.splitlines()] == ["4", "5"]


def test_no_series_is_told() -> None:
    assert refused(DataError, measured=[]) == "there is no measured series to fit to."


@pytest.mark.parametrize(
    ("limit", "message"),
    [
        ({"MaxIter": 2}, "stopped at the limit of iterations: MaxIter is 2"),
        ({"MaxFunEvals": 5}, "stopped at the limit of evaluations: MaxFunEvals is 5"),
    ],
)
def test_limits_of_optimset_hold_for_every_method(limit: dict[str, int], message: str) -> None:
    found = fitted(OSCILLATOR, series(oscillation(T, 0.9)), options=optimset(**limit))
    assert (found.exitflag, found.message) == (0, message)
    assert found.criterion <= found.criterion_before


def test_an_output_function_stops_every_method() -> None:
    states = []

    def stop(x: Any, values: Any, state: str) -> bool:
        states.append(state)
        comparisons = values.comparisons()
        assert [c.signal for c in comparisons] == ["x"]
        return bool(values.iteration == 2)

    found = fitted(OSCILLATOR, series(oscillation(T, 0.9)), options=optimset(OutputFcn=stop))
    assert (found.exitflag, found.message) == (-1, "stopped by an output function")
    assert found.iterations == 2
    assert states == ["init", "iter", "iter", "done"]
    assert found.criterion < found.criterion_before


def test_ctrl_c_ends_at_the_best_so_far() -> None:
    told: list[Progress] = []

    def interrupt(now: Progress) -> None:
        told.append(now)
        if len(told) == 2:
            raise KeyboardInterrupt

    endless = optimset(TolX=0, TolFun=0, MaxIter=1e6, MaxFunEvals=1e6, Display="off")
    measured = series(oscillation(T, 0.9))
    found = fitted(OSCILLATOR, measured, method="fminsearch", progress=interrupt, options=endless)
    assert found.interrupted
    assert found.exitflag == -1
    assert found.message == "stopped by Ctrl-C: this is the best so far"
    assert found.criterion < found.criterion_before


def test_a_model_that_does_not_run_is_told_with_time_and_block() -> None:
    text = """\
span: [0, 6]
parameters: {a: {value: 1, fit: free}}
blocks:
  x: {type: integrator, of: growth, start: 1}
  growth: {type: expression, formula: a*x**2}
"""
    told = refused(FitError, text)
    assert "the model does not run at the start: " in told
    assert "block 'x'" in told or "'x'" in told
    assert "t = 1" in told or "t = 0.99" in told
    assert not told.endswith("..")


def test_a_search_that_meets_failing_runs_goes_on() -> None:
    """x' = a x^2 from 1 has no solution to t = 6 for a > 1/6; the data are of a = 0.1."""
    text = """\
span: [0, 6]
parameters: {a: {value: 0.15, fit: [0, 5]}}
blocks: {x: {type: integrator, of: r, start: 1}, r: {type: expression, formula: a*x**2}}
"""
    for method in METHODS:
        found = fitted(text, series(1 / (1 - 0.1 * T)), method=method)
        assert found.values["a"] == pytest.approx(0.1, rel=1e-3)


def test_the_same_fit_twice_is_the_same() -> None:
    measured = series(oscillation(T, 0.9) + NOISE)
    first, second = fitted(OSCILLATOR, measured), fitted(OSCILLATOR, measured)
    assert replace(first, seconds=0.0).values == replace(second, seconds=0.0).values
    assert first.errors == second.errors


def test_without_a_series_for_training_nothing_is_fitted() -> None:
    told = refused(DataError, measured=[series(oscillation(T), use="validate")])
    assert told == (
        "no series is for training: run (validate). Give one `use: train`, or leave `use:` out."
    )


def test_a_delay_beyond_the_record_is_told() -> None:
    late = series(oscillation(T), sensors={"x": Sensor(delay=100.0)})
    assert refused(DataError, measured=[late]) == (
        "the delay of 'x' in 'run' is 100 s, and the record is 6 s long. "
        "Is it in s? Correct `delay:`."
    )


def test_presets_that_disagree_on_a_free_parameter_are_told() -> None:
    text = OSCILLATOR + "  soft: {k: 2}\n"
    pair = [series(oscillation(T), "one", preset="soft"), series(oscillation(T), "two")]
    told = refused(OptionError, text, measured=pair)
    assert told == (
        "'k' is free and the same for all series, and their presets say 2 (soft), 3 (no preset). "
        "Fix it, or take it out of the presets."
    )


def test_a_search_that_ends_before_a_minimum_says_so() -> None:
    noisy = series(oscillation(T, 0.9) + NOISE)
    few = optimset(MaxIter=5, Display="off")
    found = fitted(OSCILLATOR, noisy, method="fminsearch", options=few)
    assert found.unfinished.startswith("the search ended before a minimum: the slope there leads ")
    whole = fitted(OSCILLATOR, noisy)
    assert (whole.unfinished, whole.remarks) == ("", ())


def test_a_search_that_ends_before_a_minimum_has_not_converged(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    noisy = series(oscillation(T, 0.9) + NOISE)
    assert fitted(OSCILLATOR, noisy).message.startswith("converged")
    module = sys.modules[fit.__module__]
    monkeypatch.setattr(module, "unfinished", lambda *given: "the search ended")
    found = fitted(OSCILLATOR, noisy)
    assert found.message.startswith("ended before a minimum")
    assert found.unfinished == "the search ended"


def test_a_series_that_begins_elsewhere_is_told() -> None:
    train, other = series(oscillation(T, 0.9)), series(oscillation(T, 0.4), "other", use="validate")
    _exact, remark = fitted(OSCILLATOR, train, other).remarks
    assert remark == (
        "other: x begins at 0.4, and the run is at 0.9 there (SI): where that is another start, "
        "say start: {x: free}"
    )


def test_a_robust_loss_that_counts_all_as_outliers_has_no_errors() -> None:
    far = series(oscillation(T, 0.9) + 100 * NOISE, sigma={"x": 1e-3})
    found = fitted(OSCILLATOR, far, loss="cauchy")
    assert "most samples of x in run count as outliers" in found.uncertainty.words[0]
    assert all(np.isnan(error) for error in found.errors.values())


def test_outliers_do_not_lead_a_robust_loss_astray() -> None:
    spoilt = oscillation(T, 0.9) + NOISE
    spoilt[::10] += 3.0
    measured = series(spoilt, sigma={"x": 0.01})
    plain, robust = (fitted(OSCILLATOR, measured, loss=loss) for loss in ("linear", "huber"))
    assert abs(plain.values["k"] - K) > 5 * abs(robust.values["k"] - K)
    assert robust.values == pytest.approx({"k": K, "c": C}, rel=0.02)


def test_a_search_whose_last_slope_promises_much_says_so_though_errors_are_large() -> None:
    """r = a*p + b where p is 1 off: the residual that is there makes the errors as wide as the
    step."""
    criterion: Any = SimpleNamespace(scales=np.array([1.0]))
    slope, vector = np.ones((50, 1)), np.ones(50)
    told: Any = SimpleNamespace(names=("p",), at_bounds=(), errors={"p": 2.0})
    remark = unfinished(told, criterion, slope, vector, "fminsearch")
    assert remark.startswith("the search ended before a minimum: the slope there promises to ")
    assert remark.endswith("go on with --method least_squares")
    settled = np.tile([1.0, -1.0], 25)
    assert unfinished(told, criterion, slope, settled, "fminsearch") == ""
    again = unfinished(told, criterion, slope, vector, "least_squares")
    assert "least_squares gains nothing more from here: try --method growing_windows" in again


def test_a_search_that_ends_above_where_it_began_says_so() -> None:
    (remark,) = rises(2.0, 5.0, "least_squares")
    assert remark.startswith("the criterion is 2.5 times that of the values with which the search")
    assert remark.endswith("--method multiple_shooting takes short ones")
    (again,) = rises(2.0, 5.0, "multiple_shooting")
    assert "--method" not in again, "it does not advise itself"
    assert "cut the series shorter by `from:` and `to:`" in again
    assert rises(2.0, 2.0, "simplex") == rises(0.0, 0.0, "simplex") == []


def test_a_fit_that_raises_the_error_of_what_it_has_not_seen_says_so() -> None:
    """The stiffness of the other one is that with which the search begins."""
    slower = oscillation(T * (3 / K) ** 0.5, 0.9)
    train, other = series(oscillation(T, 0.9)), series(slower, "other", use="validate")
    _exact, remark = fitted(OSCILLATOR, train, other).remarks
    assert remark.startswith("other: the fit raises the error of x, which it has not seen, ")
    assert remark.endswith("(--method multiple_shooting takes short ones)")
    (again,) = raises_unseen(fitted(OSCILLATOR, train, other).comparisons, "multiple_shooting")
    assert "--method" not in again
    same = series(oscillation(T, 0.9), "other", use="validate")
    assert fitted(OSCILLATOR, train, same).remarks == (EXACT,)


def test_a_block_bounds_what_a_fit_may_change() -> None:
    """Viscous friction is not below 0, though the diagram lets its fit go there."""
    text = OSCILLATOR.replace(
        "a: {type: expression, formula: -k*x - c*v}",
        "a: {type: sum, of: [s, f]}\n  s: {type: stiffness, of: x, k: k}\n"
        "  f: {type: viscous, rate: v, c: c}",
    )
    assert text != OSCILLATOR
    text = text.replace("fit: [0, 2]", "fit: [-2, 2]")
    grows = np.exp(0.02 * T) * np.cos(2 * T)
    for method in METHODS:
        found = fitted(text, series(grows, sigma={"x": 0.01}), method=method)
        assert found.values["c"] == pytest.approx(0, abs=1e-6)
        assert found.bounds["c"] == (0, 2)
        assert not any("failed" in text for text in found.remarks)
