"""Segments of a series near some unknowns: residuals and derivatives, from runs together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate, pairwise
from typing import NamedTuple

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import Problem, SimulationError
from tracewire.residual.limits import CRITERION, WINDOW
from tracewire.residual.measured import Measured
from tracewire.residual.observation import ObservationModel
from tracewire.residual.segment import (
    Segment,
    absolute_tolerances,
    is_of_sensor,
    of_diagram,
    parameter_in,
)
from tracewire.solve import Interrupted, Limits, Span, SpanProblem, SpanRuns, StopFlag, span_problem

Names = list[tuple[str, ...]]


@dataclass(frozen=True, eq=False)
class Projection:
    """A segment without what its start can explain: an orthonormal `basis` of that, (N*signals, r),
    and by which start it is explained, `starts` (states, r)."""

    basis: Matrix
    starts: Matrix

    def start_of(self, column: Vector) -> Vector:
        """The start that explains most of a column (N*signals,), by least squares: (states,)."""
        return np.asarray(self.starts @ (self.basis.T @ column))

    def project_out(self, columns: Matrix) -> Matrix:
        """Columns without what the start can explain."""
        return np.asarray(columns - self.basis @ (self.basis.T @ columns))


@dataclass(frozen=True, eq=False)
class Linearisation:
    """A segment near some unknowns: residuals (N, signals) in sigma, their derivatives `slopes`
    (N*signals, unknowns + free starts) in SI, the `scales` of the free starts, the `final` states
    where it ended with their derivatives `final_slopes` (states, unknowns + free starts), and
    whether it `ran`."""

    residual: Vector
    slopes: Matrix
    scales: Vector
    final: Mapping[str, float]
    final_slopes: Matrix
    ran: bool = True

    @cached_property
    def square(self) -> float:
        """The sum of the squared residuals."""
        return float(np.sum(self.residual**2))

    @cached_property
    def projection(self) -> Projection:
        """What the start can explain."""
        scales = self.scales
        moved = self.slopes[:, self.slopes.shape[1] - len(scales) :] * scales
        if not moved.size:
            return Projection(np.zeros((len(moved), 0)), np.zeros((0, 0)))
        left, singular, right = np.linalg.svd(moved, full_matrices=False)
        kept = singular > WINDOW.unseen * max(float(singular[0]), 1e-300)
        return Projection(left[:, kept], scales[:, None] * right[kept].T / singular[kept])


@dataclass(frozen=True, eq=False)
class BatchLinearisation:
    """Segments of one series near some unknowns, by their place among them, and the `errors` of
    those whose runs failed. `steps` of all runs, and what they warn of."""

    linearisations: Mapping[int, Linearisation]
    errors: Mapping[int, SimulationError]
    steps: int
    warnings: frozenset[str]


class Point(NamedTuple):
    """Where segments are run: the `values` of unknowns and fixed parameters by name, the free
    `starts` of each segment, and the `budget` of steps of all runs."""

    values: Mapping[str, float]
    starts: Sequence[Mapping[str, float]]
    budget: float


@dataclass(frozen=True, eq=False)
class SegmentBatch:
    """Segments of one series that run together, at any values of unknowns.

    One that `follows` goes on with states that are not free where the one before has ended.
    """

    model: Model
    segments: Sequence[Segment]
    follows: Sequence[bool]
    rtol: float
    limits: Limits
    _kept: dict[tuple[str, ...] | None, tuple[Names, SpanProblem]] = field(
        default_factory=dict, init=False, repr=False
    )
    """By what is asked for, the problem with the declared sensors, and the names of its starts."""

    @cached_property
    def samples(self) -> Matrix:
        """What was measured in the segments, one behind the other: (N, signals)."""
        return np.concatenate([segment.samples() for segment in self.segments])

    @cached_property
    def _slices(self) -> list[slice]:
        """Where the samples of each segment are among those of all."""
        rows = [*accumulate((len(segment.rows) for segment in self.segments), initial=0)]
        return [slice(*both) for both in pairwise(rows)]

    @cached_property
    def _declared(self) -> ObservationModel:
        """The sensors as they are where none of their terms is unknown."""
        return ObservationModel(self.segments, {})

    def _observation(self, values: Mapping[str, float], rates: bool) -> ObservationModel:
        """The sensors with the values of unknowns."""
        if rates or any(is_of_sensor(self.model, name) for name in values):
            return ObservationModel(self.segments, values, rates=rates)
        return self._declared

    def simulate(
        self,
        point: Point,
        stop_flag: StopFlag,
        asked: Sequence[str] | None = None,
        rates: bool = False,
    ) -> tuple[SpanRuns, ObservationModel]:
        """The runs, with the sensitivities that are `asked` for, and the sensors that look at them;
        `rates` of signals are for the derivatives by a delay. Raises Interrupted."""
        observation = self._observation(point.values, rates)
        starts = [
            start if after else {**segment.start, **start}
            for segment, start, after in zip(self.segments, point.starts, self.follows, strict=True)
        ]
        parameters = of_diagram(self.model, point.values, self.segments[0].measured)
        key = asked if asked is None else tuple(asked)
        names = [tuple(start) for start in starts]
        kept = self._kept.get(key) if observation is self._declared else None
        if kept is not None and kept[0] == names:
            problem = kept[1].with_values(parameters, starts)
        else:
            problem = self._problem(observation, parameters, starts, asked)
            if observation is self._declared and problem.size <= CRITERION.kept:
                self._kept[key] = names, problem
        return problem.run(point.budget, stop_flag), observation

    def _problem(
        self,
        observation: ObservationModel,
        parameters: Mapping[str, float],
        starts: Sequence[Mapping[str, float]],
        asked: Sequence[str] | None,
    ) -> SpanProblem:
        """The problem of the runs, checked and laid out."""
        measured = self.segments[0].measured
        spans = [
            Span(*about)
            for about in zip(
                observation.begins,
                observation.ends,
                observation.times,
                starts,
                self.follows,
                strict=True,
            )
        ]
        return span_problem(
            self.model,
            spans,
            asked or (),
            parameters=parameters,
            rtol=self.rtol,
            atol=None if asked is None else absolute_tolerances(self.model, measured, self.rtol),
            preset=measured.preset,
            inputs=measured.inputs,
            past=measured.past,
            limits=self.limits,
        )

    def linearise(
        self, point: Point, sigma: Vector, moving: Sequence[str] | None, stop_flag: StopFlag
    ) -> BatchLinearisation:
        """The residuals of the segments with the noise `sigma` (signals,), and their derivatives by
        the unknowns `moving` and the free starts; None: without these."""
        measured = self.segments[0].measured
        if moving is None:
            answers, asked = dict[str, str](), None
        else:
            answers = {name: parameter_in(self.model, name, measured) for name in moving}
            answers |= {f"start.{name}": f"start.{name}" for one in point.starts for name in one}
            asked = [name for name in answers.values() if name]
        rates = any(
            name.startswith("delay.") and is_of_sensor(self.model, name) for name in answers
        )
        try:
            runs, observation = self.simulate(point, stop_flag, asked, rates)
        except Interrupted:
            raise
        except SimulationError as error:  # values that the diagram does not allow: nothing runs
            count = len(self.segments)
            errors = dict.fromkeys(range(count), error)
            return BatchLinearisation({}, errors, 0, frozenset())
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows is not usable
            shown = observation.observe(runs)
            residual = subtract_measured(measured, self.samples, shown, self._slices)
            residual /= sigma
            slopes = observation.derivatives(runs, answers)
            if answers:
                slopes /= sigma[:, None]
        near, errors = dict[int, Linearisation](), dict(runs.errors)
        columns = {name: column for column, name in enumerate(answers)}
        moved = [column for column, name in enumerate(answers.values()) if name]
        for number, (segment, start) in enumerate(zip(self.segments, point.starts, strict=True)):
            mine = self._slices[number]
            if number in errors:
                continue
            if not (_is_usable(shown[mine]) and _is_usable(slopes[mine])):
                errors[number] = _huge(measured.name, shown[mine])
                continue
            own = slopes[mine].reshape(residual[mine].size, len(answers))
            ends = np.zeros((len(self.model.states), len(answers)))
            if moved:
                ends[:, moved] = runs.final_slopes[number]
            wanted = () if moving is None else (*moving, *(f"start.{name}" for name in start))
            kept = [columns[name] for name in wanted]
            if kept != [*columns.values()]:
                own, ends = own[:, kept], ends[:, kept]
            final = dict(zip(self.model.states, runs.final[number].tolist(), strict=True))
            scales = np.array([segment.start_scales[name] for name in start])
            near[number] = Linearisation(residual[mine], own, scales, final, ends)
        steps = int(runs.steps.sum()) + self.limits.steps * len(runs.errors)
        warnings = frozenset(text for texts in runs.warnings.values() for text in texts)
        return BatchLinearisation(near, errors, steps, warnings)


def _is_usable(values: Vector) -> bool:
    """Whether they are numbers whose squares are some, too."""
    return not values.size or bool(-WINDOW.largest < values.min() and values.max() < WINDOW.largest)


def _huge(series: str, shown: Vector) -> SimulationError:
    largest = float(np.max(np.abs(shown)))
    what = f"the series '{series}' is simulated as large as {largest:.3g}"
    return SimulationError([Problem(what, hint="Begin elsewhere, or narrow `fit:` bounds.")])


def subtract_measured(
    measured: Measured, samples: Vector, shown: Vector, segments: Sequence[slice]
) -> Vector:
    """What sensors show without what was measured, (N, signals): in each of the segments modulo the
    period where a signal has one."""
    off = shown - samples
    for column, name in enumerate(measured.values if measured.periods else ()):
        for rows in segments:
            off[rows, column] = wrap_to_period(off[rows, column], measured.periods.get(name, 0.0))
    return off


def wrap_to_period(off: Vector, period: float, first: int = 0) -> Vector:
    """Differences (N,) of one run modulo a period, 0 is none: the one at `first` goes the shortest
    way around, and each other one is as near as can be to the one beside it.

    The shortest way alone would let a run that falls behind by whole turns look right every turn. A
    sample that is not finite stays so.
    """
    if period <= 0:
        return off
    known = np.isfinite(off)
    near = off[known] - period * np.round(off[known] / period)
    found = off.copy()
    found[known] = np.unwrap(near, period=period)
    if known[first:].any():  # the first known one from there on
        found[known] -= period * np.round(found[first + int(np.argmax(known[first:]))] / period)
    return found
