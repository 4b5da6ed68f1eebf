"""The event loop: steps with frozen modes up to the next event, then the event, then again."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tracewire.solve.flow import Flow
from tracewire.solve.limits import Guardian, Limits
from tracewire.solve.locate import Found, Watch, Watched
from tracewire.solve.methods import DormandPrince, Method, Rosenbrock, Step
from tracewire.solve.record import Recorder
from tracewire.solve.schedule import Schedule
from tracewire.solve.settle import settle
from tracewire.solve.transition import Crossing, Transition

Vector = NDArray[np.float64]
STIFF = 3.0  # h times the largest eigenvalue at the edge of stability of the explicit method
STIFF_STEPS = 8
CALM_STEPS = 6
POLISH = 3
TOGETHER = 1e-12
AT_ONCE = 1e-9
NEAR = 32.0
METHODS: dict[str, Method] = {"dormand_prince": DormandPrince(), "rosenbrock": Rosenbrock()}


class Integration:
    """One run of a flow from t0 to t1; samples and events go to the recorder."""

    def __init__(
        self,
        flow: Flow,
        span: tuple[float, float],
        recorder: Recorder,
        method: str,
        tolerances: tuple[float, float],
        limits: Limits,
    ) -> None:
        self.flow, self.recorder, self.name = flow, recorder, method
        self.t, self.end = span
        self.rtol, self.atol = tolerances
        self.length = self.end - self.t
        self.guardian = Guardian(flow, self.length, limits)
        self.schedule = Schedule(flow)
        self.transition = Transition(flow, recorder, self.guardian)
        self.stiff: set[tuple[object, ...]] = set()
        self.suspicious = 0
        self.calm = 0
        self.warnings: list[str] = []
        self.h = 0.0

    def run(self, x: Vector) -> Vector:
        """Integrate to the end; the final states."""
        with np.errstate(all="ignore"):  # what is not finite is a rejected step
            return self.whole(x)

    def whole(self, x: Vector) -> Vector:
        """The start, all that happens between, and the last samples; the final states."""
        self.schedule.begin(self.t)
        if not settle(self.flow, self.t, x, fresh=True):
            self.warnings.append(f"the start at t = {self.t:g} s is not unique: two modes fit it")
        self.warnings += self.transition.overlooked(self.t, x)
        self.check_finite(x)
        while self.t < self.end:
            x = self.smooth(x)
        self.recorder.last(self.t, x)
        return x

    def check_finite(self, x: Vector) -> None:
        """Refuse rates that are not finite where the run begins."""
        if not np.isfinite(self.flow.rates(self.t, x)).all():
            name, value = self.guardian.not_finite(self.t, x)
            hint = "Look for a division by zero, the root of a negative number, or a bad parameter."
            what = f"'{name or 'a rate'}' is not finite ({value})"
            raise self.guardian.stopped(self.t, x, what, hint, name)

    def smooth(self, x: Vector) -> Vector:
        """Steps until something happens, and what happens; the states after it."""
        watch = Watch(self.flow)
        margins = watch.margins(self.t, x)
        due, changes = self.schedule.next(self.t)
        limit = min(due, self.end)
        rate = self.flow.rates(self.t, x)
        if self.h <= 0.0 and limit > self.t:
            self.h = self.first_step(x, rate, limit)
        while self.t < limit:
            method = self.method()
            step, ratio = self.trial(method, x, rate, limit)
            if ratio == 0.0:
                return self.undefined(watch, step, margins)
            found = watch.find(method, step, margins)
            if found is not None and found.at_once:
                if step.h > AT_ONCE * self.length:
                    self.h = step.h / 16
                    continue
                found = Found(1.0, found.watched)
            if found is not None:
                return self.crossed(method, watch, step, rate, found)
            self.recorder.inside(method, step, step.t + step.h)
            last = step.t + step.h >= limit
            self.t = limit if last else step.t + step.h
            x = step.x_end
            self.h = max(self.h, step.h * ratio) if last else step.h * ratio
            rate = step.rate_end if step.rate_end is not None else self.flow.rates(self.t, x)
            margins = watch.margins(self.t, x)
        if limit == due:
            x = self.scheduled(x, changes)
        return x

    def method(self) -> Method:
        """The method for this mode combination."""
        if self.name != "auto":
            return METHODS[self.name]
        return METHODS["rosenbrock" if self.flow.key() in self.stiff else "dormand_prince"]

    def scale(self, x: Vector, other: Vector) -> Vector:
        """What an error of one is measured in, for each state."""
        return np.asarray(self.atol + self.rtol * np.maximum(np.abs(x), np.abs(other)))

    def first_step(self, x: Vector, rate: Vector, limit: float) -> float:
        """Hairer's starting step for a method of order 5 (Solving ODEs I, section II.4)."""
        scale = self.scale(x, x)
        size, speed = _norm(x / scale), _norm(rate / scale)
        h = 1e-6 * self.length if size < 1e-5 or speed < 1e-5 else 0.01 * size / speed
        h = min(h, limit - self.t)
        moved = self.flow.rates(self.t + h, x + h * rate)
        bend = _norm((moved - rate) / scale) / h
        if not math.isfinite(bend):
            return h * 1e-3
        largest = max(bend, speed)
        after = max(1e-6 * self.length, h * 1e-3) if largest <= 1e-15 else (0.01 / largest) ** 0.2
        return min(100 * h, after, self.length)

    def trial(self, method: Method, x: Vector, rate: Vector, limit: float) -> tuple[Step, float]:
        """A step within the tolerances and the factor for the next one.

        Where the rates are undefined however small the step is, the last trial and the factor 0.
        Raises SimulationError where the error stays large.
        """
        while True:
            self.guardian.tried(self.t, x)
            h = min(self.h, self.length / 10)
            if self.t + h * 1.01 >= limit:
                h = limit - self.t
            step = method.step(self.flow, self.t, x, rate, h)
            scale = self.scale(x, step.x_end)
            error = _norm(step.error / scale)
            if error <= 1.0:
                self.watch_stiffness(step)
                self.guardian.stiff_steps += isinstance(method, Rosenbrock)
                return step, min(6.0, max(0.2, 0.9 * max(error, 1e-10) ** -0.2))
            self.guardian.rejected += 1
            self.h = h * (max(0.1, 0.9 * error**-0.2) if math.isfinite(error) else 0.1)
            if self.h < self.guardian.smallest_step(self.t):
                if math.isfinite(error):
                    raise self.guardian.underflow(self.t, x, step, scale)
                return step, 0.0

    def undefined(self, watch: Watch, step: Step, margins: Vector) -> Vector:
        """Where the rates end to be defined: at a guard it is an event, elsewhere an error."""
        x = step.x
        reach = NEAR * self.guardian.smallest_step(self.t)
        near = watch.reached(self.t, x, margins, reach)
        if not near:
            raise self.guardian.underflow(self.t, x, step, self.scale(x, x))
        self.h = 0.0
        return self.transition.happen(self.t, x, [_crossing(item) for item in near])

    def watch_stiffness(self, step: Step) -> None:
        """After enough steps at the edge of stability this mode combination is called stiff."""
        if self.name != "auto":
            return
        if step.stiffness > STIFF:
            self.suspicious, self.calm = self.suspicious + 1, 0
        else:
            self.calm += 1
            if self.calm == CALM_STEPS:
                self.suspicious = 0
        if self.suspicious >= STIFF_STEPS:
            self.stiff.add(self.flow.key())
            self.suspicious = 0

    def crossed(
        self, method: Method, watch: Watch, step: Step, rate: Vector, found: Found
    ) -> Vector:
        """Go to the located time, fire what happens there; the states after it."""
        first = watch.items[found.watched[0]]
        part = self.polished(method, step, rate, found.theta, first)
        self.recorder.inside(method, part, part.t + part.h)
        self.t = part.t + part.h
        x = part.x_end
        fired = {watch.items[i].mode: watch.items[i] for i in found.watched}
        margins = watch.margins(self.t, x)
        for item in watch.reached(self.t, x, margins, TOGETHER * self.length):
            fired.setdefault(item.mode, item)
        after = self.transition.happen(self.t, x, [_crossing(item) for item in fired.values()])
        self.h = self.h / 4 if np.array_equal(x, after) else 0.0
        self.suspicious = 0
        return after

    def polished(
        self, method: Method, step: Step, rate: Vector, theta: float, item: Watched
    ) -> Step:
        """A step that ends at the crossing: located on the polynomial, then on true steps."""
        h = max(theta * step.h, self.guardian.smallest_step(step.t))
        part = method.step(self.flow, step.t, step.x, rate, h)
        if item.kind != "guard" or not np.isfinite(part.x_end).all():
            return part
        for _ in range(POLISH):
            t = step.t + part.h
            margin = self.flow.guards(t, part.x_end)[item.mode] - item.level
            slope = self.flow.guard_rates(t, part.x_end)[item.mode]
            change = -margin / slope if slope else 0.0
            if abs(change) <= 1e-14 * self.length or not 0 < part.h + change <= step.h:
                break
            if abs(change) > 0.1 * step.h:
                break
            part = method.step(self.flow, step.t, step.x, rate, part.h + change)
        return part

    def scheduled(self, x: Vector, changes: list[tuple[int, float]]) -> Vector:
        """Change timed modes, and settle the others in the new field; the states after it."""
        modes = self.flow.modes
        crossings = [Crossing(i, value, value > modes[i], "timed") for i, value in changes]
        after = self.transition.happen(self.t, x, crossings)
        if any(self.flow.model.modes[i].kind != "segment" for i, _ in changes):
            self.h = 0.0
        return after


def _crossing(item: Watched) -> Crossing:
    up = item.sign < 0 if item.kind == "guard" else item.to > 0.5
    return Crossing(item.mode, item.to, up, item.kind)


def _norm(scaled: Vector) -> float:
    return math.sqrt(float(scaled @ scaled) / max(len(scaled), 1))
