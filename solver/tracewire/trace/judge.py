"""Judging trials: the gate on unseen data, and what is superfluous beside the others."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from tracewire.fit.segment import Segment
from tracewire.trace.statistics import bic
from tracewire.trace.trial import Bench, Trial

AT_NOISE = 1.5
MATERIAL = 1 / 3
LEAST_DROP = 0.02
CHEAP = 6.0
PIECES = 8


def gate(bench: Bench, now: Trial, trial: Trial, segments: Sequence[Segment]) -> tuple[bool, str]:
    """Whether a trial is better than another on segments that no fit saw, and why in words.

    Where it reaches the noise its squared error must be 2 % smaller there; far above the noise,
    where everything is significant, it must be a third smaller.
    """
    old, new = bench.elsewhere(now, segments), bench.elsewhere(trial, segments)
    if len(segments) < PIECES // 2:  # too few to pair: compare pieces of them
        old = [piece for r in old for piece in np.array_split(r, PIECES)]
        new = [piece for r in new for piece in np.array_split(r, PIECES)]
    before = np.array([np.sum(r**2) for r in old])
    after = np.array([np.sum(r**2) for r in new])
    if not before.sum() > 0:
        return False, "gate: nothing to improve"
    drop = float(1 - after.sum() / before.sum())
    change = before - after
    spread = float(np.std(change, ddof=1)) if len(change) > 1 else np.inf
    z = float(np.mean(change)) / (spread / len(change) ** 0.5) if spread > 0 else 0.0
    least = LEAST_DROP if trial.s2 <= AT_NOISE else MATERIAL
    passed = drop > least and (z > 2 or float(np.mean(change > 0)) > 0.75 or drop > 0.5)
    words = f"gate: squared error {'falls' if drop > 0 else 'rises'} by {abs(drop):.0%}"
    return passed, words + (", accepted" if passed else ", refused")


def prune(bench: Bench, trial: Trial, tell: Callable[[str], None]) -> tuple[Trial, tuple[str, ...]]:
    """The trial without effects and declared terms that the others made superfluous; their names.

    At the noise BIC decides. Far above it a term stays only if it matters, by a third of the
    squared error. Declared terms are tried where zero is their lower bound.
    """
    removed: list[str] = []
    added = {effect.unknown for effect in trial.effects}
    lows = {u.name: u.low for u in trial.criterion.unknowns}
    names = [n for n in lows if n in added]
    names += [n for n, low in lows.items() if low == 0.0 and n not in added]
    for name in names:
        tell(f"trying without {name}")
        smaller = bench.without(trial, name)
        loss = bic(smaller.rss, trial.count, trial.part, smaller.unknowns)
        loss -= bic(trial.rss, trial.count, trial.part, trial.unknowns)
        immaterial = trial.s2 > AT_NOISE and trial.rss > (1 - MATERIAL) * smaller.rss
        if loss < CHEAP or immaterial:
            removed.append(name)
            trial = smaller
    return trial, tuple(removed)
