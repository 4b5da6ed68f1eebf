from __future__ import annotations

from pathlib import Path

import pytest
from diagram.alike import said
from diagram.small_library import LIBRARY, refused
from tracewire.diagram import (
    Diagram,
    add_addend,
    read_text,
    set_values,
    set_variants,
    written_out,
)
from tracewire.errors import OptionError

FRICTION = """
subsystems:
  friction:
    inputs: [rate]
    outputs: {force: total}
    parameters: {c: 2}
    blocks:
      total: {type: sum, of: [-law]}
    variants:
      linear:
        blocks: {law: {type: viscous, rate: rate, c: c}}
      cubic:
        parameters: {b: {value: 3, fit: [0, 9]}}
        blocks: {law: {type: expression, formula: b*rate**3}}
      none:
        remove: [total]
        blocks: {law: {type: gain, of: rate, k: 0}, total: {type: sum, of: [law]}}
"""
BLOCKS = """
blocks:
  v: {type: integrator, of: drag.force}
  drag: {type: friction, rate: v, variant: cubic}
"""


def made(text: str) -> Diagram:
    return read_text(text, library=LIBRARY)


def whole(parameters: str, blocks: str) -> str:
    """The subsystem with one body, written out."""
    return f"""
subsystems:
  friction:
    inputs: [rate]
    outputs: {{force: total}}
    parameters: {{{parameters}}}
    blocks: {{{blocks}}}
blocks:
  v: {{type: integrator, of: drag.force}}
  drag: {{type: friction, rate: v}}
"""


BODIES = {
    "linear": ("c: 2", "total: {type: sum, of: [-law]}, law: {type: viscous, rate: rate, c: c}"),
    "cubic": (
        "c: 2, b: {value: 3, fit: [0, 9]}",
        "total: {type: sum, of: [-law]}, law: {type: expression, formula: b*rate**3}",
    ),
    "none": ("c: 2", "law: {type: gain, of: rate, k: 0}, total: {type: sum, of: [law]}"),
}


@pytest.mark.parametrize("variant", BODIES)
def test_a_variant_is_as_if_it_were_the_body(variant: str) -> None:
    diagram = made(FRICTION + BLOCKS.replace("cubic", variant))
    inside = diagram.blocks["drag"].subsystem
    assert inside is not None and (inside.variant, inside.variants) == (variant, tuple(BODIES))
    assert said(diagram) == said(made(whole(*BODIES[variant])))
    assert said(made(written_out(diagram))) == said(diagram)


def test_the_first_variant_is_the_usual_one_and_each_use_may_have_another() -> None:
    text = FRICTION + BLOCKS.replace(", variant: cubic", "")
    text += "  b: {type: friction, rate: v, variant: none}"
    uses = [use.subsystem for use in made(text).blocks.values() if use.subsystem is not None]
    assert [inside.variant for inside in uses] == ["linear", "none"]


