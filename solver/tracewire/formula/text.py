"""From a formula back to text, with no more brackets than it needs."""

from __future__ import annotations

import math

from tracewire.formula.expression import Call, Expression, Name, Number

LEVELS = {"if": 0, "or": 1, "and": 2, "not": 3, "<": 4, "<=": 4, ">": 4, ">=": 4}
LEVELS |= {"+": 5, "-": 5, "*": 6, "/": 6, "neg": 7, "**": 8}
ATOM = 9


def number_text(value: float) -> str:
    """The shortest text that reads back as the same number, without a useless `.0`."""
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def two_digits(value: float) -> str:
    """The first two digits of a number, written out below a million: `260`, and not `2.6e+02`."""
    return f"{float(f'{value:.2g}'):g}"


def to_text(expression: Expression) -> str:
    """The formula as a user would write it; parsing it again gives the same formula."""
    return _write(expression)[0]


def _write(node: Expression) -> tuple[str, int]:
    if isinstance(node, Number):
        signed = math.copysign(1.0, node.value) < 0  # of -0.0, too
        return number_text(node.value), (LEVELS["neg"] if signed else ATOM)
    if isinstance(node, Name):
        return node.name, ATOM
    if node.function == "stack":
        return f"[{', '.join(to_text(a) for a in node.arguments)}]", ATOM
    if node.function == "[]":
        vector, *indices = node.arguments
        return f"{_write(vector)[0]}[{', '.join(map(to_text, indices))}]", ATOM
    level = LEVELS.get(node.function)
    if level is None:
        return f"{node.function}({', '.join(to_text(a) for a in node.arguments)})", ATOM
    return _operator(node, level), level


def _operator(node: Call, level: int) -> str:
    def part(argument: Expression, least: int) -> str:
        text, inner = _write(argument)
        return text if inner >= least else f"({text})"

    arguments = node.arguments
    match node.function:
        case "neg":
            return "-" + part(arguments[0], level + 1)
        case "not":
            return "not " + part(arguments[0], level)
        case "if":
            condition, then, other = arguments
            return f"{part(then, 1)} if {part(condition, 1)} else {part(other, 0)}"
        case "and" | "or":
            return f" {node.function} ".join(part(argument, level + 1) for argument in arguments)
        case "**":
            # the exponent binds like a sign: 2**-x and 2**x**y need no brackets
            return f"{part(arguments[0], ATOM)}**{part(arguments[1], 7)}"
        case "*" | "/":
            return f"{part(arguments[0], level)}{node.function}{part(arguments[1], level + 1)}"
        case _:
            return f"{part(arguments[0], level)} {node.function} {part(arguments[1], level + 1)}"
