"""The grid of a sweep: values of parameters and start values."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from tracewire.analyse.limits import SWEEP
from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, unknown
from tracewire.solve import START


def grid_of(model: Model, grid: Mapping[str, ArrayLike]) -> dict[str, Vector]:
    """The axes of a grid as arrays. Raises OptionError."""
    known = [*model.flat.parameters, *(START + name for name in model.states)]
    problems = [unknown("parameter or start", name, known) for name in grid if name not in known]
    axes = {name: np.array(values, dtype=float).ravel() for name, values in grid.items()}
    for name, values in axes.items():
        if not len(values) or not np.isfinite(values).all():
            what = f"the axis '{name}' has no values, or some that are not finite"
            problems.append(Problem(what, hint="Give an array such as numpy.linspace(0, 1, 11)."))
    if not axes:
        problems.append(Problem("there is no parameter to sweep", hint="Give one at least."))
    if math.prod(len(values) for values in axes.values()) > SWEEP.most_points:
        count = math.prod(len(values) for values in axes.values())
        what = f"a grid of {count} points is too large"
        problems.append(Problem(what, hint=f"Give {SWEEP.most_points} at most."))
    if problems:
        raise OptionError(problems)
    return axes
