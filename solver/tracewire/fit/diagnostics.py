"""Is what is left of each measured signal noise, or is something missing?"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy.special import chdtrc, ndtr, ndtri

from tracewire.arguments import checked
from tracewire.array_types import Vector
from tracewire.errors import FormulaError, SimulationError
from tracewire.fit.limits import DIAGNOSIS
from tracewire.fit.result import Comparison, Fit
from tracewire.formula import Expression, evaluate, names_of, two_digits
from tracewire.residual import (
    WINDOW,
    InputNoise,
    Measured,
    NoiseEstimate,
    estimate_noise,
    noise_of,
    of_diagram,
    run_noise,
)
from tracewire.solve import parameter_values, values_at


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What is left of one measured signal of one series after a fit.

    `residual` (N,) is measured - simulated of the samples that count, in SI, `size` its root mean
    square; `variation` is the standard deviation of these samples. `noise` is that of the sensor:
    `declared`, or from the data, as `estimate` says.
    `driven` is what the declared noise of measured inputs makes of it, None where none is declared.
    `step` is the median time between samples in s. `correlation` (L,) is the autocorrelation at
    `lags` (L,) in samples, white noise stays within +-`band` 95 % of the time, `memory` is the time
    in s after which it has fallen to 1/e. `whiteness` is the probability that white noise looks as
    correlated (Ljung and Box), `sign_changes` that it changes its sign as seldom or as often.
    `independence` holds by measured input, by signal of time alone that drives the model, and by
    the simulated signal itself, the probability that something independent of it follows it as
    closely. `outliers` is the share of samples beyond 4 robust standard deviations. `words` says it
    in sentences, `is_missing` whether it says that something is missing, which no residual of a
    search that ended before a minimum does. `users_unit` is the unit in which the user has the
    signal, with its factor to SI.
    """

    series: str
    use: str
    signal: str
    unit: str
    residual: Vector
    size: float
    variation: float
    noise: float
    declared: bool
    step: float
    lags: Vector
    correlation: Vector
    band: float
    memory: float
    whiteness: float
    sign_changes: float
    independence: Mapping[str, float]
    outliers: float
    words: str
    driven: InputNoise | None = None
    estimate: NoiseEstimate | None = None
    is_missing: bool = False
    users_unit: tuple[str, float] = ("", 1.0)

    @property
    def is_out_of_step(self) -> bool:
        """Whether so much is left that the fit may stand in another minimum than the lowest."""
        return self.size > DIAGNOSIS.out_of_step * self.variation

    @property
    def is_white(self) -> bool:
        """Whether no correlation in time is seen that would matter."""
        largest = np.abs(self.correlation[1:]).max()
        return self.whiteness >= DIAGNOSIS.doubt or bool(largest < DIAGNOSIS.notable)


@checked
def diagnose(fit: Fit) -> tuple[Diagnosis, ...]:
    """Every measured signal of every series of a fit, in the order of its comparisons.

    Signals with fewer than 10 samples that count are left out. Samples count by their index.
    """
    series = {m.name: m for m in fit.measured}
    driven = {m.name: _driven(fit, m) for m in fit.measured}
    return tuple(
        _diagnosis(fit, one, series[one.series], driven[one.series].get(one.signal))
        for one in fit.comparisons
        if np.count_nonzero(_counted(one)) >= DIAGNOSIS.fewest_samples
    )


def autocorrelation(residual: Vector, count: int) -> Vector:
    """The autocorrelation of lags 0 to count - 1 of a residual (N,), its mean not removed."""
    square = float(residual @ residual)
    if square == 0:
        return np.asarray(np.eye(1, count)[0])
    spectrum = np.fft.rfft(residual, 2 * len(residual))
    return np.asarray(np.fft.irfft(np.abs(spectrum) ** 2)[:count]) / square


def ljung_box(correlation: Vector, samples: int) -> float:
    """The probability that white noise looks as correlated, from lags 0 to m.

    Q = N (N + 2) sum rho_k^2/(N - k) against chi-square with m degrees of freedom (G. M. Ljung and
    G. E. P. Box, Biometrika 65, 1978, 297).
    """
    k = np.arange(1, len(correlation))
    q = samples * (samples + 2) * float(np.sum(correlation[1:] ** 2 / (samples - k)))
    return float(chdtrc(len(k), q))


