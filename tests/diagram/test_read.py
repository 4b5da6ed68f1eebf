from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import tracewire as tw
from diagram.small_library import LIBRARY, PENDULUM, made
from tracewire.compile import compile as compile_model
from tracewire.diagram import Value, Wire, find_parameter, read, read_text
from tracewire.errors import DiagramError, Location, OptionError
from tracewire.formula import Name, Number, parse, to_text
from tracewire.solve import parameter_values


def test_the_example_of_the_design_becomes_nouns() -> None:
    diagram = made(PENDULUM)
    assert diagram.title == "Torsion pendulum with a bearing"
    assert diagram.text == PENDULUM
    assert list(diagram.blocks) == ["theta", "omega", "column", "bearing", "torque", "alpha"]
    assert list(diagram.record) == ["theta", "bearing.friction"]
    assert diagram.inputs["drive"].unit == "N m"
    column = diagram.blocks["column"]
    assert column.inputs["of"][0].signal == "theta"
    assert column.settings["k"] == Value(
        parse("-stiffness"), place=Location("<text>", 14, 39, "column")
    )
    bearing = diagram.blocks["bearing"].subsystem
    assert bearing is diagram.subsystems["journal_bearing"]
    assert bearing.outputs["torque"].signal == "total"
    assert diagram.blocks["torque"].local == {"q": "theta", "v": "omega"}
    assert diagram.events[0].crosses == "up"
    assert diagram.events[0].set == {"omega": parse("-0.5*omega")}
    assert diagram.presets["as_printed"]["bearing.slip"].formula == Number(2e-4)
    assert diagram.blocks["theta"].place == Location("<text>", 11, 3, "theta")


def test_a_value_keeps_unit_factor_and_bounds_in_si() -> None:
    text = "parameters: {a: {value: 90, unit: deg, fit: [0, 180]}, b: {value: 1, fit: free}, c: 2}"
    values = made(text + "\nblocks: {}").parameters
    assert values["a"].formula == Number(90)
    assert values["a"].unit == "rad"
    assert values["a"].factor == pytest.approx(math.pi / 180)
    assert values["a"].fit == pytest.approx((0, math.pi))
    assert values["a"].named
    assert values["b"].fit == (-math.inf, math.inf)
    assert not values["c"].named


def test_numbers_are_ours_and_words_are_text() -> None:
    text = "title: yes\nparameters: {a: 1e-3, on: .5, b: on + 2.e1, null_: -1E+2}\nblocks: {}"
    diagram = made(text)
    assert diagram.title == "yes"
    assert diagram.parameters["a"].formula == Number(1e-3)
    assert diagram.parameters["on"].formula == Number(0.5)
    assert diagram.parameters["null_"].formula == Number(-100.0)


def test_wires_carry_signs_and_name_outputs() -> None:
    text = """
blocks:
  o: {type: oscillator}
  s: {type: sum, of: [-o.x, o.force, i.y]}
  n: {type: gain, of: -s, k: 1}
  m: {type: sum, of: n}
  e: {type: sum, of: []}
  i: {type: integrator, of: m.y}
"""
    blocks = made(text).blocks
    plain = [(wire.signal, wire.negative) for wire in blocks["s"].inputs["of"]]
    assert plain == [("o.x", True), ("o.force", False), ("i.y", False)]
    assert blocks["n"].inputs["of"][0].negative
    assert [wire.signal for wire in blocks["m"].inputs["of"]] == ["n"]
    assert blocks["e"].inputs["of"] == ()
    assert blocks["o"].inputs == {}


def test_recorded_names_become_full_names() -> None:
    text = PENDULUM.replace(
        "[theta, bearing.friction]", "[theta.y, bearing, bearing.total.y, theta, drive]"
    )
    names = ["theta", "bearing.torque", "bearing.total", "drive"]
    assert list(made(text).record) == names


def test_a_state_that_is_no_output_can_be_recorded() -> None:
    assert list(made("record: [o.v]\nblocks: {o: {type: oscillator}}").record) == ["o.v"]


