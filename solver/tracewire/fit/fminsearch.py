"""Scilab's `fminsearch`: the simplex search of Nelder and Mead, evaluation for evaluation.

The simplex has n + 1 vertices x₁ ... xₙ₊₁ with values f₁ <= ... <= fₙ₊₁. An iteration replaces the
worst one, xₙ₊₁, by a point of the line through it and the centre x̄ of the others,

    x(μ) = (1 + μ) x̄ - μ xₙ₊₁,

    reflect            μ = ρ     where  f₁ <= f(x(ρ)) < fₙ
    expand             μ = ρχ    where  f(x(ρ)) < f₁, and it is better than the reflected point
    contract outside   μ = ργ    where  fₙ <= f(x(ρ)) < fₙ₊₁, and f(x(ργ)) <= f(x(ρ))
    contract inside    μ = -γ    where  f(x(ρ)) >= fₙ₊₁, and f(x(-γ)) < fₙ₊₁
    shrink             x ← (1 - σ) x₁ + σ x for all but x₁, where a contraction fails

with ρ = 1, χ = 2, γ = σ = 1/2. It ends where max |x - x₁| < TolX (Euclidean length of the longest
edge at the best vertex, strictly) and fₙ₊₁ - f₁ < TolFun.

Sources: J. A. Nelder and R. Mead, Computer Journal 7 (1965) 308; J. C. Lagarias, J. A. Reeds,
M. H. Wright and P. E. Wright, SIAM J. Optimization 9 (1998) 112; start simplex by L. Pfeffer;
order of the tests and of the counts: Scilab 6.1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tracewire.array_types import Vector
from tracewire.errors import FitError, OptionError
from tracewire.fit.limits import SIMPLEX
from tracewire.fit.optimset import OptimValues, Options
from tracewire.options import options_of

STOPPED, LIMIT, CONVERGED = range(-1, 2)


@dataclass(frozen=True)
class Output:
    """How a search went: method, evaluations, iterations, and why it ended."""

    algorithm: str
    funcCount: int  # noqa: N815 - Scilab's name
    iterations: int
    message: str


class Minimum(NamedTuple):
    """The best point x (n,), its value, and how the search ended.

    exitflag: 1 converged, 0 a limit of iterations or evaluations was reached, -1 stopped by an
    output function.
    """

    x: Vector
    fval: float
    exitflag: int
    output: Output


def fminsearch(
    fun: Callable[[Vector], float],
    x0: ArrayLike,
    options: Options | Mapping[str, Any] | None = None,
    *,
    resumed: Mapping[str, Any] | None = None,
    keep: Callable[[dict[str, Any]], None] | None = None,
) -> Minimum:
    """Minimise fun(x) from x0 without derivatives, as Scilab's `fminsearch` does.

    fun: x (n,) -> a number. NaN counts as +∞, so that such a trial is refused; Scilab 6.1 makes the
        same moves. A trial with a coordinate beyond the range of numbers is counted and refused
        without a call.
    x0: a number, or a one-dimensional array (n,).
    keep: is given the simplex after each iteration, in plain numbers; with that as `resumed` a
        search goes on as if it had not been stopped.

    Evaluations, moves and stops are those of Scilab 6.1; vertices of equal value stay in their
    order. What differs: of several output functions any one may stop the search (in Scilab only the
    last), and `output.message` has our wording.

    Raises OptionError where x0 is not such an array or not finite or options are not Options,
    FitError where fun(x0) is not finite or fun does not return a number. What fun itself raises
    goes through.
    """
    chosen = options_of(Options, options, "fminsearch")
    start = _start(x0)
    evaluate = _Evaluate(fun)
    monitor = _Monitor(chosen, evaluate)
    iteration, procedure = 0, "initial simplex"
    if resumed:
        vertices, values = np.array(resumed["vertices"], float), list(resumed["values"])
        iteration, procedure = resumed["iteration"], resumed["procedure"]
        start, evaluate.count = vertices[0], resumed["evaluations"]
    else:
        vertices = _pfeffer(start)
        values = [evaluate.first(start), *(evaluate(vertex) for vertex in vertices[1:])]

    if monitor.stops("init", start, values[0], 0, ""):
        return monitor.result(start, values[0], 0, STOPPED, _USER_STOP)
    while True:
        # The sort is stable: it decides which of two equal vertices is replaced first.
        order = sorted(range(len(values)), key=values.__getitem__)
        vertices, values = vertices[order], [values[i] for i in order]
        iteration += 1
        if monitor.stops("iter", vertices[0], values[0], iteration, procedure):
            flag, message = STOPPED, _USER_STOP
            break
        # Not before the first move: Scilab gives even a converged simplex one.
        if iteration > 1 and (end := _end(vertices, values, iteration, evaluate.count, chosen)):
            flag, message = end
            break
        procedure = _move(vertices, values, evaluate)
        if keep is not None:
            keep(
                {
                    "vertices": vertices.tolist(),
                    "values": values.copy(),
                    "iteration": iteration,
                    "procedure": procedure,
                    "evaluations": evaluate.count,
                }
            )
    if monitor.stops("done", vertices[0], values[0], iteration, ""):
        flag, message = STOPPED, _USER_STOP
    return monitor.result(vertices[0], values[0], iteration, flag, message)


_USER_STOP = "Stopped by an output function"


def _start(x0: ArrayLike) -> Vector:
    hint = "Give a number or a one-dimensional array of numbers."
    start = _real(x0)
    if start is None:
        raise OptionError.one(f"x0 is not made of real numbers: {_shown(x0)}", hint=hint)
    if start.ndim > 1 or start.size == 0:
        shape = "empty" if start.size == 0 else f"an array of shape {start.shape}"
        raise OptionError.one(f"x0 is {shape}", hint=hint)
    start = np.atleast_1d(start)
    for index, number in enumerate(start):
        if not math.isfinite(number):
            raise OptionError.one(f"x0[{index}] is {number}", hint="Start from finite numbers.")
    return start


def _pfeffer(start: Vector) -> Vector:
    """The vertices (n+1, n) of the start simplex; the first is the start itself."""
    edges = np.where(start == 0, SIMPLEX.zero_edge, SIMPLEX.relative_edge * start)
    return np.vstack([start, start + np.diag(edges)])


class _Evaluate:
    """The function, counted; NaN becomes +∞."""

    def __init__(self, fun: Callable[[Vector], float]) -> None:
        self.fun = fun
        self.count = 0

    def __call__(self, x: Vector) -> float:
        self.count += 1
        if not np.isfinite(x).all():
            return math.inf
        value = self.fun(x.copy())
        array = _real(value)
        if array is None or array.size != 1:
            what = f"the function returned {_shown(value)} at x = {_shown(x)}"
            raise FitError.one(what, hint="It must return one real number.")
        number = array.item()
        return math.inf if math.isnan(number) else number

    def first(self, x: Vector) -> float:
        value = self(x)
        if not math.isfinite(value):
            what = f"the function is not finite at x0 = {_shown(x)}"
            raise FitError.one(what, hint="Start where it has a finite value.")
        return value


def _real(value: object) -> Vector | None:
    """A new array of the value, or None where it is not made of real numbers."""
    try:
        array = np.asarray(value)
    except ValueError:  # rows of several lengths
        return None
    return array.astype(np.float64) if array.dtype.kind in "biuf" else None


def _shown(value: object) -> str:
    text = " ".join((str(value.tolist()) if isinstance(value, np.ndarray) else repr(value)).split())
    return text if len(text) <= 100 else f"{text[:97]}..."


def _move(vertices: Vector, values: list[float], evaluate: _Evaluate) -> str:
    """One move of a sorted simplex, in place; its name."""
    others = _centre(vertices)

    def trial(factor: float) -> tuple[Vector, float]:
        x = _on_line(others, vertices[-1], factor)
        return x, evaluate(x)

    best, second_worst, worst = values[0], values[-2], values[-1]
    reflected, value = trial(SIMPLEX.reflection)
    if best <= value < second_worst:
        vertices[-1], values[-1] = reflected, value
        return "reflect"
    if value < best:
        expanded, further = trial(SIMPLEX.reflection * SIMPLEX.expansion)
        if further < value:
            vertices[-1], values[-1] = expanded, further
            return "expand"
        vertices[-1], values[-1] = reflected, value
        return "reflect"
    outside = value < worst
    inside = -SIMPLEX.contraction
    contracted, closer = trial(SIMPLEX.reflection * SIMPLEX.contraction if outside else inside)
    if closer <= value if outside else closer < worst:
        vertices[-1], values[-1] = contracted, closer
        return "contract outside" if outside else "contract inside"
    vertices[1:] = (1 - SIMPLEX.shrinkage) * vertices[0] + SIMPLEX.shrinkage * vertices[1:]
    values[1:] = [evaluate(vertex) for vertex in vertices[1:]]
    return "shrink"


@np.errstate(over="ignore", invalid="ignore")
def _centre(vertices: Vector) -> Vector:
    """The mean (n,) of all vertices but the last; rounded as Scilab's, all minus the last."""
    mean: Vector = (vertices.sum(axis=0) - vertices[-1]) / (len(vertices) - 1)
    return mean


