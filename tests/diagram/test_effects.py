"""Effects of a user's own: one entry in the YAML makes a subsystem one that a trace tries."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import EffectType, effects_of, read, read_text
from tracewire.errors import DiagramError
from tracewire.library import Effect, Shape
from tracewire.solve import simulate

EFFECT = "coefficient: k, inputs: {q: q, rate: v}, sign: positive, shapes: {s: {at: [1, 2], of: Q}}"
PAD = """
  pad:
    inputs: [q, rate]
    outputs: {force: f}
    parameters: {k: 1, s: {value: 2, unit: mm, fit: [0.1, 30]}, twice: 2*s}
    effect: {EFFECT}
    blocks:
      f: {type: expression, formula: -k*q**2*rate*exp(-q/twice)}
"""
DIAGRAM = """
span: [0, 3]
every: 0.1
record: [x]
blocks:
  x: {type: integrator, of: v, start: 0.01}
  v: {type: integrator, of: a}
  spring: {type: stiffness, of: x, k: 1}
  a: {type: sum, of: [spring]}
subsystems:"""


def text(effect: str = EFFECT, **changes: str) -> str:
    pad = PAD.replace("EFFECT", effect)
    for old, new in changes.items():
        assert f"{old}: " in pad
        line = next(line for line in pad.splitlines() if line.strip().startswith(f"{old}: "))
        pad = pad.replace(line, f"    {old}: {new}" if new else "")
    return DIAGRAM + pad


def own(source: str) -> EffectType:
    return next(kind for kind in effects_of(read_text(source)) if kind.subsystem is not None)


def test_a_subsystem_with_the_key_effect_is_one() -> None:
    pad = own(text())
    assert (pad.name, pad.ports, pad.output) == ("pad", ("q", "rate"), ".force")
    assert pad.effect == Effect(
        "k", {"q": "q", "rate": "v"}, sign=1, shapes={"s": Shape((1.0, 2.0), of="Q", low=1e-4)}
    )
    assert pad.parameters == pytest.approx({"k": 1, "s": 0.002, "twice": 0.004})


def test_a_subsystem_without_it_is_none() -> None:
    plain = effects_of(read_text(text().replace(f"    effect: {{{EFFECT}}}\n", "")))
    assert all(kind.subsystem is None for kind in plain)


def test_blocks_of_the_library_stand_behind_the_same_interface() -> None:
    kinds = {kind.name: kind for kind in effects_of(read_text(text()))}
    coulomb = kinds["coulomb"]
    assert coulomb.block is not None
    assert (coulomb.ports, coulomb.output) == (("rate",), "")
    assert coulomb.parameters == {"level": None, "width": 0.0}
    assert coulomb.effect == coulomb.block.effect


def test_short_forms_and_the_rest_of_the_keys() -> None:
    given = "coefficient: k, inputs: {q: u}, place: drive, at: {at: 0.5}, shapes: {s: [1, 2]}"
    effect = own(text(given, inputs="[q]").replace("*rate", "")).effect
    shape = Shape((1.0, 2.0), low=1e-4)
    assert effect == Effect("k", {"q": "u"}, 0, {"s": shape}, "drive", Shape((0.5,)))
    free = "coefficient: k, inputs: {q: q, rate: v}, shapes: {twice: {at: [-1], low: -3}}"
    assert own(text(free)).effect.shapes == {"twice": Shape((-1.0,), low=-3.0)}


def test_an_effect_may_stand_in_a_library_of_subsystems(tmp_path: Path) -> None:
    (tmp_path / "pads.yaml").write_text("subsystems:" + PAD.replace("EFFECT", EFFECT), "utf-8")
    (tmp_path / "rig.yaml").write_text(
        DIAGRAM.replace("subsystems:", "include: [pads.yaml]"), "utf-8"
    )
    found = [kind.name for kind in effects_of(read(tmp_path / "rig.yaml")) if kind.subsystem]
    assert found == ["pad"]


def test_an_effect_is_used_like_any_subsystem() -> None:
    added = "  more: {type: pad, q: x, rate: v, k: 2e4}\n  a: {type: sum, of: [spring, more.force]}"
    source = text().replace("  a: {type: sum, of: [spring]}", added)
    before, after = (simulate(compile(read_text(given)))["x"] for given in (text(), source))
    assert np.abs(before - after).max() > 1e-4


MESSAGES = [
    ("[k]", "'effect' must be a mapping. Write it like {coefficient: k, inputs: {q: q}"),
    ("inputs: {q: q}", "an effect needs 'coefficient'. Write coefficient: ..."),
    ("coefficient: [k]", "the coefficient of an effect must be a text"),
    ("coefficient: kk", "unknown parameter 'kk'; there are: k, s, twice."),
    ("coefficient: k, gain: 2", "unknown key of an effect 'gain'; there are: at, coefficient,"),
    ("coefficient: k", "the effect leaves the inputs q, rate unconnected. Say which local signal"),
    ("coefficient: k, sign: up", "unknown sign of an effect 'up'; there are: either, positive."),
    ("coefficient: k, place: sensor", "unknown place of an effect 'sensor'; there are: drive, sum"),
    ("coefficient: k, inputs: [q]", "'inputs' of an effect must be a mapping. Write it like {rate"),
    ("coefficient: k, inputs: {q: x}", "unknown local signal 'x'; there are: a, other_q, other_v,"),
    (
        "coefficient: k, inputs: {q: x}",
        "v. Here q is the coordinate of the place, v is the rate of",
    ),
    ("coefficient: k, inputs: {w: q}", "unknown input 'w'; there are: q, rate."),
    ("coefficient: k, shapes: 3", "'shapes' must be a mapping. Write it like {s: {at: [0.1, 0.3]"),
    ("coefficient: k, shapes: {s: 3}", "the shape 's' must be a mapping. Write it like {at: [0.1"),
    ("coefficient: k, shapes: {s: {of: Q}}", "the shape 's' needs 'at'. Write at: ..."),
    ("coefficient: k, shapes: {s: {at: 1, on: Q}}", "unknown key of a shape 'on'; there are: at,"),
    ("coefficient: k, shapes: {s: {at: 1, of: W}}", "unknown scale of a shape 'W'; there are: Q,"),
    ("coefficient: k, shapes: {s: {at: [b]}}", "a value of the shape 's' must be a number, not"),
    ("coefficient: k, shapes: {s: {at: 1, low: b}}", "'low' of the shape 's' must be a number"),
    (EFFECT.replace("{s: {", "{z: {"), "unknown parameter 'z'; there are: k, s, twice. It is a"),
    (EFFECT + ", at: {at: [0]}", "'k' is tried at 0. The effect vanishes there"),
]


@pytest.mark.parametrize(("effect", "message"), MESSAGES)
def test_what_is_wrong_is_said_with_its_line(effect: str, message: str) -> None:
    given = text(effect) if effect[0] != "[" else text(effect).replace("{[k]}", "[k]")
    with pytest.raises(DiagramError) as caught:
        read_text(given)
    lines = [f"<text>:{problem.place.line}:" for problem in caught.value.problems]
    assert set(lines) == {"<text>:15:"}
    assert message in str(caught.value)
    assert "block 'pad'" in str(caught.value)


def test_an_effect_has_one_output() -> None:
    with pytest.raises(DiagramError, match="an effect has one output, and this block has 2"):
        read_text(text(outputs="{force: f, more: f}"))
    with pytest.raises(DiagramError, match=r"an effect needs an output. Write outputs: {force: "):
        read_text(text(outputs=""))


def test_a_diagram_is_no_effect() -> None:
    with pytest.raises(DiagramError, match=r"unknown section .effect..*It belongs to a subsystem"):
        read_text(DIAGRAM.replace("subsystems:", "effect: {coefficient: k}"))
