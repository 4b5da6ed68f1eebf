"""A measured series linearised in the errors of its inputs, from sample to sample.

Any sequence of input errors is then followed by small matrices, without another run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model, compile
from tracewire.residual.limits import INPUT
from tracewire.residual.measured import Measured
from tracewire.residual.segment import of_diagram
from tracewire.residual.starts import start_from_data
from tracewire.solve import Driving, Held, Span, SpanRuns, refuse_delays, simulate_spans, values_at


@dataclass(frozen=True)
class InputNoise:
    """What the noise of inputs makes of a signal, in SI: its `size` (root mean square), and `high`,
    which one record in a hundred exceeds. The noise is slow, so that records differ much."""

    size: float
    high: float


@dataclass(frozen=True, eq=False)
class InputResponse:
    """A series linearised from each of its N samples to the next, in n states.

    `transition` (N, n, n) takes a change of the states to the next sample, `here` and `there`
    (N, n, k) that of each of the k inputs at a sample and at the next. `output` (N, m, n) and
    `feedthrough` (N, m, k) are what changes of states and of inputs do to the m signals at a
    sample.
    """

    states: tuple[str, ...]
    signals: tuple[str, ...]
    inputs: tuple[str, ...]
    transition: Matrix
    here: Matrix
    there: Matrix
    output: Matrix
    feedthrough: Matrix

    def noise(
        self,
        sigma: Mapping[str, float],
        rows: Sequence[NDArray[np.intp]],
        free: Sequence[str],
        slopes: Matrix | None = None,
        seed: int = 0,
    ) -> dict[str, InputNoise]:
        """What white noise of these inputs makes of each signal in windows: `rows` of the samples.

        A fit moves the states that are `free` where a window begins, and parameters, to which the
        signals have these `slopes` (N, m, p): it takes a part of the noise.
        """
        rng = np.random.default_rng(seed)
        level = np.array([sigma.get(name, 0.0) for name in self.inputs])
        squares = np.zeros((len(self.signals), INPUT.draws))
        for window in rows:
            shape = (len(window) + 1, len(level), INPUT.draws)
            errors = rng.standard_normal(shape) * level[:, None]
            squares += np.sum(self._window(window, errors, free, slopes) ** 2, axis=0)
        squares /= max(sum(len(window) for window in rows), 1)
        return {
            name: InputNoise(
                float(np.mean(one)) ** 0.5, float(np.quantile(one, INPUT.chance)) ** 0.5
            )
            for name, one in zip(self.signals, squares, strict=True)
        }

    def impulses(self, sigma: Mapping[str, float], rows: NDArray[np.intp]) -> Matrix:
        """What one standard deviation of each input at each sample does in a window of W samples
        with fixed start: (W, m, (W + 1) k)."""
        count, level = len(rows) + 1, np.array([sigma.get(name, 0.0) for name in self.inputs])
        errors = np.einsum("ab,jk->ajbk", np.eye(count), np.diag(level))
        return self._window(rows, errors.reshape(count, len(level), -1), (), None)

    def _window(
        self,
        rows: NDArray[np.intp],
        errors: Matrix,
        free: Sequence[str],
        slopes: Matrix | None,
    ) -> Matrix:
        """What input errors (W + 1, k, draws) do in a window of W samples: (W, m, draws)."""
        columns = [self.states.index(name) for name in free if name in self.states]
        moved = np.zeros((len(self.states), errors.shape[2]))
        start = np.eye(len(self.states))[:, columns]
        out = np.empty((len(rows), len(self.signals), errors.shape[2]))
        taken = np.empty((len(rows), len(self.signals), len(columns)))
        for number, row in enumerate(rows.tolist()):
            now, after = errors[number], errors[number + 1]
            out[number] = self.output[row] @ moved + self.feedthrough[row] @ now
            taken[number] = self.output[row] @ start
            moved = self.transition[row] @ moved + self.here[row] @ now + self.there[row] @ after
            start = self.transition[row] @ start
        if slopes is not None:
            taken = np.concatenate((taken, slopes[rows]), axis=2)
        if taken.shape[2]:
            size = np.sqrt(np.mean(out**2, axis=(0, 2)))[:, None]
            size = np.where(size > 0, size, 1.0)  # signals count alike, whatever their units
            columns_of = (taken / size).reshape(-1, taken.shape[2])
            lengths = np.linalg.norm(columns_of, axis=0)
            basis, _ = np.linalg.qr(columns_of[:, lengths > 0] / lengths[lengths > 0])
            flat = (out / size).reshape(len(basis), -1)
            out = (flat - basis @ (basis.T @ flat)).reshape(out.shape) * size
        return out


def input_response(
    model: Model, measured: Measured, states: Matrix, values: Mapping[str, float]
) -> InputResponse:
    """How a series answers to its inputs along states (N, n) at its samples, in a model with these
    values of unknowns. A sample from which no run is possible passes changes on as they are."""
    refuse_delays(model, "a fit with noise on the inputs")
    names, signals = model.states, tuple(measured.values)
    inputs = tuple(measured.inputs)
    quick = compile(model.diagram, record=list(dict.fromkeys((*signals, *names))), backend="quick")
    ends = np.append(measured.t, 2 * measured.t[-1] - measured.t[-2])
    spans = [
        Span(float(a), float(b), np.array([a, b]), dict(zip(names, state, strict=True)))
        for a, b, state in zip(ends[:-1], ends[1:], states.tolist(), strict=True)
    ]

    def runs(driving: Mapping[str, Driving], asked: Sequence[str] = ()) -> SpanRuns:
        return simulate_spans(
            quick,
            spans,
            parameters=of_diagram(model, values, measured),
            rtol=INPUT.rtol,
            preset=measured.preset,
            inputs=driving,
            sensitivities=asked,
        )

    def ends_of(found: SpanRuns) -> tuple[Matrix, Matrix]:
        """Signals at the begins (N, m), states at the ends (N, n)."""
        shown = side_by_side([found[name][::2] for name in signals], len(spans))
        return shown, side_by_side([found[name][1::2] for name in names], len(spans))

    base = runs(measured.inputs, [f"start.{name}" for name in names])
    recorded = base.sensitivities.signals
    answers = base.sensitivities.array.transpose(2, 1, 0)
    shown = answers[::2, [recorded.index(name) for name in signals]]
    forward = answers[1::2, [recorded.index(name) for name in names]]
    before, after = ends_of(base)
    count = len(measured.t)
    here, there = np.zeros((2, count, len(names), len(inputs)))
    direct = np.zeros((count, len(signals), len(inputs)))
    failed = set(base.errors)
    for number, name in enumerate(inputs):
        known = measured.inputs[name]
        change = measured.input_sigma.get(name) or INPUT.small * float(np.std(known[1])) or 1.0
        for parity in (0, 1):
            pushed = _perturb_input(known, measured.t, change, parity)
            found = runs({**measured.inputs, name: pushed})
            failed |= set(found.errors)
            begins, states_then = ends_of(found)
            mine, others = np.arange(parity, count, 2), np.arange(1 - parity, count, 2)
            here[mine, :, number] = (states_then - after)[mine] / change
            there[others, :, number] = (states_then - after)[others] / change
            direct[mine, :, number] = (begins - before)[mine] / change
    bad = sorted(failed)
    forward[bad], here[bad], there[bad] = np.eye(len(names)), 0.0, 0.0
    shown[bad], direct[bad] = 0.0, 0.0
    gains = np.array([values.get(f"gain.{n}", measured.sensor(n).gain) for n in signals])[:, None]
    return InputResponse(
        names, signals, inputs, forward, here, there, shown * gains, direct * gains
    )


def _perturb_input(known: Driving, t: Vector, change: float, parity: int) -> Driving:
    """An input with a change at every second sample of a series."""
    push = change * (np.arange(len(t)) % 2 == parity)
    push = np.append(push, change * (len(t) % 2 == parity))
    knots = np.append(t, 2 * t[-1] - t[-2])
    times = np.union1d(known[0], knots)
    if isinstance(known, Held):
        return Held(times, values_at(known, times) + values_at(Held(knots, push), times))
    return times, np.interp(times, *known) + np.interp(times, knots, push, left=0.0, right=0.0)


def side_by_side(columns: Sequence[Vector], count: int) -> Matrix:
    """Columns (count,) as a matrix, (count, columns); a model may have no states."""
    return np.stack(columns, axis=1) if columns else np.zeros((count, 0))


def states_in_windows(
    model: Model, measured: Measured, values: Mapping[str, float], length: int
) -> Matrix:
    """The states (N, n) along a series in windows of `length` samples, which begin at what the data
    tell; a window in which no run is possible stays where it begins."""
    quick = compile(model.diagram, record=list(model.states), backend="quick")
    firsts = range(0, len(measured.t), length)
    spans = []
    for first in firsts:
        times = measured.t[first : first + length]
        end = float(times[-1]) if len(times) > 1 else float(times[0]) + 1e-9
        start = start_from_data(model, measured, first)
        spans.append(Span(float(times[0]), end, times, start))
    runs = simulate_spans(
        quick,
        spans,
        parameters=of_diagram(model, values, measured),
        preset=measured.preset,
        inputs=measured.inputs,
    )
    found = side_by_side([runs[name] for name in model.states], len(measured.t))
    for number in runs.errors:
        rows = slice(int(runs.rows[number]), int(runs.rows[number + 1]))
        found[rows] = [spans[number].start.get(name, 0.0) for name in model.states]
    return found
