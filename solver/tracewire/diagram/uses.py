"""The section `blocks`: each line a library block or a subsystem, its wires and its settings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path

from tracewire.diagram.arrays import read_array, read_formulas
from tracewire.diagram.body import Body, Reference
from tracewire.diagram.diagram import Array, BlockUse, Diagram, Points, Value, Wire
from tracewire.diagram.grammar import OF_A_BLOCK, WORDS
from tracewire.diagram.problems import clip
from tracewire.diagram.replicate import Replica
from tracewire.diagram.strict import Entries, Node, Scalar
from tracewire.diagram.values import read_points, read_value, reads_parameters
from tracewire.diagram.wires import read_wires
from tracewire.errors import Location, unknown
from tracewire.formula import (
    Expression,
    Name,
    Number,
    dimension_of,
    evaluate,
    is_name,
    names_of,
    to_text,
)
from tracewire.library import Block, Input, Parameter

Find = Callable[[str, Location, Entries], Block | Diagram | None]
"""The block or subsystem of a type, as a line uses it; None where a problem is noted already."""
EXAMPLE = "{type: gain, of: theta, k: 2}"


def read_blocks(node: Node, body: Body, find: Find) -> dict[str, BlockUse]:
    """`blocks`: a mapping of names to block lines."""
    found: dict[str, BlockUse] = {}
    for name, key, line in body.entries(node, "'blocks'", f"{{column: {EXAMPLE}}}") or ():
        body.define("a block", key)
        if isinstance(line, Entries) and isinstance(node, Entries) and "type" not in line.values:
            _refuse_new(name, key, node, body)
            found[name] = BlockUse(name, "", {}, {}, place=body.place(key, name))
            continue
        found[name] = _read_block(name, key, line, body, find)
    return found


def _refuse_new(name: str, key: Scalar, blocks: Entries, body: Body) -> None:
    """Note a block without a type, which in a file that extends another one may be a typo."""
    others = {k: n for k, n in blocks.keys.items() if n.place.file != key.place.file}
    place, hint = body.place(blocks.values[name], name), "Write type: ..."
    if not others:
        body.problems.add("it needs 'type'", place, (), hint)
        return
    file = Path(next(iter(others.values())).place.file).name
    what = f"it is no block of '{file}', and a new one needs 'type'"
    near = get_close_matches(name, others, n=1)
    hint = f"Did you mean '{near[0]}'?" if near else hint
    body.problems.add(what, place, tuple(others), hint)


def _read_block(name: str, key: Scalar, line: Node, body: Body, find: Find) -> BlockUse:
    place = body.place(key, name)
    unread = BlockUse(name, "", {}, {}, place=place)
    entries = body.entries(line, "it", EXAMPLE, name)
    if entries is None:
        return unread
    type_node = entries.values["type"]
    type_name = body.text(type_node, "a type", name)
    if type_name is None:
        return unread
    kind = find(type_name, body.place(type_node, name), entries)
    unit, shown = body.shown(entries, name)
    local = {}
    if "place" in entries.values:
        local = _read_local(entries.values["place"], type_name, body, name)
    if kind is None:
        return replace(unread, unit=unit, local=local)
    if isinstance(kind, Block) and "unit" in entries.values:
        _check_unit(kind, body.place(entries.values["unit"], name), body)
    ports, parameters = shape_of(kind)
    _check_keys(entries, (*ports, *parameters), type_name, body, name)
    inputs: dict[str, tuple[Wire, ...]] = {}
    for port in ports.values():
        if port.name in entries.values:
            given = entries.values[port.name]
            wires = read_wires(given, body, f"input '{port.name}'", port.many, name)
            inputs[port.name] = wires
        elif port.default is None:
            what = f"input '{port.name}' is not connected"
            hint = f"Write {port.name}: {'[a, b]' if port.many else 'signal'}."
            body.problems.add(what, place, (), hint)
    settings = _read_settings(entries, kind, parameters, body, name, place)
    inside = kind if isinstance(kind, Diagram) else None
    if inside is None and "variant" in entries.values:
        what = f"only a subsystem has variants, and '{clip(name)}' is a {type_name}"
        body.problems.add(what, body.place(entries.keys["variant"], name), (), "Take it away.")
    guess = None
    if "guess" in entries.values:
        guess = _read_guess(entries.values["guess"], inside, body, name)
    row = entries.row if isinstance(entries, Replica) else ""
    return BlockUse(
        name, type_name, inputs, settings, unit, local, inside, guess, place, shown, row
    )


def _check_unit(kind: Block, place: Location, body: Body) -> None:
    """Note a unit for all outputs of a block whose outputs are of several quantities."""
    names = [output.name for output in kind.outputs]
    units = {o.name: dimension_of(o.unit) for o in kind.outputs if dimension_of(o.unit) is not None}
    different = [n for n, unit in units.items() if unit != next(iter(units.values()))]
    rates = [str(rate.name) for rate in kind.rates.values() if isinstance(rate, Name)]
    moved = [name for name in rates if name in names and len(names) > 1]
    if different or moved:
        what = f"'unit' holds for all outputs, and {', '.join(names)} are several quantities"
        hint = f"Take it away. `tracewire run --unit BLOCK.{names[0]}=UNIT` shows one in a unit."
        body.problems.add(what, place, (), hint)


def _check_keys(
    entries: Entries, own: tuple[str, ...], type_name: str, body: Body, name: str
) -> None:
    """Note the keys of a line that its block does not have; of those that all blocks have only one
    that is spelled alike is named."""
    for key, at, _ in entries:
        if key not in own and key not in OF_A_BLOCK:
            near = get_close_matches(key, OF_A_BLOCK, n=1)
            kind = f"input or parameter of '{type_name}'"
            free = [known for known in own if known not in entries.values]
            told = unknown(kind, key, (*own, *near)).hint
            hint = "" if told else _hint_of_word(key, free, type_name)
            body.problems.unknown(kind, key, (*own, *near), body.place(at, name), hint)


def _hint_of_word(key: str, free: Sequence[str], type_name: str) -> str:
    """What a key is here that is a word of another tool, or the begin of one of ours."""
    if type_name == "sum" and key in ("sign", "signs", "inputs"):
        return "Write a minus before a signal: of: [a, -b]."
    word = key.lower()
    if word in ("f", "freq", "frequency") and "omega" in free:
        return "Write omega: 2*pi*..., in rad/s."
    longer = [name for name in free if len(word) > 1 and name.startswith(word)]
    meant = longer or [name for name in WORDS.get(word, ()) if name in free]
    return f"Did you mean '{meant[0]}'?" if meant else ""


def _read_guess(node: Node, inside: Diagram | None, body: Body, name: str) -> Value | Array | None:
    """`guess` of a block: where the search of an algebraic loop begins."""
    if inside is None:
        return read_array(node, body, name, fit=False)
    what = f"only a block has 'guess', and '{clip(name)}' is a subsystem"
    hint = "Give it to a block inside, where the loop is."
    body.problems.add(what, body.place(node, name), (), hint)
    return None


def shape_of(kind: Block | Diagram) -> tuple[dict[str, Input], dict[str, Parameter]]:
    """The inputs and parameters of a block or subsystem."""
    if isinstance(kind, Block):
        return {p.name: p for p in kind.inputs}, {p.name: p for p in kind.parameters}
    ports = {
        name: Input(name, port.unit, default=None if port.default is None else "0")
        for name, port in kind.inputs.items()
    }
    return ports, {name: Parameter(name, default=0.0) for name in kind.parameters}


def _read_settings(
    entries: Entries,
    kind: Block | Diagram,
    parameters: Mapping[str, Parameter],
    body: Body,
    name: str,
    place: Location,
) -> dict[str, Value | Array | Points | Expression]:
    settings: dict[str, Value | Array | Points | Expression] = {}
    for parameter in parameters.values():
        node = entries.values.get(parameter.name)
        if node is None:
            if parameter.default is None:
                what = f"parameter '{parameter.name}' is not given"
                hint = f"Write {parameter.name}: ..."
                body.problems.add(what, place, (), hint)
            continue
        given: Value | Array | Points | Expression | None
        if parameter.kind == "points":
            given = read_points(node, body, name)
            if given is not None:
                check_bounds(given, parameter, body)
        elif parameter.kind == "formula":
            given = read_formulas(node, body, name)
        elif isinstance(kind, Diagram):
            given = read_value(node, body, name)
            if given is not None:
                given = in_unit_of(given, kind.parameters[parameter.name])
        else:
            given = read_array(node, body, name)
            for value in given.items if isinstance(given, Array) else (given,):
                if value is not None:
                    check_bounds(value, parameter, body)
        if given is not None:
            settings[parameter.name] = given
    if isinstance(kind, Block):
        check_conditions(kind, settings, body, place)
    return settings


def check_conditions(
    block: Block,
    settings: Mapping[str, Value | Array | Points | Expression],
    body: Body,
    place: Location,
) -> None:
    """Note each condition of a block that numbers do not meet which its line gives."""
    known: dict[str, float] = {}
    for parameter in block.parameters:
        value = settings.get(parameter.name)
        if value is None and isinstance(parameter.default, int | float):
            known[parameter.name] = float(parameter.default)
        elif isinstance(value, Value) and isinstance(value.formula, Number):
            known[parameter.name] = value.formula.value * value.factor
    for condition in block.conditions:
        read = names_of(condition)
        if known.keys() >= set(read) and not evaluate(condition, known):
            shown = ", ".join(f"{name} = {known[name]:g}" for name in read)
            what = f"the parameters must meet {to_text(condition)}, and {shown}"
            body.problems.add(what, place)


def in_unit_of(given: Value, declared: Value) -> Value:
    """A value for a parameter that is declared elsewhere.

    A number without a unit is in the unit of the declaration; a formula is in SI, as everywhere.
    """
    if given.unit or given.factor != 1.0:
        return given
    factor = 1.0 if reads_parameters(given.formula) else declared.factor
    bounds = given.fit and (given.fit[0] * factor, given.fit[1] * factor)
    # the unit is never empty where there is a factor, so that nobody takes the value for a bare one
    unit = declared.unit or ("" if declared.factor == 1.0 else "1")
    return replace(given, unit=unit, factor=factor, fit=bounds, written=declared.written)


def check_bounds(value: Value | Points, parameter: Parameter, body: Body) -> None:
    """Note a number that a parameter may not have; of a table the least and the largest one."""
    if isinstance(value, Points):
        for number in (min(*value.x, *value.y), max(*value.x, *value.y)):
            check_bounds(Value(Number(number), place=value.place), parameter, body)
        return
    if not isinstance(value.formula, Number):
        return
    number = value.formula.value * value.factor
    low, high, above = parameter.low, parameter.high, parameter.above
    unit = f" {parameter.unit}" if parameter.unit else ""
    if above is not None and number <= above:
        what = f"parameter '{parameter.name}' must be above {above:g}{unit}, not {number:g}"
        body.problems.add(what, value.place)
    if low is not None and number < low:
        what = f"parameter '{parameter.name}' must be at least {low:g}{unit}, not {number:g}"
        body.problems.add(what, value.place)
    if high is not None and number > high:
        what = f"parameter '{parameter.name}' must be at most {high:g}{unit}, not {number:g}"
        body.problems.add(what, value.place)


def _read_local(node: Node, type_name: str, body: Body, name: str) -> dict[str, str]:
    """`place` of a sum: the local signals by which a trace tries effects there."""
    if type_name != "sum":
        what = f"only a sum has 'place', and '{clip(name)}' is a {clip(type_name)}"
        hint = "Name the sum of the forces or torques that drive a rate."
        body.problems.add(what, body.place(node, name), (), hint)
        return {}
    found: dict[str, str] = {}
    for symbol, key, given in body.entries(node, "'place'", "{q: theta, v: omega}", name) or ():
        signal = body.text(given, f"'{clip(symbol)}' of a place", name)
        if not is_name(symbol):
            what = f"'{clip(symbol)}' cannot be a symbol of a place"
            body.problems.add(what, body.place(key, name), (), "Use q, v, or another plain name.")
        elif signal is not None:
            body.references.append(Reference(signal, "signal", body.place(given, name)))
            found[symbol] = signal
    return found
