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
@pytest.mark.parametrize("first", range(0, 300, 30))
def test_three_hundred_random_diagrams_are_drawn_without_faults(first: int) -> None:
    for seed in range(first, first + 30):
        depth, words = seed % 3, seed % 2 == 0
        drawing = draw(read_text(text_of(seed)), depth, names=words, units=words)
        assert faults(drawing) == [], f"seed {seed}, depth {depth}"


@settings(max_examples=10)
@given(st.integers(0, 10**6))
def test_random_systems_are_drawn_without_faults(seed: int) -> None:
    assert faults(draw(read_text(systems.text_of(systems.draw(seed))))) == []


def test_two_signals_on_one_line_are_moved_apart() -> None:
    drawing = draw(read_text(text_of(40850)))
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