@np.errstate(over="ignore", invalid="ignore")
def _on_line(centre: Vector, worst: Vector, factor: float) -> Vector:
    point: Vector = (1 + factor) * centre - factor * worst
    return point


@np.errstate(over="ignore", invalid="ignore")
def _size(vertices: Vector) -> float:
    """Length of the longest edge at the best vertex (σ₊ of C. T. Kelley, 1999, section 6.2)."""
    return float(np.linalg.norm(vertices[1:] - vertices[0], axis=1).max())


def _end(
    vertices: Vector, values: list[float], iteration: int, count: int, options: Options
) -> tuple[int, str] | None:
    """The exit flag and the reason, where a search ends; Scilab looks at the limits first."""
    size = vertices.shape[1]
    for reached, limit, name, things in (
        (iteration, options.iterations(size), "MaxIter", "iterations"),
        (count, options.evaluations(size), "MaxFunEvals", "function evaluations"),
    ):
        if reached >= limit:
            return LIMIT, (
                f"Maximum number of {things} has been exceeded: {reached}\n"
                f" - increase {name}, which is {limit:g}.\n"
                f" Current function value: {values[0]:.8g}"
            )
    if _size(vertices) < options.TolX and values[-1] - values[0] < options.TolFun:
        return CONVERGED, (
            "Optimization terminated:\n"
            f" the size of the simplex is below TolX = {options.TolX:g}\n"
            f" and the spread of the function values is below TolFun = {options.TolFun:g}."
        )
    return None


