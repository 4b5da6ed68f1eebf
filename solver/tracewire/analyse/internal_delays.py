"""What a linear model has of delays: equations between what goes in and what comes out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.errors import AnalysisError, Problem


@dataclass(frozen=True, eq=False)
class InternalDelays:
    """Delays w(t) = z(t - T) of a linear model dx' = A dx + B du + B2 w, dy = C dx + D du + D12 w.

    What goes in is z = C2 dx + D21 du + D22 w. `times` (m,) are T in s, `signals` names z; B2 (n,
    m), C2 (m, n), D12 (q, m), D21 (m, p), D22 (m, m) are in SI.
    """

    signals: tuple[str, ...]
    times: Vector
    B2: Matrix
    C2: Matrix
    D12: Matrix
    D21: Matrix
    D22: Matrix

    def terms(self) -> dict[float, Matrix]:
        """The matrices A_k (n, n) of x' = A x + sum_k A_k x(t - T_k), by T_k in s.

        Delays in a row add up. Raises AnalysisError where a way leads from a delay back to it
        without a state: then rates of the past count, too.
        """
        rows: list[dict[float, Vector] | None] = [None] * len(self.times)

        def row(j: int, around: tuple[int, ...]) -> dict[float, Vector]:
            if j in around:
                what = f"'{self.signals[j]}' is delayed and comes back to its delay without a state"
                hint = "Put an integrator or a first_order block in between."
                raise AnalysisError([Problem(f"{what}: there are no eigenvalues", hint=hint)])
            known = rows[j]
            if known is None:
                time = float(self.times[j])
                known = {time: self.C2[j].copy()}
                for i in np.flatnonzero(self.D22[j]):
                    for earlier, part in row(int(i), (*around, j)).items():
                        both = time + earlier
                        known[both] = known.get(both, 0.0) + self.D22[j, i] * part
                rows[j] = known
            return known

        found: dict[float, Matrix] = {}
        for j in range(len(self.times)):
            for time, part in row(j, ()).items():
                matrix = np.outer(self.B2[:, j], part)
                found[time] = found[time] + matrix if time in found else matrix
        return {time: matrix for time, matrix in found.items() if np.any(matrix)}
