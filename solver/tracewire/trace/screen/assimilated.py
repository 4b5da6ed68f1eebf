"""Windows that follow the data: those of a fit with the torques that it lacks.

A model that is far from the data also moves elsewhere: its rate changes sign at other times, and
what friction would do along its way says little of what friction does along the measured one. So a
torque w_p(t), straight between a few nodes of each window, is added at each sum p:

    w = argmin |r + A w|^2 + sum over p of |D2 w_p|^2/s_p^2 + |w_p|^2/(1000 s_p)^2,

r the residual in sigma and A the linearised answer, both without what the start of the window
explains, D2 the second differences, s_p a part of the root mean square of the sum. The model with w
runs along the data, and is linearised there; what effects have to explain is what w does.

Source: data assimilation with a weak constraint (Y. Tremolet, Q. J. R. Meteorol. Soc. 132, 2006,
2483).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from tracewire.diagram import Diagram, Value
from tracewire.errors import FitError, SimulationError
from tracewire.formula import Number
from tracewire.residual import opened, settled
from tracewire.solve import Interrupted
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.places import Place
from tracewire.trace.screen.probe import probed
from tracewire.trace.screen.tangent import Tangent
from tracewire.trace.trials.trial import Bench, Trial

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
Torques = Mapping[str, Sequence[Vector]]
"""By place, and by series at its samples."""


def assimilated(bench: Bench, trial: Trial, tangent: Tangent) -> Tangent | None:
    """The tangent along the data, with what torques at the sums do there as the residual.

    None where they do not take most of the residual away, as of a sensor, or where such a model
    does not run.
    """
    places = [place for place in tangent.places if place.kind == "sum"]
    if not places:
        return None
    torques = _needed(tangent, places)
    diagram, inputs = _with_torques(trial.diagram, places)
    series = list(dict.fromkeys(s.measured.name for s in trial.windows.segments))
    given = {
        name: {
            signal: (run.t, torques[place.name][number])
            for signal, place in zip(inputs, places, strict=True)
        }
        for number, (name, run) in enumerate(zip(series, tangent.trajectories, strict=True))
    }
    measured = {
        s.measured.name: replace(s.measured, inputs={**s.measured.inputs, **given[s.measured.name]})
        for s in trial.windows.segments
    }
    segments = [replace(s, measured=measured[s.measured.name]) for s in trial.windows.segments]
    there = replace(trial, diagram=diagram, model=bench.compiled(diagram))
    try:
        criterion = bench.warm(there, segments, trial.values)
        windows = settled(opened(criterion, trial.windows.good))
        if windows.rss > tangent.options.screen.followed * trial.rss:
            return None
        found = Tangent(diagram, windows, tangent.places, bench.rtol, tangent.options)
    except Interrupted:
        raise
    except (FitError, SimulationError):
        return None
    histories = {place.name: [w[:, None] for w in torques[place.name]] for place in places}
    near = []
    for joined, one in zip(found.joined, windows.near, strict=True):
        done = sum(
            found.window_answer(joined, {name: history})[:, 0]
            for name, history in histories.items()
        )
        near.append(replace(one, residual=one.residual - np.reshape(done, one.residual.shape)))
    found.windows = replace(windows, near=tuple(near))
    found.along_data = True
    return found


def seen_along(candidates: Sequence[Candidate]) -> list[Candidate]:
    """The candidates that may be judged along data: those of sums that take nothing of what drives
    them. A drive that is a part of itself would look perfect: all forces may vanish together."""
    return [
        c
        for c in candidates
        if c.place.kind == "sum"
        and not {c.place.name, c.place.a, *c.place.drive} & set(c.signals.values())
    ]


def _with_torques(diagram: Diagram, places: Sequence[Place]) -> tuple[Diagram, list[str]]:
    """The diagram with an input added at each of some sums, and the names of these."""
    found, parameters = probed(diagram, places, len(places))
    inputs = [name for name in found.inputs if name not in diagram.inputs]
    own = {names[number]: Value(Number(1.0)) for number, names in enumerate(parameters)}
    return replace(found, parameters={**found.parameters, **own}), inputs


def _needed(tangent: Tangent, places: Sequence[Place]) -> Torques:
    """The torques that take the residual away, zero where no window is."""
    runs, options = tangent.trajectories, tangent.options.screen
    found = {place.name: [np.zeros(len(run.t)) for run in runs] for place in places}
    for joined, number in zip(tangent.joined, tangent.series, strict=True):
        samples = np.unique(joined.samples)
        count = min(options.torque_nodes, len(samples))
        edges = np.linspace(samples[0], samples[-1], count)
        hats = np.stack([np.interp(samples, edges, one) for one in np.eye(count)], axis=1)
        near = tangent.windows.near[joined.window]
        view, answers, rows = near.projection, [], []
        for place in places:
            given = [np.zeros((len(run.t), count)) for run in runs]
            given[number][samples] = hats
            answers.append(view.off(tangent.window_answer(joined, {place.name: given})))
            usual = float(np.sqrt(np.mean(runs[number].signals[place.name] ** 2)))
            size = options.torque_bend * max(usual, 1e-300)
            level = options.torque_level * np.eye(count)
            rows.append(np.vstack((np.diff(np.eye(count), 2, axis=0), level)) / size)
        held = block_diag(*rows)
        residual = view.off(near.residual.ravel())
        matrix = np.vstack((np.hstack(answers), held))
        target = np.concatenate((-residual, np.zeros(len(held))))
        torque = np.linalg.lstsq(matrix, target, rcond=None)[0]
        for place, part in zip(places, np.split(torque, len(places)), strict=True):
            found[place.name][number][samples] = hats @ part
    return found
