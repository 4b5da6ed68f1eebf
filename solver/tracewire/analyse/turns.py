"""States that turn: angles that are the same after a turn."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, unknown


def units_of(model: Model, modulo: Mapping[str, float]) -> Vector:
    """The unit (n,) that each state turns by, infinite where it does not. Raises OptionError."""
    problems = [unknown("state", name, model.states) for name in modulo if name not in model.states]
    problems += [
        Problem(f"'{name}' modulo {value:g} has no use", hint="Give a number above 0.")
        for name, value in modulo.items()
        if not value > 0
    ]
    if problems:
        raise OptionError(problems)
    return np.array([modulo.get(name, np.inf) for name in model.states])


def within_a_turn(x: Vector, unit: Vector) -> Vector:
    """The states (..., n), those that turn within half a unit from zero."""
    found = x.copy()
    turns = np.isfinite(unit)
    found[..., turns] -= unit[turns] * np.round(found[..., turns] / unit[turns])
    return found
