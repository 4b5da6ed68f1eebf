from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagram.alike import said
from diagram.small_library import LIBRARY, refused
from tracewire.compile import compile
from tracewire.diagram import Diagram, read_text, write_out
from tracewire.diagram.edit import add_addend
from tracewire.diagram.edit_values import set_values
from tracewire.errors import OptionError, SimulationError
from tracewire.solve import simulate

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
    assert said(made(write_out(diagram))) == said(diagram)


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


def test_edits_reach_the_variant_that_is_used() -> None:
    diagram = made(FRICTION + BLOCKS)
    new = set_values(diagram, {"drag.b": 4.0})
    assert new.text == diagram.text.replace("value: 3", "value: 4")
    assert "c: 5" in set_values(diagram, {"drag.c": 5.0}).text
    line = "{type: viscous, rate: rate, c: 0}"
    added = add_addend(diagram, "friction.total", "more", line)
    inside = added.blocks["drag"].subsystem
    assert inside is not None and "more" in inside.blocks
    other = made(FRICTION + BLOCKS.replace("variant: cubic", "variant: none"))
    none = add_addend(other, "friction.total", "more", line)
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
        "linear, none. Did you mean 'cubic'? Or name a parameter of this diagram that has the "
        "number of one, from 1.",
    ),
    "a variant and a parameter of one name": (
        FRICTION + BLOCKS + "parameters: {cubic: 1}",
        "'cubic' is a variant of 'friction' and a parameter here. Rename the parameter.",
    ),
    "a choice that a fit would change": (
        FRICTION + BLOCKS.replace("cubic", "kind") + "parameters: {kind: {value: 1, fit: [1, 3]}}",
        "'kind' chooses a variant of 'drag', and a fit cannot change it. Take 'fit' away.",
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
        "'drag.variant' is no parameter: a variant is chosen when the diagram is read. Name a "
        "parameter in the block, variant: law, which has its number, and set that.",
    ),
}


@pytest.mark.parametrize("case", MESSAGES)
def test_messages(case: str) -> None:
    text, message = MESSAGES[case]
    assert message in refused(text)


CHOSEN = """
parameters: {kind: 1}
presets: {slow: {kind: 2}, none: {drag.variant: 3}}
blocks:
  v: {type: integrator, of: drag.force, start: 0.5}
  drag: {type: friction, rate: v, variant: kind}
"""


def test_a_parameter_chooses_the_body() -> None:
    model = compile(made(FRICTION + CHOSEN))
    t = np.linspace(0.0, 2.0, 21)
    exact = {
        "": 0.5 * np.exp(2.0 * t),  # the block gives -2 v, and the sum its negative
        "slow": 0.5 / np.sqrt(1.0 + 2.0 * 3.0 * 0.25 * t),  # v' = -3 v^3
        "none": np.full(21, 0.5),
    }
    for preset, v in exact.items():
        run = simulate(model, preset=preset, times=t, rtol=1e-10)
        assert np.allclose(run["v"], v, rtol=0.0, atol=1e-7), preset
    several = simulate(model, parameters={"kind": 2.0, "drag.b": 1.0}, span=(0.0, 2.0))
    assert several["v"][-1] == pytest.approx(0.5 / np.sqrt(2.0), abs=1e-6)


def test_edits_of_a_subsystem_whose_body_a_parameter_chooses() -> None:
    diagram = made(FRICTION + CHOSEN)
    new = set_values(diagram, {"kind": 2.0, "drag.c": 5.0, "drag.b": 4.0})
    assert new.text == diagram.text.replace("kind: 1", "kind: 2").replace("c: 2", "c: 5").replace(
        "value: 3", "value: 4"
    )
    assert said(made(write_out(diagram))) == said(diagram)
    for path, name in (("drag.variant", "kind"), ("drag.cubic_body.b", "b")):
        with pytest.raises(OptionError) as error:
            set_values(diagram, {path: 2.0})
        assert f"is given by the parameter '{name}'. Change that one." in str(error.value)


def test_a_parameter_that_bodies_give_other_values_stays_with_its_body() -> None:
    text = FRICTION.replace("remove: [total]", "parameters: {c: 7}\n        remove: [total]")
    inside = made(text + CHOSEN).blocks["drag"].subsystem
    assert inside is not None and [*inside.parameters] == ["variant", "b"]
    with pytest.raises(OptionError, match="which several blocks are"):
        set_values(made(text + CHOSEN), {"drag.linear_body.c": 3.0})
    assert "c: 9" in set_values(made(text + CHOSEN), {"drag.none_body.c": 9.0}).text


def test_a_number_without_a_variant_is_refused_by_the_run() -> None:
    model = compile(made(FRICTION + CHOSEN))
    for number in (0.0, 4.0, 1.5):
        with pytest.raises(SimulationError) as error:
            simulate(model, parameters={"kind": number}, span=(0.0, 1.0))
        assert "It is the number of a variant: 1 linear, 2 cubic, 3 none." in str(error.value)
