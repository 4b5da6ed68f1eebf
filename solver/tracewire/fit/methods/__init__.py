"""The methods of a fit by their names: each takes a Search and gives where it ended."""

from __future__ import annotations

from collections.abc import Callable

from tracewire.fit.methods.growing_windows import by_growing_windows
from tracewire.fit.methods.least_squares import by_least_squares
from tracewire.fit.methods.multiple_shooting import by_multiple_shooting
from tracewire.fit.methods.multistart import by_multistart
from tracewire.fit.methods.shooting import by_shooting
from tracewire.fit.methods.simplex import by_simplex
from tracewire.fit.search import MethodResult, Search

METHODS: dict[str, Callable[[Search], MethodResult]] = {
    "fminsearch": by_simplex,
    "least_squares": by_least_squares,
    "growing_windows": by_growing_windows,
    "multiple_shooting": by_multiple_shooting,
    "shooting": by_shooting,
    "multistart": by_multistart,
}
