"""Formulas of ports that take several wires: what they do with these is written out."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce

from tracewire.compile.limits import CODE
from tracewire.formula import FUNCTIONS, Call, Expression, Name, Number


def write_wires(formula: Expression, manies: Mapping[str, list[Expression]]) -> Expression:
    """The formula with sum(port), product(port), min(..., port) and max(..., port) written out."""
    if not isinstance(formula, Call):
        return formula
    first = formula.arguments[0]
    if formula.function == "join" and isinstance(first, Name) and first.name in manies:
        return Call("join", tuple(manies[first.name]))
    if formula.function in ("sum", "product") and isinstance(first, Name) and first.name in manies:
        plus = formula.function == "sum"
        return _folded("+" if plus else "*", manies[first.name], 0.0 if plus else 1.0)
    function = FUNCTIONS.get(formula.function)
    if function is not None and function.most is None:
        several = (_wires(argument, manies) for argument in formula.arguments)
        return Call(formula.function, tuple(wire for wires in several for wire in wires))
    return Call(formula.function, tuple(write_wires(a, manies) for a in formula.arguments))


def _wires(formula: Expression, manies: Mapping[str, list[Expression]]) -> list[Expression]:
    """The wires of a port that takes several, or any other formula by itself."""
    if isinstance(formula, Name) and formula.name in manies:
        return manies[formula.name]
    return [write_wires(formula, manies)]


def _folded(sign: str, terms: list[Expression], empty: float) -> Expression:
    """The sum or product of terms; a sum takes away a term that is negative."""

    def joined(a: Expression, b: Expression) -> Expression:
        if sign == "+" and isinstance(b, Call) and b.function == "neg":
            return Call("-", (a, *b.arguments))
        return Call(sign, (a, b))

    if len(terms) > CODE.longest_fold:  # by halves: a formula may not nest as deep as that
        middle = len(terms) // 2
        return joined(_folded(sign, terms[:middle], empty), _folded(sign, terms[middle:], empty))
    return reduce(joined, terms) if terms else Number(empty)
