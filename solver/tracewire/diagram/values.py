"""Values of a diagram file: numbers, formulas, units, bounds, and tables of points."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from tracewire.data import read_curve
from tracewire.diagram.body import Body, Reference, Sees
from tracewire.diagram.diagram import Points, Value
from tracewire.diagram.grammar import AXIS, FITTED, POINTS_FILE, VALUE
from tracewire.diagram.problems import clip
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.errors import DataError, FormulaError, Location
from tracewire.formula import (
    CONSTANTS,
    FUNCTIONS,
    Expression,
    Number,
    Unit,
    calls_in,
    names_of,
    parse,
    parse_condition,
)

FREE = (-math.inf, math.inf)
UNBOUNDED = {"inf": math.inf, "+inf": math.inf, "-inf": -math.inf}
OF_BLOCKS = {name: function.instead for name, function in FUNCTIONS.items() if function.instead}
"""Functions of ports, tables and polynomials, which a diagram's own formulas do not have."""
NO_UNIT = Unit("", 1.0)


def read_formula(
    node: Node, body: Body, sees: Sees, block: str = "", condition: bool = False
) -> Expression | None:
    """A formula over the names that `sees` allows, or None with a problem noted.

    condition: whether it is a comparison, and not a number.
    """
    place = body.place(node, block)
    if not isinstance(node, Scalar):
        body.problems.add("a formula must be a text, such as 2*k", place)
        return None
    if node.style in ("'", '"'):
        place = Location(place.file, place.line, place.column + 1, place.block)
    try:
        formula = (parse_condition if condition else parse)(node.text, place)
    except FormulaError as error:
        body.problems.take(error)
        return None
    functions = {call.function for call in calls_in(formula)}
    for function in sorted(functions & OF_BLOCKS.keys()):
        what = f"formula '{clip(node.text)}': {function} is for the formulas of block declarations"
        body.problems.add(what, place, (), OF_BLOCKS[function])
        return None
    if sees == "parameter" and "[]" in functions:
        what = f"formula '{clip(node.text)}': a value is made of numbers, which have no elements"
        hint = "A vector is the signal of a block: use an expression block."
        body.problems.add(what, place, (), hint)
        return None
    for name in names_of(formula):
        if name not in CONSTANTS:
            body.references.append(Reference(name, sees, place))
    return formula


def read_value(
    node: Node, body: Body, block: str = "", unit: Unit = NO_UNIT, fit: bool = True
) -> Value | None:
    """A value: a number, a formula over parameters, or a mapping of value, unit and fit.

    unit: the unit of a value that names none itself. fit: whether bounds may be given. A unit is
    that of the numbers in the file: a formula that reads parameters is in SI, as these are.
    """
    if isinstance(node, Scalar):
        formula = read_formula(node, body, "parameter", block)
        if formula is None:
            return None
        factor, place = _factor(formula, unit), body.place(node, block)
        return Value(formula, unit.text, factor, place=place, written=unit.written)
    if isinstance(node, Items):
        what = "a value is a number, a formula, or a mapping, and not a list"
        hint = "Write it like 2.5, 2*k, or {value: 2.5, unit: N m, fit: [0, 5]}."
        body.problems.add(what, body.place(node, block), (), hint)
        return None
    body.check_keys(node, FITTED if fit else VALUE, "key of a value", block)
    given = body.required(node, "value", "a value in a mapping", block)
    if "unit" in node.values:
        unit = body.unit(node.values["unit"], block)
    formula = None if given is None else read_formula(given, body, "parameter", block)
    bounds = None
    if fit and "fit" in node.values:
        bounds = read_bounds(node.values["fit"], body, block)
    if formula is None:
        return None
    told = given is not None and body.problems.is_told(given.place)
    number = formula.value if isinstance(formula, Number) and not told else None
    if bounds and number is not None and not bounds[0] <= number <= bounds[1]:
        what = f"the value {number:g} is outside of its bounds {bounds[0]:g} to {bounds[1]:g}"
        body.problems.add(what, body.place(node, block), (), "Widen 'fit', or change the value.")
    scaled = (bounds[0] * unit.factor, bounds[1] * unit.factor) if bounds else None
    return Value(
        formula,
        unit.text,
        _factor(formula, unit),
        scaled,
        named=True,
        place=body.place(node, block),
        written=unit.written,
    )


def _factor(formula: Expression, unit: Unit) -> float:
    """The factor to SI of a value in a unit."""
    return 1.0 if reads_parameters(formula) else unit.factor


