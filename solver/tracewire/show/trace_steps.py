"""The steps of a trace, and what of them holds in the end."""

from __future__ import annotations

import math
import re

from tracewire.show.trace_words import both_of
from tracewire.trace import CandidateScore, Found, FoundEffect, SearchStep


def compares(step: SearchStep) -> bool:
    """Whether a step compares whole models by what they predict: no screen promised anything."""
    none_promised = not any(math.isfinite(row.promised) for row in step.tried)
    return bool(step.tried) and none_promised and math.isnan(step.chance)


def names_of_row(row: CandidateScore) -> set[str]:
    """The effects that were tried together."""
    return set(row.effects.split(", without ")[0].split(" + "))


def own_gain(found: Found, effect: FoundEffect) -> float:
    """The gain of an effect; nan where it is that of a combination with others that are not named
    in the end."""
    named = set(map(str, found.effects))
    for step in found.steps:
        for row in step.tried:
            if row.gain == effect.gain and str(effect) in names_of_row(row):
                return effect.gain if names_of_row(row) <= named else math.nan
    return effect.gain


def decided_words(found: Found) -> str:
    """Which step decides, where the result is not what the steps before accepted; else ''."""
    if not any(map(compares, found.steps)):
        return ""
    last = max(n for n, step in enumerate(found.steps) if compares(step))
    accepted = {
        name: number
        for number, step in enumerate(found.steps[:last], start=1)
        if step.words.startswith("accepted")
        for row in step.tried
        for name in names_of_row(row)
        if name in re.split(r": | and |, ", step.words)
    }
    named = list(map(str, found.effects))
    lost = [f"{name}, which step {n} accepted" for name, n in accepted.items() if name not in named]
    new = [name for name in named if name not in accepted]
    if not lost and not new:
        return ""
    parts = [f"leaves out {both_of(lost)}"] if lost else []
    if new:
        parts.append(f"takes {both_of(new)}, which no step before accepted")
    return (
        f"Step {last + 1} decides, whatever the steps before accepted or refused. It fits "
        "models to longer windows, and takes the one of fewest numbers that predicts held-out "
        f"blocks as well as the best. It {', and '.join(parts)}."
    )
