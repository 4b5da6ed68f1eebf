"""The numbers that have a name at the top level of a file."""

from __future__ import annotations

import ast


def constants(source: str) -> list[str]:
    """The names at the top level of a file that stand for a single number; tables do not count."""
    found = []
    for node in ast.parse(source).body:
        if isinstance(node, ast.AnnAssign) and node.value is not None:
            pairs = [(node.target, node.value)]
        elif isinstance(node, ast.Assign):
            pairs = [(target, node.value) for target in node.targets]
        else:
            continue
        for target, value in pairs:
            if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
                some = zip(target.elts, value.elts, strict=False)
            else:
                some = zip([target], [value], strict=True)
            found += [ast.unparse(name) for name, number in some if is_number(number)]
    return found


def is_number(node: ast.expr) -> bool:
    """Whether an expression is a number, or made of numbers by operators."""
    match node:
        case ast.Constant(value=bool()):
            return False
        case ast.Constant(value=int() | float()):
            return True
        case ast.UnaryOp(operand=inner):
            return is_number(inner)
        case ast.BinOp(left=left, right=right):
            return is_number(left) and is_number(right)
    return False
