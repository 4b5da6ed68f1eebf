"""Common laws before waves and drifts, which follow whatever a law that is nearly right leaves."""

from __future__ import annotations

from collections.abc import Sequence

from tracewire.trace.candidates.lines import lines_of
from tracewire.trace.options import TraceOptions
from tracewire.trace.search.refits import RefitResult
from tracewire.trace.trials.trial import Trial


def common_first(
    queue: Sequence[int], results: Sequence[RefitResult], now: Trial, options: TraceOptions
) -> list[int]:
    """The queue with the best result of common effects first, where the first one has a wave, a
    drift or their kin and as many numbers, and takes hardly more of the squared error.

    A wave that goes with a free motion itself gives way where a common law takes half as much: it
    beats with the motion, as an amplitude or a frequency that is nearly right does.
    """
    if not queue:
        return []
    first = results[queue[0]]
    most = first.trial.rss + least_part(first.trial, options) * (now.rss - first.trial.rss)
    common = [
        n
        for n, one in enumerate(results)
        if uncommon(one.trial, options) < uncommon(first.trial, options)
        and one.proposal.count <= first.proposal.count
        and one.trial.rss <= most
    ]
    if not common:
        return [*queue]
    best = min(common, key=lambda n: results[n].delta_bic)
    return [best, *(n for n in queue if n != best)]


def least_part(trial: Trial, options: TraceOptions) -> float:
    """The part of the squared error by which waves and drifts of a trial must take more than common
    effects."""
    return options.with_motion if goes_with_motion(trial, options) else options.material


def uncommon(trial: Trial, options: TraceOptions) -> int:
    """How many effects of a trial are waves, drifts and their kin."""
    return sum(effect.candidate.effect in options.uncommon for effect in trial.effects)


def goes_with_motion(trial: Trial, options: TraceOptions) -> bool:
    """Whether an effect of a trial is a wave in time within one line of the spectrum of the free
    motion, or that modulates it with twice its frequency."""
    periods = [
        (1.0 if shape not in effect.candidate.modulated else 2.0, effect.values[shape])
        for effect in trial.effects
        for shape in effect.candidate.lines
        if effect.values.get(shape)
    ]
    series = {s.measured.name: s.measured for s in trial.windows.segments}.values()
    for measured in series if periods else ():
        if measured.inputs:
            return False
        length = float(measured.t[-1] - measured.t[0])
        for values in measured.values.values():
            own = lines_of(measured.t, values, options.candidate)[:1]
            near = (abs(1 / p - times * f) * length for times, p in periods for f in own)
            if any(apart < 1 for apart in near):
                return True
    return False
