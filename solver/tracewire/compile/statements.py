"""The units of statements: what a diagram expects is in the unit of its quantity."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from tracewire.compile.dimensions import unit_of
from tracewire.compile.model import Model
from tracewire.compile.quantity_units import in_full
from tracewire.diagram import Statement
from tracewire.errors import Problem
from tracewire.formula import dimension_of, dimension_text, read_unit


def statement_problems(model: Model, statements: Iterable[Statement]) -> list[Problem]:
    """Where the unit of a statement is not that of its quantity in a model. A name that the model
    does not have may be of any unit."""
    found: list[Problem] = []
    for statement in statements:
        term, inside = unit_of(model.flat, in_full(model, statement.that))
        found += [replace(problem, place=statement.place) for problem in inside]
        given = dimension_of(read_unit(statement.unit).text) if statement.unit else None
        if term is not None and given is not None and term != given:
            what = (
                f"'{statement.what}' is in {dimension_text(term) or 'no unit'}, and its unit is "
                f"'{statement.unit}'"
            )
            hint = "Give the unit in which 'is' and the bounds are written."
            found.append(Problem(what, statement.place, hint=hint))
    return found
