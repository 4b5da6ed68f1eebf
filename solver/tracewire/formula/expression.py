"""The nodes of a formula: numbers, names and calls. An operator is a call of its sign."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Number:
    """A literal, always finite."""

    value: float


@dataclass(frozen=True, slots=True)
class Name:
    """A signal, a parameter, `t` or a constant; parts of a path are joined by dots."""

    name: str


@dataclass(frozen=True, slots=True)
class Call:
    """A function or operator and its arguments: `+ - * / ** neg < <= > >= and or not if` or a name.

    `if` has the arguments condition, value where it holds, value where it does not.
    """

    function: str
    arguments: tuple[Expression, ...]


Expression = Number | Name | Call
DELAYS = ("delayed", "shifted")
"""Functions that read their first argument as it was."""


def names_of(expression: Expression) -> tuple[str, ...]:
    """Every name in the formula, once, in the order of first appearance."""
    found: dict[str, None] = {}

    def visit(node: Expression) -> None:
        if isinstance(node, Name):
            found.setdefault(node.name)
        elif isinstance(node, Call):
            for argument in node.arguments:
                visit(argument)

    visit(expression)
    return tuple(found)


def calls_in(expression: Expression) -> Iterator[Call]:
    """Every call in the formula."""
    due = [expression]
    while due:
        node = due.pop()
        if isinstance(node, Call):
            yield node
            due += node.arguments


def has_delay(expression: Expression) -> bool:
    """Whether a part of the formula is read with a delay."""
    return any(call.function in DELAYS for call in calls_in(expression))


def read_at_once(expression: Expression, also_before: bool = False) -> tuple[str, ...]:
    """The names that the formula reads without a delay, each once; also_before: and those of what
    delayed signals were before the start."""
    found: dict[str, None] = {}

    def visit(node: Expression) -> None:
        if isinstance(node, Name):
            found.setdefault(node.name)
        elif isinstance(node, Call):
            later = {0} if also_before else {0, 2}
            for number, argument in enumerate(node.arguments):
                if node.function != "delayed" or number not in later:
                    visit(argument)

    visit(expression)
    return tuple(found)


def rename(expression: Expression, change: Callable[[str], Expression]) -> Expression:
    """The formula with every name replaced by what `change` makes of it."""
    if isinstance(expression, Name):
        return change(expression.name)
    if isinstance(expression, Call):
        arguments = tuple(rename(argument, change) for argument in expression.arguments)
        return Call(expression.function, arguments)
    return expression
