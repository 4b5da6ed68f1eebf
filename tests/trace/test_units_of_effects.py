"""The unit of a coefficient follows from the formula of its effect and from its place."""

from __future__ import annotations

from dataclasses import replace

import pytest
from show.traces import FOUND
from tracewire.compile import compile, unit_problems
from tracewire.diagram import read_text
from tracewire.show.trace_summary import meaning_words
from tracewire.trace import FoundEffect
from tracewire.trace.units import unit_at, unit_of, unit_of_effect, users_unit_of

CART = """\
blocks:
  x: {type: integrator, of: v, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  spring: {type: stiffness, of: x, k: 1}
  force: {type: sum, of: [spring], unit: N}
  a: {type: gain, of: force, k: 2}
"""
(EFFECT,) = FOUND.effects
CART_UNITS = {"x": "m", "v": "m/s", "force": "N"}
PENDULUM = """\
blocks:
  q: {type: integrator, of: w, unit: rad}
  w: {type: integrator, of: acceleration, unit: rad/s}
  height: {type: sin, of: q}
  acceleration: {type: sum, of: [-height]}
"""


@pytest.mark.parametrize(
    ("effect", "parameter", "unit"),
    [
        ("coulomb", "level", "N"),
        ("coulomb", "width", "m/s"),
        ("stribeck", "speed", "m/s"),
        ("viscous", "c", "N s/m"),
        ("quad_drag", "c", "N s^2/m^2"),
        ("cubic_stiffness", "k", "N/m^3"),
        ("backlash", "gap", "m"),
        ("cogging", "pitch", "m"),
        ("friction_drift", "level", "N/s"),
        ("dahl", "deflection", "m"),
        ("bouc_wen", "level", "N"),
        ("inertia", "m", "N s^2/m"),
        ("hunt_crossley", "k", ""),  # it depends on the exponent
        ("dahl", "exponent", ""),
        ("nothing", "c", ""),
    ],
)
def test_units_at_a_sum_with_a_unit(effect: str, parameter: str, unit: str) -> None:
    found = replace(FOUND, original=read_text(CART), units=CART_UNITS)
    assert unit_of_effect(found, effect, "force", parameter) == unit


def test_a_sum_that_is_a_rate_of_a_rate_has_its_unit() -> None:
    found = replace(FOUND, original=read_text(PENDULUM), units={"q": "rad", "w": "rad/s"})
    assert unit_at(found, "acceleration") == "rad/s^2"
    assert unit_of_effect(found, "coulomb", "acceleration", "level") == "rad/s^2"
    assert unit_of_effect(found, "viscous", "acceleration", "c") == "1/s"


def test_where_the_place_has_no_unit_none_is_made_up() -> None:
    bare = replace(FOUND, original=read_text(CART), units={"x": "m", "v": "m/s"})
    assert unit_at(bare, "force") == ""
    assert unit_of_effect(bare, "coulomb", "force", "level") == ""
    assert unit_of_effect(bare, "coulomb", "force", "width") == "m/s"


def test_sensors_and_drives_have_the_unit_of_their_signal() -> None:
    found = replace(FOUND, units={"theta": "rad", "F": "N"})
    assert (unit_at(found, "sensor.theta"), unit_at(found, "drive.F")) == ("rad", "N")


@pytest.mark.parametrize("effect", ["drive_lag", "drive_delay"])
def test_a_lag_and_a_delay_of_a_drive_are_in_seconds(effect: str) -> None:
    driven = "inputs: {F: {unit: N}}\n" + CART.replace("[spring]", "[spring, F]")
    found = replace(FOUND, original=read_text(driven), units=CART_UNITS | {"F": "N"})
    assert unit_of_effect(found, effect, "drive.F", "tau") == "s"


@pytest.mark.parametrize(("load", "unit"), [("N", ""), ("Pa", "N/Pa")])
def test_a_friction_that_grows_with_a_drive_has_a_share_in_the_unit_of_both(
    load: str, unit: str
) -> None:
    push = "  push: {type: gain, of: p, k: 0.01}\n"
    driven = f"inputs: {{p: {{unit: {load}}}}}\n{CART.replace('[spring]', '[spring, push]')}{push}"
    found = replace(FOUND, original=read_text(driven), units=CART_UNITS | {"p": load})
    assert unit_of_effect(found, "load_friction", "force", "share") == unit


@pytest.mark.parametrize(
    ("term", "unit"), [("offset", "rad"), ("drift", "rad/s"), ("delay", "s"), ("gain", "")]
)
def test_what_a_sensor_adds_has_its_unit(term: str, unit: str) -> None:
    found = replace(FOUND, units={"theta": "rad"})
    effect = FoundEffect(f"sensor_{term}", "sensor.theta", {term: 0.1})
    assert unit_of(found, effect, term) == unit


