"""Diagrams with delays that several tests use."""

LINEAR = """
span: [0, 10]
record: [x, late]
parameters: {a: -0.5, b: -1.2, T: {value: 0.7, unit: s}}
blocks:
  x: {type: integrator, of: rate, start: 1}
  late: {type: delay, of: x, time: T, before: 1}
  rate: {type: expression, formula: a*x + b*late}
"""

RELAY = """
span: [0, 30]
record: [x]
parameters: {T: {value: 0.7, unit: s}}
blocks:
  x: {type: integrator, of: rate, start: 0.3}
  late: {type: delay, of: x, time: T, before: 0.3}
  rate: {type: expression, formula: -sign(late)}
"""

BALL = """
span: [0, 3]
record: [v, late]
parameters: {e: 0.8, T: {value: 0.21, unit: s}}
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: g}
  g: {type: constant, value: -9.81}
  impacts: {type: counter, of: v}
  late: {type: delay, of: v, time: T}
  heard: {type: counter, of: late}
events:
  - {when: x, crosses: down, set: {v: -e*v}}
"""
VARIABLE = """
span: [0, 4]
record: [x, late, tau]
blocks:
  x: {type: integrator, of: rate, start: 1}
  tau: {type: expression, formula: 0.5 + 0.3*sin(3*t) + 0.1*x, unit: s}
  late: {type: variable_delay, of: x, time: tau, before: 1, shortest: 0.05, longest: 2}
  rate: {type: gain, of: late, k: -1}
"""
