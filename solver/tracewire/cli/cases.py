"""The cases of `tracewire run`: one for each preset and each value of --over, or a single one."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tracewire.cli.limits import LIMITS
from tracewire.cli.values import parameter_values_of, start_values_of, values_of
from tracewire.errors import OptionError, Problem, TracewireError

if TYPE_CHECKING:
    from tracewire.cli.run_records import RunGiven
    from tracewire.compile import Model
    from tracewire.solve import Options


@dataclass(frozen=True)
class Case:
    """One of several runs: what sets it apart, and its options as `simulate` takes them."""

    name: str
    options: Options


def cases_of(model: Model, given: RunGiven, conditions: Options, more: Options) -> list[Case]:
    """Each preset with each value of each parameter that the user gives. Raises OptionError.

    conditions: those of a measured series, over which the user's values go. more: further options
    of all cases.
    """
    from tracewire.solve import Options, with_options, with_row

    parameters = parameter_values_of(model, given.values or ())
    start = start_values_of(model, given.start or ())
    grid = values_of(model, given.over or (), parameters=parameters, start=start)
    presets = list(dict.fromkeys(given.preset or ())) or [""]
    own = Options(parameters=parameters, start=start)
    options = with_options(conditions, own | more)
    found = []
    for preset, *values in itertools.product(presets, *grid.values()):
        row = {name: float(value) for name, value in zip(grid, values, strict=True)}
        told = [_told(model, name, value) for name, value in row.items()]
        parts = [*([preset] if len(presets) > 1 else []), *told]
        chosen = with_row(model, options, row)
        if preset:
            chosen["preset"] = preset
        found.append(Case(", ".join(parts), chosen))
    if len(found) > LIMITS.most_cases:
        what = f"{len(found)} runs do not go into one figure"
        hint = f"Take {LIMITS.most_cases} at most; "
        hint += "`tracewire sweep` keeps a few numbers of many runs."
        raise OptionError([Problem(what, hint=hint)])
    return found


def failure_of(failed: Mapping[str, TracewireError]) -> TracewireError:
    """The error of the first case where all fail; where they differ it names that case."""
    name, first = next(iter(failed.items()))
    if len({str(error) for error in failed.values()}) > 1:
        what = f"all {len(failed)} runs failed, the first one with {name}"
        first.problems = [replace(p, what=f"{what}: {p.what}") for p in first.problems]
    return first


def _told(model: Model, name: str, value: float) -> str:
    """`k = 2 N/m`, in SI."""
    from tracewire.show import shown

    units = {state.name: state.unit for state in model.flat.states}
    parameter = model.flat.parameters.get(name)
    unit = units.get(name.removeprefix("start."), "") if parameter is None else parameter.unit
    return f"{name} = {shown(value)} {unit}".rstrip()
