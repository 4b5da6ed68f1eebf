"""From when to when a run goes, and at which times it is sampled."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.errors import Location, OptionError, Problem
from tracewire.formula import evaluate, names_of
from tracewire.solve.limits import MEMORY, SAMPLE
from tracewire.solve.once_per_model import once_per_model

DEFAULT_SAMPLES = 1001


def check_times(times: ArrayLike) -> Vector:
    """Sample times (N,) as they are used. Raises OptionError where they do not ascend."""
    samples = np.array(times, dtype=float).ravel()
    increasing = bool((samples[1:] > samples[:-1]).all())  # not so where one is NaN
    if not len(samples) or not (increasing and -math.inf < samples[0] and samples[-1] < math.inf):
        what = "the sample times do not ascend"
        raise OptionError([Problem(what, hint="Sort them, without repetition or NaN.")])
    return samples


def span_of(
    model: Model,
    values: Mapping[str, float],
    span: tuple[float, float] | None,
    times: Vector | None,
) -> tuple[float, float]:
    """Begin and end in s: the span that is given, or the diagram's. Raises OptionError."""
    own = (evaluate(formula, values) for formula in model.flat.span)
    begin, end = own if span is None else span
    if span is None and times is not None:
        begin, end = min(begin, times[0]), times[-1]
    begin, end = float(begin), float(end)
    if not (math.isfinite(begin) and math.isfinite(end) and begin < end):
        what = f"the span from {begin:g} to {end:g} s is empty"
        raise OptionError([Problem(what, hint="Give a begin before the end.")])
    return begin, end


@once_per_model
def timing_follows(model: Model) -> bool:
    """Whether parameters may change the span of the diagram, its samples or its longest step."""
    flat = model.flat
    formulas = [*flat.span, *(f for f in (flat.every, flat.max_step) if f is not None)]
    return bool(model.lowered.delays) or any(names_of(formula) for formula in formulas)


def samples_of(
    model: Model,
    values: Mapping[str, float],
    begin: float,
    end: float,
    times: Vector | None = None,
    every: float | None = None,
) -> Vector:
    """The sample times (N,) within a span: those that are given, or each so many seconds, or as the
    diagram says. Raises OptionError where there is no use in them."""
    if times is not None and every is not None:
        what = f"there are sample times, and an output every {every:g} s"
        raise OptionError([Problem(what, hint="Give times= or every=, not both.")])
    if times is not None:
        if times[0] < begin or times[-1] > end:
            what = (
                f"the sample times from {times[0]:g} to {times[-1]:g} s are not within the span "
                f"from {begin:g} to {end:g} s"
            )
            raise OptionError([Problem(what, hint="Give a longer span, or other times.")])
        return times
    place = Location()
    if every is None:
        if model.flat.every is None:
            return _default_times(begin, end).copy()
        every = evaluate(model.flat.every, values)
        place = place if model.diagram.every is None else model.diagram.every.place
    if not every > 0 or (end - begin) / every > SAMPLE.most:
        what = f"an output every {every:g} s from {begin:g} to {end:g} s cannot be kept"
        raise OptionError([Problem(what, place, hint="Give a larger `every`.")])
    if every > (end - begin) * (1 + 1e-12):  # a run of one sample would say nothing of its end
        what = f"an output every {every:g} s has one sample only from {begin:g} to {end:g} s"
        raise OptionError([Problem(what, place, hint="Give a smaller `every`, or a longer span.")])
    count = math.floor((end - begin) / every * (1 + 1e-12))
    return np.asarray(np.minimum(begin + every * np.arange(count + 1), end))


def short_of_end(samples: Vector, end: float) -> list[str]:
    """That evenly spaced samples end before the run does, which goes on without one."""
    if len(samples) < 2 or end - samples[-1] <= SAMPLE.short * (samples[1] - samples[0]):
        return []
    every = float(samples[1] - samples[0])
    return [
        f"the run ends at {end:g} s and its last sample is at {samples[-1]:g} s, as `every` "
        f"{every:g} s does not divide the span: end() is the value there, and events count to the "
        "end; give an `every` that divides the span"
    ]


@lru_cache(maxsize=MEMORY.times)
def _default_times(begin: float, end: float) -> Vector:
    return np.linspace(begin, end, DEFAULT_SAMPLES)


def sample_times(
    model: Model,
    values: Mapping[str, float],
    span: tuple[float, float],
    every: float | None = None,
) -> Vector:
    """The sample times (N,) in s that a run over a span has by itself. Raises OptionError."""
    begin, end = span_of(model, values, span, None)
    return samples_of(model, values, begin, end, every=every)


def even_times(
    model: Model, values: Mapping[str, float], span: tuple[float, float] | None, steps: int
) -> Vector:
    """Times (steps + 1,) in s, evenly from the begin to the end of a span, the diagram's unless
    given. Raises OptionError."""
    begin, end = span_of(model, values, span, None)
    return np.linspace(begin, end, steps + 1)
