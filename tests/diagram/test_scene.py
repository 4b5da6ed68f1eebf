"""The section `scene`: what is read of it, and what is told where it is wrong."""

from __future__ import annotations

import pytest
from diagram.small_library import made, refused
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import DiagramError

BASE = """\
parameters: {l: 2}
blocks: {phi: {type: integrator, of: w, start: 1}, w: {type: gain, of: phi, k: -1}}
scene:
"""
WRONG = [
    ("  rod: [0, 0]", "4:3: 'scene' must be a list of parts. Write it like - rod: {from: [0, 0],"),
    (
        "  - rod",
        "4:5: a part of a scene is a mapping of its kind to what it needs; there are: box,",
    ),
    ("  - {rod: {}, disc: {}}", "a part of a scene is a mapping of its kind"),
    (
        "  - bar: {}",
        "4:5: unknown part of a scene 'bar'; there are: box, disc, ground, rod, spring",
    ),
    ("  - bxo: {}", "Did you mean 'box'?"),
    ("  - rod: 3", "4:10: a rod must be a mapping. Write it like {from: [0, 0], to: [x, y]}"),
    ("  - rod: {from: [0, 0]}", "4:10: a rod needs 'to'. Write to: ..."),
    ("  - rod: {from: [0, 0], to: [1, 0], radius: 1}", "unknown key of a rod 'radius'; there are:"),
    ("  - box: {at: [0, 0], width: 1}", "4:10: a box needs 'height'. Write height: ..."),
    ("  - disc: {at: [0], radius: 1}", "4:16: 'at' of a disc must be a pair [x, y]. Write it like"),
    ("  - disc: {at: 0, radius: 1}", "'at' of a disc must be a pair [x, y]"),
    ("  - disc: {at: [0, [1]], radius: 1}", "a formula must be a text, such as 2*k"),
    ("  - disc: {at: [psi, 0], radius: 1}", "4:17: unknown signal or parameter 'psi'; there are:"),
    ("  - disc: {at: [0, 0], radius: 2*}", "formula '2*': it does not parse"),
    (
        "  - disc: {at: [0, 0], radius: is_held(phi)}",
        "4:32: formula 'is_held(phi)': a scene cannot",
    ),
    ("  - disc: {at: [0, 0], radius: is_held(phi)}", "Make it an expression block of the diagram"),
    ("  - disc: {at: [0, 0], radius: open(phi)}", "open"),
    (
        "  - disc: {at: [0, 0], radius: 1, color: red}",
        "4:42: unknown color 'red'; there are: black",
    ),
    ("  - trace: {at: [0, 0], color: [1]}", "'color' of a part must be a text"),
]


@pytest.mark.parametrize(("scene", "message"), WRONG)
def test_what_is_wrong_with_a_scene_is_told(scene: str, message: str) -> None:
    assert message in refused(BASE + scene)


def test_a_scene_has_a_limit() -> None:
    told = refused(BASE + "  - disc: {at: [0, 0], radius: 1}\n" * 201)
    assert "the scene has 201 parts, and at most 200 can be drawn" in told


def test_a_scene_belongs_to_the_top_of_a_file() -> None:
    told = refused("blocks: {}\nsubsystems: {s: {blocks: {}, scene: []}}")
    assert "unknown section of a subsystem 'scene'" in told


def test_parts_have_formulas_usual_sizes_and_a_place() -> None:
    diagram = made(BASE + "  - spring: {from: [0, 0], to: [l*sin(phi), t], color: blue}\n")
    (part,) = diagram.scene
    assert (part.kind, part.color, part.place.line) == ("spring", "blue", 4)
    assert set(part.formulas) == {"from", "from y", "to", "to y", "coils"}


VECTOR = """\
blocks:
  q: {type: integrator, of: q, start: [1, 2]}
  body: {type: bouncing_body, start: 1}
  f: {type: gain, of: body.x, k: 2}
scene:
  - disc: {at: [PLACE, "q[1]"], radius: 1}
"""


def test_a_scene_reads_elements_outputs_and_blocks_by_their_full_names() -> None:
    model = compile(read_text(VECTOR.replace("PLACE", "body.x + f.y")))
    assert set(model.read_by_scene) == {"body.x", "f", "q[1]"}


@pytest.mark.parametrize(
    ("place", "message"),
    [
        (
            "q",
            "6:5: 'q' has elements, and a disc is drawn from numbers; there are: q[0], q[1].",
        ),
        ('"q[2]"', "'q[2]' is no element of 'q'; there are: q[0], q[1]."),
        ('"f[0]"', "'f' is a number, and has no elements; there are: f. Name one of them."),
    ],
)
def test_a_scene_is_drawn_from_numbers(place: str, message: str) -> None:
    with pytest.raises(DiagramError) as told:
        compile(read_text(VECTOR.replace("PLACE", place)))
    assert message in str(told.value)
