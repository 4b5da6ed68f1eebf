"""An exact solution of piecewise linear hybrid systems: a series between events, roots of it.

Between two events every mode is frozen and z' = A z, where z holds the states, the number 1, and a
sine and a cosine for each wave. Its Taylor series is summed in cells in which it has converged to
rounding; guards are linear in z, and their first roots in a cell are those of a polynomial. What
the theory leaves open (a guard that is only touched, two things at one instant, no unique mode)
raises `Unclear`: such a system judges nobody. Nothing here knows the product.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence

import numpy as np
from fuzz.elements import (
    CLOSE,
    Element,
    Guard,
    Play,
    Reader,
    Reset,
    Stop,
    Switch,
    System,
    Unclear,
    Wave,
    joined,
    same,
)
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
ORDER = 16
CELL = 0.5  # of 1/|A|: there a term of the series is below 1e-17 of the first one
POINTS = np.linspace(0.0, 1.0, 9)
EXPONENTS = np.arange(ORDER + 1)
POWERS = POINTS[None, :] ** EXPONENTS[:, None]
NEAR = np.linspace(0.0, 1.0, 129)
FINE = NEAR[None, :] ** EXPONENTS[:, None]
MOST_EVENTS = 400
ROUNDING = 1e-11  # of a guard that is held at zero
SOON = 1e-5  # after a reset: it may be one of a sequence without end
LAST_FLIGHTS = 1e-2  # before a body lies
FLIGHTS = 10  # times as long as the last flights: then a body lies, whatever its force has done
BEYOND = 1e-10  # a stop: what is more is no rounding
LOWEST = 2 * CLOSE  # a flight that rises no higher counts as lying


class Solution:
    """The solution of a system: `at(times)` are the values of z; `events` counts what happened.

    With `shared`, guards of several elements on one surface are passed together; else that is not
    clear.
    """

    def __init__(self, system: System, end: float, shared: bool = True) -> None:
        self.system, self.end, self.shared = system, end, shared
        self.t, self.z = 0.0, system.start.copy()
        self.pieces: list[tuple[float, float, Matrix]] = []  # begin, length, coefficients
        self.events = 0
        self.fired: dict[int, float] = {}  # when each reset has fired the last time
        self.cell = math.inf  # how long the next cell may be
        self.left_out: list[tuple[float, float]] = []  # the last flights before a body lies
        if shared:
            system.elements = joined(system.elements)
        for element in system.elements:
            element.begin(self.z)
        self.hold()
        for reader in self.readers():
            reader.begin(self.z)
        while self.t < end:
            self.advance(min(end, self.known()))
            self.events += 1
            if self.events > MOST_EVENTS:
                raise Unclear("many events")

    def at(self, times: Sequence[float]) -> Matrix:
        """z at ascending times (N, len z)."""
        found, number = [], 0
        for t in times:
            if any(begin < t < end for begin, end in self.left_out):
                raise Unclear("a time in the last flights of a body")
            while number + 1 < len(self.pieces) and self.pieces[number + 1][0] <= t:
                number += 1
            begin, length, series = self.pieces[number]
            found.append(series @ ((t - begin) / length) ** EXPONENTS)
        return np.array(found)

    def known(self) -> float:
        """The next known time."""
        later = [math.inf]
        for part in (*self.waves(), *self.system.clocks):
            period = part.half if isinstance(part, Wave) else part.period
            later.append((math.floor(self.t / period + 1e-9) + 1) * period)
        return min(later)

    def waves(self) -> list[Wave]:
        return [element for element in self.system.elements if isinstance(element, Wave)]

    def readers(self) -> list[Reader]:
        return [element for element in self.system.elements if isinstance(element, Reader)]

    def field(self, without: Sequence[Element] = ()) -> Matrix:
        """A with the modes as they stand."""
        matrix = self.system.matrix.copy()
        for element in self.system.elements:
            if not any(element is other for other in without):
                matrix += np.outer(element.into, element.output())
        for element in self.system.elements:
            if isinstance(element, Stop):
                element.force = matrix[element.v].copy()
                if element.side:
                    matrix[[element.x, element.v]] = 0.0
        return matrix

    def hold(self) -> None:
        """Let the switches that have met their surface cross it, or hold it."""
        switches = [e for e in self.system.elements if isinstance(e, Switch)]
        met = [s for s in switches if s.met]
        held = [s for s in switches if s.held is not None]
        if met:
            self.decide([s for s in switches if s.met or s.held is not None])
        elif not self.solve_held(held):
            raise Unclear("surfaces that their modes do not move any more")
        elif any(abs(float(np.asarray(s.held) @ self.z)) > s.stick for s in held):
            self.decide(held)  # a jump asks more of them than they can
        for switch in switches:
            switch.met = False

    def solve_held(self, held: Sequence[Switch]) -> bool:
        """Find the rows of the modes that hold these switches; whether there are any."""
        if not held:
            return True
        base = self.field(without=held)
        rows = np.array([s.row for s in held])
        ways = np.array([s.level * s.into for s in held])
        for stop in (e for e in self.system.elements if isinstance(e, Stop) and e.side):
            ways[:, [stop.x, stop.v]] = 0.0
        matrix = rows @ ways.T
        if abs(np.linalg.det(matrix)) < 1e-9:
            return False
        found = np.linalg.solve(matrix, -rows @ base)
        for switch, row in zip(held, found, strict=True):
            switch.held = row
        return True

    def decide(self, switches: Sequence[Switch]) -> None:
        """Which of these switches, all on their surfaces, hold, and which side the others take."""
        fits: list[tuple[int, tuple[int, ...]]] = []
        for modes in itertools.product((0, 1, -1), repeat=len(switches)):
            if not self.assign(switches, modes):
                continue
            rate = self.field() @ self.z
            good = True
            for switch, mode in zip(switches, modes, strict=True):
                if mode == 0:
                    need = abs(float(np.asarray(switch.held) @ self.z))
                    self.clear(need - switch.stick)
                    good = good and need < switch.stick
                else:
                    along = float(switch.row @ rate)
                    self.clear(along)
                    good = good and along * mode > 0
            if good:
                fits.append((modes.count(0), modes))
        most = max((count for count, _ in fits), default=-1)
        best = [modes for count, modes in fits if count == most]
        if len(best) != 1:
            raise Unclear(f"{len(best)} modes fit")
        self.assign(switches, best[0])
        for switch in switches:
            switch.left = switch.held is None

    def assign(self, switches: Sequence[Switch], modes: Sequence[int]) -> bool:
        """Give switches their modes; whether those that are to hold can."""
        for switch, mode in zip(switches, modes, strict=True):
            switch.mode, switch.held = mode, None
        return self.solve_held([s for s, mode in zip(switches, modes, strict=True) if mode == 0])

    def clear(self, value: float) -> None:
        if abs(value) < CLOSE:
            raise Unclear("a decision on the edge")

    def advance(self, limit: float) -> None:
        """Go on to the next event, at `limit` at the latest, and let it happen."""
        matrix = self.field()
        if self.taken_up(matrix @ self.z):
            return
        guards = [guard for element in self.system.elements for guard in element.guards()]
        rows = np.array([guard.row for guard in guards]).reshape(len(guards), len(self.z))
        values = rows @ self.z
        owners = [element for element in self.system.elements for _ in element.guards()]
        walls = np.array([isinstance(e, Stop) and not e.side for e in owners], dtype=bool)
        armed = values > CLOSE
        if np.any(values < -CLOSE):
            raise Unclear("a guard is passed where a piece begins")
        size = float(np.abs(matrix).sum(axis=1).max()) or 1.0
        powers = powers_of(matrix * (CELL / size))
        while self.t < limit:
            length = min(CELL / size, limit - self.t, self.cell)
            self.cell *= 2
            series = (powers @ self.z).T * (length * size / CELL) ** EXPONENTS
            samples = (rows @ series) @ POWERS  # (guards, points)
            fine = (rows[~armed] @ series) @ FINE
            below, above = fine < -CLOSE, fine > CLOSE
            if np.any(below.any(axis=1) & (below.argmax(axis=1) < first(above))):
                raise Unclear("a guard turns where a piece begins")
            if np.any(walls[~armed] & (fine.min(axis=1, initial=0.0) < -BEYOND)):
                raise Unclear("flights that are too low to be told")
            hits = self.hits(samples, dict(zip(np.flatnonzero(~armed), fine, strict=True)), armed)
            if hits:
                self.happen(guards, rows, series, length, hits, armed)
                return
            armed |= samples[:, -1] > CLOSE
            self.pieces.append((self.t, length, series))
            self.z = series.sum(axis=1)
            self.t = limit if length == limit - self.t else self.t + length
        self.scheduled()

    def taken_up(self, rate: Vector) -> bool:
        """Whether a play that stands at an end of its gap is taken along from there on."""
        for element in self.system.elements:
            if isinstance(element, Play) and element.mode == "free":
                for guard in element.guards():
                    if abs(guard.row @ self.z) < CLOSE and guard.row @ rate < -CLOSE:
                        guard.act()
                        return True
        return False

    def hits(
        self, samples: Matrix, fine: Mapping[int, Vector], armed: NDArray[np.bool_]
    ) -> list[int]:
        """The guards that are passed in a cell; `fine` are samples of those that are not armed."""
        found = []
        near = samples.min(axis=1, initial=np.inf) < 10 * np.ptp(samples, axis=1)
        for number in np.flatnonzero(near):
            line = samples[number]
            if not armed[number]:  # from where it has left zero
                line = fine[number][int(np.argmax(fine[number] > CLOSE)) :]
            if armed[number] or line[0] > CLOSE:
                low = int(np.argmin(line))
                least = line[low]
                if 0 < low < len(line) - 1:  # the bottom of a parabola
                    bend = line[low + 1] - 2 * line[low] + line[low - 1]
                    slope = (line[low + 1] - line[low - 1]) / 2
                    least -= slope**2 / (2 * bend) if bend > 0 else 0.0
                    if abs(least) < CLOSE:
                        raise Unclear("a guard is touched")
                if least < 0:
                    found.append(int(number))
                elif armed[number] and line[0] < CLOSE:
                    raise Unclear("a guard is touched")
        return found

    def happen(
        self,
        guards: list[Guard],
        rows: Matrix,
        series: Matrix,
        length: float,
        hits: list[int],
        armed: NDArray[np.bool_],
    ) -> None:
        """Go to the first of the guards that are passed in a cell, and let it act."""
        least = np.where(armed, -CLOSE, CLOSE)
        roots = sorted((self.root(rows[i] @ series, least[i]), i) for i in hits)
        part, first = roots[0]
        self.pieces.append((self.t, length, series))
        powers = part**EXPONENTS
        self.t += part * length
        self.z = series @ powers
        before = rows @ series[:, 0]
        due = (np.abs(rows @ self.z) < CLOSE) & (np.abs(before) > CLOSE)
        due[first] = True
        passed = np.flatnonzero(due)
        one = all(number in hits and same(rows[first], rows[number]) for number in passed)
        if not one or (len(passed) > 1 and not self.shared):
            raise Unclear("two things at one instant")
        for number in passed:  # surfaces that are one
            guards[number].act()
        self.react()

    def root(self, line: Vector, least: float) -> float:
        """The first root of a polynomial in (0, 1], behind where it is above `least`."""
        values = line @ FINE
        below = int(np.argmax((values < 0) & (np.maximum.accumulate(values) > least)))
        if values[below] >= 0:  # between two samples
            near = np.linspace(0, 1, 1001)
            values = np.polynomial.polynomial.polyval(near, line)
            below = int(np.argmax((values < 0) & (np.maximum.accumulate(values) > least)))
            if below == 0:
                raise Unclear("a guard is touched")
            low, high = near[below - 1], near[below]
        else:
            low, high = NEAR[below - 1], NEAR[below]
        for _ in range(60):
            middle = (low + high) / 2
            if float(np.polynomial.polynomial.polyval(middle, line)) > 0:
                low = middle
            else:
                high = middle
        return float(high)

    def scheduled(self) -> None:
        """What happens at a known time: waves turn, clocks write."""
        due: dict[int, Vector] = {}
        for wave in self.waves():
            number = self.t / wave.half
            if abs(number - round(number)) < 1e-9 and round(number) > 0:
                wave.value = 1 if round(number) % 2 == 0 else -1
        for clock in self.system.clocks:
            number = self.t / clock.period
            if abs(number - round(number)) < 1e-9 and round(number) > 0:
                due |= clock.rows
        self.write(due)
        self.throw()
        self.react()

    def throw(self) -> None:
        """A body that lies on a stop and has been given a rate leaves it, or strikes it."""
        for element in self.system.elements:
            if not isinstance(element, Stop) or not element.side or self.z[element.v] == 0.0:
                continue
            rate = element.side * self.z[element.v]
            if abs(rate) < CLOSE or self.t < element.still:
                raise Unclear("a body that is thrown while it comes to rest, or hardly")
            side = element.side
            element.release()
            if rate > 0:
                element.strike(side)

    def write(self, rows: dict[int, Vector]) -> None:
        before = self.z.copy()
        for place, row in rows.items():
            self.z[place] = float(row @ before)

    def react(self) -> None:
        """What follows at the same instant: impacts, resets, plays that let go, modes."""
        turned: set[int] = set()
        for _ in range(20):
            for element in self.system.elements:
                if isinstance(element, Play) and element.leaves:
                    self.z[element.at] = float(element.row @ self.z) - element.leaves * element.half
                    element.leaves = 0.0
                if isinstance(element, Stop) and element.hit:
                    self.strike(element)
            writes: dict[int, Vector] = {}
            before, fired = self.z.copy(), self.due()
            for reset in fired:
                if set(reset.rows) & set(writes):
                    raise Unclear("two resets of one state")
                if 0 < self.t - self.fired.get(id(reset), -math.inf) < SOON:
                    raise Unclear("resets that come ever closer")
                self.fired[id(reset)] = self.t
                reset.due = False
                writes |= reset.rows
            left = [e for e in self.system.elements if isinstance(e, Switch) and e.left]
            along = [float(switch.row @ (self.field() @ self.z)) for switch in left]
            self.write(writes)
            self.throw()
            moves = self.z - before
            if any(-CLOSE < float(r.guards()[0].row @ moves) < 0 for r in fired):
                raise Unclear("a reset that hardly moves its own guard back")
            self.carry([e for e in self.system.elements if not isinstance(e, Reset)])
            for switch, rate in zip(left, along, strict=True):
                after = float(switch.row @ (self.field() @ self.z))
                on_it = abs(float(switch.row @ self.z)) < CLOSE
                if on_it and abs(after - rate) > CLOSE:  # its load has changed: it may hold again
                    switch.met, switch.left = True, False
            self.hold()  # what a jump carries over zero fires when all modes stand still
            self.carry([e for e in self.system.elements if isinstance(e, Reset)])
            self.turn(turned)
            if not self.due():
                break
        else:
            raise Unclear("resets without end")
        for element in self.system.elements:
            if isinstance(element, Switch):
                element.left = False
            if isinstance(element, Stop) and element.side == 0 and self.t < element.still:
                raise Unclear("a body that is let go while it comes to rest")

    def due(self) -> list[Reset]:
        return [e for e in self.system.elements if isinstance(e, Reset) and e.due]

    def turn(self, turned: set[int]) -> None:
        """Refuse to judge a guard at zero that is turned back and, at the same instant, forward.

        `turned` are those that were turned back. The product lets such a guard fire again.
        """
        rate = self.field() @ self.z
        for reset in (e for e in self.system.elements if isinstance(e, Reset)):
            row = reset.guards()[0].row
            if abs(float(row @ self.z)) > CLOSE:
                continue
            if float(row @ rate) < CLOSE:
                turned.add(id(reset))
            elif id(reset) in turned:
                raise Unclear("a guard that is turned back and forward at one instant")

    def carry(self, elements: Sequence[Element]) -> None:
        """Let the guards act that a jump has carried over zero."""
        for element in elements:
            if isinstance(element, Switch) and element.held is not None:
                value = float(element.row @ self.z)
                if ROUNDING < abs(value) < CLOSE:
                    raise Unclear("a jump that hardly leaves a surface")
                if abs(value) > CLOSE:
                    element.held, element.mode = None, 1 if value > 0 else -1
                continue
            for _ in range(10):
                values = [float(guard.row @ self.z) for guard in element.guards()]
                if any(-CLOSE <= value < -ROUNDING for value in values):
                    raise Unclear("a jump that hardly passes a guard")
                passed = [n for n, value in enumerate(values) if value < -CLOSE]
                if not passed:
                    break
                if isinstance(element, Stop):
                    raise Unclear("a body beyond a stop")
                if isinstance(element, Switch):
                    element.mode = -element.mode
                else:
                    element.guards()[passed[0]].act()
                    if isinstance(element, Play) and element.leaves:
                        raise Unclear("a play that jumps")

    def strike(self, stop: Stop) -> None:
        side, stop.hit = stop.hit, 0
        self.z[stop.x] = stop.high if side > 0 else stop.low
        self.z[stop.v] *= -stop.restitution
        self.field()
        pressed = side * float(stop.force @ self.z)
        if pressed != 0 and self.z[stop.v] != 0:  # a quarter of the flight to come
            self.cell = abs(self.z[stop.v] / pressed) / 2
        if self.z[stop.v] ** 2 < 2 * LOWEST * abs(pressed) or self.z[stop.v] == 0.0:
            self.clear(pressed)
            if any(self.t - last < LAST_FLIGHTS for last in self.fired.values()):
                raise Unclear("resets at impacts that come to an end")
            if pressed > 0:
                rest = 2 * abs(self.z[stop.v]) / pressed / (1 - stop.restitution)
                self.left_out.append((self.t, self.t + rest))
                stop.still = self.t + FLIGHTS * rest
                self.z[stop.v], stop.side = 0.0, side
                self.lie(stop)

    def lie(self, stop: Stop) -> None:
        """A friction on the rate of a body that lies on a stop holds it there, up to sticking."""
        rate = np.eye(len(self.z))[stop.v]
        for switch in (e for e in self.system.elements if isinstance(e, Switch)):
            if not same(switch.row, rate):
                continue
            others = np.delete(switch.into, stop.v)
            if stop.lying or np.any(others != 0.0) or any(r.of is switch for r in self.readers()):
                raise Unclear("what a friction takes of a body on a stop")
            way = -stop.side if switch.row[stop.v] > 0 else stop.side  # in which the body leaves
            if -stop.side * way * switch.level * switch.into[stop.v] > 0:
                raise Unclear("a relay that drives a body away from a stop")
            switch.mode, switch.held, switch.lying = way, None, True
            stop.lying.append(switch)


def powers_of(matrix: Matrix) -> NDArray[np.float64]:
    """The terms of the series of exp(matrix), (ORDER + 1, n, n)."""
    found = np.empty((ORDER + 1, *matrix.shape))
    found[0] = np.eye(len(matrix))
    for k in range(1, ORDER + 1):
        found[k] = matrix @ found[k - 1] / k
    return found


def first(held: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The first column of each row that holds; past the last one where none does."""
    return np.where(held.any(axis=1), held.argmax(axis=1), held.shape[1])
