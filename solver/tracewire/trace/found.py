"""The result of a trace: verdict, effects, error before and after, and the edited diagram."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tracewire.diagram import Diagram, difference

Vector = NDArray[np.float64]
Verdict = Literal["null", "effect", "unexplained"]


@dataclass(frozen=True)
class FoundEffect:
    """An effect that the data ask for: its name, its place (a sum, or `sensor.SIGNAL`), its
    parameters in SI, and the effects that cannot be told from it on these data."""

    name: str
    place: str
    params: Mapping[str, float]
    ties: tuple[str, ...] = ()


@dataclass(frozen=True)
class Ranked:
    """A row of the ranking: what was added, its BIC relative to the declared model, its RMSE on the
    train windows in sigma, and what became of it."""

    effects: str
    bic: float
    s2: float
    remark: str = ""


@dataclass(frozen=True, eq=False)
class HeldOut:
    """One measured signal on a stretch that played no part in fitting or choosing, in SI."""

    series: str
    signal: str
    unit: str
    t: Vector
    measured: Vector
    before: Vector
    after: Vector


@dataclass(frozen=True, eq=False)
class Found:
    """What a trace found.

    `verdict`: `null` (nothing is missing beyond the noise), `effect` (named in `effects`), or
    `unexplained` (something is missing, and no effect of the library explains it). `rmse_before`
    and `rmse_after` are root mean square errors in SI of free runs on the stretch that played no
    part, over all measured signals; `sigma` is the noise of each. `fitted_before` and
    `fitted_after` are the same on the stretches that were fitted, and `s2_...` their squared
    residual per degree of freedom in units of the noise. `dropped` are declared parameters
    that went to zero, `values` the refitted parameters. `diagram` is the edited diagram.
    """

    verdict: Verdict
    effects: tuple[FoundEffect, ...]
    dropped: tuple[str, ...]
    values: Mapping[str, float]
    declared: Mapping[str, float]
    rmse_before: float
    rmse_after: float
    sigma: Mapping[str, float]
    s2_before: float
    s2_after: float
    fitted_before: float
    fitted_after: float
    ranking: tuple[Ranked, ...]
    held_out: tuple[HeldOut, ...]
    words: tuple[str, ...]
    original: Diagram
    diagram: Diagram

    @property
    def patch(self) -> str:
        """The lines of the diagram that the trace would change, as a unified diff."""
        return difference(self.original, self.diagram)

    def apply(self, diagram: Diagram | None = None) -> Diagram:
        """The diagram with the effects added and its parameters refitted; comments are kept."""
        if diagram is not None and diagram.text != self.original.text:
            raise ValueError("the diagram has changed since it was traced: trace it again")
        return self.diagram

    def as_json(self) -> dict[str, Any]:
        """The result as plain data."""
        return {
            "verdict": self.verdict,
            "effects": [
                {
                    "name": effect.name,
                    "place": effect.place,
                    "params": dict(effect.params),
                    "ties": list(effect.ties),
                }
                for effect in self.effects
            ],
            "dropped": list(self.dropped),
            "rmse_before": self.rmse_before,
            "rmse_after": self.rmse_after,
            "sigma": dict(self.sigma),
            "s2_before": self.s2_before,
            "s2_after": self.s2_after,
            "fitted_before": self.fitted_before,
            "fitted_after": self.fitted_after,
            "parameters": dict(self.values),
            "declared": dict(self.declared),
            "ranking": [vars(row) for row in self.ranking],
            "words": list(self.words),
        }