def test_a_diagram_that_extends_another_one_chooses_a_variant(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text(FRICTION + BLOCKS)
    text = (
        "extends: base.yaml\nblocks: {drag: {variant: linear}}\n"
        "subsystems: {friction: {variants: {linear: {blocks: {law: {c: 2*c}}}}}}\n"
    )
    diagram = read_text(text, tmp_path / "top.yaml", library=LIBRARY)
    inside = diagram.blocks["drag"].subsystem
    assert inside is not None and inside.variant == "linear"
    new = set_variants(diagram, {"drag": "none"})
    assert new.text == text.replace("variant: linear", "variant: none")
    other = read_text("extends: base.yaml\n", tmp_path / "top.yaml", library=LIBRARY)
    chosen = set_variants(other, {"drag": "none"})
    assert chosen.text == "extends: base.yaml\nblocks:\n  drag: {variant: none}\n"


def test_edits_reach_the_variant_that_is_used() -> None:
    diagram = made(FRICTION + BLOCKS)
    new = set_values(diagram, {"drag.b": 4.0})
    assert new.text == diagram.text.replace("value: 3", "value: 4")
    assert "c: 5" in set_values(diagram, {"drag.c": 5.0}).text
    line = "{type: viscous, rate: rate, c: 0}"
    added = add_addend(diagram, "friction.total", "more", line)
    inside = added.blocks["drag"].subsystem
    assert inside is not None and "more" in inside.blocks
    none = add_addend(set_variants(diagram, {"drag": "none"}), "friction.total", "more", line)
    assert "total: {type: sum, of: [law, more]}" in none.text


def test_a_row_inside_a_variant() -> None:
    text = FRICTION.replace(
        "{law: {type: gain, of: rate, k: 0},",
        """{law: {type: gain, of: previous,
          k: 1, replicate: {count: n, first: {of: rate}}},""",
    ).replace("[law]}}", "[law.last]}}")
    text = text.replace("{c: 2}", "{c: 2, n: 2}")
    diagram = made(text + BLOCKS.replace("cubic", "none, n: 5"))
    inside = diagram.blocks["drag"].subsystem
    assert inside is not None and len(inside.blocks) == 6


MESSAGES = {
    "no such variant": (
        FRICTION + BLOCKS.replace("cubic", "qubic"),
        "<text>:21:44: block 'drag': unknown variant of 'friction' 'qubic'; there are: cubic, "
        "linear, none. Did you mean 'cubic'?",
    ),
    "a subsystem without variants": (
        whole(*BODIES["linear"]).replace("rate: v", "rate: v, variant: x"),
        "the subsystem 'friction' has no variants. Take 'variant' away.",
    ),
    "a block of the library": (
        "blocks: {a: {type: gain, of: a, k: 1, variant: x}}",
        "<text>:1:39: block 'a': only a subsystem has variants, and 'a' is a gain. Take it away.",
    ),
    "other ports": (
        FRICTION.replace("remove:", "inputs: [v]\n        remove:") + BLOCKS,
        "unknown section of a variant 'inputs'; there are: blocks, effect, events, parameters, "
        "remove, subsystems. All variants have the inputs and outputs of the subsystem.",
    ),
    "a mistake in one that is not used": (
        FRICTION.replace("of: rate, k: 0", "of: rte, k: 0") + BLOCKS,
        "block 'friction.law': unknown signal 'rte'; there are: law, rate, total",
    ),
    "a parameter of another variant": (
        FRICTION + BLOCKS.replace("cubic", "linear, b: 1"),
        "unknown input or parameter of 'friction' 'b'",
    ),
    "no mapping": (
        FRICTION.partition("    variants:")[0] + "    variants: [a]" + BLOCKS,
        "'variants' must be a mapping. Write it like {dry: {blocks: {...}}}",
    ),
    "a variant that is no mapping": (
        FRICTION.partition("    variants:")[0] + "    variants: {a: b}" + BLOCKS,
        "variant 'a' must be a mapping. Write it like {blocks: {...}}",
    ),
    "a preset": (
        FRICTION + BLOCKS + "presets: {dry: {drag.variant: none}}",
        "'drag.variant' is no parameter: a variant is chosen when the diagram is read. Write "
        "variant: ... in the block, or in a diagram that extends this one.",
    ),
}


@pytest.mark.parametrize("case", MESSAGES)
def test_messages(case: str) -> None:
    text, message = MESSAGES[case]
    assert message in refused(text)


@pytest.mark.parametrize(
    ("name", "variant", "message"),
    [
        ("drug", "none", "unknown block 'drug'; there are: drag, v. Did you mean 'drag'?"),
        ("v", "none", "block 'v' has no variants"),
        ("drag", "non", "unknown variant of 'drag' 'non'; there are: cubic, linear, none"),
    ],
)
def test_messages_of_a_choice(name: str, variant: str, message: str) -> None:
    with pytest.raises(OptionError) as error:
        set_variants(made(FRICTION + BLOCKS), {name: variant})
    assert message in str(error.value)
