"""How units go through a formula: what is added has one unit, the argument of `exp` has none."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tracewire.formula.expression import Call, Expression, Name, Number
from tracewire.formula.functions import OPERATIONS
from tracewire.formula.limits import LIMITS
from tracewire.formula.quantities import QUANTITIES, Quantity

Term = dict[str, float]
"""A unit as powers of names, of base units or of what is not known yet; {} is a number."""
Named = Callable[[str], Term | None]
"""The unit of a name; None: it may have any."""
Equal = Callable[[Term, Term, Expression | None, Expression], None]
"""Takes two units that must be the same, those of these parts of the formula; a part that must be
a number has no other beside it."""


def times(one: Term, other: Term, power: float = 1.0) -> Term:
    """The unit of a product: `one` times a power of the `other`."""
    found = dict(one)
    for name, exponent in other.items():
        found[name] = found.get(name, 0.0) + power * exponent
    return {name: exponent for name, exponent in found.items() if abs(exponent) > 1e-9}


def unit_term(node: Expression, named: Named, equal: Equal, strict: bool) -> Term | None:
    """The unit of a formula; None: it may be any. What must be the same goes to `equal`.

    strict: a number in the formula, but 0, has no unit, nor has what is raised to a power that is
    no number. Otherwise either may have any.
    """
    if isinstance(node, Number):
        return {} if strict and node.value else None
    if isinstance(node, Name):
        return named(node.name)
    operation = OPERATIONS.get(node.function)
    quantity = QUANTITIES.get(node.function) if operation is None else None
    if quantity is not None:
        return _of_quantity(node, quantity, named, equal, strict)
    if operation is not None and operation.reads:
        return _of_points(node, named, equal, strict) if operation.reads == "points" else None
    terms = [unit_term(argument, named, equal, strict) for argument in node.arguments]
    if node.function == "if":
        branches = list(zip(node.arguments[1:], terms[1:], strict=True))
        with_units = [part for part in branches if not isinstance(part[0], Number)]
        return _same(with_units or branches, equal)
    match operation.unit if operation is not None else "any":
        case "same":
            return _same(list(zip(node.arguments, terms, strict=True)), equal)
        case "compared":
            _same(list(zip(node.arguments, terms, strict=True)), equal)
            return {}
        case "levels":
            return _same(list(zip(node.arguments, terms, strict=True))[1:], equal)
        case "delayed":
            return _same([(node.arguments[i], terms[i]) for i in (0, 2)], equal)
        case "kept":
            return terms[0]
        case "lost":
            return {}
        case "root":
            return None if terms[0] is None else times({}, terms[0], 0.5)
        case "product":
            return _product(terms, 1.0)
        case "quotient":
            return _product(terms, -1.0)
        case "power":
            exponent = node.arguments[1]
            if isinstance(exponent, Number) and abs(exponent.value) <= LIMITS.largest_power:
                return None if terms[0] is None else times({}, terms[0], exponent.value)
            return _number(node, terms, equal) if strict else None
        case "number":
            return _number(node, terms, equal)
    return None


def _of_points(node: Call, named: Named, equal: Equal, strict: bool) -> Term | None:
    """The unit of what a table gives; `named` has those of its axes as `NAME.x` and `NAME.y`."""
    read, table = node.arguments
    if not isinstance(table, Name):
        return None
    abscissa = Name(f"{table.name}.x")
    of_read, of_x = unit_term(read, named, equal, strict), named(abscissa.name)
    if of_read is not None and of_x is not None:
        equal(of_read, of_x, read, abscissa)
    return named(f"{table.name}.y")


def _of_quantity(
    node: Call, quantity: Quantity, named: Named, equal: Equal, strict: bool
) -> Term | None:
    """The unit of a quantity; of its arguments those that are signals and conditions are looked
    at."""
    seen = ("signal", "condition", "happening", "number", "parameter")
    terms = {
        n: unit_term(argument, named, equal, strict)
        for n, argument in enumerate(node.arguments)
        if quantity.kind(n) in seen
    }
    first = next((term for n, term in terms.items() if quantity.kind(n) == "signal"), None)
    match quantity.unit:
        case "kept" | "inside":
            return first
        case "kept s":
            return None if first is None else times(first, {"s": 1.0})
        case "parameter":
            return next((t for n, t in terms.items() if quantity.kind(n) == "parameter"), None)
        case "s":
            return {"s": 1.0}
        case "1/s" | "Hz":
            return {"s": -1.0}
        case "number":
            return {}
        case "any":
            return None


def _same(parts: Sequence[tuple[Expression, Term | None]], equal: Equal) -> Term | None:
    """The unit of parts that have the same one, as far as they have any."""
    known = [(node, term) for node, term in parts if term is not None]
    for node, term in known[1:]:
        equal(known[0][1], term, known[0][0], node)
    return known[0][1] if known else None


def _product(terms: Sequence[Term | None], power: float) -> Term | None:
    one, other = terms
    return None if one is None or other is None else times(one, other, power)


def _number(node: Call, terms: Sequence[Term | None], equal: Equal) -> Term:
    """A number, of arguments that are numbers."""
    for argument, term in zip(node.arguments, terms, strict=True):
        if term is not None:
            equal({}, term, None, argument)
    return {}
