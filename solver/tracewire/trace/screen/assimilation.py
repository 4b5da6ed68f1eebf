"""Windows that follow the data: those of a fit with the torques that it lacks.

A model that is far from the data also moves elsewhere: its rate changes sign at other times, and
what friction would do along its way says little of what friction does along the measured one. So a
torque that takes the residual away, straight between a few nodes of each window, is added at each
sum (`torques.py`). The model with it runs along the data, and is linearised there; what effects
have to explain is what it does.

Source: data assimilation with a weak constraint (Y. Tremolet, Q. J. R. Meteorol. Soc. 132, 2006,
2483).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tracewire.array_types import Vector
from tracewire.diagram import Diagram, Value
from tracewire.errors import SimulationError
from tracewire.formula import Number
from tracewire.residual import evaluate_windows, fit_initial_states
from tracewire.solve import Interrupted
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.places import Place
from tracewire.trace.screen.probes import add_probes
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.screen.torques import missing_torques
from tracewire.trace.trials.trial import TraceProblem, Trial


def assimilate(
    problem: TraceProblem, trial: Trial, linearisation: TorqueLinearisation
) -> TorqueLinearisation | None:
    """The linearisation along the data, with what torques at the sums do there as the residual.

    None where they do not take most of the residual away, as of a sensor, or where such a model
    does not run.
    """
    places = [place for place in linearisation.places if place.kind == "sum"]
    if not places:
        return None
    options = linearisation.options.screen

    def bend(signal: Vector) -> float:
        return options.torque_bend * float(np.sqrt(np.mean(signal**2)))

    needed = missing_torques(
        linearisation, places, bend, options.torque_level, options.torque_nodes
    )
    torques = {name: [np.nan_to_num(w) for w in series] for name, series in needed.items()}
    diagram, inputs = _with_torques(trial.diagram, places)
    series = list(dict.fromkeys(s.measured.name for s in trial.windows.segments))
    given = {
        name: {
            signal: (run.t, torques[place.name][number])
            for signal, place in zip(inputs, places, strict=True)
        }
        for number, (name, run) in enumerate(zip(series, linearisation.trajectories, strict=True))
    }
    measured = {
        s.measured.name: replace(s.measured, inputs={**s.measured.inputs, **given[s.measured.name]})
        for s in trial.windows.segments
    }
    segments = [replace(s, measured=measured[s.measured.name]) for s in trial.windows.segments]
    there = replace(trial, diagram=diagram, model=problem.compile_diagram(diagram))
    try:
        criterion = problem.free_criterion(there, segments, trial.values)
        windows = fit_initial_states(evaluate_windows(criterion, trial.windows.inlier_limit))
        if windows.rss > options.followed * trial.rss:
            return None
        found = TorqueLinearisation(
            diagram, windows, linearisation.places, problem.rtol, linearisation.options
        )
    except Interrupted:
        raise
    except SimulationError:
        return None
    given_torques = {place.name: [w[:, None] for w in torques[place.name]] for place in places}
    return found.along_torques(given_torques)


def candidates_along_data(candidates: Sequence[Candidate]) -> list[Candidate]:
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
    found, parameters = add_probes(diagram, places, len(places))
    inputs = [name for name in found.inputs if name not in diagram.inputs]
    own = {names[number]: Value(Number(1.0)) for number, names in enumerate(parameters)}
    return replace(found, parameters={**found.parameters, **own}), inputs
