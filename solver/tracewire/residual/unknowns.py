"""What a fit may change: parameters with bounds, and what sensors do to their signals."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from tracewire.compile import Model
from tracewire.errors import Location, OptionError, Problem, unknown
from tracewire.formula import names_of
from tracewire.library import SENSOR_TERMS
from tracewire.residual.limits import CRITERION
from tracewire.residual.measured import Measured
from tracewire.residual.segment import Unknown, own_name
from tracewire.solve import parameter_bounds


def free_unknowns(
    model: Model, free: Sequence[str] | None, values: Mapping[str, float]
) -> list[Unknown]:
    """The parameters that a fit may change, begun at `values`: those with `fit:` bounds, or those
    that `free` names. Their blocks may bound them, too.

    Raises OptionError: a name does not exist, a start outside the bounds.
    """
    flat = model.flat
    names = _with_bounds(model) if free is None else free
    problems = [unknown("parameter", n, flat.parameters) for n in names if n not in flat.parameters]
    if problems:
        raise OptionError(problems)
    unknowns = []
    for name in dict.fromkeys(names):
        parameter, value = flat.parameters[name], values[name]
        low, high = parameter.fit or (-np.inf, np.inf)
        problems += _outside(name, value, low, high, parameter.place)
        least, most = parameter_bounds(model, name)
        size = _size(value, high - low)
        unknowns.append(Unknown(name, value, max(low, least), min(high, most), size))
    if problems:
        raise OptionError(problems)
    return unknowns


def _with_bounds(model: Model) -> list[str]:
    return [name for name, p in model.flat.parameters.items() if p.fit is not None]


def _outside(
    name: str, value: float, low: float, high: float, place: Location = Location()
) -> list[Problem]:
    """That a start lies outside its bounds, where it does."""
    if low <= value <= high:
        return []
    what = f"'{name}' begins at {value:g}, outside its bounds {low:g} to {high:g} (SI)"
    return [Problem(what, place, hint="Begin inside them, or widen `fit:`.")]


def _size(value: float, width: float) -> float:
    """The size by which a number is scaled that begins at a value between bounds."""
    width = width if np.isfinite(width) else 0.0
    return max(abs(value), CRITERION.tiny * width) if value else 0.1 * (width or 1.0)


def sensor_unknowns(measured: Sequence[Measured]) -> list[Unknown]:
    """The free numbers of sensors, one for each signal, named `offset.SIGNAL`, `gain.SIGNAL` ...

    They begin at those of the first series that has them.
    """
    found: dict[str, Unknown] = {}
    for series in measured:
        for signal, sensor in series.sensors.items():
            spread = 0.1 * float(np.std(series.values[signal])) or 1.0
            largest = float(np.max(np.abs(series.values[signal])))
            sizes = {
                "offset": spread,
                "gain": max(abs(sensor.gain), 1e-3),
                "delay": series.interval,
                "quad": spread / (largest**2 or 1.0),
                "drift": spread / float(series.t[-1] - series.t[0]),
            }
            for kind, (low, high) in sensor.free.items():
                name = f"{kind}.{signal}"
                value = float(getattr(sensor, kind))
                found.setdefault(name, Unknown(name, value, low, high, sizes[kind]))
    return list(found.values())


def own_unknowns(measured: Sequence[Measured]) -> list[Unknown]:
    """The parameters that some series have of their own, with bounds: `harmonic.phase@run_1`.

    Raises OptionError: a start outside the bounds.
    """
    found: dict[str, Unknown] = {}
    problems: list[Problem] = []
    for series in measured:
        for parameter, (low, high) in series.free.items():
            name, value = own_name(parameter, series), series.parameters[parameter]
            problems += _outside(name, value, low, high)
            found.setdefault(name, Unknown(name, value, low, high, _size(value, high - low)))
    if problems:
        raise OptionError(problems)
    return list(found.values())


def free_names(model: Model, measured: Sequence[Measured]) -> list[str]:
    """The names of what a fit changes by itself: `k`, `offset.SIGNAL`, `k@SERIES`, `start.STATE`.

    Raises OptionError: a start outside the bounds.
    """
    own = _with_bounds(model)
    others = [unknown.name for unknown in (*sensor_unknowns(measured), *own_unknowns(measured))]
    starts = (f"start.{s}" for one in measured for s, value in one.start.items() if value is None)
    return [*own, *others, *dict.fromkeys(starts)]


def moved_by_fit(model: Model, free: Collection[str] | None = None) -> set[str]:
    """The parameters that a fit changes, all with bounds or those that `free` names, and those that
    follow them."""
    flat = model.flat.parameters
    moving = set(_with_bounds(model) if free is None else free)
    while more := {
        n for n, p in flat.items() if n not in moving and moving & {*names_of(p.formula)}
    }:
        moving |= more
    return moving


def refuse_readers_of_free(model: Model, free: Collection[str] | None = None) -> None:
    """Refuse starts and sensors of measured series that read what a fit changes, all parameters
    with bounds or those that `free` names: they are computed once, when a series is read, and would
    keep their values.

    Raises OptionError with all of them.
    """
    moving, problems = moved_by_fit(model, free), []
    for series in model.diagram.measured.values():
        read = {f"start of '{name}'": (value, "free") for name, value in series.start.items()}
        for signal, channel in series.channels.items():
            bounds = "{value: ..., fit: [low, high]}"
            read |= {
                f"{kind} of '{signal}'": (getattr(channel, kind), bounds) for kind in SENSOR_TERMS
            }
        for what, (value, instead) in read.items():
            if value is None:
                continue
            names = sorted(moving & {*names_of(value.formula)})
            if names:
                told = f"the {what} in the series '{series.name}' reads '{names[0]}', which is free"
                hint = (
                    "It would keep its value in a fit. Write " + instead + ", or fix the parameter."
                )
                place = value.place if value.place.file else series.place
                problems.append(Problem(told, place, hint=hint))
    if problems:
        raise OptionError(problems)


def chosen_unknowns(
    model: Model,
    measured: Sequence[Measured],
    values: Mapping[str, float],
    free: Sequence[str] | None,
    fixed: Sequence[str],
) -> list[Unknown]:
    """What a fit of some series may change: all that is free in the diagram, or what `free` names,
    without what `fixed` names; with numbers of sensors and what single series have of their own.

    Raises OptionError: nothing is free, a name does not exist, what is to be fixed is not free, a
    start outside the bounds.
    """
    sensors = {u.name: u for u in (*sensor_unknowns(measured), *own_unknowns(measured))}
    known = [*model.flat.parameters, *sensors]
    problems = [
        unknown("parameter", name, known)
        for name in dict.fromkeys([*(free or ()), *fixed])
        if name not in known
    ]
    if problems:
        raise OptionError(problems)
    own = _with_bounds(model) if free is None else [name for name in free if name not in sensors]
    if stay := [name for name in fixed if name not in own and name not in sensors]:
        what = f"'{stay[0]}' is not free: a fit leaves it as it is, fixed or not"
        hint = f"Free are: {', '.join([*own, *sensors]) or 'only starts'}. "
        hint += "A start that is free has a value where its series says so: start: {x: 0.9}."
        raise OptionError.one(what, hint=hint)
    found = free_unknowns(model, [name for name in own if name not in fixed], values)
    found += [
        sensor
        for name, sensor in sensors.items()
        if name not in fixed and (free is None or name in free)
    ]
    refuse_readers_of_free(model, [unknown.name for unknown in found])
    starts_are_free = any(value is None for m in measured for value in m.start.values())
    if not found and not starts_are_free:
        hint = "Give a parameter bounds, as in k: {value: 1, fit: [0, 10]}, or name it as free."
        raise OptionError([Problem("no parameter of the diagram is free", hint=hint)])
    return found
