"""The sections that only the top of a diagram file has: span, every, record and so on."""

from __future__ import annotations

from tracewire.diagram.body import Body
from tracewire.diagram.diagram import Condition, Diagram, Value
from tracewire.diagram.names import find_parameter, find_recorded, is_count, parameters, recordable
from tracewire.diagram.problems import clip
from tracewire.diagram.strict import Items, Node
from tracewire.diagram.uses import in_unit_of
from tracewire.diagram.values import read_formula, read_value, two_of
from tracewire.errors import Location
from tracewire.formula import Number


def read_span(node: Node, body: Body) -> tuple[Value, Value] | None:
    """`span`: [from, to] in s."""
    if not isinstance(node, Items) or len(node.items) != 2:
        hint = "Write it like [0, 40]." + two_of(node)
        body.problems.add("'span' must be a pair of times", body.place(node), (), hint)
        return None
    begin, end = (read_value(item, body, fit=False) for item in node.items)
    if begin is None or end is None:
        return None
    first, last = _number(begin), _number(end)
    if first is not None and last is not None and not first < last:
        what = f"the span ends at {last:g} s, not after its begin at {first:g} s"
        body.problems.add(what, body.place(node))
    return begin, end


def read_every(node: Node, body: Body) -> Value | None:
    """`every`: the interval of the output in s."""
    return _read_interval(node, body, "every", "It is the interval between output samples.")


def read_max_step(node: Node, body: Body) -> Value | None:
    """`max_step`: the longest step of a run in s."""
    return _read_interval(node, body, "max_step", "It is the longest step that a run may take.")


def _read_interval(node: Node, body: Body, key: str, hint: str) -> Value | None:
    found = read_value(node, body, fit=False)
    number = None if found is None else _number(found)
    if number is not None and number <= 0:
        what = f"'{key}' must be above zero, not {number:g} s"
        body.problems.add(what, body.place(node), (), hint)
    return found


def _number(value: Value) -> float | None:
    return value.formula.value * value.factor if isinstance(value.formula, Number) else None


def read_record(node: Node, body: Body, diagram: Diagram) -> dict[str, Location]:
    """`record`: the signals to keep, by full name."""
    found: dict[str, Location] = {}
    for name in body.scalars(node, "'record'"):
        text, place = name.text.strip(), body.place(name)
        signal = find_recorded(diagram, text)
        if signal is not None:
            found.setdefault(signal, place)
        elif (use := diagram.blocks.get(text)) is not None:
            ports = use.subsystem.outputs if use.subsystem else ()
            outputs = ports or [o.name for o in diagram.library[use.type].outputs]
            several = tuple(f"{text}.{port}" for port in outputs)
            what = f"block '{clip(text)}' has {len(several)} outputs"
            body.problems.add(what, place, several, "Name one of them.")
        else:
            body.problems.unknown("signal", text, recordable(diagram), place)
    return found


def read_require(node: Node, body: Body) -> tuple[Condition, ...]:
    """`require`: comparisons of parameters."""
    if not isinstance(node, Items):
        hint = "Write it like [B1*B2 - N12**2 > 0]."
        what = "'require' must be a list of comparisons"
        body.problems.add(what, body.place(node), (), hint)
        return ()
    read = ((item, read_formula(item, body, "parameter", condition=True)) for item in node.items)
    return tuple(Condition(found, body.place(item)) for item, found in read if found is not None)


def read_presets(node: Node, body: Body, diagram: Diagram) -> dict[str, dict[str, Value]]:
    """`presets`: a mapping of names to values of parameters, by their path."""
    found: dict[str, dict[str, Value]] = {}
    for preset, _, given in body.entries(node, "'presets'", "{as_printed: {k: 2}}") or ():
        found[preset] = read_settings(given, body, diagram, f"preset '{clip(preset)}'")
    return found


def read_settings(
    node: Node, body: Body, diagram: Diagram, what: str, fit: bool = False
) -> dict[str, Value]:
    """Values of parameters of a diagram by their path. fit: whether they may have bounds."""
    found: dict[str, Value] = {}
    for path, key, given in body.entries(node, what, "{k: 2}") or ():
        declared = find_parameter(diagram, path)
        value = read_value(given, body, fit=fit)
        if declared is None:
            _explain(diagram, path, body.place(key), body)
        elif is_count(diagram, path):
            what = f"'{clip(path)}' says how many blocks there are, and a run cannot change it"
            hint = "Change it where it is declared, or in a diagram that extends this one."
            body.problems.add(what, body.place(key), (), hint)
        elif value is not None:
            found[path] = in_unit_of(value, declared)
    return found


def _explain(diagram: Diagram, path: str, place: Location, body: Body) -> None:
    inside, head = diagram, path
    if path.endswith(".variant"):
        what = f"'{clip(path)}' is no parameter: a variant is chosen when the diagram is read"
        hint = "Name a parameter in the block, variant: law, which has its number, and set that."
        body.problems.add(what, place, (), hint)
        return
    while "." in head:
        name, _, rest = head.partition(".")
        use = inside.blocks.get(name)
        if use is None:
            break
        if use.subsystem is None and use.type not in inside.library:
            return  # its type is wrong, and that is told already
        if use.subsystem is None and rest in (p.name for p in inside.library[use.type].parameters):
            what = f"'{clip(path)}' is not a parameter that can be set"
            hint = f"Write {rest}: {{value: ...}} in the block, and it is."
            body.problems.add(what, place, (), hint)
            return
        if use.subsystem is None:
            break
        inside, head = use.subsystem, rest
    body.problems.unknown("parameter", path, parameters(diagram), place)
