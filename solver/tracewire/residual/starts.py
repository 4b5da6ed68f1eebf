"""Where the run of a series begins: from declared start values, or from the measured data."""

from __future__ import annotations

import numpy as np

from tracewire.compile import Model
from tracewire.errors import OptionError, unknown
from tracewire.formula import Name, evaluate
from tracewire.residual.measured import Measured
from tracewire.residual.segment import Segment
from tracewire.solve import parameter_values

POINTS = 17
DEGREE = 4


def start_from_data(model: Model, measured: Measured, row: int) -> dict[str, float]:
    """The states at a row of a series that the data tell: by a local quartic through 17 samples.

    A state that is measured is read off the quartic, and a state that is the rate of a measured one
    off its derivative; other states are not in the result.
    """
    found: dict[str, float] = {}
    first = int(np.clip(row - POINTS // 2, 0, max(len(measured.t) - POINTS, 0)))
    rows = slice(first, first + POINTS)
    t = measured.t[rows] - measured.t[row]
    width = float(np.max(np.abs(t))) or 1.0
    degree = min(DEGREE, len(t) - 1)
    states = {state.name: state for state in model.flat.states}
    for name, values in measured.values.items():
        if name not in states:
            continue
        sensor = measured.sensor(name)
        signal = sensor.signal(values[rows], measured.t[rows] - measured.zero)
        quartic = np.polynomial.Polynomial.fit((t - sensor.delay) / width, signal, degree)
        found[name] = float(quartic(0.0))
        rate = states[name].rate
        if isinstance(rate, Name) and rate.name in states and rate.name not in measured.values:
            found[rate.name] = float(quartic.deriv()(0.0)) / width
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
    told = start_from_data(model, measured, 0)
    for state in model.flat.states:
        if state.name in free and state.name in told:
            start[state.name] = told[state.name]
        elif state.name in free:
            start[state.name] = evaluate(state.start, values, state.place)
    return Segment(measured, float(measured.t[0]), rows, start, free)
