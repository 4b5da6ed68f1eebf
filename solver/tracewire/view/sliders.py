"""A slider for each parameter of a model: its range, its unit, and whether it is logarithmic."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from tracewire.compile import Model
from tracewire.diagram import is_count, written_units
from tracewire.errors import OptionError
from tracewire.formula import names_of, to_text
from tracewire.solve import parameter_values
from tracewire.view.limits import VIEW


@dataclass(frozen=True)
class Slider:
    """A parameter as the page shows it: `value`, `low` and `high` times `factor` are in SI.

    `free`: a fit may change it. `follows`: the formula of other parameters that gives its value, or
    nothing; such a one has no slider. `line`: where it stands in the file, from 1; 0 is unknown.
    """

    name: str
    unit: str
    factor: float
    value: float
    low: float
    high: float
    logarithmic: bool
    free: bool
    follows: str
    line: int


def sliders_of(model: Model, preset: str = "") -> list[Slider]:
    """The parameters of a model in the order of its file, with their values under a preset.

    Raises OptionError: no such preset; SimulationError: values that a condition of it refuses.
    """
    values = parameter_values(model, {}, preset)
    formulas = model.parameter_formulas(preset)
    units = written_units(model.diagram, model.flat.parameters)
    found = []
    for name, parameter in model.flat.parameters.items():
        if is_count(model.diagram, name):  # a run cannot change it
            continue
        # without a unit in this file it is shown in SI
        unit = units.get(name, _plain(parameter.unit))
        factor = parameter.factor if name in units else 1.0
        value = values[name] / factor
        fit = parameter.fit and (parameter.fit[0] / factor, parameter.fit[1] / factor)
        low, high = range_of(value, fit)
        read = [other for other in names_of(formulas[name]) if other in values]
        own = parameter.place.file == str(model.diagram.file)
        found.append(
            Slider(
                name=name,
                unit=unit,
                factor=factor,
                value=value,
                low=low,
                high=high,
                logarithmic=low > 0 and math.log10(high / low) >= VIEW.decades,
                free=parameter.fit is not None,
                follows=to_text(formulas[name]) if read else "",
                line=parameter.place.line if own else 0,
            )
        )
    return found


def range_of(value: float, fit: tuple[float, float] | None) -> tuple[float, float]:
    """The ends of a slider: the bounds of a fit where both are given, else about the value."""
    low, high = fit or (-math.inf, math.inf)
    usual = (-1.0, 1.0) if value == 0 else (min(0.0, 2 * value), max(0.0, 2 * value))
    if math.isinf(low) and math.isinf(high):
        return usual
    if math.isinf(low):
        low = min(usual[0], high - abs(high) - 1)
    if math.isinf(high):
        high = max(usual[1], low + abs(low) + 1)
    return low, high


def _plain(unit: str) -> str:
    return "" if unit == "1" else unit


def in_si(sliders: Mapping[str, float]) -> dict[str, float]:
    """Values by name as numbers. Raises OptionError for what is none."""
    wrong = [n for n, v in sliders.items() if isinstance(v, bool) or not isinstance(v, int | float)]
    if wrong:
        raise OptionError.one(f"the value of '{wrong[0]}' is no number", hint="Give a number.")
    return {name: float(value) for name, value in sliders.items()}
