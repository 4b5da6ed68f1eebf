"""Segments of a series near some unknowns: residuals and derivatives, from runs together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.residual.measured import LARGEST, Measured
from tracewire.residual.segment import Segment, absolute_tolerances, of_diagram, parameter_in
from tracewire.residual.sensing import Sensing
from tracewire.solve import Halt, Limits, Span, simulate_spans

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
UNSEEN = 1e-7
"""A direction of a segment's start that moves its residual less than this part of the strongest."""


@dataclass(frozen=True, eq=False)
class Projection:
    """A segment without what its start can explain: an orthonormal basis of that, (N*signals, r),
    and the start's answer to a residual, (states, N*signals)."""

    basis: Matrix
    answer: Matrix

    def off(self, columns: Matrix) -> Matrix:
        """Columns without what the start can explain."""
        return np.asarray(columns - self.basis @ (self.basis.T @ columns))


@dataclass(frozen=True, eq=False)
class Linearised:
    """A segment near some unknowns: residuals (N, signals) in sigma, their derivatives `slopes`
    (N*signals, unknowns + free starts) in SI, the `scales` of the free starts, the states where it
    ended, and whether it `ran`."""

    residual: Vector
    slopes: Matrix
    scales: Vector
    final: Mapping[str, float]
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
            return Projection(np.zeros((len(moved), 0)), np.zeros((0, len(moved))))
        left, singular, right = np.linalg.svd(moved, full_matrices=False)
        kept = singular > UNSEEN * max(float(singular[0]), 1e-300)
        answer = (scales[:, None] * right[kept].T / singular[kept]) @ left[:, kept].T
        return Projection(left[:, kept], answer)


@dataclass(frozen=True, eq=False)
class Shots:
    """Segments of one series that were linearised, by their place among them; those whose runs
    failed are missing. `steps` of all runs, and what they warn of."""

    near: Mapping[int, Linearised]
    steps: int
    warnings: frozenset[str]


@dataclass(frozen=True, eq=False)
class Shooting:
    """Segments of one series to run together: their measured `samples` (N, signals), the noise
    `sigma` (signals,), and whether a delay is unknown, which takes the `rates` of signals."""

    model: Model
    segments: Sequence[Segment]
    samples: Matrix
    sigma: Vector
    rtol: float
    limits: Limits
    rates: bool

    def linearised(
        self,
        named: Mapping[str, float],
        parameters: Mapping[str, float],
        starts: Sequence[Mapping[str, float]],
        follows: Sequence[bool],
        budget: float,
        halt: Halt,
    ) -> Shots:
        """The segments near unknowns and free starts; `parameters` are fixed.

        One that `follows` goes on with states that are not free where the one before has ended.
        """
        measured, values = self.segments[0].measured, {**parameters, **named}
        sensing = Sensing(self.segments, values, rates=self.rates)
        spans = [
            Span(begin, end, times, start if after else {**segment.start, **start}, after)
            for segment, begin, end, times, start, after in zip(
                self.segments, sensing.begins, sensing.ends, sensing.times, starts, follows,
                strict=True,
            )
        ]  # fmt: skip
        free = tuple(dict.fromkeys(f"start.{name}" for start in starts for name in start))
        answers = {name: parameter_in(name, measured) for name in named}
        answers |= {name: name for name in free}
        runs = simulate_spans(
            self.model,
            spans,
            parameters=of_diagram(values, measured),
            rtol=self.rtol,
            atol=absolute_tolerances(self.model, measured, self.rtol),
            preset=measured.preset,
            inputs=measured.inputs,
            limits=self.limits,
            budget=budget,
            sensitivities=[name for name in answers.values() if name],
            halt=halt,
        )
        shown = sensing.shown(runs)
        with np.errstate(over="ignore"):  # what overflows is not usable
            slopes = sensing.derivatives(runs, answers) / self.sigma[:, None]
            residual = difference(measured, self.samples, shown) / self.sigma
        rows = np.cumsum([0, *(len(segment.rows) for segment in self.segments)])
        # squares of what is larger would be no numbers
        small = (np.abs(shown) < LARGEST).all(axis=1) & (np.abs(slopes) < LARGEST).all(axis=(1, 2))
        usable = np.logical_and.reduceat(small, rows[:-1])
        near = {}
        for number, start in enumerate(starts):
            if number in runs.errors or not usable[number]:
                continue
            mine = slice(int(rows[number]), int(rows[number + 1]))
            own = slopes[mine].reshape(residual[mine].size, len(answers))
            columns = [len(named) + free.index(f"start.{name}") for name in start]
            if columns != [*range(len(named), len(answers))]:
                own = own[:, [*range(len(named)), *columns]]
            final = dict(zip(self.model.states, runs.final[number].tolist(), strict=True))
            scales = self.segments[number].start_scales(start)
            near[number] = Linearised(residual[mine], own, scales, final)
        steps = int(runs.steps.sum()) + self.limits.steps * len(runs.errors)
        told = frozenset(text for texts in runs.warnings.values() for text in texts)
        return Shots(near, steps, told)


def difference(measured: Measured, samples: Vector, shown: Vector) -> Vector:
    """What sensors show without what was measured, (N, signals): the shortest way around."""
    off = shown - samples
    for column, signal in enumerate(measured.values):
        period = measured.periods.get(signal, 0.0)
        if period > 0:
            off[:, column] -= period * np.round(off[:, column] / period)
    return np.asarray(off)