def sign_change_probability(residual: Vector) -> float:
    """The probability that independent signs change as seldom or as often as those of a residual.

    The test of runs (A. Wald and J. Wolfowitz, Annals of Mathematical Statistics 11, 1940, 147).
    """
    signs = residual[residual != 0] > 0
    above, below = float(np.sum(signs)), float(np.sum(~signs))
    both = 2 * above * below
    if both == 0:
        return 0.0 if len(signs) > DIAGNOSIS.fewest_samples else 1.0
    count = above + below
    variance = both * (both - count) / (count**2 * (count - 1))
    runs = 1 + np.count_nonzero(signs[1:] != signs[:-1])
    return float(2 * ndtr(-abs(runs - both / count - 1) / max(variance, 1e-12) ** 0.5))


def independence(residual: Vector, other: Vector, lags: int) -> float:
    """The probability that a residual independent of a signal follows it as closely; both (N,).

    The residual is regressed on the signal's last `lags` values, on no more than the 6 principal
    components of these that are above a tenth of the first. With coefficients c and K their
    covariance under the correlation of what is then left, c' K^-1 c is chi-square (A. Wald,
    Transactions of the American Mathematical Society 54, 1943, 426).
    """
    past = sliding_window_view(other, lags)
    x = residual[lags - 1 :] - np.mean(residual[lags - 1 :])
    past = past - past.mean(axis=0)
    squares, components = np.linalg.eigh(past.T @ past)  # ascending
    if squares[-1] <= 1e-20 * lags * float(other @ other):
        return 1.0
    strong = squares > 0.01 * squares[-1]
    strong[: -DIAGNOSIS.components] = False
    basis = past @ components[:, strong] / np.sqrt(squares[strong])
    follows = basis.T @ x
    left = x - basis @ follows
    noise = noise_of(left, float(np.sqrt(left @ left / (len(x) - len(follows)))))
    if noise.level == 0:
        return 1.0
    covariance = basis.T @ noise.spread(basis)
    return float(chdtrc(len(follows), follows @ np.linalg.solve(covariance, follows)))


def _counted(comparison: Comparison) -> NDArray[np.bool_]:
    return np.asarray(comparison.counts & np.isfinite(comparison.after))


def _drives(fit: Fit, measured: Measured, t: Vector) -> dict[str, Vector]:
    """What drives the model at times t (N,): its measured inputs, and signals of time alone."""
    found = {name: values_at(known, t) for name, known in measured.inputs.items()}
    flat = fit.model.flat
    given = {**fit.parameters, **of_diagram(fit.model, fit.values, measured)}
    values = parameter_values(fit.model, given, measured.preset)
    timed: dict[str, Expression] = {}
    others = [state.rate for state in flat.states]
    for name, formula in flat.signals.items():
        read = set(names_of(formula)) - set(values)
        if read and read <= {"t", *timed}:
            timed[name] = formula
        else:
            others.append(formula)
    driving = {name for formula in others for name in names_of(formula)} & set(timed)
    for name in driving:
        formula = timed[name]
        try:
            found[name] = np.array([_at(time, formula, timed, values) for time in t])
        except FormulaError:  # a table, or no number at some time: nothing to compare with
            continue
    return found


def _at(
    time: float,
    formula: Expression,
    timed: Mapping[str, Expression],
    values: Mapping[str, float],
) -> float:
    known = {**values, "t": time}
    for name in names_of(formula):
        if name in timed:
            known[name] = _at(time, timed[name], timed, values)
    return evaluate(formula, known)


def _driven(fit: Fit, measured: Measured) -> Mapping[str, InputNoise]:
    """What the declared noise of a series' inputs makes of its signals, after a fit."""
    if not measured.input_sigma:
        return {}
    values = {**fit.parameters, **fit.values}
    fitted = list(fit.values) if measured.use == "train" else []
    start = fit.starts.get(measured.name, {})
    try:
        return run_noise(fit.model, measured, values, start, fitted)
    except SimulationError:
        return {}


