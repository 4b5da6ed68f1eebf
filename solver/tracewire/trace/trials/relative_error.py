"""How far a model is from its data, in units of what the signals move."""

from __future__ import annotations

import numpy as np

from tracewire.trace.trials.trial import Trial


def relative_error(trial: Trial) -> float:
    """The root mean square of what a model leaves in its windows over that of what the signal moves
    beside a straight line in each series, the largest of any signal."""
    windows = trial.windows
    left = np.mean(np.concatenate(windows.residuals) ** 2, axis=0)
    motion, noise = [], []
    for name in dict.fromkeys(segment.measured.name for segment in windows.segments):
        own = [segment for segment in windows.segments if segment.measured.name == name]
        t = np.concatenate([segment.t for segment in own])
        samples = np.concatenate([segment.samples() for segment in own])
        line = np.column_stack([np.ones_like(t), t - t.mean()])
        motion.append(samples - line @ np.linalg.lstsq(line, samples)[0])
        noise.append(windows.criterion.sigma[name] ** 2)
    moves = np.mean(np.concatenate(motion) ** 2, axis=0)
    squares = left * np.mean(noise, axis=0) / np.maximum(moves, np.finfo(float).tiny)
    return float(np.sqrt(np.max(squares)))
