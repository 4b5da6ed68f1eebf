"""The starts of windows fitted, each for itself, while the unknowns stay."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tracewire.array_types import Vector
from tracewire.residual.limits import WINDOW
from tracewire.residual.starts import start_from_data
from tracewire.residual.windows import Windows, keep_better, with_initial_states


def fit_initial_states(windows: Windows, steps: int = WINDOW.initial_state_steps) -> Windows:
    """The starts alone fitted, each window for itself; the unknowns stay.

    A window whose start is led astray (a start inside a stiff barrier kicks it away) is tried from
    the end of the window before it; where nothing happens but at known times, only one that is much
    worse than most.
    """
    windows = refine_initial_states(windows, range(len(windows.linearisations)), steps)
    off = _diverged(windows)
    if _has_events(windows):
        off = [n for n in range(len(windows.linearisations)) if not _is_good(windows, n)]
    return restart_from_data(update_memories(restart_from_ends(windows, off, steps)), steps)


def restart_from_others(windows: Windows, others: Windows) -> Windows:
    """Windows that another model has, too, each from the start that it has there where that leaves
    less, and where it does better: what a start led astray says nothing of the model."""
    off = [
        n
        for n in np.flatnonzero(windows.squares > others.squares).tolist()
        if windows.starts[n] and not _is_good(windows, n)
    ]
    starts = {
        n: {name: others.starts[n].get(name, value) for name, value in windows.starts[n].items()}
        for n in off
    }
    return _restart(windows, starts, WINDOW.initial_state_steps) if off else windows


def restart_from_data(windows: Windows, steps: int) -> Windows:
    """Windows that are much worse than most from the starts that the data tell, where that does
    better: a body that friction holds at its start does not feel where it should begin. The same
    windows where nothing is better.
    """
    tried: dict[int, Mapping[str, float]] = {}
    for n in _diverged(windows):
        known = _start_by_data(windows, n)
        if not is_far_off(windows, n, known):
            tried[n] = known
    if not tried:
        return windows
    found = _restart(windows, tried, steps)
    if _has_events(windows):
        found = _restart_beside_data(found, steps)
    changed = any(found.starts[n] is not windows.starts[n] for n in range(len(found.starts)))
    return update_memories(found) if changed else windows


def _restart_beside_data(windows: Windows, steps: int) -> Windows:
    """Windows that are much worse than most from starts a standard deviation and two beside what
    the data tell of a measured state: how deep a body is in a stop, which no sample shows, decides
    when it leaves that."""
    diverged, criterion = _diverged(windows), windows.criterion
    best = dict[int, tuple[float, Mapping[str, float]]]()
    known = {n: _start_by_data(windows, n) for n in diverged}
    for signal in dict.fromkeys(name for n in diverged for name in criterion.segments[n].signals):
        for shift in WINDOW.beside:
            moved: dict[int, Mapping[str, float]] = {}
            for n in diverged:
                segment = criterion.segments[n]
                if signal in segment.signals and signal in known[n]:
                    sigma = criterion.sigma[segment.measured.name][segment.signals.index(signal)]
                    size = float(sigma) / abs(segment.measured.sensor(signal).gain)
                    moved[n] = {**known[n], signal: known[n][signal] + shift * size}
            there = with_initial_states(windows, moved)
            for n in moved:
                square = there.linearisations[n].square
                if there.linearisations[n].ran and square < best.get(n, (np.inf, {}))[0]:
                    best[n] = square, moved[n]
    return _restart(windows, {n: start for n, (_, start) in best.items()}, steps)


def _restart(windows: Windows, starts: Mapping[int, Mapping[str, float]], steps: int) -> Windows:
    """The windows with some fitted from other starts, where that does better."""
    there = refine_initial_states(with_initial_states(windows, starts), list(starts), steps)
    return keep_better(windows, there, list(starts))


def _has_events(windows: Windows) -> bool:
    """Whether a start decides what happens in a run: else the squared error is smooth in it."""
    return any(not mode.timed for mode in windows.criterion.model.modes)


def _diverged(windows: Windows) -> list[int]:
    """The windows with free starts that are much worse than most."""
    sizes = np.array([near.residual.size for near in windows.linearisations])
    means = windows.squares / np.maximum(sizes, 1)
    far = np.flatnonzero(means > WINDOW.diverged * float(np.median(means))).tolist()
    return [n for n in far if windows.starts[n] and not _is_good(windows, n)]


def _start_by_data(windows: Windows, n: int) -> dict[str, float]:
    """The start of a window with the states that the data tell."""
    segment = windows.criterion.segments[n]
    row = int(np.searchsorted(segment.measured.t, segment.begin))
    known = start_from_data(windows.criterion.model, segment.measured, row)
    return {name: known.get(name, value) for name, value in windows.starts[n].items()}


def restart_from_ends(windows: Windows, rows: Sequence[int], steps: int) -> Windows:
    """Some windows from the ends of those before them, where that does better; once more, where the
    one before has changed by that."""
    changed = {n - 1 for n in rows}
    while True:
        off = [n for n in rows if n - 1 in changed and not _is_good(windows, n)]
        there = with_initial_states(windows, previous_ends(windows, off))
        tried = [n for n in off if there.starts[n] is not windows.starts[n]]
        if not tried:
            return windows
        found = keep_better(windows, refine_initial_states(there, tried, steps), tried)
        changed = {n for n in tried if found.starts[n] is not windows.starts[n]}
        windows = found


def _is_good(windows: Windows, n: int) -> bool:
    """Whether a window is so near what the best models leave that it is not astray."""
    near = windows.linearisations[n]
    return near.square <= windows.inlier_limit * near.residual.size


def update_memories(windows: Windows) -> Windows:
    """The windows with memories as they are after starts of some have moved."""
    remembers = windows.criterion.remembers
    return with_initial_states(windows, dict(enumerate(windows.starts))) if remembers else windows


def previous_ends(windows: Windows, rows: Sequence[int]) -> dict[int, Mapping[str, float]]:
    """The ends of the windows before some, which are starts for these, by number."""
    found: dict[int, Mapping[str, float]] = {}
    for n in rows:
        ends = windows.linearisations[n - 1].final if windows.criterion.follows(n) else {}
        if ends:
            found[n] = {name: ends[name] for name in windows.starts[n]}
    return found


def refine_initial_states(windows: Windows, rows: Sequence[int], steps: int) -> Windows:
    """The starts of some windows fitted by damped Gauss-Newton steps, each for itself."""
    share = {n: 1.0 for n in rows if windows.starts[n]}
    answers: dict[int, Vector] = {}
    for _ in range(steps):
        moved: dict[int, Mapping[str, float]] = {}
        for n in list(share):
            near = windows.linearisations[n]
            if n not in answers:
                view = windows.linearisations[n].projection
                gain = float(np.sum((view.basis.T @ near.residual.ravel()) ** 2))
                if gain < max(WINDOW.negligible_gain, WINDOW.converged * near.square):
                    del share[n]
                    continue
                answers[n] = -view.start_of(near.residual.ravel())
            start = np.array(list(windows.starts[n].values())) + share[n] * answers[n]
            moved[n] = dict(zip(windows.starts[n], start.tolist(), strict=True))
            if is_far_off(windows, n, moved[n]):
                share[n] /= 4
                del moved[n]
        if not share:
            break
        there = with_initial_states(windows, moved)
        for n in moved:
            if not there.linearisations[n].ran:
                del share[n]
            elif there.linearisations[n].square < windows.linearisations[n].square:
                share[n] = min(2 * share[n], 1.0)
                del answers[n]
            else:
                share[n] /= 4
        windows = keep_better(windows, there, list(moved))
    return windows


def is_far_off(windows: Windows, n: int, start: Mapping[str, float]) -> bool:
    """Whether a start is where no body of this record can be: no run is worth its time there.

    A state that is not measured may be a rate of a signal, or of the kind of a signal itself.
    """
    segment = windows.criterion.segments[n]
    spreads = segment.measured.spreads
    scales = {
        name: scale if name in spreads else max(scale, *spreads.values())
        for name, scale in segment.start_scales.items()
    }
    return any(
        not abs(value - segment.start.get(name, 0.0)) < WINDOW.far_off * scales[name]
        for name, value in start.items()
    )
