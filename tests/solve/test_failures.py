"""What a run says that cannot go on: block, guard, time and remedy.

Undefined rates, steps that are too small and limits are in test_limits.py, resets that write what
they must not in test_events.py, loops without a solution in test_loops.py.
"""

from __future__ import annotations

import re

import pytest
from solve.models import LIMITS, one
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import OptionError, SimulationError
from tracewire.library import Block, Input, Mode, Output, Transition, load_library
from tracewire.solve import simulate, simulate_many


def said(text: str) -> str:
    """The message of a run that is refused, with the name of its file and the place in it."""
    with pytest.raises(SimulationError) as caught:
        simulate(compile(read_text(text)), limits=LIMITS)
    return str(caught.value)


def test_a_reset_that_fires_again_and_again_is_chatter() -> None:
    """x rises by 1e-9 to 1, and is put back, for ever."""
    text = one("1", 0.5) + "events:\n  - {when: x - 1, crosses: up, set: {x: 1 - 1e-9}}\n"
    message = said(text)
    found = re.search(r"the run stopped at t = (\S+) s: the guard 'x - 1' changed", message)
    assert found is not None
    assert float(found[1]) == pytest.approx(0.5 + 49e-9, abs=2e-9)
    assert "its mode again and again: 50 events within 4.9e-08 s; x = 1." in message
    assert "Give the block hysteresis or a stick level" in message


def test_a_body_without_room_between_two_walls_never_stops_bouncing() -> None:
    text = """
span: [0, 2]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: none, start: -1}
  none: {type: constant, value: 0}
events:
  - {when: x, crosses: down, set: {v: -v}}
  - {when: 2*x, crosses: up, set: {v: -v}}
"""
    message = said(text)
    assert re.search(r"block 'events\[.\]': the run stopped at t = 1 s: the impacts of '", message)
    assert "and its neighbours do not come to an end; x = " in message
    assert "Give one of them a restitution below 1." in message


def test_where_too_many_surfaces_meet_the_run_is_refused_with_all_of_them() -> None:
    """Ten surfaces through the origin of two states, none of which can be left."""
    terms = "".join(f" - sign({k}*x - y)" for k in range(1, 9))
    message = said(f"""
blocks:
  x: {{type: integrator, of: xd}}
  y: {{type: integrator, of: yd}}
  xd: {{type: expression, formula: 0{terms}}}
  yd: {{type: expression, formula: "-sign(y + 2*x) - (2 if x >= 0 else -2)"}}
""")
    assert "block 'xd': no consistent mode at t = 0 s for the guards '1*x - y' in xd, " in message
    assert "'8*x - y' in xd, 'y + 2*x' in yd, 'x' in yd." in message
    assert "use hysteresis or a block with memory" in message


HURRY = Block(
    name="hurry",
    doc="Two modes, each of which is left where the other is entered.",
    inputs=(Input("of"),),
    modes=(Mode("off"), Mode("on")),
    transitions=(
        Transition("off", "on", when="of >= 1"),
        Transition("on", "off", when="of >= 1"),
    ),
    outputs=(Output("y", {"off": "0", "on": "1"}),),
)


def test_a_memory_that_is_led_in_a_circle_is_named() -> None:
    text = """
span: [0, 7]
blocks:
  x: {type: ramp, slope: 1, offset: 0.5}
  hurry: {type: hurry, of: x}
"""
    library = load_library().extended({"hurry": HURRY}, {})
    with pytest.raises(SimulationError) as caught:
        simulate(compile(read_text(text, library=library)), limits=LIMITS)
    message = str(caught.value)
    assert "<text>:5:3: block 'hurry': the transitions of 'hurry' at t = 0.5 s lead back" in message
    assert "Let the condition that leaves a mode be false where the mode is entered." in message


REQUIRED = """
parameters: {m: 1, k: 4, scale: 2*m}
require: [m > 0, k/scale >= 1]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: gain, of: x, k: -k/m}
"""


def test_a_run_whose_parameters_do_not_meet_what_is_required_is_refused() -> None:
    model = compile(read_text(REQUIRED))
    simulate(model, parameters={"m": 2.0})
    with pytest.raises(SimulationError) as caught:
        simulate(model, parameters={"m": 3.0})
    told = str(caught.value)
    assert "3:18: the parameters do not meet 'k/scale >= 1': k = 4, scale = 6" in told
    assert "see its section 'require'" in told


BOUNDED = """\
span: [0, 1]
parameters: {e: 0.5}
blocks:
  weight: {type: constant, value: -9.81}
  ball: {type: bouncing_body, force: weight, restitution: 2*e - 0.5, start: 1}
  outer: {type: damped, drag: e}
subsystems:
  damped:
    parameters: {drag: 1}
    outputs: {v: v}
    blocks:
      v: {type: integrator, of: friction, start: 1}
      friction: {type: viscous, rate: v, c: drag - 0.1}
"""


@pytest.mark.parametrize(
    ("e", "told"),
    [
        (0.2, "block 'ball': the parameters do not meet '2*e - 0.5 >= 0': e = 0.2"),
        (0.8, "block 'ball': the parameters do not meet '2*e - 0.5 <= 1': e = 0.8"),
        (0.05, "block 'outer.friction': the parameters do not meet 'outer.drag - 0.1 >= 0'"),
    ],
)
def test_the_bounds_of_a_block_hold_for_formulas_and_inside_subsystems(e: float, told: str) -> None:
    model = compile(read_text(BOUNDED))
    assert simulate(model).final
    with pytest.raises(SimulationError) as caught:
        simulate(model, parameters={"e": e})
    assert told in str(caught.value)
    assert "Its block '" in str(caught.value)


def test_the_bounds_of_a_block_hold_for_each_element_of_a_list() -> None:
    text = """\
span: [0, 1]
parameters: {a: 1, b: 1}
blocks:
  v: {type: integrator, of: friction, start: [1, 1]}
  friction: {type: viscous, rate: v, c: [a, b]}
"""
    model = compile(read_text(text))
    with pytest.raises(SimulationError, match="do not meet 'b >= 0': b = -1"):
        simulate(model, parameters={"b": -1})


def test_of_many_rows_only_those_fail_that_do_not_meet_what_is_required() -> None:
    runs = simulate_many(compile(read_text(REQUIRED)), {"m": [1.0, 3.0, -1.0, 2.0]})
    assert sorted(runs.errors) == [1, 2]
    assert "'m > 0': m = -1" in runs.errors[2]


def test_a_start_that_is_not_finite_is_told_with_its_line() -> None:
    text = """\
parameters: {k: 1}
blocks:
  x: {type: integrator, of: v, start: 1/(k - 1)}
  v: {type: constant, value: 1}
"""
    wanted = "<text>:3:3: block 'x': the start of 'x' is inf. A start is a finite number"
    with pytest.raises(OptionError, match=wanted):
        simulate(compile(read_text(text)))
