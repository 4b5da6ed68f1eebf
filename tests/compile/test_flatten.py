from __future__ import annotations

import math

import pytest
from solve.models import made, run
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import DiagramError, OptionError
from tracewire.solve import parameter_values

NESTED = """
title: A mass on two springs
span: [0, 1]
record: [left.force, x]
parameters:
  m: {value: 2, unit: kg}
  soft: {value: 3, unit: N/m, fit: [1, 5]}
blocks:
  x: {type: integrator, of: v, start: {value: 30, unit: cm}, unit: m}
  v: {type: integrator, of: a}
  left: {type: wall, of: x, k: soft, rest: {value: 20, unit: cm}}
  right: {type: wall, of: x}
  total: {type: sum, of: [left, -right, left.force]}
  a: {type: gain, of: total, k: 1/m}
subsystems:
  wall:
    inputs: [of]
    outputs: {force: spring}
    parameters:
      k: {value: 7, unit: N/m}
      rest: {value: 10, unit: cm}
      half: k/2
    blocks:
      slack: {type: expression, formula: of - rest}
      spring: {type: expression, formula: -half*slack}
presets:
  stiff: {soft: {value: 1, unit: N/cm}, right.k: 9}
  tied: {soft: m*4}
"""


def test_subsystems_dissolve_into_full_names() -> None:
    model = made(NESTED)
    assert model.states == ("x", "v")
    assert model.recorded == ("left.force", "x")
    assert {"left.k", "left.rest", "left.half", "right.k"} <= set(model.parameters)
    assert list(model.flat.signals) == [
        "left.slack",
        "left.spring",
        "left.force",
        "right.slack",
        "right.spring",
        "right.force",
        "total",
        "a",
    ]
    assert model.flat.blocks["left.spring"].definition == "wall.spring"


def test_values_are_in_si_and_follow_their_formulas() -> None:
    values = parameter_values(made(NESTED), {})
    assert values["left.k"] == values["soft"] == 3.0
    assert values["left.half"] == 1.5
    assert values["right.half"] == 3.5
    assert values["left.rest"] == pytest.approx(0.2)
    assert values["right.rest"] == pytest.approx(0.1)
    assert parameter_values(made(NESTED), {"soft": 8.0})["left.half"] == 4.0


def test_presets_change_parameters_before_what_is_given() -> None:
    model = made(NESTED)
    assert parameter_values(model, {}, "stiff")["soft"] == pytest.approx(100.0)
    assert parameter_values(model, {}, "stiff")["right.half"] == 4.5
    assert parameter_values(model, {"m": 3.0}, "tied")["left.k"] == 12.0
    assert parameter_values(model, {"soft": 5.0}, "stiff")["soft"] == 5.0


def test_sums_carry_the_signs_of_their_wires() -> None:
    result = run(NESTED, record=("total", "right", "a"))
    assert list(result.signals) == ["left.force", "x", "total", "right.force", "a"]
    left, right = -1.5 * (0.3 - 0.2), -3.5 * (0.3 - 0.1)
    assert result["left.force"][0] == pytest.approx(left)
    assert result["total"][0] == pytest.approx(2 * left - right)
    assert result["a"][0] == pytest.approx((2 * left - right) / 2)


def test_equations_are_readable() -> None:
    text = made(NESTED).equations
    assert "left.slack = x - left.rest" in text
    assert "total = left.force - right.force + left.force" in text
    assert "x' = v" in text
    assert "x(t0) = x.start" in text


def test_a_port_without_a_wire_has_its_default() -> None:
    text = "span: [0, 2]\nrecord: [y]\nblocks: {y: {type: table, points: [[0, 0], [2, 6]]}}"
    assert run(text, times=[0.5, 1.5])["y"] == pytest.approx([1.5, 4.5])


def test_a_phase_in_degrees_is_converted() -> None:
    text = """
span: [0, 1]
record: [y]
blocks: {y: {type: sine, amplitude: 2, omega: 1, phase: {value: 30, unit: deg}}}
"""
    assert run(text)["y"][0] == pytest.approx(2 * math.sin(math.pi / 6))


def test_a_start_value_reads_only_parameters() -> None:
    text = "blocks: {x: {type: integrator, of: y, start: y}, y: {type: constant, value: 1}}"
    with pytest.raises(DiagramError, match="y"):
        made(text)


def test_a_recorded_signal_must_exist() -> None:
    with pytest.raises(OptionError, match=r"unknown signal 'lefd'.*Did you mean 'left"):
        made(NESTED, record=("lefd",))


def test_an_algebraic_loop_through_subsystems_is_no_false_alarm() -> None:
    text = """
blocks:
  x: {type: integrator, of: pair.second}
  pair: {type: two, first: x, other: pair.straight}
subsystems:
  two:
    inputs: [first, other]
    outputs: {straight: f, second: s}
    blocks:
      f: {type: gain, of: first, k: 2}
      s: {type: gain, of: other, k: 3}
"""
    model = compile(read_text(text))
    assert "pair.s = 3*pair.straight" in model.equations


@pytest.mark.parametrize("outputs", ["[x, force]", "{x: x, force: force}"])
def test_an_output_may_have_the_name_of_the_block_that_it_carries(outputs: str) -> None:
    inside = f"""
span: [0, 1]
record: [left.x, left.force, left.rate]
blocks:
  left: {{type: body, k: 4}}
subsystems:
  body:
    outputs: {outputs}
    parameters: {{k: 1}}
    blocks:
      x: {{type: integrator, of: rate, start: 1, unit: m}}
      rate: {{type: integrator, of: force, unit: m/s}}
      force: {{type: gain, of: x, k: -k}}
"""
    result = run(inside)
    assert result["left.x"][-1] == pytest.approx(math.cos(2.0), abs=1e-5)
    assert result["left.force"][-1] == pytest.approx(-4 * math.cos(2.0), abs=1e-5)
    assert made(inside).flat.units["left.x"] == "m"


def test_an_output_takes_the_unit_of_what_it_carries() -> None:
    carried = NESTED.replace("outputs: {force: spring}", "outputs: {force: -spring}").replace(
        "formula: -half*slack", "formula: -half*slack, unit: N"
    )
    assert made(carried).flat.units["left.force"] == "N"


def test_a_model_is_shown_in_a_line() -> None:
    assert repr(made(NESTED)) == "Model('A mass on two springs': states x, v; 9 parameters)"
