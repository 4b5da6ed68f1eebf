"""Which names are visible where: the rules of docs/diagrams.md."""

from __future__ import annotations

from pathlib import Path

import pytest
from diagram.small_library import LIBRARY, refused
from tracewire.diagram import Diagram, find_parameter, read_text
from tracewire.formula import Name, to_text

SAME_NAMES = """
parameters: {k: 1}
subsystems:
  part:
    inputs: [x]
    outputs: {y: v}
    parameters: {k: 2}
    blocks:
      v: {type: gain, of: x, k: k}
blocks:
  x: {type: integrator, of: v}
  v: {type: part, x: x, k: 3*k}
  other: {type: part, x: v.y}
"""
HIDDEN = """
subsystems:
  law: {inputs: [u], outputs: {y: a}, blocks: {a: {type: gain, of: u, k: 1}}}
  outer:
    inputs: [u]
    outputs: {y: b.y}
    subsystems:
      law: {inputs: [u], outputs: {y: c}, blocks: {c: {type: gain, of: u, k: 2}}}
    blocks: {b: {type: law, u: u}}
  beside: {inputs: [u], outputs: {y: b.y}, blocks: {b: {type: law, u: u}}}
blocks:
  x: {type: integrator, of: top.y}
  top: {type: law, u: x}
  one: {type: outer, u: x}
  two: {type: beside, u: x}
"""


def made(text: str) -> Diagram:
    return read_text(text, library=LIBRARY)


def inside(diagram: Diagram, *path: str) -> Diagram:
    for name in path:
        found = diagram.blocks[name].subsystem
        assert found is not None
        diagram = found
    return diagram


def test_a_name_may_stand_in_a_diagram_and_in_a_subsystem_of_it() -> None:
    diagram = made(SAME_NAMES)
    assert inside(diagram, "v").blocks["v"].settings["k"].formula == Name("k")  # type: ignore[union-attr]
    given = find_parameter(diagram, "v.k")
    usual = find_parameter(diagram, "other.k")
    assert given is not None and usual is not None
    assert (given.place.line, usual.place.line) == (12, 7)
    assert (to_text(given.formula), to_text(usual.formula)) == ("3*k", "2")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("of: x, k: k", "of: x, k: m", "block 'part.v': unknown parameter 'm'; there are: k."),
        ("of: x, k: k", "of: other, k: k", "block 'part.v': unknown signal 'other'; there are: v"),
        ("x: v.y", "x: v.x", "block 'other': unknown output 'v.x'; there are: v.y."),
    ],
)
def test_a_subsystem_sees_its_own_names_only(old: str, new: str, message: str) -> None:
    assert old in SAME_NAMES
    text = SAME_NAMES.replace(old, new).replace("parameters: {k: 1}", "parameters: {k: 1, m: 1}")
    assert message in refused(text)


def test_a_subsystem_inside_hides_one_outside() -> None:
    diagram = made(HIDDEN)
    assert list(inside(diagram, "top").blocks) == ["a"]
    assert list(inside(diagram, "one", "b").blocks) == ["c"]
    assert list(inside(diagram, "two", "b").blocks) == ["a"]


def test_what_hides_an_included_subsystem_and_what_may_not(tmp_path: Path) -> None:
    law = (
        "subsystems: {law: {inputs: [u], outputs: {y: z}, blocks: {z: {type: gain, of: u, k: 1}}}}"
    )
    (tmp_path / "law.yaml").write_text(law)
    text = HIDDEN.replace("\n  law:", "\n  other:")
    diagram = read_text(f"include: law.yaml{text}", tmp_path / "top.yaml", library=LIBRARY)
    assert list(inside(diagram, "top").blocks) == ["z"]
    assert list(inside(diagram, "one", "b").blocks) == ["c"]
    assert list(inside(diagram, "two", "b").blocks) == ["z"]
    assert "two definitions of 'law'" in refused(f"include: law.yaml{HIDDEN}", tmp_path / "t.yaml")
    told = refused(HIDDEN.replace("\n  law:", "\n  gain:"))
    assert "two definitions of 'gain': a subsystem here, and a block of the library" in told
