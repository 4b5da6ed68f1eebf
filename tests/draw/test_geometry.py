"""No block overlaps another, no wire runs through a block, and every wire ends at its ports."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from draw.geometry import faults
from draw.random_diagrams import text_of
from fuzz import systems
from hypothesis import given, settings
from hypothesis import strategies as st
from tracewire.diagram import read_readable, read_text
from tracewire.draw import draw
from tracewire.draw.layout import layout_of, mirrored

ROOT = Path(__file__).parents[2]
SHIPPED = [
    file
    for file in sorted((ROOT / "diagrams").rglob("*.yaml"))
    if "\nblocks:" in file.read_text(encoding="utf-8")
]

TWO_ON_ONE_LINE = """
inputs: [force, drive]
blocks:
  b0_long_name: {type: gain, of: b15, k: 0.5}
  b1: {type: sum, of: [-b10, -b6, -b9_long_name]}
  b2_long_name: {type: sign, of: b10}
  b3_long_name: {type: sum, of: [-b17, -b16, b18.x1, -b16, -b8, b3_long_name]}
  b4: {type: sum, of: [-b1, -b1, b13, b16, -b14, -b11]}
  b5: {type: gain, of: b4, k: 0.5}
  b6: {type: coupling_q, other: b18.v1, k: 0.5}
  b7: {type: sin, of: b8}
  b8: {type: sin, of: b19}
  b9_long_name: {type: derivative, of: b4, lag: 0.5}
  b10: {type: sin, of: b18.v2}
  b11: {type: expression, formula: 1 + b2_long_name + b14}
  b12: {type: product, of: [-b6, -b4, -b18.v1]}
  b13: {type: integrator, of: b18.v1}
  b14: {type: sin, of: b3_long_name}
  b15: {type: sum, of: [b20.v, b6, b18.x2]}
  b16: {type: monostable, of: b12, duration: 0.5}
  b17: {type: product, of: [-b20.v, b17]}
  b18: {type: collision, force1: b18.x2, force2: b15}
  b19: {type: sum, of: [b7, b7, -b12, b18.x2]}
  b20: {type: mass, force: b20.x, mass: 0.5}
"""
"""ELK lays a wire of this over another one."""


def test_there_are_diagrams() -> None:
    assert len(SHIPPED) > 60


@pytest.mark.parametrize("file", SHIPPED, ids=lambda file: file.stem)
def test_shipped_diagrams_are_drawn_without_faults(file: Path) -> None:
    diagram, problems = read_readable(file)  # the files of some are fetched first
    assert faults(draw(diagram, measured=True, problems=problems)) == []


@pytest.mark.parametrize("depth", [1, 2])
@pytest.mark.parametrize("name", ["pendulum", "s1_symmetric", "s5_restitution"])
def test_open_subsystems_are_drawn_without_faults(name: str, depth: int) -> None:
    diagram, _ = read_readable(ROOT / "diagrams" / "papers" / "a_torsion" / f"{name}.yaml")
    drawing = draw(diagram, depth, names=True, units=True)
    assert any(node.nodes for node in drawing.graph.nodes)
    assert faults(drawing) == []


@settings(max_examples=25)
@given(st.integers(0, 10**6), st.integers(0, 2), st.booleans())
def test_random_diagrams_are_drawn_without_faults(seed: int, depth: int, words: bool) -> None:
    drawing = draw(read_text(text_of(seed)), depth, names=words, units=words)
    assert faults(drawing) == []


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 20, 10))
def test_twenty_random_diagrams_are_drawn_without_faults(first: int) -> None:
    for seed in range(first, first + 10):
        depth, words = seed % 3, seed % 2 == 0
        drawing = draw(read_text(text_of(seed)), depth, names=words, units=words)
        assert faults(drawing) == [], f"seed {seed}, depth {depth}"


@settings(max_examples=10)
@given(st.integers(0, 10**6))
def test_random_systems_are_drawn_without_faults(seed: int) -> None:
    assert faults(draw(read_text(systems.text_of(systems.draw(seed))))) == []


def test_two_signals_on_one_line_are_moved_apart() -> None:
    drawing = draw(read_text(TWO_ON_ONE_LINE))
    as_placed = replace(drawing, layout=layout_of(drawing.graph))
    assert faults(as_placed) == ["wire b10<of lies on wire b15<of.2"]
    assert faults(drawing) == []
    ends = [(line[0], line[-1]) for line in as_placed.layout.wires.values()]
    assert [(line[0], line[-1]) for line in drawing.layout.wires.values()] == ends


def test_a_picture_upside_down_has_no_faults_either() -> None:
    drawing = draw(read_text(text_of(4)))
    turned = type(drawing)(drawing.graph, mirrored(drawing.layout), "")
    assert faults(turned) == []
    assert mirrored(turned.layout).width == drawing.layout.width


def test_faults_are_found() -> None:
    drawing = draw(read_text(text_of(1)))
    first, second, *_ = [node.id for node in drawing.graph.nodes]
    drawing.layout.nodes[second] = drawing.layout.nodes[first]
    found = faults(drawing)
    assert f"{first} overlaps {second}" in found
    one = drawing.graph.wires[0]
    other = next(wire for wire in drawing.graph.wires if wire.source != one.source)
    drawing.layout.wires[other.id] = drawing.layout.wires[one.id]
    assert any(" lies on wire " in fault for fault in faults(drawing))
    assert any(fault.startswith(f"port {second}") for fault in found)
