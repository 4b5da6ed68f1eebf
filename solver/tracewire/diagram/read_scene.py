"""`scene`: how a diagram is drawn as a mechanism, a list of parts that signals move."""

from __future__ import annotations

from tracewire.diagram.body import Body
from tracewire.diagram.diagram import ScenePart
from tracewire.diagram.limits import LIMITS
from tracewire.diagram.problems import clip
from tracewire.diagram.scene_kinds import COLORS, KINDS
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.diagram.values import read_formula
from tracewire.formula import ALONG, FUNCTIONS, Expression, Number, calls_in

EXAMPLE = "- rod: {from: [0, 0], to: [l*sin(phi), -l*cos(phi)]}"
NOT_ALONG = FUNCTIONS.keys() - ALONG.keys()
"""Functions that mean nothing for samples alone."""


def read_scene(node: Node, body: Body) -> tuple[ScenePart, ...]:
    """`scene`: a list of parts, each a mapping of its kind to its points and sizes."""
    if not isinstance(node, Items):
        what = "'scene' must be a list of parts"
        body.problems.add(what, body.place(node), (), f"Write it like {EXAMPLE}.")
        return ()
    if len(node.items) > LIMITS.most_parts:
        what = f"the scene has {len(node.items)} parts, "
        what += f"and at most {LIMITS.most_parts} can be drawn"
        body.problems.add(what, body.place(node), (), "Draw the bodies that move.")
    parts = (_read_part(item, body) for item in node.items[: LIMITS.most_parts])
    return tuple(part for part in parts if part is not None)


def _read_part(node: Node, body: Body) -> ScenePart | None:
    if not isinstance(node, Entries) or len(node.keys) != 1:
        what = "a part of a scene is a mapping of its kind to what it needs"
        body.problems.add(what, body.place(node), sorted(KINDS), f"Write it like {EXAMPLE}.")
        return None
    ((name, key, given),) = node
    kind = KINDS.get(name)
    if kind is None:
        body.problems.unknown("part of a scene", name, KINDS, body.place(key))
        return None
    entries = body.entries(given, f"a {name}", kind.example)
    if entries is None:
        return None
    body.check_keys(entries, kind.keys, f"key of a {name}")
    points: dict[str, tuple[Expression, Expression]] = {}
    for point in kind.points:
        where = body.required(entries, point, f"a {name}")
        read = None if where is None else _read_point(where, body, f"'{point}' of a {name}")
        if read is not None:
            points[point] = read
    sizes: dict[str, Expression] = {
        size: Number(usual) for size, usual in kind.usual.items() if usual is not None
    }
    for size in kind.sizes:
        body.required(entries, size, f"a {name}")
    for size in (*kind.sizes, *kind.usual):
        formula = _read_size(entries.values[size], body) if size in entries.values else None
        if formula is not None:
            sizes[size] = formula
    color = _read_color(entries, body)
    return ScenePart(name, points, sizes, color, body.place(key))


def _read_point(node: Node, body: Body, what: str) -> tuple[Expression, Expression] | None:
    """A point [x, y]: two formulas."""
    if not isinstance(node, Items) or len(node.items) != 2:
        hint = "Write it like [l*sin(phi), -l*cos(phi)]; quote a formula that has a comma."
        body.problems.add(f"{what} must be a pair [x, y]", body.place(node), (), hint)
        return None
    x, y = (_read_size(item, body) for item in node.items)
    return None if x is None or y is None else (x, y)


def _read_size(node: Node, body: Body) -> Expression | None:
    """A formula over signals, parameters and t, in SI, that has a value at each sample alone."""
    formula = read_formula(node, body, "either")
    if formula is None:
        return None
    for function in sorted({call.function for call in calls_in(formula)} & NOT_ALONG):
        text = node.text if isinstance(node, Scalar) else ""
        what = f"formula '{clip(text)}': a scene cannot work out {function}"
        hint = "Make it an expression block of the diagram, and name that here."
        body.problems.add(what, body.place(node), (), hint)
        return None
    return formula


def _read_color(entries: Entries, body: Body) -> str:
    node = entries.values.get("color")
    name = "" if node is None else body.text(node, "'color' of a part") or ""
    if node is not None and name and name not in COLORS:
        body.problems.unknown("color", name, COLORS, body.place(node))
        return ""
    return name
