"""An effect in a diagram: what was added, and with which values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from tracewire.trace.candidates.candidate import Candidate, without_defaults


@dataclass(frozen=True)
class PlacedEffect:
    """An effect in a diagram: the candidate, and the values of its parameters by their names in
    its block; a shape that is not among them keeps its default."""

    candidate: Candidate
    values: Mapping[str, float]

    def __str__(self) -> str:
        return str(self.candidate)

    def unknown(self, parameter: str) -> str:
        """The name of a parameter among the unknowns of a fit."""
        candidate = self.candidate
        own = parameter == candidate.parameter
        return candidate.coefficient if own else f"{candidate.block}.{parameter}"

    @property
    def own_series(self) -> set[str]:
        """The series in which a shape has a value of its own."""
        return {key.partition("@")[2] for key in self.values if "@" in key}

    def series_values(self, series: str) -> dict[str, float]:
        """The values of its own that a series has, by path."""
        ends = f"@{series}"
        own = dict(self.candidate.own.get(series, {}))
        own |= {key.removesuffix(ends): v for key, v in self.values.items() if key.endswith(ends)}
        return {f"{self.candidate.block}.{name}": value for name, value in own.items()}

    def with_value(self, name: str, value: float) -> PlacedEffect:
        """The effect with one more value."""
        return replace(self, values={**self.values, name: value})

    @property
    def coefficient(self) -> float:
        """The value of the coefficient."""
        return self.values[self.candidate.parameter]

    def with_values(self, named: Mapping[str, float]) -> PlacedEffect:
        """The effect with the values that the unknowns of a fit have."""
        values = {n: named.get(self.unknown(n), value) for n, value in self.values.items()}
        return replace(self, values=without_defaults(self.candidate, values))
