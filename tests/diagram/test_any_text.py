"""Whatever the text is: a diagram, or a DiagramError that says where; nothing else, and soon."""

from __future__ import annotations

import json
from typing import Any

from diagram.small_library import LIBRARY, PENDULUM, made, refused
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from tracewire.diagram import difference, read_text
from tracewire.diagram.edit import add_addend
from tracewire.diagram.edit_values import set_values
from tracewire.errors import DiagramError, Problem, TracewireError
from tracewire.formula import Number

WORDS = ["title", "span", "every", "record", "inputs", "outputs", "parameters", "blocks"]
WORDS += ["subsystems", "include", "events", "presets", "measured", "type", "of", "unit", "place"]
WORDS += ["value", "fit", "free", "file", "time", "signals", "when", "set", "crosses", "column"]
WORDS += [*LIBRARY, "k", "c", "points", "formula", "x", "y", "s", "t", "pi", "x.y", "s.x", "-x"]
words = st.sampled_from(WORDS)
leaves = words | st.integers(-3, 3) | st.floats(allow_nan=True) | st.text(max_size=8) | st.none()
nodes = st.recursive(
    leaves,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(words, inner, max_size=5),
    max_leaves=25,
)
sections = st.dictionaries(st.sampled_from(WORDS[:13]), nodes, max_size=6)
lines = st.fixed_dictionaries(
    {"type": st.sampled_from([*LIBRARY, "s"])},
    optional={
        "of": words,
        "k": nodes,
        "rate": words,
        "c": nodes,
        "formula": nodes,
        "points": nodes,
    },
)
block_maps = st.dictionaries(st.sampled_from(["x", "y", "z", "k", "s"]), lines, max_size=5)


patient = settings(deadline=None)  # the first unit that is not SI takes a third of a second


def problems_of(text: str) -> list[Problem]:
    try:
        read_text(text, library=LIBRARY)
    except DiagramError as error:
        return list(error.problems) or [Problem("an error without a problem")]
    return []


def told(text: str) -> None:
    assert [problem for problem in problems_of(text) if not problem.place.file] == []


@patient
@given(st.text(max_size=400))
def test_any_text(text: str) -> None:
    told(text)


@patient
@given(st.text("{}[]:,-#&*!|>'\"%@`?\n \tab1.", max_size=200))
def test_any_text_of_signs(text: str) -> None:
    told(text)


@patient
@given(sections)
def test_any_sections(sections: dict[str, Any]) -> None:
    told(json.dumps(sections))


@patient
@given(block_maps, block_maps, nodes)
def test_any_blocks(top: dict[str, Any], inside: dict[str, Any], more: Any) -> None:
    subsystem = {"inputs": ["u"], "outputs": {"y": "x"}, "blocks": inside, "parameters": {"c": 1}}
    text = {"blocks": top, "subsystems": {"s": subsystem}, "events": more, "presets": more}
    told(json.dumps(text))


@patient
@given(st.data())
def test_a_valid_diagram_with_a_part_changed(data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(PENDULUM) - 1))
    length = data.draw(st.integers(0, 12))
    piece = data.draw(st.sampled_from([*WORDS, *"{}[]:,-#\n\t ", ""]) | st.text(max_size=6))
    told(PENDULUM[:start] + piece + PENDULUM[start + length :])


@patient
@given(st.integers(0, len(PENDULUM.splitlines()) - 1), st.integers(0, 3))
def test_a_valid_diagram_without_some_lines(first: int, count: int) -> None:
    lines = PENDULUM.splitlines()
    told("\n".join([*lines[:first], *lines[first + count :]]))


@patient
@given(
    st.sampled_from(["J", "stiffness", "half", "bearing.slip"]),
    st.floats(1e-3, 1e-2, exclude_min=True),
)
def test_a_value_changes_its_line_only(path: str, value: float) -> None:
    old = made(PENDULUM)
    value = value / 10 if path == "bearing.slip" else value
    new = set_values(old, {path: value})
    before, after = old.text.split("\n"), new.text.split("\n")
    assert len(before) == len(after)
    assert sum(a != b for a, b in zip(before, after, strict=True)) == 1


@patient
@given(st.text("abc{}[],:#'\" 1", max_size=20))
def test_a_block_line_of_any_text_makes_a_diagram_or_an_error(line: str) -> None:
    old = made(PENDULUM)
    try:
        new = add_addend(old, "torque", "drag", line)
    except TracewireError:
        return
    assert "drag" in new.blocks
    assert difference(old, new)


@patient
@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_number_is_read_as_it_is_written(value: float) -> None:
    assume(abs(value) < 1e300)
    text = f"parameters: {{a: {value!r}}}\nblocks: {{}}"
    assert refused(text) == ""
    assert made(text).parameters["a"].formula == Number(value)
