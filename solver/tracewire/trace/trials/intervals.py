"""The intervals of what a trial has fitted."""

from __future__ import annotations

from scipy.special import stdtrit

from tracewire.trace.trials.trial import Trial


def intervals(trial: Trial, confidence: float) -> dict[str, tuple[float, float]]:
    """The interval of each fitted value, which holds the truth with this confidence."""
    quantile = float(
        stdtrit(max(trial.degrees_of_freedom * trial.effective_fraction, 1.0), 0.5 + confidence / 2)
    )
    errors = trial.standard_errors
    return {
        name: (value - quantile * errors[name], value + quantile * errors[name])
        for name, value in trial.values.items()
    }


def undetermined_effects(trial: Trial, confidence: float) -> list[str]:
    """The effects of a trial, by name, whose coefficient may as well be zero."""
    ends = intervals(trial, confidence)
    found = []
    for effect in trial.effects:
        low, high = ends.get(effect.candidate.coefficient, (1.0, 1.0))
        if low <= 0 <= high:
            found.append(str(effect))
    return found
