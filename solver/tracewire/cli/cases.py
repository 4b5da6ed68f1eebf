"""The cases of `tracewire run`: one for each preset and each value of --over, or a single one."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tracewire.cli.limits import LIMITS
from tracewire.cli.values import values_of
from tracewire.errors import OptionError, Problem, TracewireError

if TYPE_CHECKING:
    from tracewire.compile import Model
    from tracewire.solve import Options


@dataclass(frozen=True)
class Case:
    """A preset, values and start values that one of several runs has beside those of all."""

    name: str
    preset: str
    parameters: Mapping[str, float]
    start: Mapping[str, float]

    @property
    def options(self) -> Options:
        """These, as `simulate` takes them."""
        from tracewire.solve import Options

        return Options(parameters=self.parameters, start=self.start, preset=self.preset)


def cases_of(
    model: Model,
    over: Sequence[str],
    presets: Sequence[str],
    parameters: Collection[str],
    start: Collection[str],
) -> list[Case]:
    """Each preset with each value of each parameter. Raises OptionError.

    parameters, start: what all cases set to one value.
    """
    grid = values_of(model, over, parameters=parameters, start=start)
    presets = list(dict.fromkeys(presets)) or [""]
    found = []
    for preset, *values in itertools.product(presets, *grid.values()):
        given = {name: float(value) for name, value in zip(grid, values, strict=True)}
        told = [_told(model, name, value) for name, value in given.items()]
        parts = [*([preset] if len(presets) > 1 else []), *told]
        parameters = {n: v for n, v in given.items() if n in model.flat.parameters}
        start = {n.removeprefix("start."): v for n, v in given.items() if n not in parameters}
        found.append(Case(", ".join(parts), preset, parameters, start))
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
