"""`steady_state`: where the rates of a model are zero, and whether it stays there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from tracewire.analyse import verdict
from tracewire.analyse.drive import is_driven
from tracewire.analyse.equilibrium import find_equilibrium
from tracewire.analyse.linearisation import linearise, nonsmooth
from tracewire.arguments import checked
from tracewire.array_types import Complexes, Matrix, Vector
from tracewire.compile import Model, at_rest
from tracewire.errors import AnalysisError, Problem
from tracewire.result import Result
from tracewire.solve import Passage


@dataclass(frozen=True, eq=False, repr=False)
class SteadyState(Result):
    """States `x` (n,) in SI at which all rates are zero.

    `residual` is the largest rate that is left there; `eigenvalues` (n,) in 1/s those of the
    Jacobian, the largest real part first; `verdict` stable, unstable or neutral. With delays the
    eigenvalues are the rightmost characteristic roots, and the Jacobian counts delayed states at
    once. At a nonsmooth point, such as a body that sticks, there are no eigenvalues, the verdict is
    "nonsmooth", and `guards` says why.
    """

    states: tuple[str, ...]
    x: Vector
    residual: float
    jacobian: Matrix
    eigenvalues: Complexes
    verdict: str
    guards: tuple[str, ...]
    units: Mapping[str, str] = field(default_factory=dict)

    def __getitem__(self, name: str) -> float:
        return float(self.x[self.states.index(name)])

    @property
    def values(self) -> dict[str, float]:
        """The states by name, as `at` of linearise and `start` of simulate take them."""
        return dict(zip(self.states, self.x.tolist(), strict=True))


@checked
def steady_state(
    model: Model,
    *,
    guess: Mapping[str, float] | None = None,
    t: float = 0.0,
    parameters: Mapping[str, float] | None = None,
    preset: str = "",
) -> SteadyState:
    """Find the equilibrium next to the start values, or next to `guess` by state.

    The search stays on the near side of contacts; a body may lie on one. See `equilibrium`.

    Raises AnalysisError: a model whose rates change with time by themselves has none, the start
    lies beyond a contact, or the search has not found one, with the rates that are left.
    """
    rest = at_rest(model).settled if model.reads_past else model
    passage = Passage(
        rest, length=1.0, begin=t, parameters=parameters, start=guess, preset=preset, rtol=1e-9
    )
    if is_driven(passage, _span(model, passage)):
        what = "the rates change with time by themselves: this model has no steady state"
        hint = "Set its drive to zero (parameters=, --set), or find its periodic orbit."
        raise AnalysisError([Problem(what, hint=hint)])
    find_equilibrium(passage)
    x, left = passage.x, float(np.abs(passage.rates()).max(initial=0.0))
    guards = tuple(nonsmooth(passage))
    jacobian = passage.jacobian()
    none = np.empty(0, dtype=np.complex128)
    eigenvalues = none
    if not guards:
        at = dict(zip(model.states, x.tolist(), strict=True))
        eigenvalues = linearise(
            model, at=at, t=t, outputs=(), parameters=parameters, preset=preset
        ).eigenvalues
    said = "nonsmooth" if guards else verdict.of_eigenvalues(eigenvalues)
    units = {state.name: state.unit for state in model.flat.states}
    return SteadyState(model.states, x, left, jacobian, eigenvalues, said, guards, units)


def _span(model: Model, passage: Passage) -> float:
    from tracewire.formula import evaluate

    begin, end = (evaluate(formula, passage.parameters) for formula in model.flat.span)
    return float(end - begin) or 1.0
