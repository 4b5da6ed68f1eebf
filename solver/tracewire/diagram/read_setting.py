"""`run` and `reference` of a statement: in which setting it is measured."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from tracewire.diagram.body import Body
from tracewire.diagram.diagram import Diagram, Setting, Value
from tracewire.diagram.grammar import DIRECTIONS, FIT_METHODS, SETTING
from tracewire.diagram.limits import LIMITS
from tracewire.diagram.names import find_parameter, find_state, parameters, states
from tracewire.diagram.problems import clip
from tracewire.diagram.quantities import read_above_zero, read_count
from tracewire.diagram.settings import read_settings
from tracewire.diagram.strict import Items, Node, Scalar
from tracewire.diagram.values import read_value, reads_parameters
from tracewire.formula import Number, to_text

TIMES = {"from": "begin", "until": "until", "since": "since"}
OF_ANALYSES = ("period", "phase", "length", "transient", "interval")
COUNTS = ("skip", "keep")
WORDS_OF = {"edge": (), "guard": (), "method": FIT_METHODS, "direction": DIRECTIONS}
"""What the text of a key may be; any text where there are none."""
EXAMPLE = "{preset: free, set: {k: 2}, until: 10}"
RANGE = re.compile(r"\s*(\S+?)\s*:\s*(\S+?)\s*:\s*(\d+)\s*")


def read_setting(
    node: Node,
    body: Body,
    diagram: Diagram,
    reference: bool = False,
    full: bool = False,
    other: bool = False,
) -> Setting:
    """A setting. reference: it may be that of another diagram; full: of the longest runs; other: of
    another diagram, whose presets, parameters and states are looked up when it runs."""
    what = "'full'" if full else "'reference'" if reference else "'run'"
    entries = body.entries(node, what, EXAMPLE)
    if entries is None:
        return Setting()
    keys = [*SETTING, *([] if full else ["full"]), *(["diagram"] if reference else [])]
    body.check_keys(entries, keys, f"key of {what}")
    other = other or (reference and "diagram" in entries.values)
    found: dict[str, object] = {"place": body.place(entries)}
    options: dict[str, Value | str] = {}
    for key, name, value in entries:
        match key:
            case _ if key not in keys:
                continue  # noted above
            case "series" | "modulo" | "over" if other:
                hint = "Leave it out, or write the statement in that diagram."
                body.problems.add(
                    f"'{key}' cannot stand with 'diagram'", body.place(name), (), hint
                )
            case "diagram":
                found["file"] = _file(value, body)
                found["place"] = body.place(value)
            case "preset" if other:
                found["preset"] = body.text(value, "'preset'") or ""
            case "preset":
                found["preset"] = _known(value, body, "preset", diagram.presets)
            case "series":
                found["series"] = _known(value, body, "measured series", diagram.measured)
            case "set" | "start" if other:
                found["values" if key == "set" else key] = _plain(value, body, f"'{key}'")
            case "set":
                found["values"] = read_settings(value, body, diagram, "'set'")
            case "start" | "modulo":
                found[key] = _of_states(value, body, diagram, f"'{key}'")
            case "samples":
                found["samples"] = _samples(value, body)
            case "over":
                found["over"] = _read_over(value, body, diagram)
            case "full":
                found["full"] = read_setting(value, body, diagram, full=True, other=other)
            case _ if key in TIMES:
                found[TIMES[key]] = read_value(value, body, fit=False)
            case _ if key in WORDS_OF:
                allowed = WORDS_OF[key]
                word = body.text(value, f"'{key}'") or ""
                if allowed and word not in allowed:
                    body.problems.unknown(key, word, allowed, body.place(value))
                options[key] = word
            case _ if key in (*OF_ANALYSES, *COUNTS, "rtol"):
                read = _read_option(key, value, body)
                if read is not None:
                    options[key] = read
            case _:
                raise AssertionError(key)
    read_all = replace(Setting(**found), options=options)  # type: ignore[arg-type]
    if other:
        _refuse_parameters(read_all, body)
    return read_all


def _file(node: Node, body: Body) -> Path:
    """The file of another diagram."""
    text = body.text(node, "'diagram'") or ""
    file = node.path if isinstance(node, Scalar) else Path()
    if not file.is_file():
        hint = "Name a file beside this diagram."
        body.problems.add(f"there is no file '{clip(text)}'", body.place(node), (), hint)
    return file


def _refuse_parameters(setting: Setting, body: Body) -> None:
    """Note the values in the setting of another diagram that read parameters."""
    times = (setting.begin, setting.until, setting.since)
    made = (*setting.values.values(), *setting.start.values(), *setting.options.values(), *times)
    for value in made:
        if isinstance(value, Value) and reads_parameters(value.formula):
            shown = clip(to_text(value.formula))
            what = f"a value in the setting of another diagram is a number, and not '{shown}'"
            body.problems.add(what, value.place, (), "Its parameters are not known here.")


def _samples(node: Node, body: Body) -> int | None:
    count = read_count(node, body, "'samples'")
    if count is not None and not 2 <= count <= LIMITS.most_samples:
        what = f"'samples' must be 2 or more, and {LIMITS.most_samples} at most"
        body.problems.add(what, body.place(node))
    return count


def _plain(node: Node, body: Body, what: str) -> dict[str, Value]:
    """Values by names that belong to another diagram."""
    entries = body.entries(node, what, "{k: 2}")
    read = {name: read_value(value, body, fit=False) for name, _, value in entries or ()}
    return {name: value for name, value in read.items() if value is not None}


def _known(node: Node, body: Body, kind: str, there: object) -> str:
    name = body.text(node, f"the {kind}") or ""
    names = list(there)  # type: ignore[call-overload]
    if name not in names:
        body.problems.unknown(kind, name, names, body.place(node))
        return ""
    return name


def _read_option(key: str, node: Node, body: Body) -> Value | None:
    """A number of an analysis, as a value."""
    if key in COUNTS:
        count = read_count(node, body, f"'{key}'")
        return None if count is None else Value(Number(float(count)), place=body.place(node))
    if key == "rtol":
        rtol = read_above_zero(node, body, "'rtol'")
        return None if rtol is None else Value(Number(rtol), place=body.place(node))
    return read_value(node, body, fit=False)


def _of_states(node: Node, body: Body, diagram: Diagram, what: str) -> dict[str, Value]:
    found: dict[str, Value] = {}
    for name, key, given in body.entries(node, what, "{x: 0.1}") or ():
        state, value = find_state(diagram, name), read_value(given, body, fit=False)
        if state is None:
            body.problems.unknown("state", name, states(diagram), body.place(key))
        elif value is not None:
            found[state] = value
    return found


def _read_over(node: Node, body: Body, diagram: Diagram) -> dict[str, tuple[float, ...]]:
    """`over`: the values of one parameter, as numbers and FROM:TO:COUNT."""
    entries = body.entries(node, "'over'", "{f: 0.3:0.9:800}")
    found: dict[str, tuple[float, ...]] = {}
    for name, key, given in entries or ():
        declared = find_parameter(diagram, name)
        if declared is None:
            body.problems.unknown("parameter", name, parameters(diagram), body.place(key))
            continue
        parts = given.items if isinstance(given, Items) else (given,)
        values: list[float] = []
        for part in parts:
            read = _read_range(part.text) if isinstance(part, Scalar) else None
            if read is None:
                hint = "Write it like over: {f: 0.3:0.9:800} or over: {f: [0.3, 0.5, 0.6:0.9:4]}."
                what = "the values of 'over' are numbers or FROM:TO:COUNT"
                body.problems.add(what, body.place(part), (), hint)
                return {}
            values += read
        found[name] = tuple(value * declared.factor for value in values)
    if len(found) > 1:
        body.problems.add("'over' goes over one parameter", body.place(node), (), "Leave one.")
    return found


def _read_range(text: str) -> list[float] | None:
    ranged = RANGE.fullmatch(text)
    parts: list[str] = [text] if ranged is None else [ranged[1], ranged[2]]
    convert: Callable[[str], float] = float
    try:
        numbers = [convert(part) for part in parts]
    except ValueError:
        return None
    if not all(abs(number) < float("inf") for number in numbers):
        return None
    if ranged is None:
        return numbers
    count = int(ranged[3])
    if not 2 <= count <= LIMITS.most_values:
        return None
    first, last = numbers
    step = (last - first) / (count - 1)
    return [first + n * step for n in range(count - 1)] + [last]
