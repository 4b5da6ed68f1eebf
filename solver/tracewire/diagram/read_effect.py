"""`effect` of a subsystem: what makes a user's own subsystem one that a trace tries."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TypeVar, get_args

from tracewire.diagram.body import Body
from tracewire.diagram.diagram import Diagram
from tracewire.diagram.grammar import EFFECT, SHAPE, SIGNS
from tracewire.diagram.problems import clip
from tracewire.diagram.strict import Items, Node
from tracewire.library import (
    SCALES,
    SYMBOLS,
    Effect,
    Face,
    Scale,
    Shape,
    Symbol,
    Where,
    check_effect,
)

Word = TypeVar("Word")
EXAMPLE = "{coefficient: k, inputs: {q: q}, sign: either, shapes: {s: {at: [0.1, 0.5], of: Q}}}"
EXAMPLE_SHAPE = "{at: [0.1, 0.3], of: Q}"
PLACES: dict[str, Where] = {word: word for word in get_args(Where)}
NAMED_SYMBOLS: dict[str, Symbol] = {word: word for word in SYMBOLS}
NAMED_SCALES: dict[str, Scale] = {word: word for word in SCALES if word}


def read_effect(node: Node, body: Body, inside: Diagram) -> Effect | None:
    """`effect` of a subsystem: which parameter is its coefficient, and what its inputs read."""
    entries = body.entries(node, "'effect'", EXAMPLE)
    if entries is None:
        return None
    body.check_keys(entries, EFFECT, "key of an effect")
    before = len(body.problems.found)
    given = entries.values
    coefficient = body.required(entries, "coefficient", "an effect")
    name = None if coefficient is None else body.text(coefficient, "the coefficient of an effect")
    sign = _word(given, "sign", "sign of an effect", SIGNS, body)
    where = _word(given, "place", "place of an effect", PLACES, body)
    inputs = _read_wiring(given["inputs"], body) if "inputs" in given else {}
    shapes: dict[str, Shape] = {}
    if "shapes" in given:
        example = "{s: " + EXAMPLE_SHAPE + "}"
        for key, _, value in body.entries(given["shapes"], "'shapes'", example) or ():
            shape = _read_shape(value, key, _least(inside, key), body)
            if shape is not None:
                shapes[key] = shape
    at = None
    if "at" in given:
        at = _read_shape(given["at"], name or "coefficient", 0.0, body)
    if name is None or len(body.problems.found) > before:
        return None
    effect = Effect(name, inputs, sign or 0, shapes, where or "sum", at)
    problems = check_effect(effect, _face(inside), body.place(entries))
    if not inside.outputs:
        hint = "Write outputs: {force: ...}."
        body.problems.add("an effect needs an output", body.place(entries), (), hint)
    for problem in problems:
        body.problems.add(problem.what, problem.place, problem.exists, problem.hint)
    return None if problems or not inside.outputs else effect


def _face(inside: Diagram) -> Face:
    return Face(
        ports={name: port.default is not None for name, port in inside.inputs.items()},
        parameters=dict.fromkeys(inside.parameters, True),
        bounds=dict.fromkeys(inside.parameters, (-math.inf, math.inf)),
        outputs=len(inside.outputs),
    )


def _word(
    given: Mapping[str, Node], key: str, kind: str, words: Mapping[str, Word], body: Body
) -> Word | None:
    """What a word of a few stands for; None where it is not given, or with a problem noted."""
    node = given.get(key)
    word = None if node is None else body.text(node, f"the {kind}")
    if node is not None and word is not None and word not in words:
        body.problems.unknown(kind, word, words, body.place(node))
    return words.get(word or "")


def _read_wiring(node: Node, body: Body) -> dict[str, Symbol]:
    found: dict[str, Symbol] = {}
    for port, _, value in body.entries(node, "'inputs' of an effect", "{rate: v}") or ():
        what = f"what '{clip(port)}' reads"
        symbol = body.text(value, what)
        if symbol in NAMED_SYMBOLS:
            found[port] = NAMED_SYMBOLS[symbol]
        elif symbol is not None:
            told = ", ".join(f"{name} is {text}" for name, text in SYMBOLS.items())
            body.problems.unknown(
                "local signal", symbol, SYMBOLS, body.place(value), f"Here {told}."
            )
    return found


def _least(inside: Diagram, name: str) -> float:
    """The lower bound that a parameter of a subsystem has in a fit; else 0."""
    value = inside.parameters.get(name)
    return 0.0 if value is None or value.fit is None else value.fit[0]


def _read_shape(node: Node, name: str, least: float, body: Body) -> Shape | None:
    what = f"the shape '{clip(name)}'"
    if isinstance(node, Items):
        return _made(node, "", least, what, body)
    entries = body.entries(node, what, EXAMPLE_SHAPE)
    if entries is None:
        return None
    body.check_keys(entries, SHAPE, "key of a shape")
    at = body.required(entries, "at", what)
    scale = _word(entries.values, "of", "scale of a shape", NAMED_SCALES, body)
    low = entries.values.get("low")
    given = least if low is None else body.number(low, f"'low' of {what}")
    if at is None or given is None:
        return None
    return _made(at, scale or "", given, what, body)


def _made(node: Node, scale: Scale, low: float, what: str, body: Body) -> Shape | None:
    """A shape from the list of its values, or from a single one."""
    items = node.items if isinstance(node, Items) else (node,)
    values = [body.number(item, f"a value of {what}") for item in items]
    numbers = tuple(value for value in values if value is not None)
    return Shape(numbers, scale, low) if len(numbers) == len(values) else None
