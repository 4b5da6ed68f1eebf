"""The product beside another solution, on random systems."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import tracewire as tw
from fuzz.elements import Unclear
from fuzz.exact import Solution
from fuzz.reference import Reference
from fuzz.smooth import draw as draw_smooth
from fuzz.systems import draw, system_of, text_of
from numpy.typing import NDArray
from tracewire.errors import SimulationError
from tracewire.solve import Limits

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
RTOL = 1e-8
AGREES = 1e-6  # of the size of a state, and of what a change of the start by NUDGE grows to
NUDGE = 1e-7
SENSITIVE = 1e4  # times the nudge: beyond it, no two computations agree
SAMPLES = 12
METHODS = ("auto", "dormand_prince", "dop853", "rosenbrock")
BACKENDS = ("llvm", "quick", "python"), (2, 17, 1)  # how often: the quick one compiles in no time
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


@dataclass
class Case:
    """A system: its diagram, and its solution from starts that are moved by (n,) at times (N,).

    The solution is in units of its own, those of a state and of the time; a name is empty where a
    column is no state of the diagram. The solution raises Unclear.
    """

    text: str
    end: float
    second: float
    names: Sequence[str]
    units: Sequence[float]
    said: Sequence[str]
    solve: Callable[[Vector, Vector], Matrix]


def linear(seed: int, shared: bool = False) -> Case:
    """A piecewise linear system and its exact solution, where no elements are `shared` on one
    surface, or also there."""
    draft = draw(seed)

    def solve(moves: Vector, times: Vector) -> Matrix:
        system = system_of(draft)
        system.start += moves
        return Solution(system, draft.end, shared).at(times.tolist())

    text, said = text_of(draft), sorted(draft.said)
    return Case(text, draft.end, draft.second, draft.names, draft.units, said, solve)


def smooth(seed: int) -> Case:
    """A nonlinear system and what another integrator makes of it."""
    system = draw_smooth(seed)
    names, start = list(system.starts), np.array(list(system.starts.values()))

    def solve(moves: Vector, times: Vector) -> Matrix:
        return Reference(system, start + moves).at(times.tolist())

    return Case(system.text(), system.end, 1.0, names, [1.0] * len(names), system.said, solve)


def surfaces(seed: int) -> Case:
    """A linear system, also with several elements on one surface."""
    return linear(seed, shared=True)


CASES = {"linear": linear, "smooth": smooth, "surfaces": surfaces}


def check(case: Case, seed: int, tally: Tally, method: str = "any", backend: str = "any") -> None:
    """Compare one system; what comes of it goes to the tally."""
    rng = random.Random(seed + 1)
    if method == "any":
        method = rng.choice(METHODS)
    if backend == "any":
        backend = rng.choices(*BACKENDS)[0]
    times = np.sort([rng.uniform(0, case.end) for _ in range(SAMPLES)])
    try:
        base = case.solve(np.zeros(len(case.names)), times)
    except Unclear as reason:
        tally.unclear[str(reason)] += 1
        return
    model = tw.compile(tw.read_text(case.text), backend=backend)  # type: ignore[arg-type]
    limits = Limits(steps=200_000, seconds=20.0)
    run, refused = None, ""
    try:
        run = tw.simulate(model, times=times * case.second, rtol=RTOL, method=method, limits=limits)
    except SimulationError as error:
        refused = str(error)
    wrong = "" if run is None else disagrees(case, run, times, base, np.zeros(len(case.names)))
    if refused or wrong:  # in most cases nobody has to know how sensitive it is
        try:
            grown = growth(case, rng, times, base)
        except Unclear as reason:
            tally.unclear[str(reason)] += 1
            return
        if grown.max() > SENSITIVE:
            tally.unclear["too sensitive"] += 1
            return
        wrong = "" if run is None else disagrees(case, run, times, base, grown)
    if refused:
        tally.refused[kind_of(refused)] += 1
        tally.refusals.append((seed, f"{method}, {backend}: {refused}"))
        return
    tally.judged += 1
    if wrong:
        tally.wrong.append((seed, f"{wrong}, {method}, {backend}, {case.said}"))


def growth(case: Case, rng: random.Random, times: Vector, base: Matrix) -> Vector:
    """By how much a small change of the start grows in each state. Raises Unclear."""
    nudged = []
    for _ in range(2):
        moves = [rng.choice((-1, 1)) * NUDGE if name else 0.0 for name in case.names]
        nudged.append(case.solve(np.array(moves), times))
    return np.asarray(np.max([np.abs(other - base) for other in nudged], axis=(0, 1)) / NUDGE)


def disagrees(case: Case, run: tw.Run, times: Vector, base: Matrix, grown: Vector) -> str:
    """Where a run is farther from the solution than rounding, as it grows, explains; or nothing."""
    size = np.maximum(np.abs(base).max(axis=0), 1e-3)
    for place, name in enumerate(case.names):
        if not name or name not in run.final:
            continue
        off = np.abs(run[name] / case.units[place] - base[:, place])
        allowed = AGREES * size[place] + 10 * RTOL * grown[place] + AGREES * grown[place] * 0.1
        if not np.all(off <= allowed):
            worst = int(np.argmax(off))
            return f"{name} at {times[worst]:.6g}: {off[worst]:.3g} off"
    return ""


def kind_of(text: str) -> str:
    """A refusal in short."""
    for words in ("no consistent mode", "no unique slide", "again and again", "two resets",
                  "changes with its own mode", "lead back", "over the contact",
                  "step became smaller", "more than", "is not finite"):  # fmt: skip
        if words in text:
            return words
    return text
