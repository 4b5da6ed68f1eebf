"""`name=value` and `name=values` of the command line: numbers with or without a unit."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from tracewire.errors import FormulaError, OptionError, Problem, unknown

if TYPE_CHECKING:
    from tracewire.compile import Model

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
ASSIGNMENT = re.compile(rf"\s*([^=\s]+)\s*=\s*({NUMBER})(?:\s*([^\s\d.].*?|1\s*/.*?))?\s*")
VALUES = re.compile(rf"\s*([^=\s]+)\s*=\s*({NUMBER})\s*:\s*({NUMBER})\s*:\s*(\d+)\s*(.*)")
COUNT_GOES_ON = re.compile(r"[.\d]|[eE][+-]?\d")
EVEN = re.compile(rf"\s*[^=\s]+\s*=\s*{NUMBER}\s*:\s*{NUMBER}\s*:.*")
LISTED = re.compile(rf"\s*([^=\s]+)\s*=\s*({NUMBER}(?:\s*,\s*{NUMBER})*)\s*([^\d:,;]?[^:,;]*)")
HINT = "Write it like {option} k=2.5 or {option} 'phi=13.6 deg'."

Declared = tuple[str, str, float]
"""What a name stands for: full name, unit in SI, and the factor of a number without a unit."""


def parameter_values_of(
    model: Model, texts: Iterable[str], option: str = "--set"
) -> dict[str, float]:
    """The parameters that `name=value` texts give, by full name in SI.

    A number without a unit is in the unit in which the diagram's file gives the parameter, as it
    is in a preset. Raises OptionError: a text that cannot be read, an unknown name, a unit of
    another quantity.
    """
    parameters = model.flat.parameters

    def declared(name: str) -> Declared | Problem:
        if name not in parameters:
            return unknown("parameter", name, parameters)
        parameter = parameters[name]
        return name, parameter.unit, parameter.factor

    return _assigned(texts, option, declared)


def start_values_of(
    model: Model, texts: Iterable[str], option: str = "--start"
) -> dict[str, float]:
    """The start values that `name=value` texts give, by the full name of the state in SI.

    A number without a unit is in SI. Raises OptionError as `parameter_values_of` does.
    """
    from tracewire.diagram import find_state

    units = {state.name: state.unit for state in model.flat.states}

    def declared(name: str) -> Declared | Problem:
        found = name if name in units else find_state(model.diagram, name)
        if found is None or found not in units:
            return unknown("state", name, units)
        return found, units[found], 1.0

    return _assigned(texts, option, declared)


def values_of(
    model: Model,
    texts: Sequence[str],
    option: str = "--over",
    *,
    parameters: Collection[str] = (),
    start: Collection[str] = (),
) -> dict[str, Any]:
    """NAME=FROM:TO:COUNT as evenly spaced values, NAME=VALUE,VALUE,... as these, in SI by name.

    parameters, start: what other options set to one value, by full names. Raises OptionError.
    """
    import numpy as np

    found: dict[str, Any] = {}
    problems: list[Problem] = []
    for text in texts:
        even, listed = VALUES.fullmatch(text), LISTED.fullmatch(text)
        if even is not None and COUNT_GOES_ON.match(even[5]):
            even = None
        if even is not None:
            name, first, last, count, unit = even.groups()
            given = [first, last]
        elif listed is not None and not listed[3].startswith("-"):  # 0-40 is no unit of -40
            name, numbers, unit = listed.groups()
            given, count = numbers.split(","), "1"
        elif EVEN.fullmatch(text):
            what = f"the COUNT of {option} '{text}' is no whole number"
            hint = f"Write it like {option} f=0.3:0.9:800."
            problems.append(Problem(what, hint=hint))
            continue
        else:
            what = f"{option} '{text}' is not a name, '=' and FROM:TO:COUNT or values"
            hint = f"Write it like {option} f=0.3:0.9:800 or {option} f=0.3,0.5,1."
            problems.append(Problem(what, hint=hint))
            continue
        read, known, fixed = parameter_values_of, name, parameters
        if name.startswith("start.") and name not in model.flat.parameters:
            read, known, fixed = start_values_of, name.removeprefix("start."), start
        told = [read(model, [f"{known}={number.strip()} {unit}"], option) for number in given]
        values = [value for one in told for value in one.values()]
        if any(full in fixed for full in told[0]):
            what = f"'{name}' is set to one value, and has values in {option}"
            problems.append(Problem(what, hint="Leave one of the two out."))
        if int(count) < 1:
            problems.append(Problem(f"{option} '{text}' has no values", hint="Give a COUNT."))
            continue
        if name in found:
            problems.append(Problem(f"{option} gives '{name}' twice", hint="Leave one out."))
        found[name] = np.linspace(values[0], values[1], int(count)) if even else np.array(values)
    if problems:
        raise OptionError(problems)
    return found


def units_of(model: Model, texts: Iterable[str], option: str = "--unit") -> dict[str, str]:
    """The units that `signal=unit` texts give, by recorded signal.

    Raises OptionError: a text that cannot be read, an unknown signal, a unit of another quantity.
    """
    found: dict[str, str] = {}
    problems: list[Problem] = []
    for text in texts:
        name, equals, unit = (part.strip() for part in text.partition("="))
        if not (name and equals and unit):
            what = f"{option} '{text}' is not a signal, '=' and a unit"
            problems.append(Problem(what, hint=f"Write it like {option} phi=deg."))
        elif name not in model.recorded:
            problems.append(unknown("recorded signal", name, model.recorded))
        else:
            try:
                _factor(text, unit, model.flat.units.get(name, ""), option, needed=True)
            except (FormulaError, OptionError) as error:
                problems += error.problems
        found[name] = unit
    if problems:
        raise OptionError(problems)
    return found


def _assigned(
    texts: Iterable[str], option: str, declared: Callable[[str], Declared | Problem]
) -> dict[str, float]:
    values: dict[str, float] = {}
    problems: list[Problem] = []
    for text in texts:
        match = ASSIGNMENT.fullmatch(text)
        if match is None:
            what = f"{option} '{text}' is not a name, '=' and a number"
            problems.append(Problem(what, hint=HINT.format(option=option)))
            continue
        name, number, unit_text = match.groups()
        found = declared(name)
        if isinstance(found, Problem):
            problems.append(found)
            continue
        full, unit, factor = found
        if full in values:
            what = f"{option} gives '{full}' twice"
            several = f", or run both: --over {name}=1,2" if option == "--set" else ""
            problems.append(Problem(what, hint=f"Leave one out{several}."))
        try:
            if unit_text:
                factor = _factor(text, unit_text, unit, option)
        except (FormulaError, OptionError) as error:
            problems += error.problems
        values[full] = float(number) * factor
        if not math.isfinite(values[full]):
            problems.append(Problem(f"{option} '{text}' is too large for a number"))
    if problems:
        raise OptionError(problems)
    return values


def _factor(text: str, given: str, declared: str, option: str, needed: bool = False) -> float:
    """The factor from the given unit to SI; a name that declares no unit takes any."""
    from tracewire.formula import quantity_hint, read_unit, same_quantity

    unit = read_unit(given)
    if declared not in ("", "1", given, unit.text) and not same_quantity(given, declared):
        what = f"{option} '{text}': '{given}' is another quantity than {declared}"
        other = " or a unit like it" if needed else ", or without a unit"
        hint = quantity_hint(given, declared, f"Give it in {declared}{other}.")
        raise OptionError([Problem(what, hint=hint)])
    return unit.factor
