"""Experiments that would tell two effects apart which the data at hand cannot.

One effect makes the data of a new experiment; the other fits them as well as it can: it chooses
the starts of windows, and moves its unknowns as far as the data at hand allow. What is left, in
sigma, is how clearly the experiment would decide. Drives and releases are searched that stay in the
range of the records.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tracewire.array_types import Matrix
from tracewire.compile import Model, compile
from tracewire.errors import OptionError, SimulationError
from tracewire.residual import (
    Criterion,
    Segment,
    evaluate_windows,
    fit_initial_states,
    of_diagram,
    project_out_initial_states,
    with_past,
)
from tracewire.solve import Limits, simulate
from tracewire.trace.experiment.rig import Design, Rig, rig_of
from tracewire.trace.experiment.words import alias_hint, decision, none_within
from tracewire.trace.found import Experiment
from tracewire.trace.trials.trial import TraceProblem, Trial


def design_experiment(
    problem: TraceProblem,
    one: Trial,
    other: Trial,
    name: str,
    rival: str,
    returns: bool = True,
) -> Experiment:
    """The experiment that best tells two fitted trials apart, and by how many sigma (rms).

    Searched: the body released from rest without drive, and at rest driven by a sine, on each named
    input and each sine or square block whose amplitude and frequency are parameters; first
    coarsely, then around the best. All of it stays in the range of the records (`Rig`): starts,
    drives, and the motion of both models. Where no body comes back (`returns`), and at a sum
    without a coordinate, nothing is released. Deterministic.
    Raises OptionError where nothing within that range can be simulated.
    """
    places = [effect.candidate.place for effect in one.effects if str(effect) == name]
    first_order = any(place.kind == "sum" and not place.q for place in places)
    states = compile(one.diagram, record=[*problem.signals, *problem.states], backend="quick")
    rig = rig_of(problem, one, states, returns and not first_order)
    # what the data at hand say of the rival's unknowns
    known, _ = project_out_initial_states(other.windows)
    information = known.T @ known
    separations: dict[Design, float] = {}

    def tell(design: Design) -> None:
        if design not in separations and rig.is_allowed(design):
            try:
                separations[design] = _separation(
                    problem, rig, states, one, other, information, design
                )
            except SimulationError:
                separations[design] = math.nan

    for design in rig.designs():
        tell(design)
    options = problem.options.experiment
    for _ in range(options.rounds):
        if any(math.isfinite(value) for value in separations.values()):
            for design in _best(separations).near(options):
                tell(design)
    if not any(math.isfinite(value) for value in separations.values()):
        hint = alias_hint(name, rival)
        what = f"{none_within(name, rival)}{f'. {hint}' if hint else ''}"
        raise OptionError.one(what, hint="Simulate the diagram by itself first.")
    best = _best(separations)
    rows = tuple(
        {**rig.as_parameters(design), "separation": value}
        for design, value in separations.items()
        if math.isfinite(value)
    )

    words = decision(rig, best, separations[best], name, rival, one.model.users_unit)
    return Experiment(name, rival, rig.as_parameters(best), separations[best], words, rows)


def _best(separations: Mapping[Design, float]) -> Design:
    return max(
        separations, key=lambda design: (math.isfinite(separations[design]), separations[design])
    )


def _separation(
    problem: TraceProblem,
    rig: Rig,
    states: Model,
    one: Trial,
    other: Trial,
    information: Matrix,
    design: Design,
) -> float:
    """The residual of the rival on what the pick does, root mean square in sigma; nan where one of
    both leaves the range that the rig is known to bear."""
    options = problem.options.experiment
    limits = Limits(options.steps, options.seconds, options.events)
    set_here, inputs = rig.parameters(design), rig.inputs(design)
    start = rig.start(design)
    blank = {signal: np.zeros(len(rig.t)) for signal in problem.signals}
    base = replace(rig.template, t=rig.t, values=blank, inputs=inputs, past={}, drift_from=0.0)
    whole = Segment(base, 0.0, np.arange(len(rig.t)), start)
    mine = {**problem.all_values(one), **set_here}
    maker = Criterion(
        one.model, [whole], [], mine, problem.rtol, problem.sigma, weighting="sum", limits=limits
    )
    shown = maker.outputs(whole, {}, {})
    fixed = {**problem.all_values(other), **set_here}
    follower = Criterion(
        other.model, [whole], [], fixed, problem.rtol, problem.sigma, weighting="sum", limits=limits
    )
    if not rig.stays(shown) or not rig.stays(follower.outputs(whole, {}, {})):
        return math.nan
    run = simulate(
        states,
        parameters=of_diagram(one.model, mine, base),
        start=start,
        span=(0.0, float(rig.t[-1])),
        times=rig.t,
        rtol=problem.rtol,
        preset=base.preset,
        inputs=inputs,
        limits=limits,
    )
    measured = replace(base, values=dict(zip(base.values, shown.T, strict=True)))
    measured = with_past(problem.declared, measured, "each window of an experiment")
    edges = np.linspace(0, len(rig.t), _count(one, rig, options.windows) + 1).astype(int)
    segments = []
    for a, b in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        begin = max(a - 1, 0)
        there = {state: float(run[state][begin]) for state in problem.states}
        rows = np.arange(a, b)
        segments.append(Segment(measured, float(rig.t[begin]), rows, there, problem.states))
    unknowns = other.windows.criterion.unknowns
    unknowns = tuple(replace(u, value=other.values[u.name]) for u in unknowns)
    free = [n for n, u in enumerate(unknowns) if u.name not in set_here]
    criterion = Criterion(
        other.model,
        segments,
        [unknowns[n] for n in free],
        fixed,
        problem.rtol,
        problem.sigma,
        weighting="sum",
        limits=limits,
        chained=True,  # a memory is where the window before has left it
    )
    windows = fit_initial_states(evaluate_windows(criterion))
    if not all(near.ran for near in windows.linearisations):
        raise criterion.failure or SimulationError.one("the rival does not run")
    columns, residual = project_out_initial_states(windows)
    matrix = columns.T @ columns + information[np.ix_(free, free)]
    right = columns.T @ residual
    sizes = np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    step = np.linalg.pinv(matrix / np.outer(sizes, sizes), hermitian=True) @ (right / sizes)
    left = float(residual @ residual) - float(step @ (right / sizes))
    return math.sqrt(max(left, 0.0) / len(residual))


def _count(one: Trial, rig: Rig, ends: tuple[int, int]) -> int:
    """How many windows, between two ends: as long as those of the fit."""
    length = one.length * one.windows.segments[0].measured.interval
    return int(np.clip(round(float(rig.t[-1]) / length), *ends))
