"""Mistakes of a record that look like missing effects: other units, a drive shifted in time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain

import numpy as np

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.errors import DataError, FormulaError, Problem, TracewireError
from tracewire.formula import Name, same_quantity, two_digits
from tracewire.residual import Measured, Section, channel_noise, cut_windows, with_past
from tracewire.solve import values_at, with_points
from tracewire.trace.data_thresholds import CheckOptions
from tracewire.trace.trials.trial import TraceProblem


@dataclass(frozen=True, eq=False)
class Mistake:
    """What may be wrong with a record, in words, and how it is undone."""

    what: str
    hint: str
    undone: Callable[[Measured], Measured]


def refuse_mistakes(
    model: Model,
    measured: Sequence[Measured],
    options: CheckOptions,
    reduced_chi2: float = np.inf,
    rtol: float = 1e-6,
) -> None:
    """Refuse a record that the declared model explains once a mistake in it is undone.

    Tried are: a drive that is shifted in time against the response, angles in degrees for radians,
    lengths in mm for m, an input in thousandths, and the reverse of each; on the first samples of
    the first train series, in short windows. A mistake is told only where a record far from the
    noise comes nearer by a factor of 30 without it: no effect of the library does that.

    reduced_chi2: RSS per degree of freedom of the declared model in short windows, where it is
    known; below 30 nothing is tried. Raises DataError.
    """
    train = [m for m in measured if m.use == "train" and len(m.t) > options.mistake_window]
    if reduced_chi2 < options.mistake_from or not train:
        return
    m = _beginning(model, train[0], options.mistake_samples)
    before = declared_reduced_chi2(
        model, [m], rtol, options.mistake_window, options.mistake_first_steps
    )
    if before < options.mistake_from:
        return
    best, found = np.inf, None
    for mistake in chain(_shifts(model, train[0], m, before, rtol, options), _units(model, m)):
        length, steps = options.mistake_window, options.mistake_steps
        after = declared_reduced_chi2(
            model, [_with_own_past(model, mistake.undone(m))], rtol, length, steps
        )
        if after < best:
            best, found = after, mistake
        if best < options.mistake_undone:
            break
    if found is not None and best * options.mistake_nearer < before:
        what = f"the series '{m.name}' is explained {before / best:.0f} times better {found.what}"
        raise DataError([Problem(what, hint=found.hint)])


def _with_own_past(model: Model, m: Measured) -> Measured:
    """A series that was changed, with what it tells now of delayed signals."""
    return with_past(model, replace(m, past={}), "each window") if m.past else m


def declared_reduced_chi2(
    model: Model, measured: Sequence[Measured], rtol: float, length: int, steps: int
) -> float:
    """RSS per degree of freedom of the declared model, fitted to windows of `length` samples with
    free starts.

    Infinity where it cannot be simulated.
    """
    try:
        windows = [
            w
            for m in measured
            for w in cut_windows(model, Section(m, 0, len(m.t)), length, model.states)
        ]
        problem = TraceProblem(model, tuple(measured), channel_noise(measured), rtol)
        return problem.fit((), windows, length, {}, steps=steps).reduced_chi2
    except TracewireError:
        return np.inf


def _beginning(model: Model, m: Measured, samples: int) -> Measured:
    """The first samples of a series, from a free start."""
    rows = slice(0, samples)
    values = {name: column[rows] for name, column in m.values.items()}
    start = dict.fromkeys(model.states)
    return replace(m, t=m.t[rows], values=values, start=start, drift_from=m.zero)


def _units(model: Model, m: Measured) -> Iterator[Mistake]:
    """Signals and inputs in another unit than is declared."""
    units = model.flat.units
    degrees = np.pi / 180
    angles = [name for name in m.values if _is(units.get(name, ""), "rad", "rad/s")]
    lengths = [name for name in m.values if _is(units.get(name, ""), "m", "m/s")]
    for names, factors in (
        (angles, {degrees: "degrees, and not radians", 1 / degrees: "radians, and not degrees"}),
        (lengths, {1e-3: "thousandths of m (mm)", 1e3: "m, and not mm"}),
    ):
        for factor, meaning in factors.items() if names else ():
            shown = " and ".join(f"'{name}'" for name in names)
            verb = "is" if len(names) == 1 else "are"
            yield Mistake(
                f"if {shown} {verb} in {meaning}",
                "Say the unit of the column: in its header, or in the diagram.",
                partial(_scale_signals, names=names, factor=factor),
            )
    for name in m.inputs:
        for factor, meaning in ((1e-3, "thousandths of"), (1e3, "thousands of")):
            yield Mistake(
                f"if the input '{name}' is in {meaning} its unit",
                "Say the unit of the column: in its header, or in the diagram.",
                partial(_scale_input, name=name, factor=factor),
            )


def _is(unit: str, *others: str) -> bool:
    """Whether a unit is that of one of the quantities; a plain number is no angle."""
    if not unit or ("rad" in others and "rad" not in unit and "deg" not in unit):
        return False
    try:
        return any(same_quantity(unit, other) for other in others)
    except FormulaError:
        return False


def _scale_signals(m: Measured, names: Sequence[str], factor: float) -> Measured:
    values = {name: v * factor if name in names else v for name, v in m.values.items()}
    sigma = {
        name: None if s is None else s * factor if name in names else s
        for name, s in m.sigma.items()
    }
    return replace(m, values=values, sigma=sigma)


def _scale_input(m: Measured, name: str, factor: float) -> Measured:
    t, values = m.inputs[name]
    return replace(m, inputs={**m.inputs, name: with_points(m.inputs[name], t, values * factor)})


def _shifts(
    model: Model, m: Measured, part: Measured, before: float, rtol: float, options: CheckOptions
) -> Iterator[Mistake]:
    """A drive that stands too late or too early in time beside the response.

    The lag is told by the whole series, and to a sample by the declared model on a part of it.
    """
    step = m.interval

    def left(lag: float) -> float:
        length, steps = options.mistake_window, options.mistake_steps
        return declared_reduced_chi2(model, [shift_inputs(part, lag)], rtol, length, steps)

    def is_worth_refining(reduced_chi2: float) -> bool:
        return options.mistake_undone < reduced_chi2 < before / options.lag_hopeful

    for likely in likely_lags(model, m, options):
        if -options.lag_before < likely / step < options.lag_after:
            continue
        lag, least = likely, left(likely)
        for side in (-step, step):
            while (
                is_worth_refining(least)
                and (there := left(lag + side)) < options.lag_better * least
            ):
                lag, least = lag + side, there
                if abs(lag - likely) > options.lag_steps * step:
                    break
        when = f"about {two_digits(abs(lag))} s {'after' if lag > 0 else 'before'} its drive"
        yield Mistake(
            f"if its signals come {when}",
            "Are drive and signals from one clock? Put them to the same time.",
            partial(shift_inputs, lag=lag),
        )


def shift_inputs(m: Measured, lag: float) -> Measured:
    """A series whose inputs act later by `lag` (s)."""
    later = {n: with_points(known, known[0] + lag, known[1]) for n, known in m.inputs.items()}
    return replace(m, inputs=later)


def likely_lags(model: Model, m: Measured, options: CheckOptions) -> list[float]:
    """The lags in s by which the response may follow the inputs, the most likely first.

    Where the accelerations are explained best by a polynomial of the signals, their rates, and the
    inputs that long ago; all weighed over short stretches with a smooth bump, whose derivatives
    stand for those of the signals. Positive: the response comes after.
    """
    step = m.interval
    if not m.inputs or len(m.t) < 8 * options.lag_bump:
        return []
    target, basis = _weak_form(model, m, step, options.lag_bump)
    basis, _ = np.linalg.qr(basis)
    target = target - basis @ (basis.T @ target)
    bump, _, _ = _bump(step, options.lag_bump)
    reach = int(min(len(m.t) // 3, options.lag_longest / step))
    lags = step * np.arange(-reach, reach + 1)
    left = []
    for lag in lags:
        drives = [values_at(known, m.t - lag) for known in m.inputs.values()]
        columns = np.column_stack([np.convolve(u, bump, "valid") for u in drives])
        columns = columns - basis @ (basis.T @ columns)
        kept, _ = np.linalg.qr(columns)
        left.append(float(np.sum(target**2) - np.sum((kept.T @ target) ** 2)))
    rest = np.array(left)
    lowest = np.flatnonzero((rest[1:-1] <= rest[:-2]) & (rest[1:-1] <= rest[2:])) + 1
    found = []
    likely = sorted(lowest, key=lambda i: rest[i])[: options.lag_likely]
    for i in likely:  # the vertex of a parabola through three
        bend = rest[i - 1] - 2 * rest[i] + rest[i + 1]
        off = 0.5 * (rest[i - 1] - rest[i + 1]) / bend if bend > 0 else 0.0
        found.append(float(lags[i] + off * step))
    return found


def _weak_form(model: Model, m: Measured, step: float, half: int) -> tuple[Vector, Vector]:
    """Accelerations (N, signals), and what they may depend on (N, n)."""
    bump, first, second = _bump(step, half)
    rates = {state.name: state.rate for state in model.flat.states}
    columns: list[Vector] = [np.ones(len(m.t))]
    targets: list[Vector] = []
    for name, values in m.values.items():
        rate = rates.get(name)
        order = 2 if isinstance(rate, Name) and rate.name in rates else 1
        y = (values - np.mean(values)) / (float(np.std(values)) or 1.0)
        target = np.convolve(y, second if order == 2 else first, "valid")
        targets.append(target / (float(np.std(target)) or 1.0))
        v = np.convolve(np.pad(y, half, mode="edge"), first / np.sum(bump), "valid")
        v = v / (float(np.std(v)) or 1.0)
        own = [y, y**2, y**3, y**5]
        if order == 2:
            own += [v, v**2, v**3, y * v, y**2 * v, y * v**2, np.sign(v), np.abs(v) * v]
        else:
            own += [np.sign(values), np.abs(values) * y]
        columns += own
    basis = [np.convolve(column, bump, "valid") for column in columns]
    return np.column_stack(targets), np.column_stack(basis)


def _bump(step: float, half: int) -> tuple[Vector, Vector, Vector]:
    """(1 - s^2)^4 over 2 half + 1 samples, and its derivatives in time."""
    polynomial = np.polynomial.Polynomial([1.0, 0.0, -1.0]) ** 4
    s = np.linspace(-1, 1, 2 * half + 1)
    width = step * half
    return (
        polynomial(s),
        polynomial.deriv()(s) / width,
        polynomial.deriv(2)(s) / width**2,
    )
