"""Units go through the blocks of signals, control and bodies, and a wrong one is told."""

from __future__ import annotations

import pytest
from tracewire.compile import compile, unit_problems
from tracewire.diagram import read_text

GIVEN = """
span: [0, 1]
parameters:
  T: {value: 5, unit: ms}
  F: {value: 2, unit: N}
  V: {value: 12, unit: V}
  b: {value: 2, unit: m/(s^2 rad)}
  k: {value: 2, unit: V/rad}
  ki: {value: 2, unit: V/(rad s)}
  kd: {value: 2, unit: V s/rad}
  L: {value: 2, unit: H}
  R: {value: 2, unit: ohm}
  kt: {value: 2, unit: N m/A}
  torque: {value: 3, unit: N m}
  rate: {value: 3, unit: 1/s}
  M: {value: 3, unit: kg}
  J: {value: 3, unit: kg m^2}
  way: {value: 3, unit: m}
  pace: {value: 3, unit: m/s}
  stiff: {value: 3, unit: N/m}
  damping: {value: 3, unit: N s/m}
  fast: {value: 3, unit: N/s}
blocks:
  turned: {type: sine, amplitude: {value: 1, unit: rad}, omega: 3, unit: rad}
  volts: {type: constant, value: V, unit: V}
  moved: {type: integrator, of: moving, unit: m}
  moving: {type: constant, value: pace, unit: m/s}
  pressed: {type: constant, value: F, unit: N}
"""
UNITS = {
    "pulse": ("amplitude: F, period: T", "N"),
    "sawtooth": ("amplitude: F, period: T", "N"),
    "triangle": ("amplitude: F, period: T", "N"),
    "chirp": ("amplitude: F, first: 1, last: 2, duration: 1", "N"),
    "multisine": ("frequencies: [1, 2], amplitudes: F", "N"),
    "noise": ("period: T, seed: 1, sigma: F", "N"),
    "random_steps": ("period: T, seed: 1, low: -F, high: F", "N"),
    "prbs": ("period: T, register: [1, 0, 0], low: -F, high: F", "N"),
    "first_order": ("of: turned, k: k, lag: T", "V"),
    "lead_lag": ("of: turned, k: k, lead: T, lag: 2*T", "V"),
    "derivative": ("of: volts, k: k, lag: T", "V^2/(rad s)"),
    "second_order": ("of: turned, k: k, frequency: 2, damping: 0.1", "V"),
    "low_pass": ("of: volts, frequency: 2", "V"),
    "high_pass": ("of: volts, frequency: 2", "V"),
    "band_pass": ("of: volts, frequency: 2", "V"),
    "notch": ("of: volts, frequency: 2", "V"),
    "delay": ("of: volts, time: T, before: V", "V"),
    "pade_delay": ("of: volts, delay: T", "V"),
    "pid": ("of: turned, kp: k, ki: ki, kd: kd, low: -V, high: V", "V"),
    "transfer_function": ("of: volts, numerator: kt, denominator: [L, R], start: torque", "N m"),
    "state_space": ("of: turned, A: [[0, 1], [-4, -1]], B: [[0], [b]], C: [1, 0]", "m"),
    "unit_delay": ("of: volts, period: T", "V"),
    "discrete_integrator": ("of: volts, gain: rate, period: T", "V"),
    "discrete_pid": ("of: turned, period: T, kp: k, ki: ki, kd: kd, low: -V, high: V", "V"),
    "discrete_transfer_function": ("of: volts, period: T, denominator: [1, -0.5]", "V"),
    "quantizer": ("of: volts, interval: V", "V"),
    "select": ("index: turned, of: [volts, volts]", "V"),
    "timer": ("of: volts", "s"),
    "spring_damper": ("of: moved, rate: moving, k: stiff, c: damping, length: way", "N"),
    "rope": ("of: moved, rate: moving, k: stiff, c: damping, length: way", "N"),
    "brake": ("rate: moving, normal: pressed, friction: 0.3, radius: way", "N m"),
    "clutch": (
        "rate: moving, other_rate: moving, normal: pressed, friction: 0.3, radius: way",
        "N m",
    ),
    "eddy_brake": ("rate: moving, peak: F, speed: pace", "N"),
    "stribeck_friction": ("rate: moving, slip: F, stick: 2*F, speed: pace, c: damping", "N"),
    "rolling_resistance": ("rate: moving, load: pressed, c0: 0.1", "N"),
    "maxwell_slip": ("rate: moving, k: [stiff, stiff], level: [F, F]", "N"),
    "maxwell_element": ("rate: moving, k: stiff, level: F, peak: 0.4, speed: pace, c: fast", "N"),
    "signal_builder": ("times: [0, 1], values: [F, 2*F]", "N"),
    "lookup_table_2d": (
        "of: moved, other: moving, rows: [0, 1], columns: [0, 1], values: [[F, F], [F, F]]",
        "N",
    ),
}
"""What a block is given, and the unit of its output."""


FREE = {
    "pulse",
    "sawtooth",
    "triangle",
    "noise",
    "band_pass",
    "discrete_transfer_function",
    "timer",
    "brake",
    "clutch",
    "eddy_brake",
    "rolling_resistance",
}
"""Blocks with a number or the time as a factor, which may have any unit."""


def told(type_name: str, settings: str, unit: str) -> list[str]:
    text = f"{GIVEN}  y: {{type: {type_name}, {settings}, unit: {unit}}}\n"
    return [str(problem) for problem in unit_problems(compile(read_text(text)).flat)]


@pytest.mark.parametrize("name", UNITS)
def test_the_unit_of_an_output_is_that_of_what_it_is_made_of(name: str) -> None:
    settings, unit = UNITS[name]
    assert told(name, settings, unit) == []
    assert bool(told(name, settings, "kg")) == (name not in FREE)


def test_the_gains_of_a_controller_have_the_units_of_its_signals() -> None:
    gains = "kp: {value: 2, fit: free}, ki: {value: 3, fit: free}, kd: {value: 1, fit: free}"
    assert told("pid", f"of: turned, {gains}", "V") == []
    assert told("discrete_pid", f"of: turned, {gains}, period: T", "V") == []


@pytest.mark.parametrize(
    ("blocks", "wrong"),
    [
        ("y: {type: mass, force: volts, mass: M}", "it needs a rate in m/s^2"),
        ("y: {type: rotating_mass, torque: pressed, inertia: J}", "it needs a rate in 1/s^2"),
        ("y: {type: rack, torque: pressed, radius: way, inertia: J, mass: M}", "a rate in m/s^2"),
        ("y: {type: lever, force1: volts, a: way, b: way, inertia: J}", "it needs a rate in 1/s^2"),
        (
            "y: {type: gear, torque2: pressed, ratio: 2, inertia1: J, inertia2: J}",
            "it needs a rate in 1/s^2",
        ),
        (
            "y: {type: spring_damper, of: moved, rate: moved, k: stiff, c: damping, unit: N}",
            "cannot be added",
        ),
    ],
)
def test_a_wrong_unit_at_a_body_is_told(blocks: str, wrong: str) -> None:
    problems = unit_problems(compile(read_text(f"{GIVEN}  {blocks}\n")).flat)
    assert any(wrong in str(problem) for problem in problems)
