"""Judging trials: the gate on data that no fit saw, and which of several is the best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tracewire.residual import Segment, restart_from_others
from tracewire.trace.trials.trial import TraceProblem, Trial


def judge_on_gate(
    problem: TraceProblem,
    now: Trial,
    trial: Trial,
    windows: Sequence[Segment],
    bic_reduction: float,
) -> tuple[bool, str]:
    """Whether a trial does better than another on windows that no fit saw, and that in words.

    Its squared error must be 2 % smaller there (and by a third of what is above the noise, where it
    stays far above that where it was fitted: there everything is significant), and either the
    paired z over windows exceeds 2, or more than three of four windows improve; where BIC has
    fallen by more than 100, z above 1 is enough, or that hardly any window does worse.
    `bic_reduction` is that fall of BIC. Of a trial at the noise, few windows in which both models
    lose their track say nothing and do not count.
    """
    options = problem.options.trial
    at_noise = trial.reduced_chi2 <= options.gate_noise
    old, new = problem.windows_on(now, windows), problem.windows_on(trial, windows)
    before = restart_from_others(old, new).squares
    after = restart_from_others(new, old).squares
    noise = np.array([float(r.size) for r in new.residuals])
    astray = np.minimum(before, after) > options.gate_astray * noise
    if at_noise and astray.sum() <= options.gate_few_astray * len(astray):
        before, after, noise = before[~astray], after[~astray], noise[~astray]
    if not before.sum() > 0:
        return False, "gate: nothing to improve"
    drop = float(1 - after.sum() / before.sum())
    change = before - after
    spread = float(np.std(change, ddof=1)) if len(change) > 1 else 0.0
    mean = float(np.mean(change))
    z = mean / (spread / len(change) ** 0.5) if spread > 0 else np.copysign(np.inf, mean)
    improved = float(np.mean(change > 0))
    gained, lost = float(np.maximum(change, 0.0).sum()), -float(np.minimum(change, 0.0).sum())
    supported = z > options.gate_errors or improved > options.gate_improved
    if bic_reduction > options.gate_decisive:
        supported |= z > options.gate_few_errors or lost < options.gate_harm * gained
    least = options.gate_drop
    if not at_noise:
        least = max(least, options.gate_material * float(1 - noise.sum() / before.sum()))
    passed = drop > least and bool(supported)
    size = f"{abs(drop):.0%}" if not 0.995 <= drop < 1 else "more than 99.5%"
    words = f"gate: squared error {'falls' if drop > 0 else 'rises'} by {size}"
    return passed, words + (", passed" if passed else ", refused")
