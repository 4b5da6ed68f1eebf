"""The values of the parameters of a run."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from tracewire.compile import Model
from tracewire.diagram import Condition
from tracewire.errors import OptionError, Problem, SimulationError, unknown
from tracewire.formula import Call, Name, Number, evaluate, names_of, to_text
from tracewire.solve.limits import MEMORY
from tracewire.solve.once_per_model import once_per_model

Given = tuple[str, tuple[str, ...]]
"""A preset, and the names of the parameters that are given beside it."""


@once_per_model
def _known_values(model: Model) -> dict[Given, tuple[dict[str, float], list[str]]]:
    """The values that follow from nothing that is given, the others as they were once, and the
    names of those that follow from it."""
    return {}


@once_per_model
def _conditions(model: Model) -> tuple[dict[str, tuple[float, float]], list[Condition]]:
    """What the diagram requires: the bounds of single parameters, and the conditions that are left.

    A bound is what most conditions are, and is looked at in every run.
    """
    bounds: dict[str, tuple[float, float]] = {}
    others = []
    for known in model.flat.require:
        match known.formula:
            case Call(">" | ">=" | "<=" as relation, (Name(name), Number(limit))):
                low, high = bounds.get(name, (-math.inf, math.inf))
                if relation == "<=":
                    bounds[name] = low, min(high, limit)
                else:
                    least = limit if relation == ">=" else math.nextafter(limit, math.inf)
                    bounds[name] = max(low, least), high
            case _:
                others.append(known)
    return bounds, others


@once_per_model
def _preset_values(model: Model) -> dict[str, dict[str, float]]:
    """The values of presets that meet what the diagram requires."""
    return {}


def parameter_bounds(model: Model, name: str) -> tuple[float, float]:
    """Between which the blocks that read a parameter let it be."""
    return _conditions(model)[0].get(name, (-math.inf, math.inf))


def parameter_values(
    model: Model, given: Mapping[str, float], preset: str = ""
) -> dict[str, float]:
    """The value of every parameter in SI: the diagram's, changed by a preset and by `given`.

    A parameter that is a formula of others follows them. Raises OptionError for names that do not
    exist and values that are not finite, SimulationError for values that do not meet what the
    diagram requires.
    """
    flat, met = model.flat, _preset_values(model)
    if not given and preset in met:
        return met[preset].copy()
    if preset and preset not in flat.presets:
        raise OptionError([unknown("preset", preset, flat.presets)])
    if not (given.keys() <= flat.parameters.keys() and all(map(math.isfinite, given.values()))):
        raise OptionError([*_refused(model, given)])
    values = {name: float(value) for name, value in given.items()}
    kept, key = _known_values(model), (preset, tuple(values))
    known = kept.get(key)
    if known is None:  # what follows from nothing that is given is the same every time
        following = []
        for name, formula in model.parameter_formulas(preset).items():
            if name in values:
                continue
            values[name] = evaluate(formula, values, flat.parameters[name].place)
            if any(read in given or read in following for read in names_of(formula)):
                following.append(name)
        values = {name: values[name] for name in flat.parameters}
        if len(kept) < MEMORY.given:
            kept[key] = values.copy(), following
    else:
        before, following = known
        values = {**before, **values}
        formulas = model.parameter_formulas(preset)
        for name in following:
            values[name] = evaluate(formulas[name], values, flat.parameters[name].place)
    refuse_unmet(model, values)
    if not given:
        met[preset] = values.copy()
    return values


def _refused(model: Model, given: Mapping[str, float]) -> Iterator[Problem]:
    """What is wrong with given values: names that do not exist, and numbers that are not finite."""
    known = model.flat.parameters
    yield from (unknown("parameter", name, known) for name in given if name not in known)
    for name, value in given.items():
        if not math.isfinite(value):
            what = f"the parameter '{name}' is given as {value}, which is not a finite number"
            yield Problem(what)


def refuse_unmet(model: Model, values: Mapping[str, float]) -> None:
    """Raises SimulationError: the values of the parameters do not meet a condition of `require`."""
    bounds, conditions = _conditions(model)
    if not all(low <= values[name] <= high for name, (low, high) in bounds.items()):
        conditions = list(model.flat.require)
    problems = []
    for known in conditions:
        if not evaluate(known.formula, values, known.place):
            read = [name for name in names_of(known.formula) if name in values]
            shown = ", ".join(f"{name} = {values[name]:.6g}" for name in read)
            what = f"the parameters do not meet '{to_text(known.formula)}'"
            what += f": {shown}" if shown else ""
            problems.append(Problem(what, known.place, (), known.hint))
    if problems:
        raise SimulationError(problems)
