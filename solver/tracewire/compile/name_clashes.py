"""Names that a parameter must not have: those of a start value, and of a number of a sensor."""

from __future__ import annotations

from collections.abc import Iterable

from tracewire.compile.flat import Flat
from tracewire.errors import Location, Problem
from tracewire.library import SENSOR_TERMS


def find_name_clashes(flat: Flat, measured: Iterable[str]) -> list[Problem]:
    """The parameters that have the name of something else that a run or a fit may set: `start.x` of
    a block `start` where there is a state `x`, `gain.x` of a block `gain` where `x` is measured."""
    taken = {f"start.{state.name}": f"the start of '{state.name}'" for state in flat.states}
    for signal in measured:
        for term in SENSOR_TERMS:
            taken[f"{term}.{signal}"] = f"the {term} of the sensor of '{signal}'"
    return [
        _problem(name, flat.parameters[name].place, other)
        for name, other in taken.items()
        if name in flat.parameters
    ]


def _problem(name: str, place: Location, other: str) -> Problem:
    block = name.partition(".")[0]
    what = f"the parameter '{name}' has the name of {other}"
    return Problem(what, place, hint=f"Give the block '{block}' another name.")
