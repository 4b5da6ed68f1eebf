from __future__ import annotations

import linecache
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from diagram.alike import said
from hypothesis import given, settings
from hypothesis import strategies as st
from tracewire.diagram import DiagramBuilder, Signal, read, read_text, write
from tracewire.diagram.edit_values import set_values
from tracewire.errors import DiagramError, OptionError

CART = """\
# A cart on a spring.
#
# Built in Python.
title: Cart
span: [0, 20]
every: 0.05
record: [x, drag.force]
inputs:
  F: {unit: N, default: 0}
parameters:
  k: {value: 3, unit: N/m, fit: [0, inf]}  # the spring
  m: {value: 0.5, unit: kg}
  T: 2
require: [k > 0]
blocks:
  x: {type: integrator, of: v, unit: m, start: 0.1}
  v: {type: integrator, of: a, unit: m/s}
  spring: {type: gain, of: x, k: k}
  drag: {type: damper, rate: v}
  force: {type: sum, of: [F, -spring, drag.force], unit: N, place: {q: x, v: v}}
  a: {type: gain, of: force, k: 1/m}
events:
  - {when: x - 1, crosses: up, set: {v: -0.5*v}}
  - {every: T, set: {v: 0}}
subsystems:
  damper:
    inputs: [rate]
    outputs: [force]
    parameters:
      c: 0.1
    blocks:
      force: {type: viscous, rate: rate, c: c}  # linear
presets:
  soft: {k: 1, drag.c: 0}
scene:
  - {rod: {from: [0, 0], to: [x, 0.2]}}
"""


def cart() -> DiagramBuilder:
    rig = DiagramBuilder(
        "Cart",
        span=(0, 20),
        every=0.05,
        record=["x", "drag.force"],
        comment="A cart on a spring.\n\nBuilt in Python.",
    )
    force = rig.input("F", unit="N", default=0)
    k = rig.parameter("k", np.float64(3), unit="N/m", fit=(0, math.inf), comment="the spring")
    m = rig.parameter("m", 0.5, unit="kg")
    rig.parameter("T", np.int64(2))
    rig.require(f"{k} > 0")
    damper = rig.subsystem("damper")
    rate = damper.input("rate")
    c = damper.parameter("c", 0.1)
    damper.block("force", "viscous", rate=rate, c=c, comment="linear")
    damper.output("force")
    x = rig.block("x", "integrator", of="v", unit="m", start=0.1)
    v = rig.block("v", "integrator", of="a", unit="m/s")
    spring = rig.block("spring", "gain", of=x, k=k)
    drag = rig.block("drag", "damper", rate=v)
    rig.block("force", "sum", of=force, unit="N", place={"q": x, "v": v})
    rig.connect(-spring, "force")
    rig.connect(drag.output("force"), "force")
    rig.block("a", "gain", of="force", k=f"1/{m}")
    rig.event({v: f"-0.5*{v}"}, when="x - 1", crosses="up")
    rig.event({v: 0}, every="T")
    rig.preset("soft", {k: 1, "drag.c": 0})
    rig.scene({"rod": {"from": [0, 0], "to": [x, 0.2]}})
    return rig


def test_the_text_is_what_a_person_would_have_written() -> None:
    assert cart().text == CART


def test_a_diagram_that_is_built_is_that_of_its_text(tmp_path: Path) -> None:
    built = cart().build()
    file = write(built, tmp_path / "cart.yaml")
    assert file.read_text(encoding="utf-8") == built.text == cart().text
    assert said(read(file)) == said(built)
    assert (
        "k: {value: 4, unit: N/m, fit: [0, inf]}  # the spring" in set_values(built, {"k": 4}).text
    )


NAMES = st.from_regex(r"[a-z]{1,6}_[0-9]", fullmatch=True)
NUMBERS = st.floats(-1e12, 1e12) | st.integers(-1000, 1000)
TEXTS = st.text("abc xyz:#,[]{}'\"\\é-?&*!|>%@`0123456789", min_size=1, max_size=20)


@settings(max_examples=100, deadline=None)
@given(
    parameters=st.dictionaries(NAMES, st.tuples(NUMBERS, st.sampled_from(["", "N/m", "1", "ms"]))),
    starts=st.lists(NUMBERS, max_size=5),
    title=TEXTS,
    labels=st.lists(TEXTS, min_size=5, max_size=5),
    comment=TEXTS,
)
def test_numbers_and_texts_come_back_as_they_were_given(
    parameters: dict[str, tuple[float, str]],
    starts: list[float],
    title: str,
    labels: list[str],
    comment: str,
) -> None:
    rig = DiagramBuilder(title, comment=comment)
    rig.block("u", "constant", value=1, comment=comment)
    for name, (value, unit) in parameters.items():
        rig.parameter(name, value, unit=unit, comment=comment)
    for number, start in enumerate(starts):
        rig.block(f"x{number}", "integrator", of="u", start=start, label=labels[number])
    built = rig.build()
    assert said(built) == said(read_text(built.text))
    assert built.title == title.strip()
    numbers = {name: value.formula for name, value in built.parameters.items()}
    assert {name: formula.value for name, formula in numbers.items()} == {  # type: ignore[union-attr]
        name: float(value) for name, (value, _) in parameters.items()
    }
    for number, start in enumerate(starts):
        use = built.blocks[f"x{number}"]
        assert use.settings["start"].formula.value == float(start)  # type: ignore[union-attr]
        assert use.shown.label == " ".join(labels[number].split())


