"""The search for an equilibrium: Newton's method inside the active mode, damped, guards respected.

Newton's step is shortened until the step that would follow it is the shorter one (the natural
monotonicity test: P. Deuflhard, Newton Methods for Nonlinear Problems, section 3.3), so that the
search follows the path along which all rates fall together, to the equilibrium at the end of it.
Where a guard reaches its level on the way, the step ends there: a contact is not passed, the body
lies on it from then on; at any other guard the modes are decided anew, and a slide holds.
"""

from __future__ import annotations

import numpy as np

from tracewire.analyse.limits import EQUILIBRIUM
from tracewire.array_types import Vector
from tracewire.errors import AnalysisError, Problem, SimulationError
from tracewire.solve import Passage

EPSILON = float(np.finfo(float).eps)


def state_sizes(passage: Passage) -> Vector:
    """Of what size the states are (n,): at a stop, and at the start values of the diagram."""
    t, x, n = passage.t, passage.x, len(passage.x)
    sizes = np.maximum(np.abs(x), passage.arrays.progress.sizes[n:])
    try:
        passage.begin_at(t, passage.declared_start)
        sizes = np.maximum(sizes, passage.arrays.progress.sizes[n:])
    except SimulationError:  # it says nothing then
        pass
    passage.begin_at(t, x)
    return sizes


def rate_sizes(passage: Passage, sizes: Vector) -> Vector:
    """What the rates at a stop are made of, in their units (n,): the sum of the parts of each."""
    x, n = passage.x, len(passage.x)
    both = np.concatenate([x, np.maximum(np.abs(x), sizes)])
    found = passage.value("rate_sizes", n, both, passage.t)
    return np.where(np.isfinite(found), found, 0.0)


def is_steady(passage: Passage, sizes: Vector) -> bool:
    """Whether all rates at a stop are zero, but for rounding."""
    return bool(np.all(np.abs(passage.rates()) <= EQUILIBRIUM.closed * rate_sizes(passage, sizes)))


def find_equilibrium(passage: Passage) -> None:
    """Lead a passage to the equilibrium next on the way of Newton's search from where it stands.

    Raises AnalysisError where the search ends without one, with the rates that are left.
    """
    _refuse_outside(passage)
    sizes, last = state_sizes(passage), -1
    for _ in range(EQUILIBRIUM.most_steps):
        if is_steady(passage, sizes):
            _Step(passage, sizes).finish()
            return
        last = _Step(passage, sizes).take(last)
    raise _not_found(passage, sizes)


class _Step:
    """One step of Newton's search from where a passage stands, with its modes as they are."""

    def __init__(self, passage: Passage, sizes: Vector) -> None:
        self.passage, self.x, self.t = passage, passage.x, passage.t
        self.modes = passage.modes
        self.sizes = sizes
        self.rows = _inverse(rate_sizes(passage, sizes))
        self.columns = np.maximum(np.abs(self.x), sizes)
        scaled = self.rows[:, None] * passage.slopes() * self.columns
        if not np.all(np.isfinite(scaled)):
            raise _not_found(passage, sizes)
        self.inverse = np.linalg.pinv(scaled, rcond=EQUILIBRIUM.rank)
        self.way = self.newton(passage.rates())

    def newton(self, rates: Vector) -> Vector:
        """Newton's step for these rates with the slopes of the beginning, the shortest one."""
        step: Vector = -self.columns * (self.inverse @ (self.rows * rates))
        return step

    def length(self, step: Vector) -> float:
        """The length of a step, in units of the states."""
        return float(np.linalg.norm(step / self.columns))

    def take(self, last: int) -> int:
        """Go as far as the rates fall and no guard is passed; the guard that was reached, -1: none.

        A guard that was reached by the `last` step too, from its other side, ends the search on it.
        """
        whole, part, ends = self.length(self.way), 1.0, ""
        while part >= EQUILIBRIUM.shortest and whole > 0:
            guard = self.passed(part)
            reach = part if guard < 0 else self.reached(guard, part)
            if guard >= 0 and reach < EQUILIBRIUM.shortest:
                reach = 0.0
            if reach == 0.0 or self.falls(reach):
                ends = self.goes_to(guard, reach, guard == last)
                if not ends:
                    return guard
                self.begin_at(self.x)
            part = reach / 2
        raise _not_found(self.passage, self.sizes, ends)

    def finish(self) -> None:
        """Take the whole step if the rates, which are zero but for rounding, fall with it; a state
        that is zero but for rounding of its size becomes zero."""
        before = self.length(self.way)
        after = self.length(self.newton(self.passage.rates_at(self.x + self.way)))
        if after < before and not self.passage.held and self.passed(1.0) < 0:
            at = self.x + self.way
            self.begin_at(np.where(np.abs(at) <= EPSILON * self.columns, 0.0, at))

    def falls(self, part: float) -> bool:
        """Whether the natural monotonicity test lets so much of the step pass, all along it."""
        for share in EQUILIBRIUM.along:
            some = share * part
            rates = self.passage.rates_at(self.x + some * self.way)
            if not np.all(np.isfinite(rates)):
                return False
            if self.length(self.newton(rates)) > (1 - some / 2) * self.length(self.way):
                return False
        return True

    def goes_to(self, guard: int, part: float, again: bool) -> str:
        """Stand after so much of the step; beyond a guard, or on it: a contact, or one that was
        passed from the other side by the last step. In words why that cannot be, "": it can."""
        passage, at = self.passage, self.x + part * self.way
        if guard < 0:
            self.begin_at(at)
            return ""
        mode = passage.model.modes[guard]
        resets = [reset for reset in passage.model.lowered.resets if reset.trigger == guard]
        if not (resets or again):
            beyond = part * (1 + EQUILIBRIUM.passed) + EQUILIBRIUM.shortest
            self.begin_at(self.x + beyond * self.way)
            return ""
        self.begin_at(self.on_surface(guard, at, with_rate=bool(resets)))
        if guard in passage.held or is_steady(passage, self.sizes):
            return ""
        why = f"where {resets[0].name} fires" if resets else "from where the rates lead back to it"
        return f"; the search ends where '{mode.text}' is zero, {why}"

    def begin_at(self, x: Vector) -> None:
        """Let the passage stand at other states, with modes decided anew."""
        try:
            self.passage.begin_at(self.t, x)
        except SimulationError as error:
            what = f"the search for a steady state ends: {error}"
            hint = "Give a guess nearer to it (guess=, --start); there may be none."
            raise AnalysisError([Problem(what, hint=hint)]) from error

    def margins(self, part: float) -> Vector:
        """How far the guards are inside their modes, over their size (M,); inf where held."""
        x, count = self.x + part * self.way, len(self.modes)
        guards = self.passage.value("guards", count, x, self.t)
        sizes = self.passage.value("guard_sizes", count, np.concatenate([x, self.columns]), self.t)
        inside = np.array([_inside(self.passage, i, guards[i]) for i in range(count)])
        inside[self.passage.held] = np.inf
        return np.asarray(inside * _inverse(sizes))

    def passed(self, part: float) -> int:
        """The guard that is passed first on so much of the step; -1: none."""
        if not len(self.modes):
            return -1
        beyond = np.flatnonzero(self.margins(part) < -EQUILIBRIUM.beyond).tolist()
        return min(beyond, key=lambda i: self.reached(i, part), default=-1)

    def reached(self, guard: int, part: float) -> float:
        """Where on the step a guard reaches its level, by bisection."""
        low, high = 0.0, part
        for _ in range(EQUILIBRIUM.halvings):
            middle = (low + high) / 2
            if self.margins(middle)[guard] < 0:
                high = middle
            else:
                low = middle
        return high

    def on_surface(self, guard: int, x: Vector, *, with_rate: bool) -> Vector:
        """The point beside x where a guard, and its rate, are zero."""
        count, n = len(self.modes), len(x)
        for _ in range(EQUILIBRIUM.most_corrections):
            value = self.passage.value("guards", count, x, self.t)[guard]
            rows = self.passage.value("guard_gradients", count * n, x, self.t)
            x = x + self.back(rows.reshape(count, n)[guard], value)
            if with_rate:
                value = self.passage.value("guard_rates", count, x, self.t)[guard]
                rows = self.passage.value("guard_curves", count * (n + 1), x, self.t)
                x = x + self.back(rows.reshape(count, n + 1)[guard, :n], value)
        return x

    def back(self, gradient: Vector, value: float) -> Vector:
        """The shortest change of the states that takes a value to zero."""
        way = self.columns**2 * gradient
        square = float(gradient @ way)
        return -way * (value / square) if square > 0 else np.zeros(len(way))


