"""`expect`: what a diagram must show, a list of statements about quantities of its runs."""

from __future__ import annotations

from dataclasses import replace

from tracewire.diagram.body import Body
from tracewire.diagram.diagram import Diagram, Setting, Statement
from tracewire.diagram.grammar import EXPECTED, STATEMENT
from tracewire.diagram.problems import clip
from tracewire.diagram.quantity_names import quantities_in, quantity_problems
from tracewire.diagram.read_setting import read_setting
from tracewire.diagram.setting_use import refuse_unused
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.errors import DiagramError, FormulaError, Location
from tracewire.formula import QUANTITIES, Call, Expression, Unit, parse_quantity, to_text

TEXTS = ("name", "says", "what", "source", "erratum", "note")
VERDICTS = ("stable", "unstable", "neutral", "nonsmooth")
EXAMPLE = '- {that: "end(x)", is: 0.0136, within: 1e-6, source: "Table 3"}'
ONE_OF = "Write one of: is: 2 with within: 0.1 or within: 5 %; above: 1; below: 3; between: [1, 3]."


def read_expect(node: Node, body: Body, diagram: Diagram) -> tuple[Statement, ...]:
    """`expect`: a list of statements, each a mapping."""
    if not isinstance(node, Items):
        what = "'expect' must be a list of statements"
        body.problems.add(what, body.place(node), (), f"Write it like {EXAMPLE}.")
        return ()
    read = (_read_statement(item, body, diagram) for item in node.items)
    found = [statement for statement in read if statement is not None]
    first: dict[str, Location] = {}
    for statement in found:
        if statement.name in first:
            what = f"two statements are called '{clip(statement.name)}'"
            hint = f"The other one is in line {first[statement.name].line}: give one a 'name'."
            body.problems.add(what, statement.place, (), hint)
        first.setdefault(statement.name, statement.place)
    return tuple(found)


def _read_statement(node: Node, body: Body, diagram: Diagram) -> Statement | None:
    entries = body.entries(node, "a statement", EXAMPLE.removeprefix("- "))
    if entries is None:
        return None
    body.check_keys(entries, STATEMENT, "key of a statement")
    given = entries.values
    unit = body.unit(given["unit"]) if "unit" in given else Unit("", 1.0)
    run = read_setting(given["run"], body, diagram) if "run" in given else Setting()
    reference = None
    if "reference" in given:
        reference = read_setting(given["reference"], body, diagram, reference=True)
    node_of_that = body.required(entries, "that", "a statement")
    that = None if node_of_that is None else read_quantity(node_of_that, body)
    if that is None or node_of_that is None:
        return None
    place = body.place(node_of_that)
    if wrong := quantity_problems(that, diagram, place, reference):
        body.problems.take(DiagramError(wrong))
    for key, inside in (("run", False), ("reference", True)):
        if key in given:
            refuse_unused(given[key], body, quantities_in(that, reference=inside))
    texts = {key: body.text(given[key], f"'{key}'") or "" if key in given else "" for key in TEXTS}
    shown = to_text(that)
    base = Statement(
        that,
        texts["name"] or shown,
        texts["says"],
        texts["what"] or shown,
        texts["source"],
        unit=body.text(given["unit"], "a unit") or "" if "unit" in given else "",
        factor=unit.factor,
        erratum=texts["erratum"],
        note=texts["note"],
        run=run,
        reference=reference,
        place=place,
    )
    return _with_bounds(base, entries, body, diagram)


def read_quantity(node: Node, body: Body) -> Expression | None:
    """A quantity, or None with a problem noted."""
    if not isinstance(node, Scalar):
        hint = 'Quote it where it has a comma: that: "at(x, 2)".'
        body.problems.add("a quantity must be a text, such as end(x)", body.place(node), (), hint)
        return None
    place = body.place(node)
    if node.style in ("'", '"'):
        place = Location(place.file, place.line, place.column + 1, place.block)
    try:
        return parse_quantity(node.text, place)
    except FormulaError as error:
        body.problems.take(error)
        return None


def _with_bounds(
    base: Statement, entries: Entries, body: Body, diagram: Diagram
) -> Statement | None:
    """The statement with what is expected of its quantity."""
    given, place = entries.values, base.place
    there = [key for key in EXPECTED if key in given]
    if len(there) != 1:
        what = f"a statement has {' and '.join(there)}" if there else "a statement expects nothing"
        body.problems.add(what, place, (), ONE_OF)
        return None
    if "within" in given and there != ["is"]:
        what = "'within' belongs to 'is'"
        body.problems.add(what, body.place(given["within"]), (), ONE_OF)
    (kind,) = there
    bound = given[kind]
    if kind == "between":
        return _between(base, bound, body, diagram)
    known = QUANTITIES.get(base.that.function) if isinstance(base.that, Call) else None
    if known is not None and known.text:
        return _word(base, kind, bound, body)
    found = _read_bound(bound, body, diagram)
    if found is None:
        return None
    if kind == "above":
        return replace(base, above=found)
    if kind == "below":
        return replace(base, below=found)
    if "within" not in given:
        hint = "Write within: 1e-6, in the unit of the quantity, or within: 1 %."
        body.problems.add("a statement with 'is' needs 'within'", place, (), hint)
        return None
    within = _read_within(given["within"], body)
    if within is None:
        return None
    return replace(base, value=found, within=within[0], relative=within[1])


def _between(base: Statement, node: Node, body: Body, diagram: Diagram) -> Statement | None:
    if not isinstance(node, Items) or len(node.items) != 2:
        hint = "Write it like between: [1, 3]."
        body.problems.add("'between' must be a pair of numbers", body.place(node), (), hint)
        return None
    low, high = (_read_bound(item, body, diagram) for item in node.items)
    return None if low is None or high is None else replace(base, above=low, below=high)


def _word(base: Statement, kind: str, node: Node, body: Body) -> Statement | None:
    text = body.text(node, f"'{kind}'") or ""
    if kind != "is":
        what = f"'{clip(base.what)}' is a word, and not {kind} anything"
        body.problems.add(what, body.place(node), VERDICTS, "Write is: stable.")
        return None
    if text not in VERDICTS:
        body.problems.unknown("verdict", text, VERDICTS, body.place(node))
        return None
    return replace(base, word=text)


def _read_bound(node: Node, body: Body, diagram: Diagram) -> Expression | None:
    """A number that is expected: a formula of numbers, parameters and what theory knows."""
    found = read_quantity(node, body)
    if found is not None:
        wrong = quantity_problems(found, diagram, body.place(node), fixed=True)
        if wrong:
            body.problems.take(DiagramError(wrong))
    return found


def _read_within(node: Node, body: Body) -> tuple[float, bool] | None:
    """A tolerance, and whether it is a part of the value."""
    text = body.text(node, "'within'") or ""
    part = text.endswith("%")
    try:
        value = float(text.removesuffix("%"))
    except ValueError:
        value = -1.0
    if not 0 <= value < float("inf"):
        what = f"'within' must be a number from 0 on, or a part such as 1 %, not '{clip(text)}'"
        body.problems.add(what, body.place(node))
        return None
    return (value / 100, True) if part else (value, False)
