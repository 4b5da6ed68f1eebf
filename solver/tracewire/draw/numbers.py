"""The numbers of a diagram's parameters, as far as they can be known without compiling it."""

from __future__ import annotations

from collections.abc import Mapping

from tracewire.diagram import BlockUse, Diagram, Value
from tracewire.errors import FormulaError
from tracewire.formula import evaluate, names_of
from tracewire.library import Block


def numbers_of(diagram: Diagram, given: Mapping[str, float]) -> dict[str, float]:
    """Each parameter of a diagram that has a number in SI; `given` go before their definitions."""
    known = dict(given)
    open_ones = {n: v for n, v in diagram.parameters.items() if n not in known}
    while open_ones:
        ready = [n for n, v in open_ones.items() if not names_of_signals(v) & open_ones.keys()]
        if not ready:
            break  # they depend on each other
        for name in ready:
            number = _number(open_ones.pop(name), known)
            if number is not None:
                known[name] = number
    return known


def names_of_signals(value: Value) -> set[str]:
    """The names that a value reads."""
    return set(names_of(value.formula))


def setting_numbers(
    use: BlockUse, numbers: Mapping[str, float], block: Block | None = None
) -> dict[str, float]:
    """The settings of a block that are numbers, in SI, and the defaults of those not given."""
    found = {}
    for name, value in use.settings.items():
        number = _number(value, numbers) if isinstance(value, Value) else None
        if number is not None:
            found[name] = number
    for parameter in block.parameters if block is not None else ():
        if parameter.name in use.settings or parameter.default is None:
            continue
        if not isinstance(parameter.default, str):
            found[parameter.name] = float(parameter.default)
        elif block is not None:
            number = _number(Value(block.defaults[parameter.name]), found)
            if number is not None:
                found[parameter.name] = number
    return found


def inner_numbers(use: BlockUse, numbers: Mapping[str, float]) -> dict[str, float]:
    """The parameters inside of a subsystem, as its use gives them."""
    assert use.subsystem is not None
    return numbers_of(use.subsystem, setting_numbers(use, numbers))


def _number(value: Value, known: Mapping[str, float]) -> float | None:
    try:
        return evaluate(value.formula, known) * value.factor
    except FormulaError:
        return None
