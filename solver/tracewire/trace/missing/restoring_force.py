"""The torque that a model lacks over time, as the data tell it, for the restoring-force picture."""

from __future__ import annotations

import numpy as np

from tracewire.array_types import Vector
from tracewire.compile import compile
from tracewire.diagram import effects_of
from tracewire.residual import Windows
from tracewire.trace.candidates.places import Place
from tracewire.trace.found import Force, Means
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.screen.torques import missing_torques
from tracewire.trace.screen.trajectories import join_windows, simulate_signals
from tracewire.trace.thresholds import MapOptions
from tracewire.trace.trials.trial import Trial


def restoring_forces(
    linearisation: TorqueLinearisation,
    best: Trial,
    rtol: float,
    fitted: TorqueLinearisation | None = None,
) -> tuple[Force, ...]:
    """What is needed at each place to which an effect was added, and what the effects give there.

    `needed` is what the effects give, and beside it the torque that takes the rest of the residual
    away (partial residuals, at the values of the best model): in each window, the ridge solution
    for a torque of free values at its nodes. `fitted` is the linearisation of the windows of the
    fit, which are long enough to tell a small torque from noise: the means are estimated there.
    """
    options = linearisation.options

    def bend(signal: Vector) -> float:
        return options.map.force_smooth * float(np.std(signal))

    found = []
    names = {place.name: place for place in linearisation.places if place.kind == "sum" and place.v}
    for name in dict.fromkeys(effect.candidate.place.name for effect in best.effects):
        if name not in names:
            continue
        place = names[name]
        needed = missing_torques(
            linearisation, [place], bend, options.screen.torque_level, options.map.force_nodes
        )[place.name]
        given_by_effects = _effect_torques(best, linearisation.windows, place, rtol)
        means = () if fitted is None else _means(fitted, best, place, rtol)
        parts = []
        for run, torque, given in zip(
            linearisation.trajectories, needed, given_by_effects, strict=True
        ):
            q = run.signals[place.q] if place.q else np.zeros(len(run.t))
            both = np.stack((q, run.signals[place.v], torque + given, given))
            parts.append(both[:, np.isfinite(torque)])
        q, v, torque, given = np.concatenate(parts, axis=1)
        found.append(Force(place.name, q, v, torque, given, (place.q, place.v), means))
    return tuple(found)


def _means(
    linearisation: TorqueLinearisation, best: Trial, place: Place, rtol: float
) -> tuple[Means, ...]:
    """The mean torque that is needed in bins of q and of v, all bins of a variable at once.

    A torque that is constant in each bin is fitted to the residual, with the window starts free and
    the parameters at the values of the best model; what the effects give is added.
    """
    given = np.concatenate(_effect_torques(best, linearisation.windows, place, rtol))
    seen = [np.zeros(len(run.t), dtype=bool) for run in linearisation.trajectories]
    for window, number in zip(linearisation.window_pieces, linearisation.series, strict=True):
        seen[number][window.samples] = True
    inside = np.concatenate(seen)
    found = []
    for signal in (place.q, place.v):
        runs = [run.signals[signal] if signal else np.zeros(len(run.t))
                for run in linearisation.trajectories]  # fmt: skip
        values = np.concatenate(runs)[inside]
        edges = _edges(values, linearisation.options.map)
        count = len(edges) - 1
        bins = [np.clip(np.searchsorted(edges, x, "right") - 1, 0, count - 1) for x in runs]
        steps = [np.eye(count)[numbers] for numbers in bins]
        extra, error = _least_squares(linearisation, place, steps, best.reduced_chi2)
        numbers = np.concatenate(bins)[inside]
        members = np.maximum(np.bincount(numbers, minlength=count), 1)
        at = np.bincount(numbers, values, count) / members
        mean = np.bincount(numbers, given[inside], count) / members
        found.append(Means(at, mean + extra, error))
    return tuple(found)


def _edges(values: Vector, options: MapOptions) -> Vector:
    """The edges of at least one bin, each of which has a few samples."""
    bins = options.force_bins + 1
    counted = np.quantile(values, np.linspace(0, 1, bins))
    low, high = np.quantile(values, [0.01, 0.99]).tolist()
    even = np.linspace(low, high, bins)[1:-1]
    edges = [float(values.min())]
    for edge in np.unique(np.concatenate((counted, even))).tolist():
        if np.sum((values >= edges[-1]) & (values < edge)) >= options.force_samples:
            edges.append(edge)
    if len(edges) > 2:
        edges.pop()  # the last bin goes to the end
    return np.array([*edges, float(values.max())])


def _least_squares(
    linearisation: TorqueLinearisation, place: Place, columns: list[Vector], reduced_chi2: float
) -> tuple[Vector, Vector]:
    """The coefficients of torques at a place, (N, K) by series, that take the residual away, and
    their standard errors (K,)."""
    count = columns[0].shape[1]
    matrix, right = np.zeros((count, count)), np.zeros(count)
    for window in linearisation.window_pieces:
        view = linearisation.windows.linearisations[window.index].projection
        answer = view.project_out(linearisation.window_response(window, {place.name: columns}))
        residual = view.project_out(
            linearisation.windows.linearisations[window.index].residual.ravel()
        )
        matrix += answer.T @ answer
        right -= answer.T @ residual
    ridge = 1e-12 * max(float(np.trace(matrix)) / count, 1e-300)
    inverse = np.linalg.inv(matrix + ridge * np.eye(count))
    return inverse @ right, np.sqrt(np.diag(inverse) * max(reduced_chi2, 1.0))


def _effect_torques(best: Trial, windows: Windows, place: Place, rtol: float) -> list[Vector]:
    """What the added effects give at a place, at the samples of each series."""
    outputs = {effect.name: effect.output for effect in effects_of(best.diagram)}
    added = [e.candidate for e in best.effects if e.candidate.place.name == place.name]
    signals = [c.block + outputs.get(c.effect, "") for c in added]
    model = compile(best.diagram, record=signals, backend="quick")
    runs = join_windows(windows, simulate_signals(model, windows, rtol))
    return [np.sum([run.signals[name] for name in signals], axis=0) for run in runs]
