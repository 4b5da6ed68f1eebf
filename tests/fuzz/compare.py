"""The product beside the exact solution, on random systems."""

from __future__ import annotations

import random
import time
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
import tracewire as tw
from fuzz.elements import System, Unclear
from fuzz.exact import Solution
from fuzz.systems import draw, system_of, text_of
from tracewire.errors import SimulationError
from tracewire.solve import Limits

RTOL = 1e-8
AGREES = 1e-6  # of the size of a state, and of what a change of the start by NUDGE grows to
NUDGE = 1e-7
SENSITIVE = 1e4  # times the nudge: beyond it, no two computations agree
SAMPLES = 12
TRUE_REASONS: tuple[str, ...] = ()  # the exact solution judges none of what may be refused


@dataclass
class Tally:
    """What came of many systems."""

    judged: int = 0
    unclear: Counter[str] = field(default_factory=Counter)
    refused: Counter[str] = field(default_factory=Counter)
    wrong: list[tuple[int, str]] = field(default_factory=list)
    refusals: list[tuple[int, str]] = field(default_factory=list)

    @property
    def unexplained(self) -> list[tuple[int, str]]:
        """The refusals for which the exact solution knows no reason."""
        return [(seed, text) for seed, text in self.refusals if kind_of(text) not in TRUE_REASONS]

    def __str__(self) -> str:
        return (
            f"{self.judged} judged, {len(self.wrong)} wrong, refused: {dict(self.refused)}, "
            f"not judged: {dict(self.unclear)}"
        )


def exact(system: System, end: float, times: np.ndarray) -> np.ndarray:
    """z at the times (N, len z). Raises Unclear."""
    return Solution(system, end).at(times)


def check(seed: int, tally: Tally, method: str = "auto") -> None:
    """Compare one system; what comes of it goes to the tally."""
    draft = draw(seed)
    rng = random.Random(seed + 1)
    times = np.sort([rng.uniform(0, draft.end) for _ in range(SAMPLES)])
    try:
        base = exact(system_of(draft), draft.end, times)
        nudged = []
        for _ in range(2):
            system = system_of(draft)
            moves = [rng.choice((-1, 1)) * NUDGE if name else 0.0 for name in draft.names]
            system.start += np.array(moves)
            nudged.append(exact(system, draft.end, times))
    except Unclear as reason:
        tally.unclear[str(reason)] += 1
        return
    grown = np.max([np.abs(other - base) for other in nudged], axis=(0, 1)) / NUDGE
    if grown.max() > SENSITIVE:
        tally.unclear["too sensitive"] += 1
        return
    model = tw.compile(tw.read_text(text_of(draft)))
    try:
        run = tw.simulate(
            model,
            times=times * draft.second,
            rtol=RTOL,
            method=method,
            limits=Limits(steps=200_000, seconds=20.0),
        )
    except SimulationError as error:
        tally.refused[kind_of(str(error))] += 1
        tally.refusals.append((seed, str(error)))
        return
    tally.judged += 1
    size = np.maximum(np.abs(base).max(axis=0), 1e-3)
    for place, name in enumerate(draft.names):
        if not name or name not in model.states:
            continue
        off = np.abs(run[name] / draft.units[place] - base[:, place])
        allowed = AGREES * size[place] + 10 * RTOL * grown[place] + AGREES * grown[place] * 0.1
        if not np.all(off <= allowed):
            worst = int(np.argmax(off))
            tally.wrong.append(
                (seed, f"{name} at {times[worst]:.6g}: {off[worst]:.3g} off, {sorted(draft.said)}")
            )
            return


def kind_of(text: str) -> str:
    """A refusal in short."""
    for words in ("no consistent mode", "no unique slide", "again and again", "two resets",
                  "changes with its own mode", "lead back", "over the contact",
                  "step became smaller", "more than", "is not finite"):  # fmt: skip
        if words in text:
            return words
    return text


def fuzz(count: int, seed: int, method: str = "auto") -> Tally:
    """So many systems from a seed on."""
    tally, began = Tally(), time.perf_counter()
    for number in range(count):
        check(seed + number, tally, method)
        if (number + 1) % 1000 == 0:
            spent = time.perf_counter() - began
            print(f"{number + 1} of {count}, {spent:.0f} s: {tally}", flush=True)  # noqa: T201
    return tally