def test_a_signal_knows_its_sign_and_its_outputs() -> None:
    x = Signal("x")
    minus = -x
    assert (minus, -minus) == ("-x", "x")
    assert -x.output("torque") == "-x.torque"


def line_of(error: pytest.ExceptionInfo[Any]) -> list[int]:
    assert all(problem.place.file == __file__ for problem in error.value.problems)
    return [problem.place.line for problem in error.value.problems]


def test_what_is_wired_wrongly_is_told_by_the_lines_of_python() -> None:
    rig = DiagramBuilder(span=(0, 1), comment="one")
    rig.parameter("k", 5, fit=(0, 1))
    here = test_what_is_wired_wrongly_is_told_by_the_lines_of_python.__code__.co_firstlineno
    rig.block("x", "integratr", of="k")
    rig.block("y", "gain", of="z", k=1)
    inner = rig.subsystem("part")
    inner.block("q", "gain", of="w", k=1)
    rig.event({"y": 0}, when="y")
    rig.event({"y": 0}, when="nothing")
    with pytest.raises(DiagramError) as error:
        rig.build()
    assert line_of(error) == [here + line for line in (2, 4, 5, 7, 8, 9, 9)]
    told = str(error.value)
    assert f"test_builder.py:{here + 5}: block 'y': unknown signal 'z'; there are: x, y." in told
    assert "block 'part.q': unknown signal 'w'; there are: q." in told
    with pytest.raises(DiagramError, match=r"test_builder.py:\d+: a diagram needs 'blocks'"):
        DiagramBuilder("nothing").build()


MESSAGES = {
    "twice": (
        "block",
        ("x", "gain"),
        {},
        r"'x' in 'blocks': the other is in .*test_builder.py:\d+",
    ),
    "no name": ("block", ("x y", "gain"), {}, "'x y' cannot be a name in 'blocks'"),
    "NaN": ("parameter", ("k", math.nan), {}, r"'k' has a value that is no number \(NaN\)"),
    "an object": ("block", ("y", "gain"), {"k": object()}, "'y' has a value of type object. Give"),
    "a truth": ("block", ("y", "gain"), {"k": True}, "'y' has a value of type bool. Give a number"),
    "a key": ("preset", ("p", {1: 2}), {}, "'p' has a key that is no text"),
    "a wire to nothing": ("connect", ("x", "z"), {}, "unknown block 'z'; there are: x"),
}


@pytest.mark.parametrize("case", MESSAGES)
def test_messages(case: str) -> None:
    method, arguments, more, message = MESSAGES[case]
    rig = DiagramBuilder()
    rig.block("x", "integrator", of="x")
    with pytest.raises(OptionError, match=message) as error:
        getattr(rig, method)(*arguments, **more)
    assert line_of(error) != [0]


def test_a_series_and_an_effect(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("t,x\n0,0\n1,1\n")
    rig = DiagramBuilder(file=tmp_path / "built.yaml", max_step=0.1)
    rig.block("x", "integrator", of="x")
    rig.measured("run", "run.csv", time="t", signals={"x": "x"}, comment="a day in May")
    late = rig.subsystem("late", comment="tried by a trace")
    late.input("v")
    late.parameter("c", 0)
    late.block("force", "gain", of="v", k="-c")
    late.output("force")
    late.effect("c", {"v": "v"}, sign="positive")
    built = rig.build()
    assert list(built.measured["run"].channels) == ["x"]
    effect = built.subsystems["late"].effect
    assert effect is not None and effect.coefficient == "c"
    assert "  late:  # tried by a trace\n" in built.text


def test_a_subsystem_with_variants_and_a_row_of_it() -> None:
    rig = DiagramBuilder()
    law = rig.subsystem("law")
    rate = law.input("rate")
    law.output("force")
    law.variant("viscous", comment="slow").block("force", "viscous", rate=rate, c=0.1)
    law.variant("dry").block("force", "coulomb", rate=rate, level=0.2)
    rig.block("v", "integrator", of="drag.last.force")
    rig.block("drag", "law", rate="v", variant="dry", replicate=2)
    assert (
        rig.text
        == """\
blocks:
  v: {type: integrator, of: drag.last.force}
  drag: {type: law, rate: v, variant: dry, replicate: 2}
subsystems:
  law:
    inputs: [rate]
    outputs: [force]
    variants:
      viscous:  # slow
        blocks:
          force: {type: viscous, rate: rate, c: 0.1}
      dry:
        blocks:
          force: {type: coulomb, rate: rate, level: 0.2}
"""
    )
    inside = rig.build().blocks["drag_2"].subsystem
    assert inside is not None and inside.variant == "dry"
    law.variant("none").block("force", "gain", of="speed", k=0)
    with pytest.raises(DiagramError, match=r"block 'law.force': unknown signal 'speed'") as error:
        rig.build()
    (line,) = line_of(error)
    assert 'of="speed"' in linecache.getline(__file__, line)
