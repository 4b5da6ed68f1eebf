"""Waves in time that keep the rhythm of a free motion: they stand for a law of the motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.residual import Section
from tracewire.trace.search.search import Search
from tracewire.trace.trials.trial import Trial

Vector = NDArray[np.float64]


def describe_own_rhythm(search: Search, trial: Trial) -> str:
    """In words, that all effects of a model are waves in time whose period is that of the measured
    motion, or a whole part of it; '' where that is not so, or where something drives the bodies.

    A bent scale of a sensor, or a force that is not in proportion, makes such waves of a free
    motion. What shakes the rig from outside has a period of its own.
    """
    options = search.options
    if not trial.effects or _is_driven(search.problem.declared):
        return ""
    motion = _period(search.data_split.train)
    errors = trial.standard_errors
    for effect in trial.effects:
        candidate = effect.candidate
        if not candidate.lines or not candidate.each:
            return ""
        unknown = f"{candidate.block}.{candidate.lines[0]}"
        period = trial.values[unknown]
        order = motion / period
        part = options.sure * errors[unknown] / period
        whole = round(order)
        if not 1 <= whole <= options.rhythms or abs(order / whole - 1) > part:
            return ""
    return "stands for a law of another form: its wave keeps the rhythm of the motion itself"


def _is_driven(model: Model) -> bool:
    """Whether the rates of a model depend on the time, or on an input."""
    return "t" in model.lowered.tape.leaves(model.lowered.rates)


def _period(sections: Sequence[Section]) -> float:
    """The period in s of the measured motion: the median over sections and signals of the time
    between passages of the mean in one direction; infinite where there are fewer than three."""
    found = []
    for section in sections:
        t = section.measured.t[section.first : section.end]
        for values in section.measured.values.values():
            y = values[section.first : section.end]
            found += np.diff(_rises(t, y - np.mean(y))).tolist()
    return float(np.median(found)) if len(found) > 1 else np.inf


def _rises(t: Vector, y: Vector) -> Vector:
    """The times at which y rises through zero."""
    rows = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0))
    return np.asarray(t[rows] + (t[rows + 1] - t[rows]) * y[rows] / (y[rows] - y[rows + 1]))
