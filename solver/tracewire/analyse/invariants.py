"""`invariant_drift`: how well recorded signals stay what they were, as an energy should."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracewire.analyse.signal import SI, users_unit_of
from tracewire.arguments import checked
from tracewire.array_types import Vector
from tracewire.errors import OptionError, Problem, unknown
from tracewire.result import Result
from tracewire.solve import Run


@dataclass(frozen=True, eq=False, repr=False)
class Drift(Result):
    """The drift of one invariant I: `largest` max|I - I(0)| and `final` I(T) - I(0), in its unit.

    `relative` is the largest over `scale`. `t` (N,) in s and `values` (N,) are I - I(0).
    """

    name: str
    unit: str
    start: float
    largest: float
    final: float
    scale: float
    at: float
    t: Vector
    values: Vector
    users_unit: tuple[str, float] = SI

    @property
    def as_shown(self) -> Drift:
        """The same in the unit in which tables and figures show the signal."""
        unit, factor = self.users_unit
        return replace(
            self,
            unit=unit or self.unit,
            start=self.start / factor,
            largest=self.largest / factor,
            final=self.final / factor,
            scale=self.scale / factor,
            values=self.values / factor,
            users_unit=SI,
        )

    @property
    def relative(self) -> float:
        """The largest drift as a part of the scale."""
        return (
            self.largest / self.scale if self.scale > 0 else (0.0 if self.largest == 0 else np.inf)
        )


@checked
def invariant_drift(
    run: Run, names: Sequence[str], *, scale: Mapping[str, float] | float | None = None
) -> tuple[Drift, ...]:
    """The drift of recorded signals that should not change over a run: energies, momenta.

    `scale` is what a drift is compared with, a number or by name, in SI: |I(0)| unless given, or
    where that is zero the largest |I|. Give the size of the terms that add up to I where they
    cancel, as those of an energy may. Raises OptionError: a name that is not recorded.
    """
    if not names:
        raise OptionError([Problem("no invariant is named", hint="Name recorded signals.")])
    given = scale if isinstance(scale, Mapping) else dict.fromkeys(names, scale)
    wrong = [unknown("invariant", name, names) for name in given if name not in names]
    wrong += [
        Problem(f"the scale {value:g} of '{name}' has no use", hint="Give a number above 0.")
        for name, value in given.items()
        if value is not None and not 0 < value < np.inf
    ]
    if wrong:
        raise OptionError(wrong)
    return tuple(_drift(run, name, given.get(name)) for name in names)


def _drift(run: Run, name: str, scale: float | None) -> Drift:
    values = run[name]
    start = float(values[0])
    off = values - start
    worst = int(np.argmax(np.abs(off)))
    size = scale or abs(start) or float(np.abs(values).max())
    return Drift(
        name=name,
        unit=run.units.get(name, ""),
        start=start,
        largest=float(abs(off[worst])),
        final=float(off[-1]),
        scale=size,
        at=float(run.t[worst]),
        t=run.t,
        values=off,
        users_unit=users_unit_of(run, name),
    )