def reads_parameters(formula: Expression) -> bool:
    """Whether a formula is more than a number that is worked out."""
    return any(name not in CONSTANTS for name in names_of(formula))


def read_bounds(node: Node, body: Body, block: str = "") -> tuple[float, float] | None:
    """The bounds of a fit, in the unit of the value: `free`, or [low, high] (-inf, inf allowed)."""
    if isinstance(node, Scalar) and node.text == "free":
        return FREE
    hint = "Write fit: [low, high] in the unit of the value, or fit: free."
    if not isinstance(node, Items) or len(node.items) != 2:
        what = "the bounds of a fit are two numbers"
        body.problems.add(what, body.place(node, block), (), hint + two_of(node))
        return None
    ends = []
    for item in node.items:
        if isinstance(item, Scalar) and item.text in UNBOUNDED:
            ends.append(UNBOUNDED[item.text])
        else:
            end = body.number(item, "a bound of a fit", block)
            if end is None:
                return None
            ends.append(end)
    low, high = ends
    if not low < high:
        if not any(body.problems.is_told(item.place) for item in node.items):
            what = f"the lower bound {low:g} is not below the upper bound {high:g}"
            body.problems.add(what, body.place(node, block), (), hint)
        return None
    return low, high


def two_of(node: Node) -> str:
    """What to say where a pair has more than two numbers: a comma may be meant as a point."""
    return " A decimal has a point: 1.5." if isinstance(node, Items) and len(node.items) > 2 else ""


def read_points(node: Node, body: Body, block: str) -> Points | None:
    """A table of points: [[x, y], ...], or {file, x, y} with the names of two columns."""
    place = body.place(node, block)
    if isinstance(node, Entries):
        return _points_of_columns(node, body, block)
    if not isinstance(node, Items):
        hint = "Write it like [[0, 0], [1, 2]], or {file: table.csv, x: column, y: column}."
        body.problems.add("a table of points must be a list of pairs", place, (), hint)
        return None
    points: list[tuple[float, float]] = []
    for item in node.items:
        if not isinstance(item, Items) or len(item.items) != 2:
            hint = "Write it like [0.5, 2]."
            body.problems.add("a point must be a pair [x, y]", body.place(item, block), (), hint)
            return None
        x, y = (body.number(part, "a coordinate of a point", block) for part in item.items)
        if x is None or y is None:
            return None
        if points and x <= points[-1][0]:
            what = f"the points must ascend in x, and {x:g} is not above {points[-1][0]:g}"
            body.problems.add(what, body.place(item, block), (), "Sort them.")
            return None
        points.append((x, y))
    if len(points) < 2:
        body.problems.add("a table needs at least two points", place)
        return None
    return Points(tuple(x for x, _ in points), tuple(y for _, y in points), place)


def _points_of_columns(node: Entries, body: Body, block: str) -> Points | None:
    body.check_keys(node, POINTS_FILE, "key of a table", block)
    parts = [body.required(node, key, "a table from a file", block) for key in POINTS_FILE]
    file, *columns = parts
    if file is not None and body.text(file, "'file'", block) is None:
        return None
    x, y = (None if part is None else _axis(part, body, block) for part in columns)
    if not isinstance(file, Scalar) or x is None or y is None:
        return None
    return points_of_file(file.path, x, y, body, body.place(node, block))


def _axis(node: Node, body: Body, block: str) -> Axis | None:
    """A column of a table: its name, or {column, unit}."""
    if not isinstance(node, Entries):
        name = body.text(node, "a column", block)
        return None if name is None else Axis(name)
    body.check_keys(node, AXIS, "key of a column", block)
    given = body.required(node, "column", "a column of a table", block)
    name = None if given is None else body.text(given, "'column'", block)
    unit = None
    if "unit" in node.values:
        body.unit(node.values["unit"], block)
        unit = body.text(node.values["unit"], "a unit", block)
    return None if name is None else Axis(name, unit)


@dataclass(frozen=True)
class Axis:
    """A column of a table, and its unit; None: that of the header."""

    column: str
    unit: str | None = None


def points_of_file(path: Path, x: Axis, y: Axis, body: Body, place: Location) -> Points | None:
    """A table of points in two columns of a file."""
    try:
        curve = read_curve(path, x.column, y.column, (x.unit, y.unit), place)
    except (DataError, FormulaError) as error:
        body.problems.take(error)
        return None
    # read_curve promises at least two rows, ascending
    return Points(tuple(curve.x.tolist()), tuple(curve.y.tolist()), place, curve.units)