NODE = """\
blocks:
  v1: {type: integrator, of: slope, unit: V}
  probe: {type: gain, of: v1, k: {value: 0.01, unit: A/V}, unit: A}
  node: {type: sum, of: [-probe], unit: A, place: {v: v1}}
  slope: {type: gain, of: node, k: {value: 2, unit: V/A/s}}
"""


def test_what_runs_over_at_an_electrical_node_is_a_conductance() -> None:
    found = replace(FOUND, original=read_text(NODE), units={"v1": "V", "node": "A"})
    assert unit_of_effect(found, "overflow", "node", "k") == "A/V"
    assert unit_of_effect(found, "overflow", "node", "edge") == "V"


def test_an_overflow_that_is_written_at_a_node_is_told_and_checked_in_its_unit() -> None:
    changed = NODE.replace("[-probe]", "[-probe, spill]") + (
        "  spill: {type: overflow, of: v1, k: {value: 0.005, fit: [0, 0.1]}, edge: 0.5}\n"
    )
    flat = compile(read_text(changed)).flat
    assert unit_problems(flat) == []
    units = {**flat.units, **{name: p.unit for name, p in flat.parameters.items()}}
    effect = FoundEffect("overflow", "node", {"k": 0.005}, block="spill")
    found = replace(FOUND, original=read_text(NODE), units=units)
    assert unit_of(found, effect, "k") == "A/V"


ROPE = """\
blocks:
  theta: {type: integrator, of: omega, unit: rad}
  omega: {type: integrator, of: alpha, unit: rad/s}
  speed: {type: gain, of: omega, k: {value: 2, unit: m}, unit: m/s}
  weight: {type: gain, of: theta, k: {value: -9.81, unit: m/s^2}}
  push: {type: sum, of: [weight], unit: m/s^2, place: {q: theta, v: speed}}
  alpha: {type: gain, of: push, k: {value: 0.5, unit: 1/m}}
"""
ROPE_UNITS = {"theta": "rad", "omega": "rad/s", "speed": "m/s", "push": "m/s^2"}


@pytest.mark.parametrize(
    ("effect", "parameter", "unit"),
    [
        ("quad_drag", "c", "1/m"),
        ("viscous", "c", "1/s"),
        ("coulomb", "width", "m/s"),
        ("dahl", "deflection", "m"),
        ("stiffness", "k", "m/s^2/rad"),
        ("hunt_crossley", "k", ""),
    ],
)
def test_a_rate_that_is_not_that_of_the_coordinate(effect: str, parameter: str, unit: str) -> None:
    found = replace(FOUND, original=read_text(ROPE), units=ROPE_UNITS)
    assert unit_of_effect(found, effect, "push", parameter) == unit


def test_a_value_has_the_users_unit_of_what_it_is_compared_with() -> None:
    """A gap in the unit of the coordinate, a level in that of the sum, a limit in the drive's."""
    scales = {"x": ("mm", 1e-3), "u": ("mA", 1e-3), "v": ("m/s", 1.0), "force": ("kN", 1e3)}
    found = replace(
        FOUND, original=read_text(CART), units={**CART_UNITS, "u": "A"}, users_units=scales
    )

    def shown(name: str, place: str, parameter: str) -> tuple[str, float]:
        return users_unit_of(found, replace(EFFECT, name=name, place=place), parameter)

    assert shown("backlash", "force", "gap") == ("mm", 1e-3)
    assert shown("coulomb", "force", "level") == ("kN", 1e3)
    assert shown("stribeck", "force", "speed") == ("m/s", 1.0)
    assert shown("viscous", "force", "c") == ("N s/m", 1.0)
    drive = replace(found, units={**found.units, "drive_saturation.limit": "A"})
    effect = replace(EFFECT, place="drive.u", block="drive_saturation")
    assert users_unit_of(drive, effect, "limit") == ("mA", 1e-3)


def test_an_effect_at_a_temperature_is_told_in_its_words() -> None:
    wall = """\
blocks:
  T: {type: integrator, of: net, unit: K}
  net: {type: sum, of: [T], unit: K/s}
"""
    units = {"T": "K", "net": "K/s"}
    found = replace(FOUND, original=read_text(wall), diagram=read_text(wall), units=units)
    drag = replace(EFFECT, name="quad_drag", place="net", block="quad_drag")
    assert meaning_words(found, drag) == "'quad_drag': a loss in proportion to the square of T."
    turning = replace(found, units={"T": "rad/s", "net": "rad/s^2"})
    assert "as of a body in a turbulent fluid" in meaning_words(turning, drag)
