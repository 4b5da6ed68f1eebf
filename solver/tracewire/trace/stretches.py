"""Which stretch of the data does what: fit (train), accept (gate), the final claim (validate).

A series whose start is free is cut into windows with free start states: short windows keep the
problem nearly linear. A series whose start is declared is one run from that start, of which
different stretches count. Without series of their own, gate and validation are held back in time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from tracewire.compile import Model
from tracewire.errors import DataError, Problem
from tracewire.fit.measured import Measured
from tracewire.fit.segment import Segment
from tracewire.fit.starts import start_from_data, whole_segment

WINDOWS = 9
LEAST_SAMPLES = 24
VALIDATED = 1 / 6
GATED = 0.2


@dataclass(frozen=True, eq=False)
class Stretches:
    """Segments by use, and how they came about in words."""

    train: tuple[Segment, ...]
    gate: tuple[Segment, ...]
    validate: tuple[Segment, ...]
    words: tuple[str, ...]

    def runs(self) -> list[Segment]:
        """One long run for each train series: from its start over all that is not held back."""
        first: dict[str, Segment] = {}
        end: dict[str, int] = {}
        for segment in (*self.train, *self.gate):
            name = segment.measured.name
            if segment.measured.use == "train":
                first.setdefault(name, segment)
                end[name] = max(end.get(name, 0), int(segment.rows[-1]) + 1)
        return [replace(s, rows=np.arange(int(s.rows[0]), end[n])) for n, s in first.items()]


def can_be_cut(model: Model, measured: Sequence[Measured]) -> bool:
    """Whether the data tell every state, so that a window can begin anywhere."""
    return all(set(start_from_data(model, m, 0)) == set(model.states) for m in measured)


def share_out(model: Model, measured: Sequence[Measured], cut: bool = False) -> Stretches:
    """The stretches of the measured series; `cut` asks for windows even where starts are declared.

    Raises DataError where a series is too short to hold anything back.
    """
    by_use = {use: [m for m in measured if m.use == use] for use in ("train", "gate", "validate")}
    if not by_use["train"]:
        raise DataError([Problem("no series is for training", hint="Say `use: train` of one.")])
    for m in by_use["train"]:
        if len(m.t) < 4 * LEAST_SAMPLES:
            what = f"the series '{m.name}' has {len(m.t)} samples, too few to trace anything"
            raise DataError([Problem(what, hint=f"At least {4 * LEAST_SAMPLES} are needed.")])
    fitted = {signal for m in by_use["train"] for signal in m.values}
    for m in (*by_use["gate"], *by_use["validate"]):
        for signal in sorted(set(m.values) - fitted):
            what = f"the series '{m.name}' measures '{signal}', which no train series measures"
            raise DataError([Problem(what, hint="Leave it out, or train with it.")])
    train: list[Segment] = []
    gate = [s for m in by_use["gate"] for s in _cut(model, m, 0, len(m.t), cut)]
    validate = [whole_segment(model, m) for m in by_use["validate"]]
    words = []
    for m in by_use["train"]:
        count = len(m.t)
        end = count if validate else int(count * (1 - VALIDATED))
        if not by_use["validate"]:
            words.append(f"the last sixth of '{m.name}' is held back for the final claim")
        parts = _cut(model, m, 0, end, cut)
        windowed = any(s.free for s in parts)
        if by_use["gate"]:
            train += parts
        elif windowed:
            words.append(f"every third window of the rest of '{m.name}' is the gate")
            train += [s for n, s in enumerate(parts) if n % 3 != 2]
            gate += [s for n, s in enumerate(parts) if n % 3 == 2]
        else:
            words.append(f"the last fifth of the rest of '{m.name}' is the gate")
            part = int(end * (1 - GATED))
            train.append(replace(parts[0], rows=parts[0].rows[:part]))
            gate.append(replace(parts[0], rows=parts[0].rows[part:]))
    if not by_use["validate"]:
        validate = [_tail(model, m, int(len(m.t) * (1 - VALIDATED)), cut) for m in by_use["train"]]
    return Stretches(tuple(train), tuple(gate), tuple(validate), tuple(words))


def _cut(model: Model, measured: Measured, first: int, end: int, cut: bool) -> list[Segment]:
    """Windows with free starts, or one run where the start is declared."""
    whole = whole_segment(model, measured)
    if not whole.free and not cut:
        return [replace(whole, rows=np.arange(first, end))]
    windows = min(WINDOWS, (end - first) // LEAST_SAMPLES)
    edges = np.linspace(first, end, windows + 1).astype(int)
    return [_window(model, measured, whole, a, b) for a, b in pairwise(edges.tolist())]


def _window(model: Model, measured: Measured, whole: Segment, a: int, b: int) -> Segment:
    """Rows a to b as a window of its own; every state is free there that the data tell."""
    told = start_from_data(model, measured, a)
    if a == 0:
        return replace(whole, rows=np.arange(a, b))
    start = {**whole.start, **told}
    return Segment(measured, float(measured.t[a]), np.arange(a, b), start, tuple(start))


def _tail(model: Model, measured: Measured, first: int, cut: bool) -> Segment:
    """The rest of a series as one run."""
    whole = whole_segment(model, measured)
    rows = np.arange(first, len(measured.t))
    if not whole.free and not cut:
        return replace(whole, rows=rows)
    return _window(model, measured, whole, first, len(measured.t))
