"""`floquet`: how small deviations from a periodic motion grow over one period."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from tracewire.analyse import verdict
from tracewire.analyse.drive import number, period_of
from tracewire.analyse.limits import ORBIT
from tracewire.arguments import checked
from tracewire.array_types import Complexes, Matrix
from tracewire.compile import Model
from tracewire.errors import AnalysisError, Problem
from tracewire.result import Result
from tracewire.solve import Passage, parameter_values


@dataclass(frozen=True, eq=False, repr=False)
class Floquet(Result):
    """What one period makes of small deviations: x(T) - x(T)* = M (x(0) - x(0)*).

    `monodromy` M (n, n); `period` T in s; `closure` is how far the motion is from closing, as a
    part of its size, NaN for linear rates, where M is the same for each motion. `autonomous`: one
    multiplier is 1, that of a deviation along the orbit, which the verdict leaves out.
    """

    states: tuple[str, ...]
    period: float
    monodromy: Matrix
    closure: float
    autonomous: bool = False
    warnings: tuple[str, ...] = ()

    @cached_property
    def multipliers(self) -> Complexes:
        """The multipliers (n,), the eigenvalues of M, the largest first."""
        found = np.linalg.eigvals(self.monodromy).astype(np.complex128)
        return found[np.lexsort((-found.imag, -np.abs(found)))]

    @property
    def exponents(self) -> Complexes:
        """The characteristic exponents ln(multiplier)/T (n,) in 1/s, imaginary part in (-pi, pi]/T.

        Minus infinity for a multiplier that is zero, as where a body sticks in each period.
        """
        with np.errstate(divide="ignore"):
            growth = np.log(np.abs(self.multipliers)) / self.period
        return np.asarray(growth + 1j * (np.angle(self.multipliers) / self.period))

    @property
    def radius(self) -> float:
        """The largest |multiplier| that the verdict counts."""
        return float(np.abs(self._counted).max(initial=0.0))

    @property
    def margin(self) -> float:
        """How far beyond the edge of stability it is, below zero where it is stable.

        Of two multipliers on the unit circle max(|trace M| - 1 - det M, det M - 1), which goes
        through zero evenly where the radius leaves 1 like a root; else radius - 1.
        """
        if len(self.monodromy) != 2 or self.autonomous:
            return self.radius - 1.0
        trace, volume = np.trace(self.monodromy), np.linalg.det(self.monodromy)
        apart = float(abs(trace) - 1.0 - volume)
        return apart if abs(volume - 1.0) < 1e-5 else max(apart, float(volume) - 1.0)

    @property
    def verdict(self) -> verdict.Verdict:
        """Stable, unstable, or neutral where the largest multiplier is on the unit circle."""
        return verdict.of_multipliers(self._counted)

    @property
    def _counted(self) -> Complexes:
        found = self.multipliers
        if not self.autonomous or not len(found):
            return found
        return np.delete(found, int(np.argmin(np.abs(found - 1.0))))


@checked
def floquet(
    model: Model,
    period: float | str,
    *,
    begin: float | str = 0.0,
    start: Mapping[str, float] | None = None,
    parameters: Mapping[str, float] | None = None,
    preset: str = "",
    method: str = "auto",
    rtol: float = 1e-10,
) -> Floquet:
    """The Floquet multipliers of the periodic motion through the start states.

    `period` in s, or a formula of the parameters such as "2*pi/omega"; `begin` in s, or such a
    formula, is when the motion is at the start states. Rates that are linear in the states have the
    same multipliers from each start. The monodromy is that of the variational equations, with the
    jumps that events make.

    Raises AnalysisError where nonlinear rates do not bring the motion back to its start.
    """
    tries = Tries(model, period, begin, start, parameters, preset, method, rtol)
    return tries.floquet({})


class Tries:
    """The Floquet multipliers for several values of parameters: a passage is used again."""

    def __init__(
        self,
        model: Model,
        period: float | str,
        begin: float | str,
        start: Mapping[str, float] | None,
        parameters: Mapping[str, float] | None,
        preset: str,
        method: str,
        rtol: float,
    ) -> None:
        self.model, self.period, self.begin = model, period, begin
        self.linear = model.is_linear
        self.points = 0 if self.linear else ORBIT.size_points
        self.given = dict(parameters or {})
        self.make = partial(
            Passage,
            model,
            start=start,
            preset=preset,
            method=method,
            rtol=rtol,
            tangents=True,
            inner=self.points,
        )
        self.preset = preset
        self.free: list[Passage] = []

    def floquet(self, parameters: Mapping[str, float]) -> Floquet:
        """The multipliers with these values over those that are common. Raises as `floquet`."""
        given = {**self.given, **parameters}
        values = parameter_values(self.model, given, self.preset)
        length = period_of(self.model, self.period, values)
        since = number(self.model, self.begin, values, "begin")
        try:
            passage = self.free.pop()  # at once: another thread may want it too
            passage.begin_with(given, begin=since, length=length)
        except IndexError:
            passage = self.make(length=length, begin=since, parameters=given)
        found = self._of(passage, since, length)
        self.free.append(passage)
        return found

    def _of(self, passage: Passage, since: float, length: float) -> Floquet:
        first = passage.x
        inner = since + length * np.arange(1, self.points + 1) / max(self.points, 1)
        passage.go_to(since + length, inner)
        closure = np.nan
        if not self.linear:
            size = np.abs(passage.inside).max(axis=0, initial=0.0) + 1e-9
            closure = float((np.abs(passage.x - first) / size).max(initial=0.0))
            if closure > ORBIT.closed:
                what = (
                    f"after {length:g} s the motion is not back at its start: {closure:.2g} of "
                    "its size is missing"
                )
                hint = "Find the periodic orbit first (periodic_orbit, `analyse orbit`)."
                raise AnalysisError([Problem(what, hint=hint)])
        names = self.model.states
        return Floquet(names, length, passage.tangents, closure, warnings=passage.warnings)
