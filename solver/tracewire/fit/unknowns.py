"""What a fit may change: parameters with bounds, and offsets of sensors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, unknown
from tracewire.fit.criterion import Unknown
from tracewire.fit.measured import Measured


def free_unknowns(
    model: Model, free: Sequence[str] | None, values: Mapping[str, float]
) -> list[Unknown]:
    """The parameters that a fit may change, begun at `values`: those with `fit:` bounds, or those
    that `free` names.

    Raises OptionError: none is free, a name does not exist, a start outside the bounds.
    """
    flat = model.flat
    names = [n for n, p in flat.parameters.items() if p.fit is not None] if free is None else free
    problems = [unknown("parameter", n, flat.parameters) for n in names if n not in flat.parameters]
    if not names:
        hint = "Give a parameter bounds, as in k: {value: 1, fit: [0, 10]}, or name it as free."
        problems.append(Problem("no parameter of the diagram is free", hint=hint))
    if problems:
        raise OptionError(problems)
    unknowns = []
    for name in dict.fromkeys(names):
        parameter, value = flat.parameters[name], values[name]
        low, high = parameter.fit or (-np.inf, np.inf)
        if not low <= value <= high:
            what = f"'{name}' begins at {value:g}, outside its bounds {low:g} to {high:g} (SI)"
            hint = "Begin inside them, or widen `fit:`."
            problems.append(Problem(what, parameter.place, hint=hint))
        width = high - low if np.isfinite(high - low) else 1.0
        unknowns.append(Unknown(name, value, low, high, abs(value) or 0.1 * width))
    if problems:
        raise OptionError(problems)
    return unknowns


def offset_unknowns(measured: Sequence[Measured]) -> list[Unknown]:
    """The free offsets of sensors, one for each signal, begun at the first series' offset."""
    found: dict[str, Unknown] = {}
    for series in measured:
        for signal, (low, high) in series.free_offsets.items():
            scale = max(float(np.std(series.values[signal])) * 0.1, 1e-12)
            name = f"offset.{signal}"
            value = series.offset.get(signal, 0.0)
            found.setdefault(name, Unknown(name, value, low, high, scale))
    return list(found.values())
