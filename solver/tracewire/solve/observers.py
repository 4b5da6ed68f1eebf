"""What `simulate_many` keeps of each run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, SimulationError, unknown
from tracewire.formula import CONSTANTS, evaluate, names_of, parse
from tracewire.solve.core.codes import LOG_HEAD
from tracewire.solve.limits import SAMPLE
from tracewire.solve.run import Run

Direction = Literal["up", "down", "both"]


@dataclass(frozen=True)
class Section:
    """Poincaré points: the states where a guard crosses, or at each multiple of a period.

    `guard` is the text of a guard as the log of events has it (`run.events[i].guard`), or the block
    that holds it; of its crossings in `direction` the states x⁻ are kept, with `after` x⁺. `period`
    in s, or a formula of the parameters ("2*pi/omega"): points at `begin + k*period`. Points before
    the time `since`, in s or such a formula, are left out.
    """

    guard: str = ""
    direction: Direction = "both"
    period: float | str | None = None
    since: float | str | None = None
    after: bool = False


Observer = Literal["samples"] | Section | Callable[[Run], ArrayLike]


def check_section(model: Model, section: Section) -> None:
    """Refuse a section that does not fit the model. Raises OptionError, FormulaError."""
    if bool(section.guard) == (section.period is not None):
        hint = "Write Section(guard=...) or Section(period=...)."
        raise OptionError([Problem("a section needs either a guard or a period", hint=hint)])
    if section.direction not in ("up", "down", "both"):
        raise OptionError([unknown("direction", section.direction, ("up", "down", "both"))])
    guards = {text for mode in model.modes for text in (mode.text, mode.signal)}
    if section.guard and section.guard not in guards:
        raise OptionError([unknown("guard", section.guard, guards)])
    for given in (section.period, section.since):
        read = names_of(parse(given)) if isinstance(given, str) else ()
        there = {*model.parameters, *CONSTANTS}
        wrong = [unknown("parameter", n, model.parameters) for n in read if n not in there]
        if wrong:
            raise OptionError(wrong)


def instants(
    section: Section, values: Mapping[str, float], begin: float, end: float
) -> tuple[Vector, float]:
    """The times of the multiples of the period (none without one), and the time of the first point.

    Raises OptionError where the period is not positive, or too small.
    """
    since = begin if section.since is None else _number(section.since, values)
    if section.period is None:
        return np.empty(0), since
    period = _number(section.period, values)
    if not period > 0 or (end - begin) / period > SAMPLE.most:
        what = f"a period of {period:g} s from {begin:g} to {end:g} s has no use"
        raise OptionError([Problem(what, hint="Give a larger period, above 0.")])
    last = np.floor((end - begin) / period + SAMPLE.close)
    times = np.minimum(begin + period * np.arange(last + 1), end)
    return times[times >= since - SAMPLE.close * period], since


def crossings(model: Model, section: Section, log: Matrix, since: float) -> Matrix:
    """The points (K, 1 + n) of a guard's section from the log of a run: time, then the states."""
    n, kept = len(model.states), guard_crossings(model, section.guard, section.direction, log)
    kept = kept[kept[:, 0] >= since]
    states = LOG_HEAD + n if section.after else LOG_HEAD
    return np.column_stack((kept[:, 0], kept[:, states : states + n]))


def guard_crossings(model: Model, guard: str, direction: Direction, log: Matrix) -> Matrix:
    """The rows of a log in which a guard crosses, one for each time that it does: a crossing may do
    several things."""
    named = [i for i, m in enumerate(model.modes) if guard in (m.text, m.signal)]
    way = {"up": [1], "down": [-1], "both": [1, -1]}[direction]
    rows = log[np.isin(log[:, 2], named) & np.isin(log[:, 3], way)]
    _, first = np.unique(rows[:, [0, 2]], axis=0, return_index=True)
    return np.asarray(rows[np.sort(first)])


def criterion_of(criterion: Callable[[Run], ArrayLike], run: Run) -> NDArray[np.float64]:
    """What a criterion makes of a run: a number () or an array. Raises SimulationError."""
    try:
        return np.array(criterion(run), dtype=float)
    except Exception as error:  # the user's function: it fails for its row only
        what = f"the criterion failed: {type(error).__name__}: {error}"
        raise SimulationError([Problem(what)]) from error


def _number(given: float | str, values: Mapping[str, float]) -> float:
    return evaluate(parse(given), values) if isinstance(given, str) else float(given)
