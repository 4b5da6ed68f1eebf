"""Diagrams whose analyses have closed solutions or published numbers."""

from __future__ import annotations

from pathlib import Path

from tracewire.analyse import Judged, judge
from tracewire.compile import Model, compile
from tracewire.diagram import read_text

MATHIEU = """
title: Mathieu
span: [0, 50]
record: [y]
parameters: {a: 2, q: 0.2}
blocks:
  y: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: r}
  r: {type: expression, formula: "-(a - 2*q*cos(2*t))*y"}
"""
MEISSNER = """
title: Meissner
span: [0, 50]
record: [y]
parameters: {r: 0.5, omega: 2}
blocks:
  y: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  wave: {type: square, amplitude: r, frequency: omega/(2*pi)}
  a: {type: expression, formula: "-(1 + wave)*y"}
"""
OSCILLATOR = """
title: Oscillator
span: [0, 20]
record: [x, energy]
parameters: {k: 4, c: 0.1, force: 0, omega: 1}
inputs: {u: {default: 0}}
blocks:
  x: {type: integrator, of: v, start: 1, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  pull: {type: expression, formula: force*cos(omega*t)}
  a: {type: expression, formula: pull + 3*u - k*x - c*v}
  energy: {type: expression, formula: (k*x*x + v*v)/2}
"""
PENDULUM = """
title: Pendulum
span: [0, 20]
record: [phi, energy]
parameters: {g: 9.81, b: 0}
blocks:
  phi: {type: integrator, of: w, start: 0.3, unit: rad}
  w: {type: integrator, of: a, unit: rad/s}
  a: {type: expression, formula: -g*sin(phi) - b*w}
  energy: {type: expression, formula: w*w/2 - g*cos(phi)}
"""
VAN_DER_POL = """
title: van der Pol
span: [0, 50]
record: [x]
blocks:
  x: {type: integrator, of: v, start: 2}
  v: {type: integrator, of: a}
  a: {type: expression, formula: (1 - x*x)*v - x}
"""
LORENZ = """
title: Lorenz
span: [0, 50]
record: [x, z]
parameters: {sigma: 10, rho: 28, beta: 8/3}
blocks:
  x: {type: integrator, of: dx, start: 1}
  y: {type: integrator, of: dy, start: 1}
  z: {type: integrator, of: dz, start: 20}
  dx: {type: expression, formula: sigma*(y - x)}
  dy: {type: expression, formula: x*(rho - z) - y}
  dz: {type: expression, formula: x*y - beta*z}
"""
SAW = """
title: Saw
span: [0, 50]
record: [x]
parameters: {slope: 2}
blocks:
  x: {type: integrator, of: one, start: 0.1}
  y: {type: integrator, of: zero, start: 0.237}
  one: {type: constant, value: 1}
  zero: {type: expression, formula: 0*x}
events:
  - {when: x - 1, crosses: up, set: {x: 0, y: slope*y - floor(slope*y)}}
"""
IMPACTS = """
title: A ball between a spring and a wall
span: [0, 50]
record: [x]
parameters: {restitution: 0.8, k: 4}
blocks:
  x: {type: integrator, of: v, start: 0.5}
  v: {type: integrator, of: a, start: 0}
  a: {type: expression, formula: -k*x}
events:
  - {when: x, crosses: down, set: {v: -restitution*v}}
"""
DRY = """
title: Rubbed oscillator
span: [0, 20]
record: [x]
blocks:
  x: {type: integrator, of: v, start: 0.05}
  v: {type: integrator, of: a}
  spring: {type: stiffness, of: x, k: 1}
  friction: {type: coulomb, rate: v, level: 0.1}
  a: {type: sum, of: [spring, friction]}
"""
DUFFING = """
title: Duffing
span: [0, 50]
record: [x]
parameters: {f: 0.3, omega: 1.2, c: 0.3}
blocks:
  x: {type: integrator, of: v, start: 0.1}
  v: {type: integrator, of: a}
  a: {type: expression, formula: x - x**3 - c*v + f*cos(omega*t)}
"""


def made(text: str, record: tuple[str, ...] = ()) -> Model:
    """The model of a diagram text."""
    return compile(read_text(text), record=record)


def row_of(diagram: str, that: str, more: str = "", expected: str = "above: -1e9") -> Judged:
    """One statement about a diagram, measured."""
    text = f'{diagram}expect:\n  - {{that: "{that}", {expected}{more and f", {more}"}}}\n'
    (row,) = judge(read_text(text, Path("a.yaml")))
    return row


def value_of(diagram: str, that: str, more: str = "") -> float:
    row = row_of(diagram, that, more)
    assert isinstance(row.value, float), row.why
    return row.value
