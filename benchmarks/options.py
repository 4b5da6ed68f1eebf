"""How thorough a run is."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Options:
    """`rtol` of tracewire, to whose error every peer is matched; `quick` leaves slow peers out."""

    rtol: float = 1e-6
    quick: bool = False

    @property
    def search_seconds(self) -> float:
        """For finding a peer's tolerance."""
        return 2.0 if self.quick else 15.0

    @property
    def seconds_each(self) -> float:
        """For the timed runs of each peer."""
        return 0.3 if self.quick else 2.0
