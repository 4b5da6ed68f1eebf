"""The smooth flow between two events: rates with frozen modes, and Filippov's blend on a slide."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Function, Model

Vector = NDArray[np.float64]
DIFFERENCE = 1e-7
AFFINE = 1e-9
SINGULAR = 1e10


@dataclass(frozen=True, eq=False)
class Rest:
    """A contact that is held: the mode of its guard, and how its force acts on the rates (n,)."""

    mode: int
    push: Vector


class Flow:
    """The field of a model for one set of parameters; its modes are the discrete state of a run.

    `modes[i]` is the frozen value of mode i, `holds[i]` is 1 while a dry friction holds guard i at
    zero, and `sliding` lists the modes on whose surface the run slides: there the field is
    sum over patterns of (product of m or 1 - m) times the frozen field, with the fractions m for
    which every sliding guard keeps d(guard)/dt = 0. `rests` are contacts that are held closed: the
    field gets force times push, with the forces for which d2(guard)/dt2 = 0.
    """

    def __init__(self, model: Model, parameters: Vector, tables: Sequence[Any]) -> None:
        self.model = model
        self.functions: Mapping[str, Function] = model.functions
        self.parameters = parameters.tolist()
        self.tables = tables
        self.constants = self.functions["prepare"](self.parameters)
        self.modes: list[float] = [float(mode.at_zero) for mode in model.modes]
        self.holds: list[float] = [0.0] * len(model.modes)
        self.sliding: tuple[int, ...] = ()
        self.rests: tuple[Rest, ...] = ()
        self.evaluations = 0
        self._rhs = self.functions["rhs"]
        self._guards = self.functions["guards"]

    def call(self, name: str, t: float, x: Vector) -> tuple[float, ...]:
        """One of the model's functions with the modes as they stand."""
        frozen = (self.modes, self.holds)
        return self.functions[name](t, x.tolist(), frozen, self.constants, self.tables)

    def rates(self, t: float, x: Vector) -> Vector:
        """dx/dt with frozen modes; on a slide or in a contact the field that stays there."""
        self.evaluations += 1
        if self.sliding or self.rests:
            return self.blend(t, x)
        frozen = (self.modes, self.holds)
        return np.array(self._rhs(t, x.tolist(), frozen, self.constants, self.tables))

    def guards(self, t: float, x: Vector) -> tuple[float, ...]:
        """The guards of all modes."""
        frozen = (self.modes, self.holds)
        return self._guards(t, x.tolist(), frozen, self.constants, self.tables)

    def patterns(self, name: str, t: float, x: Vector) -> tuple[Vector, Vector]:
        """A function at all sliding modes 0, and its change as each of them becomes 1."""
        for i in self.sliding:
            self.modes[i] = 0.0
        base = np.array(self.call(name, t, x))
        changes = np.empty((len(self.sliding), len(base)))
        for row, i in enumerate(self.sliding):
            self.modes[i] = 1.0
            changes[row] = np.array(self.call(name, t, x)) - base
            self.modes[i] = 0.0
        return base, changes

    def held(self, t: float, x: Vector) -> tuple[Vector, Vector]:
        """The fractions of the slide and the forces of the contacts; NaN where none hold it."""
        base, changes = self.patterns("guard_rates", t, x)
        chosen = list(self.sliding)
        matrix, right = changes[:, chosen].T, -base[chosen]
        if self.rests:
            field, bends = self.patterns("rhs", t, x)
            pushes = np.stack([rest.push for rest in self.rests])
            curves = [self.curve(t, x, rest.mode) for rest in self.rests]
            slopes = np.stack([slope for slope, _ in curves])
            late = np.array([late for _, late in curves])
            side = self.gradients(t, x)[chosen] @ pushes.T
            matrix = np.block([[matrix, side], [slopes @ bends.T, slopes @ pushes.T]])
            right = np.concatenate((right, -(slopes @ field + late)))
        try:
            solved = np.linalg.solve(matrix, right)
        except np.linalg.LinAlgError:
            solved = np.full(len(right), np.nan)
        held = np.asarray(solved, dtype=float)
        return held[: len(chosen)], held[len(chosen) :]

    def fractions(self, t: float, x: Vector) -> Vector:
        """The fractions m of the slide, shape (number of surfaces,); NaN where none holds it."""
        return self.held(t, x)[0]

    def push(self, forces: Vector) -> Vector:
        """What the contacts add to the rates."""
        pushes = (f * rest.push for f, rest in zip(forces, self.rests, strict=True))
        return np.asarray(sum(pushes, np.zeros(len(self.model.states))))

    def blend(self, t: float, x: Vector) -> Vector:
        """The rates on a slide and in a contact."""
        fractions, forces = self.held(t, x)
        base, changes = self.patterns("rhs", t, x)
        return np.asarray(base + fractions @ changes + self.push(forces))

    def curve(self, t: float, x: Vector, mode: int) -> tuple[Vector, float]:
        """The gradient of a guard's rate in the states (n,), and its change with t alone."""
        *slope, late = self._extra(self.model.guard_curve(mode), t, x)
        return np.array(slope), late

    def gradients(self, t: float, x: Vector) -> Vector:
        """The gradients of all guards in the states, shape (number of modes, n)."""
        values = self._extra(self.model.guard_gradients, t, x)
        return np.array(values).reshape(len(self.modes), len(x))

    def _extra(self, function: Function, t: float, x: Vector) -> tuple[float, ...]:
        frozen = (self.modes, self.holds)
        return function(t, x.tolist(), frozen, self.parameters, self.tables)

    def is_independent(self, t: float, x: Vector) -> bool:
        """Whether the sliding modes move their guards independently, so that one slide fits."""
        if len(self.sliding) < 2:
            return True
        _, changes = self.patterns("guard_rates", t, x)
        matrix = changes[:, list(self.sliding)].T
        matrix = matrix / np.max(np.abs(matrix), axis=1, keepdims=True)
        return bool(np.linalg.cond(matrix) < SINGULAR)

    def is_affine(self, t: float, x: Vector) -> bool:
        """Whether the rates are affine in the sliding modes, so that the blend is Filippov's."""
        base, changes = self.patterns("rhs", t, x)
        for i in self.sliding:
            self.modes[i] = 1.0
        corner = np.array(self.call("rhs", t, x))
        for i in self.sliding:
            self.modes[i] = 0.0
        size = float(np.max(np.abs(changes), initial=0.0))
        return bool(np.all(np.abs(corner - base - changes.sum(axis=0)) <= AFFINE * size))

    def outputs(self, t: float, x: Vector) -> Vector:
        """The recorded signals."""
        if not self.sliding:
            return np.array(self.call("outputs", t, x))
        fractions = self.fractions(t, x)
        base, changes = self.patterns("outputs", t, x)
        return base + fractions @ changes

    def guard_rates(self, t: float, x: Vector) -> Vector:
        """d(guard)/dt along the flow, for all modes."""
        if not (self.sliding or self.rests):
            return np.array(self.call("guard_rates", t, x))
        fractions, forces = self.held(t, x)
        base, changes = self.patterns("guard_rates", t, x)
        rates = base + fractions @ changes
        return rates + self.gradients(t, x) @ self.push(forces) if self.rests else rates

    def jacobian(self, t: float, x: Vector) -> tuple[Vector, Vector]:
        """d rates / dx and d rates / dt; exact from the tape, by differences on a slide."""
        n = len(x)
        if not (self.sliding or self.rests):
            both = np.array(self._extra(self.model.jacobian, t, x)).reshape(n, n + 1)
            return both[:, :n], both[:, n]
        base = self.rates(t, x)
        matrix = np.empty((n, n))
        for j in range(n):
            moved = x.copy()
            moved[j] += DIFFERENCE * max(1.0, abs(x[j]))
            matrix[:, j] = (self.rates(t, moved) - base) / (moved[j] - x[j])
        later = t + DIFFERENCE
        return matrix, (self.rates(later, x) - base) / (later - t)

    def is_bound(self, mode: int) -> bool:
        """Whether the guard of a mode is held at zero, by a slide or by a contact."""
        return mode in self.sliding or any(rest.mode == mode for rest in self.rests)

    def release(self, modes: Collection[int]) -> None:
        """Let contacts go."""
        self.rests = tuple(rest for rest in self.rests if rest.mode not in modes)

    def key(self) -> tuple[object, ...]:
        """What identifies the mode combination."""
        resting = tuple(rest.mode for rest in self.rests)
        return (tuple(self.modes), tuple(self.holds), self.sliding, resting)
