"""`lyapunov`: the mean rates at which small deviations from a motion grow."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from tracewire.analyse.limits import ORBIT
from tracewire.analyse.plane import span_of
from tracewire.arguments import checked
from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import AnalysisError, OptionError, Problem
from tracewire.result import Result
from tracewire.solve import (
    PartProgress,
    Passage,
    ProgressCallback,
    parameter_values,
    until_interrupted,
)

NODES, WEIGHTS = np.polynomial.legendre.leggauss(32)  # on [-1, 1]
SMOOTH = {"scheduled"}  # what may happen without a jump of the deviations


@dataclass(frozen=True, eq=False, repr=False)
class Lyapunov(Result):
    """Lyapunov exponents (k,) in 1/s, the largest first, and their standard errors (k,).

    `t` (N,) in s and `running` (N, k) are the estimate as it went. `divergence` is the mean of the
    trace of the Jacobian along the run, which is the sum of all exponents where the field is
    smooth; None where it jumps, or where not all exponents were asked for.
    """

    states: tuple[str, ...]
    exponents: Vector
    errors: Vector
    t: Vector
    running: Matrix
    divergence: float | None
    warnings: tuple[str, ...] = ()

    @property
    def total(self) -> float:
        """The sum of the exponents in 1/s."""
        return float(self.exponents.sum())

    @property
    def positive(self) -> int:
        """How many exponents are above zero by more than three standard errors."""
        return int(np.sum(self.exponents > 3 * self.errors))

    @property
    def dimension(self) -> float:
        """The Kaplan-Yorke dimension j + (sum of the first j exponents)/|exponent j + 1|."""
        sums = np.cumsum(self.exponents)
        whole = int(np.sum(sums >= 0))  # the sums rise, then fall
        if whole == 0 or whole == len(sums):
            return float(whole)
        return whole + float(sums[whole - 1] / abs(self.exponents[whole]))


@checked
def lyapunov(
    model: Model,
    length: float,
    *,
    interval: float | None = None,
    transient: float = 0.0,
    count: int | None = None,
    start: Mapping[str, float] | None = None,
    parameters: Mapping[str, float] | None = None,
    preset: str = "",
    inputs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    method: str = "auto",
    rtol: float = 1e-6,
    seed: int = 0,
    progress: ProgressCallback | None = None,
) -> Lyapunov:
    """The Lyapunov exponents of a motion, over `length` s after a `transient` in s.

    Deviations follow the variational equations with the jumps that events make; after each
    `interval` in s, about 30 steps of the integrator unless given, they are made orthogonal
    (Gram-Schmidt as a QR decomposition), and the mean of ln |diagonal of R| over time is the
    estimate; a tenth of the transient turns them to their directions (G. Benettin et al., Meccanica
    15, 1980). `count` is the number of exponents, that of the states unless given. The standard
    error is that of the means of 20 stretches. A deviation that is lost, as where a body sticks,
    or that shrinks to rounding within an interval, has the exponent minus infinity. Deviations
    begin in random directions from `seed`.

    Raises OptionError; AnalysisError where deviations vanish or grow without bound within an
    interval; SimulationError.
    """
    n = len(model.states)
    many = n if count is None else count
    step = length / 100 if interval is None else interval
    _check(n, many, length, step, transient)
    values = parameter_values(model, parameters or {}, preset)
    with until_interrupted() as stop_flag:
        make = partial(
            Passage,
            model,
            parameters=parameters,
            preset=preset,
            inputs=inputs,
            method=method,
            rtol=rtol,
            stop_flag=stop_flag,
        )
        begin = span_of(model, values)[0]
        passage = _after(make, begin, transient, step, start)
        first = passage.t
        if interval is None:  # a look ahead, at how long steps are
            ahead = make(length=step, begin=first, start=_named(passage))
            ahead.go_to(first + step)
            step = min(step, ORBIT.orthogonal_steps * step / max(1, ahead.steps))
        steps = round(length / step)
        turning = max(int(0.1 * transient / step), min(10, steps // 10))
        random = np.random.default_rng(seed).standard_normal((n, n))
        # from a start where something sticks only what it leaves is followed
        directions = passage.tangents @ np.linalg.qr(random)[0]
        growth = np.empty((steps, n))
        whole: float | None = 0.0
        told = PartProgress(progress, steps, 0)
        for i in range(-turning, steps):
            passage.tangents = directions
            before, a = passage.modes, passage.t
            b = first + (i + 1 + turning) * step
            passage.go_to(b, 0.5 * (a + b) + 0.5 * (b - a) * NODES)
            directions, diagonal = _orthogonal(passage)
            if i < 0:
                continue
            with np.errstate(divide="ignore"):
                growth[i] = np.log(np.abs(diagonal))
            if whole is not None:
                part = _divergence(passage, before, a, b)
                whole = None if part is None else whole + part
            told.step()
    growth = growth[:, :many]
    t = np.asarray(step * np.arange(1, steps + 1), dtype=float)
    running = np.cumsum(growth, axis=0) / t[:, None]
    parts = np.array_split(growth, ORBIT.batches)
    means = np.array([part.mean(axis=0) / step for part in parts])
    finite = np.isfinite(means).all(axis=0)
    errors = np.full(many, np.nan)
    errors[finite] = means[:, finite].std(axis=0, ddof=1) / np.sqrt(ORBIT.batches)
    order = np.argsort(-running[-1], kind="stable")
    divergence = None if whole is None or many < n else whole / t[-1]
    return Lyapunov(
        model.states,
        running[-1][order],
        errors[order],
        t,
        running[:, order],
        divergence,
        passage.warnings,
    )


def _after(
    make: Callable[..., Passage],
    begin: float,
    transient: float,
    step: float,
    start: Mapping[str, float] | None,
) -> Passage:
    """The passage with deviations after nine tenths of the transient, which need none.

    A memory would begin anew with it: then the whole transient goes with deviations.
    """
    long, t = 0.9 * transient, begin
    before = make(length=step, begin=begin, start=start)
    remembers = any(mode.kind == "memory" for mode in before.model.modes)
    if long > 0 and not remembers:
        before.go_to(begin + long)
        start, t = _named(before), before.t
    passage = make(length=step, begin=t, start=start, tangents=True, inner=len(NODES))
    if long > 0 and remembers:
        for end in np.linspace(t, t + long, max(2, int(long / step)))[1:]:
            directions, _ = _orthogonal(passage)
            passage.tangents = directions
            passage.go_to(float(end))
    return passage


def _named(passage: Passage) -> dict[str, float]:
    """The states at a stop by name."""
    return dict(zip(passage.model.states, passage.x.tolist(), strict=True))


def _orthogonal(passage: Passage) -> tuple[Matrix, Vector]:
    """The deviations made orthogonal, and what each has grown by."""
    tangents = passage.tangents
    if not np.isfinite(tangents).all() or np.abs(tangents).max(initial=0.0) > 1e150:
        what = f"deviations grow without bound within an interval before t = {passage.t:g} s"
        raise AnalysisError([Problem(what, hint="Give a shorter interval.")])
    directions, upper = np.linalg.qr(tangents)
    diagonal = np.diag(upper).copy()
    lost = np.abs(diagonal) <= ORBIT.lost * np.abs(diagonal).max(initial=0.0)
    # they have no direction of their own, and what QR makes up would not stay on a slide
    directions[:, lost], diagonal[lost] = 0.0, 0.0
    return directions, diagonal


def _divergence(passage: Passage, before: Vector, a: float, b: float) -> float | None:
    """The integral of the trace of the Jacobian over an interval; None where it may not be."""
    if passage.kinds - SMOOTH or passage.held:
        return None
    times, inside, total = 0.5 * (a + b) + 0.5 * (b - a) * NODES, passage.inside, 0.0
    after = passage.modes
    changed = bool(np.any(before != after))
    for weight, t, x in zip(WEIGHTS, times.tolist(), inside, strict=True):
        trace = float(np.trace(passage.jacobian(x, t, after)))
        if changed and abs(trace - np.trace(passage.jacobian(x, t, before))) > 1e-9 * (
            1 + abs(trace)
        ):
            return None
        total += 0.5 * (b - a) * float(weight) * trace
    return total


def _check(n: int, many: int, length: float, step: float, transient: float) -> None:
    problems = []
    if not 1 <= many <= n:
        what = f"{many} exponents of a model with {n} states cannot be had"
        problems.append(Problem(what, hint=f"Give a count from 1 to {n}."))
    if not (0 < step < np.inf and length >= 2 * ORBIT.batches * step and length < np.inf):
        what = f"{length:g} s with intervals of {step:g} s are too few to average"
        hint = f"Give {2 * ORBIT.batches} intervals at least."
        problems.append(Problem(what, hint=hint))
    if not 0 <= transient < np.inf:
        what = f"a transient of {transient:g} s has no use"
        problems.append(Problem(what, hint="Give 0 or more."))
    if problems:
        raise OptionError(problems)