class _Monitor:
    """What a search tells meanwhile, to the screen and to the user's functions."""

    def __init__(self, options: Options, evaluate: _Evaluate) -> None:
        self.options, self.display, self.evaluate = options, options.Display, evaluate

    def stops(self, state: str, x: Vector, fval: float, iteration: int, procedure: str) -> bool:
        """Tell a state; true where an output function wants to stop."""
        count = self.evaluate.count
        if self.display == "iter":
            if state == "init":
                print(" Iteration   Func-count     min f(x)         Procedure")  # noqa: T201
            line = f"{iteration:6d}        {count:5d}     {fval:12.8g}         {procedure}"
            print("" if state == "done" else line.rstrip())  # noqa: T201
        return self.options.stops(x, OptimValues(count, iteration, fval, procedure), state)

    def result(self, x: Vector, fval: float, iteration: int, flag: int, message: str) -> Minimum:
        """The result, told where Display asks for it."""
        told = {LIMIT: ("notify", "final", "iter"), CONVERGED: ("final", "iter"), STOPPED: ()}
        if self.display in told[flag]:
            print(f"fminsearch: {message}")  # noqa: T201
        name = "Nelder-Mead simplex direct search"
        return Minimum(x.copy(), fval, flag, Output(name, self.evaluate.count, iteration, message))
