"""A subsystem of which a parameter chooses the body: all run, and it has the outputs of one."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from tracewire.diagram.diagram import Condition, Diagram, Value
from tracewire.diagram.extend import variants_of, with_variant
from tracewire.diagram.problems import Problems
from tracewire.diagram.strict import Entries, Node, Scalar
from tracewire.formula import Call, Name, Number

NUMBER = "variant"
"""The parameter of such a subsystem that has the number of the body, from 1."""
WORD = re.compile(r"(?<![\w.])[A-Za-z_]\w*", re.ASCII)


def side_by_side(name: str, entries: Entries) -> Entries:
    """The sections of a subsystem in which each of its variants is a block, as `cubic_body`.

    name: that of the subsystem, which is the type of these blocks. Its parameters are those that
    mean the same in all bodies which have them; any other one stays with its body, as
    `drag.cubic_body.c`.
    """
    variants = variants_of(entries)
    bodies = {variant: with_variant(entries, variant, Problems()) for variant in variants}
    shared = _shared(bodies)
    given = entries.inside("variants")
    keys: dict[str, Scalar] = {}
    lines: dict[str, Node] = {}
    for variant, body in bodies.items():
        passed = [*_part(body, "inputs"), *(p for p in _part(body, "parameters") if p in shared)]
        line = {"type": name, "variant": variant} | {each: each for each in passed}
        key, block = given.keys[variant], f"{variant}_body"
        keys[block], lines[block] = replace(key, text=block), _line(line, key)
    usual = bodies[variants[0]]
    outputs = usual.values.get("outputs")
    chosen: dict[str, Node] = {}
    for output, key in outputs.keys.items() if isinstance(outputs, Entries) else ():
        *others, last = (f"{variant}_body.{output}" for variant in variants)
        formula = "".join(f"{o} if {NUMBER} <= {n} else " for n, o in enumerate(others, start=1))
        block = f"chosen_{output}"
        keys[block] = replace(key, text=block)
        line = {"type": "expression", "formula": formula + last}
        if unit := _unit(usual, output):
            line["unit"] = unit
        lines[block] = _line(line, key)
        chosen[output] = keys[block]
    sections: dict[str, Node] = {"blocks": replace(given, keys=keys, values=lines)}
    if isinstance(outputs, Entries):
        sections["outputs"] = replace(outputs, values=chosen)
    if "inputs" in usual.values:
        sections["inputs"] = usual.values["inputs"]
    if shared:
        names = {
            name: key for body in bodies.values() for name, key in _part(body, "parameters").items()
        }
        own = {name: names[name] for name in shared}
        sections["parameters"] = replace(given, keys=own, values=shared)
    headings = {section: replace(given.keys[variants[0]], text=section) for section in sections}
    return replace(entries, keys=headings, values=sections)


def is_chosen(diagram: Diagram) -> bool:
    """Whether a diagram is a subsystem of which a parameter chooses the body."""
    return bool(diagram.variants) and not diagram.variant


def with_number(diagram: Diagram) -> Diagram:
    """Such a subsystem with the parameter that chooses, and the condition that there is a body."""
    variants = diagram.variants
    listed = ", ".join(f"{number} {name}" for number, name in enumerate(variants, start=1))
    hint = f"It is the number of a variant: {listed}."
    number = Name(NUMBER)
    conditions = tuple(
        Condition(Call(relation, (left, right)), diagram.place, hint)
        for left, relation, right in (
            (number, ">=", Number(1.0)),
            (number, "<=", Number(float(len(variants)))),
            (Call("floor", (number,)), ">=", number),
        )
    )
    value = Value(Number(1.0), place=diagram.place)
    return replace(diagram, parameters={NUMBER: value, **diagram.parameters}, require=conditions)


def _shared(bodies: Mapping[str, Entries]) -> dict[str, Node]:
    """The parameters that have one node in all bodies, and so have those that they are made of."""
    known: dict[str, Node] = {}
    apart: set[str] = set()
    for body in bodies.values():
        parameters = body.values.get("parameters")
        for name, _, node in parameters if isinstance(parameters, Entries) else ():
            if known.setdefault(name, node) is not node:
                apart.add(name)
    while read := {n for n in known.keys() - apart if apart.intersection(_read_by(known[n]))}:
        apart |= read
    return {name: node for name, node in known.items() if name not in apart}


def _read_by(node: Node) -> list[str]:
    """The names in the value of a parameter."""
    value = node.values.get("value") if isinstance(node, Entries) else node
    return WORD.findall(value.text) if isinstance(value, Scalar) else []


def _part(entries: Entries, section: str) -> dict[str, Scalar]:
    node = entries.values.get(section)
    return node.keys if isinstance(node, Entries) else {}


def _unit(entries: Entries, output: str) -> str:
    """The unit of the block that an output carries; empty where it has none."""
    node: Node | None = entries
    carried = entries.values.get("outputs")
    wire = carried.values.get(output) if isinstance(carried, Entries) else None
    for key in ("blocks", wire.text if isinstance(wire, Scalar) else "", "unit"):
        node = node.values.get(key) if isinstance(node, Entries) else None
    return node.text if isinstance(node, Scalar) else ""


def _line(texts: Mapping[str, str], at: Scalar) -> Entries:
    """The line of a block, which stands in no text; its mistakes are told at `at`."""
    keys = {name: replace(at, text=name, style="") for name in texts}
    values: dict[str, Node] = {n: replace(at, text=text, style="") for n, text in texts.items()}
    return Entries(keys, values, at.place, at.start, at.end, True)
