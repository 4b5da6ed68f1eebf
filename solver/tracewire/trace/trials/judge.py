"""Judging trials: the gate on data that no fit saw, and which of several is the best."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracewire.residual import Segment
from tracewire.trace.trials.trial import Bench, Trial

Vector = NDArray[np.float64]
LEAST_DROP = 0.02
AT_NOISE = 1.5
MATERIAL = 1 / 3
DECISIVE = 100.0
"""A fall of BIC that needs less support from the gate."""
HARM = 0.1
"""The part of what windows gain that others may lose: a stop is met in few, and harms none."""
ASTRAY, FEW_ASTRAY = 30.0, 0.1
"""Times the noise's variance from which on a window has lost its track, as by an impact that comes
a sample too early, where the model is at the noise elsewhere; and the part that may have."""


@dataclass(frozen=True)
class Verdict:
    """What the gate says of a trial: whether it passes, by how much the squared error falls there,
    the paired z over windows, the part of windows that improve, and that in words."""

    passed: bool
    drop: float
    z: float
    improved: float
    words: str


def gate(
    bench: Bench, now: Trial, trial: Trial, windows: Sequence[Segment], fall: float
) -> Verdict:
    """Whether a trial does better than another on windows that no fit saw.

    Its squared error must be 2 % smaller there (a third, where it stays far above the noise, where
    everything is significant), and either the paired z over windows exceeds 2, or
    more than three of four windows improve; where BIC has fallen by more than 100, z above 1 is
    enough, or that hardly any window does worse. `fall` is that fall of BIC. Of a trial at the
    noise, few windows in which both models lose their track say nothing and do not count.
    """
    old, new = bench.on(now, windows), bench.on(trial, windows)
    before = np.array([float(np.sum(r**2)) for r in old])
    after = np.array([float(np.sum(r**2)) for r in new])
    astray = np.minimum(before, after) > ASTRAY * np.array([r.size for r in new])
    if trial.s2 <= AT_NOISE and astray.sum() <= FEW_ASTRAY * len(astray):
        before, after = before[~astray], after[~astray]
    if not before.sum() > 0:
        return Verdict(False, 0.0, 0.0, 0.0, "gate: nothing to improve")
    drop = float(1 - after.sum() / before.sum())
    change = before - after
    spread = float(np.std(change, ddof=1)) if len(change) > 1 else 0.0
    mean = float(np.mean(change))
    z = mean / (spread / len(change) ** 0.5) if spread > 0 else np.copysign(np.inf, mean)
    improved = float(np.mean(change > 0))
    harmless = -float(np.minimum(change, 0.0).sum()) < HARM * float(np.maximum(change, 0.0).sum())
    supported = z > 2 or improved > 0.75 or (fall > DECISIVE and (z > 1 or harmless))
    passed = drop > (LEAST_DROP if trial.s2 <= AT_NOISE else MATERIAL) and supported
    size = f"{abs(drop):.0%}" if not 0.995 <= drop < 1 else "more than 99.5%"
    words = f"gate: squared error {'falls' if drop > 0 else 'rises'} by {size}"
    return Verdict(
        passed, drop, float(z), improved, words + (", passed" if passed else ", refused")
    )