def _inverse(sizes: Vector) -> Vector:
    """1/size, 1 where there is none."""
    known = np.isfinite(sizes) & (sizes > 0)
    return 1.0 / np.where(known, sizes, 1.0)


def _inside(passage: Passage, i: int, guard: float) -> float:
    """How far the value of a guard is inside the range of its mode; inf: no value decides it."""
    mode, value = passage.model.modes[i], passage.modes[i]
    if mode.timed is not None or mode.kind == "memory":
        return np.inf
    if mode.kind == "sign":
        return guard if value > 0.5 else -guard
    if mode.kind == "floor":
        return float(min(guard - value, value + 1.0 - guard))
    k = passage.arrays.flow.k
    begin = int(k[passage.arrays.plan.table[i]])
    points = np.concatenate([[-np.inf], k[begin + 1 : begin + 1 + int(k[begin])], [np.inf]])
    return float(min(guard - points[int(value)], points[int(value) + 1] - guard))


def _refuse_outside(passage: Passage) -> None:
    """Raises AnalysisError where the search would begin beyond a contact."""
    model, x, t = passage.model, passage.x, passage.t
    guards = passage.value("guards", len(model.modes), x, t)
    for reset in model.lowered.resets:
        i = reset.trigger
        if reset.kind != "impact" or i in passage.held:
            continue
        size = 1e-9 * float(np.abs(x).max(initial=0.0))
        side = guards[i] if reset.direction == "up" else -guards[i]
        if side > size:
            what = f"the start lies beyond a contact: '{model.modes[i].text}' is {guards[i]:.6g}"
            hint = f"Give a start on the near side of {reset.name} (guess=, --start)."
            raise AnalysisError([Problem(what, hint=hint)])


def describe_rates(passage: Passage, sizes: Vector) -> str:
    """In words: the rates at a stop that are not zero, the largest ones first."""
    rates, closed = passage.rates(), EQUILIBRIUM.closed * rate_sizes(passage, sizes)
    parts = np.abs(rates) * _inverse(closed)
    order = [int(i) for i in np.argsort(-parts) if abs(rates[i]) > closed[i]]
    names = passage.model.states
    listed = ", ".join(f"{names[i]}' = {rates[i]:.6g}" for i in order[: EQUILIBRIUM.most_told])
    return f"the rates are {listed}{', ...' if len(order) > EQUILIBRIUM.most_told else ''}"


def _not_found(passage: Passage, sizes: Vector, more: str = "") -> AnalysisError:
    states = zip(passage.model.states, passage.x.tolist(), strict=True)
    where = ", ".join(f"{name} = {x:.6g}" for name, x in states)
    what = f"no steady state was found: at {where} {describe_rates(passage, sizes)}{more}"
    hint = "Give a guess nearer to it (guess=, --start); there may be none."
    return AnalysisError([Problem(what, hint=hint)])
