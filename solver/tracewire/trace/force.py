"""The torque that a model lacks over time, as the data tell it, for the restoring-force picture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import compile
from tracewire.diagram import effects_of
from tracewire.trace.found import Force
from tracewire.trace.levels import Trajectory
from tracewire.trace.observed import trajectories
from tracewire.trace.places import Place
from tracewire.trace.tangent import Tangent
from tracewire.trace.trial import Trial
from tracewire.trace.windows import Windows, projection

Vector = NDArray[np.float64]
SMOOTH = 0.3
"""The size that a missing torque may have between neighbouring samples, of the sum at its place."""


def forces(tangent: Tangent, best: Trial, rtol: float) -> tuple[Force, ...]:
    """What is needed at each place to which an effect was added, and what the effects give there.

    `needed` is what the effects give, and beside it the torque that takes the rest of the residual
    away (partial residuals, at the values of the best model): in each window, the ridge solution
    for a torque of free values at its samples.
    """
    found = []
    names = {place.name: place for place in tangent.places if place.kind == "sum" and place.v}
    for name in dict.fromkeys(effect.candidate.place.name for effect in best.effects):
        if name not in names:
            continue
        place = names[name]
        needed = _needed(tangent, place)
        fitted = _fitted(best, tangent.windows, place, rtol)
        for number, (run, torque) in enumerate(zip(tangent.trajectories, needed, strict=True)):
            known = np.isfinite(torque)
            q = run.signals[place.q] if place.q else np.zeros(len(run.t))
            v = run.signals[place.v]
            given = fitted[number]
            torque = torque + given
            signals = (place.q, place.v)
            found.append(
                Force(place.name, q[known], v[known], torque[known], given[known], signals)
            )
    merged: dict[str, list[Force]] = {}
    for force in found:
        merged.setdefault(force.place, []).append(force)
    return tuple(_merged(group) for group in merged.values())


def _merged(group: Sequence[Force]) -> Force:
    return Force(
        group[0].place,
        np.concatenate([force.q for force in group]),
        np.concatenate([force.v for force in group]),
        np.concatenate([force.needed for force in group]),
        np.concatenate([force.fitted for force in group]),
        group[0].names,
    )


def _needed(tangent: Tangent, place: Place) -> list[Vector]:
    """The missing torque at the samples of each series, nan where no window is."""
    found = [np.full(len(run.t), np.nan) for run in tangent.trajectories]
    for joined, number in zip(tangent.joined, tangent.series, strict=True):
        samples = np.unique(joined.samples)
        run = tangent.trajectories[number]
        unit = np.zeros((len(run.t), len(samples)))
        unit[samples, np.arange(len(samples))] = 1.0
        given = [np.zeros((len(other.t), len(samples))) for other in tangent.trajectories]
        given[number] = unit
        view = projection(tangent.windows, joined.window)
        answer = view.off(tangent.window_answer(joined, {place.name: given}))
        residual = view.off(tangent.windows.near[joined.window].residual.ravel())
        size = SMOOTH * max(float(np.std(run.signals[place.name])), 1e-300)
        bent = np.diff(np.eye(len(samples)), 2, axis=0) / size
        level = 1e-3 * np.eye(len(samples)) / size
        matrix = np.vstack((answer, bent, level))
        target = np.concatenate((-residual, np.zeros(len(bent) + len(level))))
        found[number][samples] = np.linalg.lstsq(matrix, target, rcond=None)[0]
    return found


def _fitted(best: Trial, windows: Windows, place: Place, rtol: float) -> list[Vector]:
    """What the added effects give at a place, at the samples of each series."""
    outputs = {effect.name: effect.output for effect in effects_of(best.diagram)}
    added = [e.candidate for e in best.effects if e.candidate.place.name == place.name]
    signals = [c.block + outputs.get(c.effect, "") for c in added]
    model = compile(best.diagram, record=signals, backend="quick")
    runs: list[Trajectory] = trajectories(model, windows, rtol)
    return [np.sum([run.signals[name] for name in signals], axis=0) for run in runs]
