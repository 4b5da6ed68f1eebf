"""What is wrong with one formula of a block declaration: its grammar, and what it reads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

from tracewire.errors import FormulaError, Location, Problem, unknown
from tracewire.formula import CONSTANTS, FUNCTIONS, Call, Expression, Name, parse, parse_condition

Use = Literal["value", "wires", "points"]
READ_BY: dict[Use, str] = {
    "value": "by its name alone",
    "wires": "by sum(), product(), min(), max() or join()",
    "points": "by interp(), cubic_spline() or monotone_cubic()",
}


def check_formula(
    text: str, visible: Mapping[str, Use], place: Location, condition: bool = False
) -> list[Problem]:
    """The problems of a formula, or of a condition, that may read what is visible."""
    try:
        formula = parse_condition(text, place) if condition else parse(text, place)
    except FormulaError as error:
        return list(error.problems)
    problems = []
    for name, uses in dict.fromkeys(_uses(formula)):
        if name not in visible and name not in CONSTANTS:
            problems.append(unknown("name", name, visible, place, f"It stands in '{text}'."))
        elif visible.get(name, "value") not in uses:
            right = READ_BY[visible.get(name, "value")]
            problems.append(Problem(f"formula '{text}': '{name}' is read {right}", place))
    return problems


def _uses(
    formula: Expression, uses: tuple[Use, ...] = ("value",)
) -> Iterator[tuple[str, tuple[Use, ...]]]:
    """Each name in the formula, and as what it may be read there."""
    if isinstance(formula, Name):
        yield formula.name, uses
    elif isinstance(formula, Call):
        called = FUNCTIONS.get(formula.function)
        each: tuple[Use, ...] = ("value",)
        last = each
        if called is not None and called.most is None:
            each = last = ("value", "wires")
        elif called is not None and called.reads:
            last = (called.reads,)
        for argument in formula.arguments[:-1]:
            yield from _uses(argument, each)
        yield from _uses(formula.arguments[-1], last)
