"""A motor with an encoder on its shaft, whose gain and friction are fitted."""

MOTOR = """
span: [0, 5]
record: [angle]
inputs: {voltage: {unit: V}}
parameters:
  c: {value: 2, unit: 1/s, fit: [0, 100]}
  K: {value: 50, unit: rad/(s^2 V), fit: [0, 1000]}
blocks:
  angle: {type: integrator, of: rate, unit: rad}
  rate: {type: integrator, of: acceleration, unit: rad/s}
  motor: {type: gain, of: voltage, k: K}
  friction: {type: viscous, rate: rate, c: c}
  acceleration: {type: sum, of: [motor, friction], unit: rad/s^2}
"""
