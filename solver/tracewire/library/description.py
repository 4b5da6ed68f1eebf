"""What a person, or a program, wants to read about the blocks of a library."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass

from tracewire.errors import BlockError, Problem, unknown
from tracewire.library.declare import Block
from tracewire.library.effect import SCALES, SYMBOLS, Effect, Shape
from tracewire.library.load import Library
from tracewire.library.parts import ByMode, Event, Input, Mode, Output, Parameter, Transition
from tracewire.library.sensor import SENSOR_TERMS
from tracewire.library.sensor_description import (
    PREFIX,
    describe_sensor,
    describe_sensor_json,
    sensor_doc,
    sensor_effect,
)
from tracewire.library.synonyms import OTHERWISE, find_instead, find_synonym, other_names


def palette(library: Library) -> str:
    """A table of all blocks: family, block and the sentence that says what it is."""
    rows = sorted((library.families.get(name, ""), name, library[name].doc) for name in library)
    return _table([("family", "block", "what it is"), *rows])


def effect_rows(library: Library) -> list[tuple[str, str, str]]:
    """Of each effect that a trace tries where it is tried, its name, and what it is."""
    rows = []
    for kind, words in (("sum", "at a sum"), ("drive", "in a drive")):
        kinds = {n: b for n, b in library.effects().items() if b.effect and b.effect.place == kind}
        rows += [(words, name, kinds[name].doc) for name in sorted(kinds)]
    rows += [("of a sensor", f"{PREFIX}{term}", sensor_doc(term)) for term in SENSOR_TERMS]
    return rows


def effect_table(library: Library) -> str:
    """A table of the effects that a trace tries."""
    return _table([("place", "effect", "what it is"), *effect_rows(library)])


@dataclass(frozen=True)
class Description:
    """Parts of one kind of a block: the heads of their columns, and a row for each.

    The first column is a name, the second its unit.
    """

    kind: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def describe(library: Library, name: str) -> str:
    """One block in full, as plain text: ports, parameters, states, formulas, modes, events, source.

    A name of another tool finds the block that it is here, and the name of an effect of a sensor
    that effect. Raises BlockError: there is none.
    """
    if name not in library and (term := sensor_effect(name)):
        return describe_sensor(term)
    name, same = _find(library, name)
    block = library[name]
    lines = [same, ""] if same else []
    lines += [f"{name}: {block.doc}", ""]
    for part in describe_parts(block):
        lines += _section(part.kind, part.rows)
    lines += ["formulas", *(f"  {line}" for line in describe_formulas(block)), ""]
    return "\n".join([*lines, *describe_origin(name, block)])


def describe_parts(block: Block) -> list[Description]:
    """The parts of a block: inputs, parameters, states, modes, events, outputs; none is empty."""
    found = [
        Description(
            "inputs",
            ("input", "unit", "wiring", "meaning"),
            tuple((p.name, p.unit, wiring(p), p.doc) for p in block.inputs),
        ),
        Description(
            "parameters",
            ("parameter", "unit", "values", "meaning"),
            tuple(
                (p.name, p.unit, bounds_text(p), joined_doc(p.doc, _unit_words(p)))
                for p in block.parameters
            ),
        ),
        Description("conditions", ("condition", ""), tuple((text, "") for text in block.require)),
        Description(
            "states",
            ("state", "unit", "rate", "start"),
            tuple(
                (s.name, s.unit, f"rate = {_told(s.rate)}", f"start = {s.start}")
                for s in block.states
            ),
        ),
        Description(
            "modes",
            ("mode", "", "begins", "meaning"),
            tuple((m.name, "", _started(block, m), m.doc) for m in block.modes),
        ),
        Description(
            "transitions",
            ("transition", "", "condition", "new values"),
            tuple(_transition(t) for t in block.transitions),
        ),
        Description(
            "events",
            ("event", "", "when", "new values", "meaning"),
            tuple((e.name, "", _when(e), _reset(e.set), e.doc) for e in block.events),
        ),
        Description(
            "outputs",
            ("output", "unit", "feedthrough", "meaning"),
            tuple((o.name, o.unit, _at_once(block, o), o.doc) for o in block.outputs),
        ),
    ]
    return [part for part in found if part.rows]


def describe_formulas(block: Block) -> list[str]:
    """The formula of each output."""
    return [f"{o.name} = {_told(o.formula)}" for o in block.outputs]


def describe_origin(name: str, block: Block) -> list[str]:
    """What else is known of a block, in sentences: its use in traces, other names, its source."""
    found = [] if block.effect is None else [_effect(block)]
    if others := other_names(name):
        found.append(f"Also known as {'; '.join(others)}.")
    if name in OTHERWISE:
        found.append(OTHERWISE[name])
    if block.source:
        found.append(f"Source: {block.source}")
    return [*found, f"Declared in {block.place}."]


def describe_json(library: Library, name: str) -> dict[str, object]:
    """One block in full, in lists and dictionaries that `json` can write.

    What a name finds is what it finds for `describe`. Raises BlockError: there is none.
    """
    if name not in library and (term := sensor_effect(name)):
        return describe_sensor_json(term)
    name, _ = _find(library, name)
    block = library[name]
    feedthrough = {o.name: _feedthrough(block, o.name) for o in block.outputs}
    return {
        "name": name,
        "family": library.families.get(name, ""),
        "doc": block.doc,
        "inputs": [asdict(port) for port in block.inputs],
        "parameters": [asdict(parameter) for parameter in block.parameters],
        "conditions": list(block.require),
        "states": [asdict(state) for state in block.states],
        "modes": [asdict(mode) for mode in block.modes],
        "transitions": [asdict(transition) for transition in block.transitions],
        "events": [asdict(event) | {"when": list(event.guards)} for event in block.events],
        "outputs": [asdict(o) | {"feedthrough": feedthrough[o.name]} for o in block.outputs],
        "effect": None if block.effect is None else _effect_json(block.effect),
        "also_known_as": other_names(name),
        "source": block.source,
        "place": {"file": block.place.file, "line": block.place.line},
    }


def _find(library: Library, name: str) -> tuple[str, str]:
    """The name of a block here, and where that is another one, a sentence that says so."""
    if name in library:
        return name, ""
    found = find_synonym(name, [*library])
    if found is not None:
        return found
    instead = find_instead(name)
    problem = Problem(f"'{name}' is no block", hint=instead)
    raise BlockError([problem if instead else unknown("block", name, library)])


def _feedthrough(block: Block, output: str) -> list[str]:
    """The inputs of an output, in the order of declaration, and the formulas that users give."""
    inputs = block.feedthrough(output)
    given = [f"what '{p.name}' reads" for p in block.parameters if p.kind == "formula"]
    return [port.name for port in block.inputs if port.name in inputs] + given


def _at_once(block: Block, output: Output) -> str:
    names = _feedthrough(block, output.name)
    return f"depends at once on {', '.join(names)}" if names else "no feedthrough"


def joined_doc(*parts: str) -> str:
    """Short texts about one thing as one, without those that are empty."""
    return "; ".join(part.rstrip(".") for part in parts if part)


def _unit_words(parameter: Parameter) -> str:
    """Which unit the numbers of a parameter have that has none of its own."""
    of = parameter.unit_of
    return f"in the unit of '{of}', in SI where a number has none" if of else ""


def wiring(port: Input) -> str:
    """What an input takes, in words."""
    text = "one wire or several, each with a sign" if port.many else "a wire"
    text += "" if port.sampled is None else f", sampled at each {port.sampled}"
    text += ", without jumps" if port.continuous else ""
    return text if port.default is None else f"{text}; not connected: {port.default}"


def bounds_text(parameter: Parameter) -> str:
    """The default, the kind and the bounds of a parameter, in words."""
    default = parameter.default
    value = default if isinstance(default, str) else "" if default is None else f"{default:g}"
    parts = [f"default {value}" if value else "must be given"]
    if parameter.kind != "number":
        parts.append({"points": "a table of points", "formula": "a formula"}[parameter.kind])
    if parameter.above is not None:
        parts.append(f"above {parameter.above:g}")
    if parameter.low is not None and parameter.high is not None:
        parts.append(f"{parameter.low:g} to {parameter.high:g}")
    elif parameter.low is not None:
        parts.append(f"at least {parameter.low:g}")
    elif parameter.high is not None:
        parts.append(f"at most {parameter.high:g}")
    return ", ".join(parts)


def _effect(block: Block) -> str:
    effect = block.effect
    assert effect is not None
    sign = "positive only" if effect.sign else "of either sign"
    where = " at the drive" if effect.place == "drive" else ""
    parts = [f"coefficient {effect.coefficient}, {sign}"]
    if effect.at is not None:
        parts[0] += f", first {_tried(effect.at)}"
    read = dict(SYMBOLS)
    if "q" in effect.lacking:
        read["v"] = "v of the place, as a level, a temperature or a speed, from its zero on"
    parts += [f"{port} reads {read[symbol]}" for port, symbol in effect.inputs.items()]
    parts += [f"shape {name} first {_tried(shape)}" for name, shape in effect.shapes.items()]
    parts += [f"{name} is the {of} of the drive in each series" for name, of in effect.tone.items()]
    if effect.lacking:
        lacking = " or ".join(
            SYMBOLS[symbol].removesuffix(" of the place") for symbol in effect.lacking
        )
        parts.append(f"only where the place lacks {lacking}")
    for symbol in effect.both_signs:
        parts.append(f"only where {SYMBOLS[symbol]} takes both signs")
    for symbol in effect.near_rest:
        parts.append(f"only where {SYMBOLS[symbol]} comes near zero")
    told = f"An effect that a trace tries{where}: {'; '.join(parts)}."
    return told + (
        f"\nOn many records it looks like {', '.join(effect.alias)}." if effect.alias else ""
    )


def _tried(shape: Shape, most: int = 8) -> str:
    """The values of a shape; of more than `most` the ends."""
    if shape.of == "rates":
        return f"at {len(shape.at)} rates from the slowest to the fastest"
    if shape.of == "drives":
        return f"at {len(shape.at)} sizes of the drive from the least to the largest"
    values = [f"{value:.3g}" for value in shape.at]
    if len(values) > most:
        values = [*values[:2], "...", f"{values[-1]} ({len(values)} values)"]
    if shape.wave:
        return f"at the best of all lengths up to {max(shape.at):.3g} times {SCALES[shape.of]}"
    told = ", ".join(values) + (f" times {SCALES[shape.of]}" if shape.of else "")
    return f"{told}, not fitted" if shape.fixed else told


def _effect_json(effect: Effect) -> dict[str, object]:
    return {
        "coefficient": effect.coefficient,
        "inputs": dict(effect.inputs),
        "sign": effect.sign,
        "shapes": {name: asdict(shape) for name, shape in effect.shapes.items()},
        "place": effect.place,
        "at": None if effect.at is None else asdict(effect.at),
        "alias": list(effect.alias),
        "lacking": list(effect.lacking),
        "both_signs": list(effect.both_signs),
        "near_rest": list(effect.near_rest),
    }


def _told(formula: ByMode) -> str:
    if isinstance(formula, str):
        return formula
    return "; ".join(f"{mode}: {text}" for mode, text in formula.items())


def _started(block: Block, mode: Mode) -> str:
    if mode.start is not None:
        return f"at the start where {mode.start}"
    return "at the start" if mode is block.modes[0] else ""


def _transition(transition: Transition) -> tuple[str, str, str, str]:
    ends = f"{transition.source} -> {transition.target}"
    return ends, "", f"while {transition.when}", _reset(transition.set)


def _when(event: Event) -> str:
    if event.every is not None:
        shift = "" if event.offset == "0" else f", first at t = {event.offset}"
        return f"every {event.every} s{shift}"
    direction = "zero" if event.crosses == "both" else f"zero {event.crosses}"
    return f"{' or '.join(event.guards)} crosses {direction}"


def _reset(values: Mapping[str, ByMode]) -> str:
    return ", ".join(f"{state} := {_told(formula)}" for state, formula in values.items())


def _section(title: str, rows: Iterable[tuple[str, ...]]) -> list[str]:
    rows = list(rows)
    if not rows:
        return []
    shown = [(f"  {name}", f"[{unit}]" if unit else "", *rest) for name, unit, *rest in rows]
    return [title, _table(shown), ""]


def _table(rows: Iterable[tuple[str, ...]]) -> str:
    """The rows as text in columns; a column that is empty everywhere is left out."""
    columns = [column for column in zip(*rows, strict=True) if any(column)]
    widths = [max(map(len, column)) for column in columns]
    lines = zip(*columns, strict=True)
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in lines
    )
