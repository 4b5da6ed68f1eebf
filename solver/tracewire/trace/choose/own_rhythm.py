"""Waves in time that keep the rhythm of a free motion: they stand for a law of the motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.residual import Section
from tracewire.trace.search.search import Search
from tracewire.trace.trials.trial import Trial


def describe_own_rhythm(search: Search, trial: Trial) -> str:
    """In words, that all effects of a model are waves in time whose period is that of the measured
    motion, or a whole part of it; '' where that is not so, or where something drives the bodies.

    A bent scale of a sensor, or a force that is not in proportion, makes such waves of a free
    motion. What shakes the rig from outside has a period of its own.
    """
    options, candidates = search.options, [effect.candidate for effect in trial.effects]
    waves = [one for one in candidates if one.lines and one.each]
    if not waves or len(waves) < len(candidates) or _is_driven(search.problem.declared):
        return ""
    motion, errors = _period(search.data_split.train), trial.standard_errors
    for wave in waves:
        unknown = f"{wave.block}.{wave.lines[0]}"
        if unknown not in errors or not np.isfinite(motion):
            return ""
        order = motion / trial.values[unknown]
        part = options.sure * errors[unknown] / trial.values[unknown]
        if not 1 <= round(order) <= options.rhythms or abs(order / round(order) - 1) > part:
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
