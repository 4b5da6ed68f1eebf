"""Exact enough motion with dry friction: segments between stick and slip, by scipy alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks.tracing.laws import At, Hidden
from benchmarks.tracing.plants import Plant, Values

Array = NDArray[np.float64]
TINY = 1e-300
MOST_SEGMENTS = 20000


@dataclass(frozen=True)
class Drive:
    """sum of amplitude*sin(omega*t + phase)."""

    amplitude: tuple[float, ...] = ()
    omega: tuple[float, ...] = ()
    phase: tuple[float, ...] = ()

    def __call__(self, t: float) -> float:
        return sum(
            a * math.sin(w * t + p)
            for a, w, p in zip(self.amplitude, self.omega, self.phase, strict=True)
        )


class Unmodelled(Protocol):
    """A force at the first place that no block of the library has, with `states` of its own."""

    @property
    def states(self) -> int:
        """How many."""

    def force(self, at: At, z: Sequence[float]) -> float:
        """The force now."""

    def rates(self, at: At, z: Sequence[float]) -> list[float]:
        """The rates of its states."""

    def begin(self, q: float, v: float) -> list[float]:
        """Its states at the start of a record."""


class Motion:
    """A plant with hidden effects under a drive; `noise` is a random force at the first place.

    `floor` is a force that depends on the state. With `control` (kp, kd) the drive is the reference
    of a controller at the first place: u = kp*(drive - q) - kd*v.
    """

    def __init__(
        self,
        plant: Plant,
        values: Values,
        hidden: Sequence[Hidden],
        drive: Drive,
        noise: Callable[[float], float] | None = None,
        floor: Unmodelled | None = None,
        control: tuple[float, float] | None = None,
    ) -> None:
        self.plant, self.values, self.drive, self.noise = plant, values, drive, noise
        self.floor, self.control = floor, control
        self.n = len(plant.coordinates)
        self.acting = [h for h in hidden if h.effect.kind in ("sum", "drive")]
        self.memories = [h for h in self.acting if h.effect.memory or h.name == "drive_lag"]
        self.declared = plant.levels(values)
        self.rubs = [
            self.declared[i] > 0
            or any(h.effect.level and not h.width and h.place == i for h in self.acting)
            for i in range(self.n)
        ]
        gain = plant.gain(values)
        masses = np.zeros(self.n)
        for h in hidden:
            if h.effect.kind == "mass" and isinstance(h.place, int):
                masses[h.place] += h.coefficient
        self.gain = np.linalg.solve(np.eye(self.n) + gain @ np.diag(masses), gain)
        self.rows: list[list[float]] = self.gain.tolist()

    def at(self, t: float, y: Sequence[float], place: int, u: float, z: float) -> At:
        n, other = self.n, 1 - place if self.n == 2 else place
        d = self.drive
        omega, phase = (d.omega[0], d.phase[0]) if d.omega else (0.0, 0.0)
        return At(t, y[place], y[n + place], u, y[other], y[n + other], z, omega, omega * t + phase)

    def driven(self, t: float, y: Sequence[float]) -> float:
        """What drives the plant: the drive itself, or a controller that follows it."""
        if not self.control:
            return self.drive(t)
        kp, kd = self.control
        return kp * (self.drive(t) - y[0]) - kd * y[self.n]

    def torques(self, t: float, y: Sequence[float]) -> tuple[list[float], list[float], list[float]]:
        """Forces without set-valued friction, its levels, and the rates of memory states."""
        n = self.n
        measured = u = self.driven(t, y)
        rates, zs = [], {}
        for number, h in enumerate(self.memories):
            z = y[2 * n + number]
            zs[id(h)] = z
            if h.name == "drive_lag":
                rates.append((measured - z) / h.coefficient)
                u += z - measured
            else:
                assert h.effect.memory is not None and isinstance(h.place, int)
                rates.append(h.effect.memory(self.at(t, y, h.place, u, z), h.shapes))
        for h in self.acting:
            if h.effect.kind == "drive" and h.effect.force:
                u += h.coefficient * h.effect.force(self.at(t, y, 0, measured, 0.0), h.shapes)
        force = self.plant.forces(self.values, list(y[:n]), list(y[n : 2 * n]), u)
        level = list(self.declared)
        for h in self.acting:
            if h.effect.kind != "sum" or not isinstance(h.place, int):
                continue
            at = self.at(t, y, h.place, measured, zs.get(id(h), 0.0))
            if h.effect.force:
                force[h.place] += h.coefficient * h.effect.force(at, h.shapes)
            if h.effect.level:
                size = h.coefficient * h.effect.level(at, h.shapes)
                if h.width:
                    force[h.place] -= size * math.tanh(at.v / h.width)
                else:
                    level[h.place] += size
        if self.noise:
            force[0] += self.noise(t)
        if self.floor:
            at, own = self.at(t, y, 0, measured, 0.0), y[2 * n + len(self.memories) :]
            force[0] += self.floor.force(at, own)
            rates += self.floor.rates(at, own)
        return force, level, rates

    def solved(
        self, t: float, y: Sequence[float], modes: Sequence[int]
    ) -> tuple[list[float], list[float], list[float], list[float]]:
        """Accelerations, friction while stuck (by place), levels, rates of memory states."""
        force, level, rates = self.torques(t, y)
        stuck = [i for i in range(self.n) if self.rubs[i] and modes[i] == 0]
        for i in range(self.n):
            if self.rubs[i]:
                force[i] -= modes[i] * level[i]
        held = [0.0] * self.n
        a = self.turned(force)
        if stuck:
            f = np.linalg.solve(self.gain[np.ix_(stuck, stuck)], [-a[i] for i in stuck])
            for i, value in zip(stuck, f, strict=True):
                force[i] += float(value)
                held[i] = float(value)
            a = self.turned(force)
            for i in stuck:
                a[i] = 0.0
        return a, held, level, rates

    def turned(self, force: Sequence[float]) -> list[float]:
        """gain @ force, in plain numbers: faster for one or two."""
        return [sum(g * f for g, f in zip(row, force, strict=True)) for row in self.rows]

    def run(self, start: Sequence[float], times: Array, begin: float, rtol: float = 1e-9) -> Array:
        """The states (N, 2n + memories) at `times` [s] from `start` at `begin`."""
        n = self.n
        own = self.floor.states if self.floor else 0
        y = np.concatenate([start, np.zeros(len(self.memories) + own)])
        for number, h in enumerate(self.memories):
            if h.name == "drive_lag":
                y[2 * n + number] = self.drive(begin)
            elif h.name == "maxwell" and isinstance(h.place, int):
                y[2 * n + number] = y[h.place]
        if self.floor:  # what follows the body begins where the body is
            y[2 * n + len(self.memories) :] = self.floor.begin(y[0], y[n])
        modes = [
            (self.mode_at_rest(begin, y, [1] * n, i) if y[n + i] == 0 else int(np.sign(y[n + i])))
            if self.rubs[i]
            else 1
            for i in range(n)
        ]
        out = np.empty((len(times), len(y)))
        filled, t, end = 0, begin, float(times[-1])
        for _ in range(MOST_SEGMENTS):
            run: Any = solve_ivp(
                self.rhs(modes),
                (t, end),
                y,
                method="LSODA" if self.plant.stiff else "DOP853",
                t_eval=times[filled:],
                events=self.events(modes, t) or None,
                rtol=rtol,
                atol=1e-3 * rtol,
                max_step=0.03 if rtol < 1e-8 else 0.1,
            )
            if not run.success:
                raise RuntimeError(f"segment from t={t}: {run.message}")
            count = run.y.shape[1] if len(run.t) else 0
            out[filled : filled + count] = run.y[:, :count].T if count else 0
            filled += count
            if run.status == 0 or filled == len(times):
                return out
            which = next(k for k, hit in enumerate(run.t_events) if hit.size)
            i = [k for k in range(n) if self.rubs[k]][which]
            t, y = float(run.t_events[which][0]), np.array(run.y_events[which][0])
            y[n + i] = 0.0
            if modes[i] == 0:
                _, held, _, _ = self.solved(t, y.tolist(), modes)
                modes[i] = -int(math.copysign(1, held[i]))
            else:
                modes[i] = self.mode_at_rest(t, y, modes, i)
        raise RuntimeError("too many segments")

    def mode_at_rest(self, t: float, y: Array, modes: Sequence[int], i: int) -> int:
        """0 where friction can hold body i, else the direction in which it goes."""
        tried = [*modes[:i], 0, *modes[i + 1 :]]
        _, held, level, _ = self.solved(t, y.tolist(), tried)
        return 0 if abs(held[i]) <= level[i] else -int(math.copysign(1, held[i]))

    def rhs(self, modes: Sequence[int]) -> Callable[[float, Array], list[float]]:
        n, frozen = self.n, list(modes)

        def rates(t: float, y: Array) -> list[float]:
            x = y.tolist()
            a, _, _, memory = self.solved(t, x, frozen)
            return [*x[n : 2 * n], *a, *memory]

        return rates

    def events(self, modes: Sequence[int], begin: float) -> list[Any]:
        n, frozen = self.n, list(modes)

        def made(i: int) -> Any:
            def event(t: float, y: Array) -> float:
                if frozen[i]:
                    value = frozen[i] * float(y[n + i])
                else:
                    _, held, level, _ = self.solved(t, y.tolist(), frozen)
                    value = level[i] - abs(held[i])
                return max(value, TINY) if t == begin else value

            event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
            return event

        return [made(i) for i in range(n) if self.rubs[i]]
