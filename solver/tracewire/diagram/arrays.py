"""Lists in a diagram file: vectors of values, vectors and matrices of formulas."""

from __future__ import annotations

from tracewire.diagram.body import Body
from tracewire.diagram.diagram import Array, Value
from tracewire.diagram.strict import Items, Node
from tracewire.diagram.values import read_formula, read_value
from tracewire.formula import Call, Expression


def read_array(node: Node, body: Body, block: str = "", fit: bool = True) -> Value | Array | None:
    """A value, or a list of values: `start: [0.1, {value: 5, unit: deg}]`."""
    if not isinstance(node, Items):
        return read_value(node, body, block, fit=fit)
    if not node.items:
        body.problems.add("a vector has at least one element", body.place(node, block))
        return None
    values = [read_value(item, body, block, fit=fit) for item in node.items]
    items = tuple(value for value in values if value is not None)
    return Array(items, body.place(node, block)) if len(items) == len(values) else None


def read_formulas(node: Node, body: Body, block: str = "") -> Expression | None:
    """A formula; a list of them is a vector, a list of equally long lists a matrix by rows."""
    if not isinstance(node, Items):
        return read_formula(node, body, "either", block)
    place = body.place(node, block)
    if not node.items:
        body.problems.add("a vector has at least one element", place)
        return None
    rows = [item for item in node.items if isinstance(item, Items)]
    if not rows:
        cells = [read_formula(item, body, "either", block) for item in node.items]
        found = tuple(cell for cell in cells if cell is not None)
        return Call("stack", found) if len(found) == len(cells) else None
    for number, item in enumerate(node.items):
        width = len(item.items) if isinstance(item, Items) else 1
        if not isinstance(item, Items) or width != len(rows[0].items):
            what = f"a matrix has rows of one length, and row {number} has another"
            hint = "Write it like [[a, b], [c, d]]."
            body.problems.add(what, body.place(item, block), (), hint)
            return None
        if any(isinstance(cell, Items) for cell in item.items):
            what = "a list of matrices is no matrix"
            body.problems.add(what, body.place(item, block), (), "Write it like [[a, b], [c, d]].")
            return None
    lines = [read_formulas(row, body, block) for row in rows]
    whole = tuple(line for line in lines if line is not None)
    return Call("stack", whole) if len(whole) == len(lines) else None
