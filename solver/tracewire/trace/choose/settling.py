"""Records whose residual is at the noise but for their begin, their end, or few samples."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tracewire.array_types import Vector
from tracewire.formula import two_digits
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.trial import Trial

IN_THE_FILE = " of the series, in the time of its file (where `zero:` is t = 0)"


def describe_settling(trial: Trial, options: TraceOptions) -> Iterator[str]:
    """In words, for each series whose residual is at the noise from some time on, or until some
    time, and far off it elsewhere: to leave that part out is another answer than a missing effect.

    A hand that lets go, a start that shakes the rig and a clamp that slips do not come again.
    """
    for name, (t, squares) in _by_series(trial).items():
        begin = quiet_from(squares, options)
        if begin:
            off = float(np.mean(squares[:begin])) ** 0.5
            yield (
                f"'{name}' is at the noise from {t[begin]:.4g} s on, and {two_digits(off)} σ off"
                f" before. If something settles there, leave it out by `from:`{IN_THE_FILE}"
            )
            continue
        end = len(t) - quiet_from(squares[::-1], options)
        if end < len(t):
            off = float(np.mean(squares[end:])) ** 0.5
            yield (
                f"'{name}' is at the noise until {t[end - 1]:.4g} s, and {two_digits(off)} σ off"
                f" after that. If something disturbs it there, leave it out by `to:`{IN_THE_FILE}"
            )


def describe_few_samples(trial: Trial, options: TraceOptions) -> Iterator[str]:
    """In words, for each series of whose squared residual half or more stands in few samples: a
    sample that is wrong is another answer than a missing effect."""
    for name, (t, squares) in _by_series(trial).items():
        order = np.argsort(-squares, kind="stable")
        count = int(np.searchsorted(np.cumsum(squares[order]), squares.sum() / 2)) + 1
        if count > max(options.few_samples * len(t), 1) or squares.mean() <= options.at_noise:
            continue
        times = ", ".join(f"{time:.4g}" for time in np.sort(t[order[:count]])[: options.told])
        yield (
            f"half of the squared residual of '{name}' stands in {count} of {len(t)} samples, at"
            f" t = {times} s{' and more' * (count > options.told)}: look there, and leave out what"
            " is wrong, as by `outliers` in `clean:` of the series"
        )


def quiet_from(squares: Vector, options: TraceOptions) -> int:
    """The first row from which on squared residuals (N,) in sigma are at the noise in the mean,
    where those before are many times as large; 0 where there is none in the first half, or where
    all are at the noise."""
    count = len(squares)
    sums = np.concatenate(([0.0], np.cumsum(squares)))
    rows = np.arange(1, count // 2 + 1)
    after = (sums[-1] - sums[rows]) / (count - rows)
    quiet = np.flatnonzero(after <= options.at_noise)
    if not len(quiet) or sums[-1] / count <= options.at_noise:
        return 0
    row = int(rows[quiet[0]])
    return row if sums[row] / row >= options.settles * after[quiet[0]] else 0


def _by_series(trial: Trial) -> dict[str, tuple[Vector, Vector]]:
    """By series, the times (N,) of the samples of its windows in order, and the mean squared
    residual of each over the signals (N,)."""
    parts: dict[str, list[tuple[Vector, Vector]]] = {}
    for segment, residual in zip(trial.windows.segments, trial.windows.residuals, strict=True):
        parts.setdefault(segment.measured.name, []).append(
            (segment.t, np.mean(residual**2, axis=1))
        )
    found = {}
    for name, windows in parts.items():
        t, squares = (np.concatenate(part) for part in zip(*windows, strict=True))
        order = np.argsort(t, kind="stable")
        found[name] = t[order], squares[order]
    return found
