"""States that follow inputs alone, as that of a lag does: where they are inside a record."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.errors import FormulaError
from tracewire.formula import Expression, evaluate, evaluate_along, names_of
from tracewire.residual.limits import WINDOW
from tracewire.solve import Driving, Held, values_at


def states_at_rest(
    model: Model, parameters: Mapping[str, float], inputs: Mapping[str, Driving], t: float
) -> dict[str, float]:
    """The states that follow inputs alone where they come to rest with these as they are at the
    time t in s, the begin of a window that is cut out of a longer record.

    Inputs whose samples begin there tell nothing: where a record begins, a drive may have been
    switched on, and a state begins as the diagram says. What comes to rest elsewhere with other
    parameters is left out: a fit changes these.
    """
    known = {name: u for name, u in inputs.items() if u[0][0] < t}
    now = {name: float(values_at(u, np.array([t]))[0]) for name, u in known.items()}

    def rests(factor: float) -> dict[str, float]:
        values = {name: factor * value for name, value in parameters.items()}
        return {
            name: -evaluate(rate, {**values, **now, name: 0.0}) / slope
            for name, rate, slope in _followers(model, values, now)
        }

    found, moved = rests(1.0), rests(WINDOW.rest_moved)
    return {name: x for name, x in found.items() if np.isclose(moved.get(name, np.nan), x)}


def states_along_inputs(
    model: Model, parameters: Mapping[str, float], inputs: Mapping[str, Driving], t: float
) -> dict[str, float]:
    """The states that follow inputs alone at the time t in s, if they began where the samples of
    their inputs do as the diagram says.

    With the rate a*x + g of a state, where g is what its inputs set, a line or a constant between
    their samples, x(t) is what is left of the start and of each piece of g.
    """
    now = {name: float(values_at(u, np.array([t]))[0]) for name, u in inputs.items()}
    found: dict[str, float] = {}
    starts = {state.name: state.start for state in model.flat.states}
    for name, rate, slope in _followers(model, parameters, now):
        read = {one: inputs[one] for one in names_of(rate) if one in inputs}
        since = t + WINDOW.forgotten / slope
        times = np.unique(np.concatenate([*(_between(u[0], since, t) for u in read.values()), [t]]))
        held = all(isinstance(u, Held) for u in read.values())
        known: dict[str, float | Vector] = {**parameters, name: 0.0}
        known |= {one: values_at(u, times) for one, u in read.items()}
        force = evaluate_along(rate, known, len(times))
        x = evaluate(starts[name], parameters) * np.exp(slope * (t - times[0]))
        found[name] = float(x + _answer(slope, times, force, held))
    return found


def _between(times: Vector, since: float, until: float) -> Vector:
    """The times before `until`, from the last one before `since` on."""
    first = max(int(np.searchsorted(times, since)) - 1, 0)
    return times[first : int(np.searchsorted(times, until))]


def _answer(slope: float, times: Vector, force: Vector, held: bool) -> float:
    """The state at the last time that x' = slope*x + force gives from 0 at the first one."""
    steps = np.diff(times)
    z = slope * steps
    grown = np.expm1(z)
    first = force[:-1] * grown / slope
    if not held:  # a line between two samples: its rise adds (e^z - 1 - z)/slope^2 for each unit
        first = first + np.diff(force) / np.maximum(steps, 1e-300) * (grown - z) / slope**2
    return float(np.sum(first * np.exp(slope * (times[-1] - times[1:]))))


def _followers(
    model: Model, parameters: Mapping[str, float], inputs: Mapping[str, float]
) -> Iterator[tuple[str, Expression, float]]:
    """The states whose rate reads inputs and parameters alone, is linear in the state, and falls
    with it: name, rate, and its slope in 1/s."""
    known = {**parameters, **inputs}
    for state in model.flat.states:
        names = {*names_of(state.rate)} - {state.name}
        if names.isdisjoint(inputs) or not names <= known.keys():
            continue
        try:
            at = [evaluate(state.rate, {**known, state.name: x}) for x in (0.0, 1.0, 2.0)]
        except FormulaError:
            continue
        slope = at[1] - at[0]
        if slope < 0 and np.isclose(at[2] - at[1], slope):
            yield state.name, state.rate, slope