def _diagnosis(
    fit: Fit, comparison: Comparison, measured: Measured, driven: InputNoise | None
) -> Diagnosis:
    rows = _counted(comparison)
    residual = comparison.residual_after[rows]
    t = comparison.t[rows]
    count, step = len(residual), float(np.median(np.diff(t)))
    lags = np.arange(min(int(10 * np.log10(count)), count // 4) + 1)
    correlation = autocorrelation(residual, len(lags))
    others = _drives(fit, measured, t)
    others[comparison.signal] = comparison.after[rows]
    spread = 1.4826 * float(np.median(np.abs(residual - np.median(residual))))
    far = np.abs(residual - np.median(residual)) > DIAGNOSIS.far * spread
    estimate = estimate_noise([measured])[comparison.signal]
    found = Diagnosis(
        series=comparison.series,
        use=comparison.use,
        signal=comparison.signal,
        unit=comparison.unit,
        users_unit=comparison.users_unit,
        residual=residual,
        size=float(np.sqrt(np.mean(residual**2))),
        variation=float(np.std(comparison.measured[rows])),
        noise=estimate.level,
        declared=measured.sigma.get(comparison.signal) is not None,
        step=step,
        lags=lags.astype(np.float64),
        correlation=correlation,
        band=float(ndtri(0.975)) / count**0.5,
        memory=step * _memory(residual),
        whiteness=ljung_box(correlation, count),
        sign_changes=sign_change_probability(residual),
        independence={
            n: independence(residual, x, min(DIAGNOSIS.lags, count // 5)) for n, x in others.items()
        },
        outliers=float(np.mean(far)) if spread > 0 else 0.0,
        words="",
        driven=driven,
        estimate=estimate,
    )
    return _with_words(found, measured, finished=not fit.unfinished)


def _memory(residual: Vector) -> int:
    """The first lag at which the autocorrelation is below 1/e."""
    correlation = autocorrelation(residual, len(residual) // 2)
    below = np.flatnonzero(correlation < np.exp(-1))
    return int(below[0]) if len(below) else len(correlation)


def _with_words(found: Diagnosis, measured: Measured, finished: bool) -> Diagnosis:
    noise, limit = found.noise, DIAGNOSIS.at_noise * found.noise
    source = "declared noise" if found.declared else "noise"
    if found.driven is not None:
        noise = float(np.hypot(found.noise, found.driven.size))
        limit = max(DIAGNOSIS.at_noise * noise, float(np.hypot(found.noise, found.driven.high)))
        source += " of sensor and inputs"
    times = found.size / noise
    estimate = found.estimate
    # a residual that the noise of inputs makes follows these as they are measured
    of_inputs = found.driven is not None and DIAGNOSIS.at_noise * found.noise < found.size <= limit
    known = set(measured.input_sigma) if of_inputs else set()
    depends = [
        name
        for name, p in found.independence.items()
        if p < DIAGNOSIS.doubt and name != found.signal and name not in known
    ]
    doubtful = estimate is not None and not estimate.is_sure
    lacks = False
    over = f"correlated over {two_digits(found.memory)} s"
    if of_inputs:
        names = " and ".join(f"'{name}'" for name in measured.input_sigma)
        words = [
            f"at the noise of the measured input {names}, which explains it",
            f"Without that, the residual is {two_digits(found.size / found.noise)} times the noise",
        ]
    elif estimate and doubtful and limit < found.size <= DIAGNOSIS.at_noise * estimate.high:
        unit, factor = found.users_unit
        low, high = estimate.low / factor, estimate.high / factor
        between = f"{two_digits(low)} and {two_digits(high)} {unit or found.unit}".rstrip()
        words = [
            f"the residual is {two_digits(times)} times the noise and {over}",
            "It may be noise alone: the noise is estimated to lie between "
            f"{between} ({estimate.method}). Write its `sigma:` where it is known",
        ]
    elif found.size > limit and not (found.is_white and not depends):
        correlated = "" if found.is_white else f" and {over}"
        words = [f"the residual is {two_digits(times)} times the {source}{correlated}"]
        lacks = finished
    elif found.size > limit:
        larger = "than declared" if found.declared else "than its differences tell"
        words = [f"the residual is {two_digits(times)} times the {source}, yet white: the noise is"]
        words[0] += f" larger {larger}"
    elif not found.is_white:
        words = [f"at the {source}, yet {over}"]
        words.append("Something small may be missing; the errors allow for it")
    elif times < 0.7 and found.declared:
        words = [
            f"white, and {two_digits(times)} times the declared noise: sigma is declared too large"
        ]
    else:
        words = [f"white, at the {source}"]
    if lacks:
        missing = "Something is missing"
        if estimate and not found.declared and times < DIAGNOSIS.coloured:
            missing += (
                ", or the noise itself is correlated: its estimate counts the white part alone"
            )
        words.append(missing)
        if len(measured.t) < WINDOW.traced:
            words.append(f"`tracewire trace` takes no series below {WINDOW.traced} samples")
        else:
            words.append("`tracewire trace` looks for it")
    if depends:
        words.append(f"The residual depends on {' and '.join(depends)}, which drives the model")
    if found.outliers > 0.005 and not lacks:  # what a model lacks is large where it acts
        share = f"{two_digits(100 * found.outliers)} %"
        words.append(f"{share} are outliers, beyond {DIAGNOSIS.far:g} standard deviations")
    return replace(found, words=". ".join(words), is_missing=lacks)
