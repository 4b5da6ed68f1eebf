"""Bounds that are a guess: how far a body moves says little of the least deflection that it shows.

A hysteresis over a two-hundredth of the longest stroke decides what the short strokes of a record
do. Searched from there from the start, each friction would take many times the steps of a run.
"""

from __future__ import annotations

from dataclasses import replace

from tracewire.trace.choose.heldout import Finalist
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.bounds import at_bounds
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import TraceProblem


def loosen_bounds(problem: TraceProblem, model: Finalist, options: TraceOptions) -> Finalist | None:
    """A model refitted with lower bounds for its shapes that sit on the least part of a stroke;
    None where none does, and where that leaves more than half of the squared error at a horizon: a
    small gain is what any more freedom brings."""
    names = {
        one.name
        for trial in model.trials
        for one in at_bounds(trial)
        if one.kind == "shape" and not one.upper and not one.exact
    }
    first = model.trials[0].effects
    effects = tuple(_loosened(effect, names, options.looser) for effect in first)
    if all(new is old for new, old in zip(effects, first, strict=True)):
        return None
    trials = []
    for trial in model.trials:
        both = zip(trial.effects, effects, strict=True)
        freed = tuple(replace(old, candidate=new.candidate) for old, new in both)
        looser = problem.try_refit(replace(trial, effects=freed))
        if looser is None:
            return None
        trials.append(looser)
    pairs = zip(trials, model.trials, strict=True)
    halved = all(new.rss < old.rss / options.hopeful for new, old in pairs)
    return replace(model, trials=tuple(trials)) if halved else None


def _loosened(effect: PlacedEffect, names: set[str], part: float) -> PlacedEffect:
    """An effect whose shapes with these names may be smaller, where they are parts of a stroke. A
    wave may not: its least length is that of a few samples, and a shorter one is an alias."""
    candidate, limits = effect.candidate, dict(effect.candidate.limits)
    for shape, of in candidate.scales.items():
        low, high = limits[shape]
        part_of_stroke = of == "stroke" and low > 0 and shape not in candidate.waves
        if part_of_stroke and effect.unknown(shape) in names:
            limits[shape] = part * low, high
    if limits == candidate.limits:
        return effect
    return replace(effect, candidate=replace(candidate, limits=limits))