def test_a_formula_setting_sees_signals_parameters_and_the_time() -> None:
    text = "parameters: {k: 2}\nblocks: {e: {type: expression, formula: k*u + sin(t)}}\ninputs: [u]"
    assert made(text).blocks["e"].settings["formula"] == parse("k*u + sin(t)")


def test_points_stand_in_the_diagram_or_in_a_file(tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text("angle,force\n0,1\n2,5\n")
    text = """
inputs: [u]
blocks:
  a: {type: lookup, of: u, points: [[0, 1], [2, 5]]}
  b: {type: lookup, of: u, points: {file: table.csv, x: angle, y: force}}
"""
    blocks = made(text, tmp_path / "diagram.yaml").blocks
    for name in "ab":
        points = blocks[name].settings["points"]
        assert (points.x, points.y) == ((0.0, 2.0), (1.0, 5.0))


def test_inner_subsystems_see_those_around_them_and_the_nearest_goes_first() -> None:
    text = """
inputs: [u]
blocks:
  a: {type: outer, u: u}
  b: {type: double, u: u}
subsystems:
  double: {inputs: [u], outputs: {y: k}, blocks: {k: {type: gain, of: u, k: 2}}}
  outer:
    inputs: [u]
    outputs: {y: c}
    blocks:
      c: {type: double, u: d}
      d: {type: helper, u: u}
    subsystems:
      double: {inputs: [u], outputs: {z: k}, blocks: {k: {type: gain, of: u, k: 4}}}
      helper: {inputs: [u], outputs: [e], blocks: {e: {type: double, u: u}}}
"""
    diagram = made(text)
    outer = diagram.blocks["a"].subsystem
    assert outer is not None and outer.blocks["c"].subsystem is outer.subsystems["double"]
    helper = outer.subsystems["helper"]
    assert helper.blocks["e"].subsystem is outer.subsystems["double"]
    assert helper.outputs["e"] == Wire("e", False, helper.outputs["e"].place)
    assert diagram.blocks["b"].subsystem is diagram.subsystems["double"]


UNITS = """
parameters: {tilt: {value: 10, unit: deg}}
blocks:
  number:  {type: tilted, angle: 5}
  formula: {type: tilted, angle: tilt}
  mapping: {type: tilted, angle: {value: 5, unit: rad}}
  default: {type: tilted}
subsystems:
  tilted:
    outputs: {y: e}
    parameters: {angle: {value: 1, unit: deg}}
    blocks: {e: {type: expression, formula: angle}}
presets: {p: {tilt: 20, number.angle: tilt}}
"""


def test_a_number_is_in_the_unit_of_the_parameter_and_a_formula_in_si() -> None:
    diagram = made(UNITS)
    degree = math.pi / 180
    factors = {name: find_parameter(diagram, f"{name}.angle").factor for name in diagram.blocks}
    assert factors == {"number": degree, "formula": 1.0, "mapping": 1.0, "default": degree}
    preset = diagram.presets["p"]
    assert preset["tilt"].factor == degree
    assert (preset["number.angle"].formula, preset["number.angle"].factor) == (Name("tilt"), 1.0)
    assert preset["number.angle"].unit == "rad"


def test_an_input_has_a_unit_and_a_default_in_it() -> None:
    port = made("inputs: {a: {unit: deg, default: 90}, b: {}}\nblocks: {}").inputs
    assert (port["a"].unit, port["a"].default.factor) == ("rad", pytest.approx(math.pi / 180))
    assert port["b"].default is None


def test_files_with_a_mark_or_windows_line_ends_keep_their_text(tmp_path: Path) -> None:
    text = "\ufeff" + PENDULUM.replace("\n", "\r\n")
    file = tmp_path / "diagram.yaml"
    file.write_bytes(text.encode())
    from tracewire.diagram.files import load_text

    diagram = made(load_text(file), file)
    assert diagram.text == text
    assert diagram.blocks["theta"].place.line == 11


def test_read_uses_the_shipped_blocks_and_those_that_are_named(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(
        "from tracewire.library import Block, Output\n"
        'mine = Block(name="mine", doc="one", outputs=(Output("y", "1"),))\n'
    )
    (tmp_path / "diagram.yaml").write_text("blocks: {a: {type: mine}}")
    diagram = read(tmp_path / "diagram.yaml", [tmp_path / "mine.py"])
    assert diagram.name == "diagram"
    assert diagram.blocks["a"].type == "mine"
    with pytest.raises(DiagramError, match="unknown block type 'mine'"):
        read(tmp_path / "diagram.yaml")


def test_the_same_text_gives_the_same_diagram() -> None:
    assert made(PENDULUM) == made(PENDULUM)
    assert made(PENDULUM).library is LIBRARY


def test_a_unit_is_that_of_numbers_and_formulas_of_parameters_are_in_si() -> None:
    """One rule for values, for what a subsystem is given, and for presets."""
    model = compile_model(
        read_text(
            """
            parameters:
              tilt: {value: 90, unit: deg}
              half: {value: 180/2, unit: deg}
              same: {value: tilt, unit: deg}
            blocks:
              a: {type: arm}
              b: {type: arm, angle: 180/2}
              c: {type: arm, angle: tilt}
              x: {type: integrator, of: x}
            presets:
              numbers: {tilt: 45, a.angle: 90/2}
              formulas: {same: 2*tilt}
            subsystems:
              arm:
                outputs: {y: value}
                parameters: {angle: {value: 90, unit: deg}}
                blocks: {value: {type: constant, value: angle}}
            """
        )
    )
    values = parameter_values(model, {})
    right = math.pi / 2
    assert values == pytest.approx(dict.fromkeys(values, right))
    assert parameter_values(model, {}, "numbers")["a.angle"] == pytest.approx(right / 2)
    assert parameter_values(model, {}, "formulas")["same"] == pytest.approx(2 * right)


EVENTS = """
blocks:
  o: {type: oscillator}
  i: {type: integrator, of: o.x}
events:
  - {when: o.top, set: {i: o.x, o.v: 0}}
  - {when: o.force, crosses: up, set: {o.x: 1}}
  - {every: {value: 5, unit: ms}, offset: 1, set: {i: 0}}
"""


def test_an_event_may_be_that_of_a_block_or_a_clock_and_set_one_of_several_states() -> None:
    named, crossing, clock = made(EVENTS).events
    assert named.when == Name("o.top")
    assert set(named.set) == {"i", "o.v"}
    assert (crossing.when, crossing.crosses) == (Name("o.force"), "up")
    assert clock.when is None and clock.every is not None and clock.offset is not None
    assert clock.every.formula == Number(5.0)
    assert clock.every.factor == pytest.approx(1e-3)
    assert clock.offset.formula == Number(1.0)


def test_a_subsystem_without_blocks_is_a_bundle_with_names() -> None:
    diagram = read_text("""
subsystems:
  pose: {inputs: [x, v], outputs: {x: x, v: v}, blocks: {}}
blocks:
  a: {type: integrator, of: b}
  b: {type: constant, value: 2}
  body: {type: pose, x: a, v: -b}
  s: {type: sum, of: [body.x, body.v]}
""")
    signals = compile_model(diagram).flat.signals
    assert {name: to_text(signals[name]) for name in ("body.x", "body.v")} == {
        "body.x": "a",
        "body.v": "-b",
    }


@pytest.mark.parametrize("use", [tw.simulate, tw.fit, tw.trace])
def test_a_diagram_in_the_place_of_a_model_says_so(use: Callable[[Any], object]) -> None:
    diagram = made(PENDULUM)
    with pytest.raises(OptionError, match=r"is a Diagram, and not a model.* tracewire\.compile"):
        use(diagram)
    with pytest.raises(AttributeError, match=r"Where a model is meant: tracewire\.compile"):
        diagram.flat  # type: ignore[attr-defined]  # noqa: B018
