"""`steady_state`: where the rates of a model are zero, and whether it stays there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from tracewire.analyse import verdict
from tracewire.analyse.drive import is_driven
from tracewire.analyse.linearise import nonsmooth
from tracewire.compile import Model
from tracewire.errors import AnalysisError, Problem, SimulationError
from tracewire.solve import Passage

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
Complexes = NDArray[np.complex128]
CLOSED = 1e-9  # of the size of what adds up to a rate


@dataclass(frozen=True, eq=False)
class SteadyState:
    """States `x` (n,) in SI at which all rates are zero.

    `residual` is the largest rate that is left there; `eigenvalues` (n,) in 1/s those of the
    Jacobian, the largest real part first; `verdict` stable, unstable or neutral. At a nonsmooth
    point, such as a body that sticks, there are no eigenvalues, the verdict is "nonsmooth", and
    `guards` says why.
    """

    states: tuple[str, ...]
    x: Vector
    residual: float
    jacobian: Matrix
    eigenvalues: Complexes
    verdict: str
    guards: tuple[str, ...]

    def __getitem__(self, name: str) -> float:
        return float(self.x[self.states.index(name)])

    @property
    def values(self) -> dict[str, float]:
        """The states by name, as `at` of linearise and `start` of simulate take them."""
        return dict(zip(self.states, self.x.tolist(), strict=True))


def steady_state(
    model: Model,
    *,
    guess: Mapping[str, float] | None = None,
    t: float = 0.0,
    parameters: Mapping[str, float] | None = None,
    preset: str = "",
) -> SteadyState:
    """Find an equilibrium near the start values, or near `guess` by state, with the exact Jacobian.

    Raises AnalysisError: a model whose rates change with time by themselves has none, or the search
    has not found one, with the rate that is left.
    """
    passage = Passage(
        model, length=1.0, begin=t, parameters=parameters, start=guess, preset=preset, rtol=1e-9
    )
    if is_driven(passage, _span(model, passage)):
        what = "the rates change with time by themselves: this model has no steady state"
        hint = "Set its drive to zero (parameters=, --set), or find its periodic orbit."
        raise AnalysisError([Problem(what, hint=hint)])
    first = passage.x

    def rates(x: Vector) -> Vector:
        try:
            passage.begin_at(t, x)
            found = passage.rates()
        except SimulationError:  # beyond where the model is defined
            return np.full(len(x), 1e30)
        return np.where(np.isfinite(found), found, 1e30)

    def slopes(x: Vector) -> Matrix:
        return np.nan_to_num(passage.jacobian(x, t))

    x, left = first, float(np.abs(rates(first)).max(initial=0.0))

    def size(x: Vector) -> float:
        return 1.0 + float((np.abs(slopes(x)) @ np.abs(x)).max(initial=0.0))

    for method in ("hybr", "lm"):
        if left <= CLOSED * size(x) or not len(first):
            break
        found = root(rates, first, jac=slopes, method=method, options={"xtol": 1e-13})
        now = float(np.abs(rates(found.x)).max())
        if now < left:
            x, left = np.asarray(found.x, dtype=float), now
    final = rates(x)
    if left > CLOSED * size(x):
        worst = int(np.argmax(np.abs(final)))
        name = model.states[worst]
        what = f"no steady state was found: the rate of '{name}' is still {final[worst]:.3g}"
        hint = "Give a guess nearer to it (guess=, --start); there may be none."
        raise AnalysisError([Problem(what, hint=hint)])
    guards = tuple(nonsmooth(passage))
    jacobian = passage.jacobian()
    none = np.empty(0, dtype=np.complex128)
    eigenvalues = none if guards else np.linalg.eigvals(jacobian).astype(np.complex128)
    eigenvalues = eigenvalues[np.lexsort((-eigenvalues.imag, -eigenvalues.real))]
    said = "nonsmooth" if guards else verdict.of_eigenvalues(eigenvalues)
    return SteadyState(model.states, x, left, jacobian, eigenvalues, said, guards)


def _span(model: Model, passage: Passage) -> float:
    from tracewire.formula import evaluate

    begin, end = (evaluate(formula, passage.parameters) for formula in model.flat.span)
    return float(end - begin) or 1.0
