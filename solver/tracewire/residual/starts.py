"""Where the run of a series begins: from declared start values, or from the measured data."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, unknown
from tracewire.formula import Name, evaluate
from tracewire.residual.local_quartics import LocalQuartics, rows_around
from tracewire.residual.measured import Measured
from tracewire.residual.segment import Segment
from tracewire.solve import parameter_values

Rows = NDArray[np.intp]


def start_from_data(model: Model, measured: Measured, row: int) -> dict[str, float]:
    """The states at a row of a series that the data tell."""
    states = states_from_data(model, measured, np.array([row]))
    return {name: float(values[0]) for name, values in states.items()}


def states_from_data(model: Model, measured: Measured, rows: Rows) -> dict[str, Vector]:
    """The states (N,) at rows (N,) of a series that the data tell: by local quartics through 17
    samples, or fewer where the signal bends too much for one quartic.

    A state that is measured is read off the quartic, and a state that is the rate of a measured one
    off its derivative; other states are not in the result.
    """
    found: dict[str, Vector] = {}
    states = {state.name: state for state in model.flat.states}
    for name, values in measured.values.items():
        if name not in states:
            continue
        near = rows_around(rows, measured.quartic_points[name], len(measured.t))
        sensor = measured.sensor(name)
        t = measured.t[near] - measured.t[rows, None] - sensor.delay
        signal = sensor.signal(values[near], measured.t[near] - measured.zero)
        quartics = LocalQuartics(t, signal)
        found[name] = quartics.values
        rate = states[name].rate
        if isinstance(rate, Name) and rate.name in states and rate.name not in measured.values:
            found[rate.name] = quartics.slopes
    return found


def whole_segment(model: Model, measured: Measured) -> Segment:
    """The whole series as one segment: from the series' own start, or the diagram's.

    A free start begins at what the data tell, else where the diagram does. Raises OptionError: a
    start value of a state that does not exist.
    """
    problems = [unknown("state", n, model.states) for n in measured.start if n not in model.states]
    if problems:
        raise OptionError(problems)
    rows = np.flatnonzero(measured.t >= measured.counts_from)
    values = parameter_values(model, measured.parameters, measured.preset)
    if not measured.start:
        begin = float(evaluate(model.flat.span[0], values))
        return Segment(measured, min(begin, float(measured.t[0])), rows)
    start = measured.known_start
    free = tuple(name for name, value in measured.start.items() if value is None)
    states = start_from_data(model, measured, 0)
    for state in model.flat.states:
        if state.name in free and state.name in states:
            start[state.name] = states[state.name]
        elif state.name in free:
            start[state.name] = evaluate(state.start, values, state.place)
    return Segment(measured, float(measured.t[0]), rows, start, free)
