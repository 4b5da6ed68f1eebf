"""A diagram with every section and every kind of place that names a part."""

from __future__ import annotations

WHOLE = """\
# Two bodies, to try most keys.
title: Two bodies
span: [0, 2*T]                      # s
every: 0.01
max_step: {value: 100, unit: ms}
record: [theta, hinge.slide, "q[1]", hinge.torque]
inputs:
  drive: {unit: N m, label: Drive, default: 0}
  load: {unit: N m}
parameters:
  J: {value: 4.2e-4, unit: kg m^2}
  k: {value: 3.1e-3, unit: N m/rad, fit: [1e-3, 1e-2]}     # k of the spring
  half: k/2
  T: {value: 2, unit: s, fit: free}
require: [J > 0, k*T > 0]
blocks:
  theta: {type: integrator, of: omega, start: {value: 5, unit: deg}, unit: deg, label: φ}
  omega: {type: integrator, of: alpha, start: 0, unit: rad/s}
  column: {type: gain, of: theta, k: -k}
  hinge: {type: hinge, rate: omega, slip: 2*k}
  table: {type: table, of: theta, points: [[0, 0], [1, 2]]}
  force: {type: expression, formula: "drive + load - min(k*theta, 1) + hinge.torque"}
  q: {type: expression, formula: [theta, "half*omega + t"], label: k}
  torque:
    type: sum
    of: [column, -force, hinge.torque, "q[0]"]
    guess: 0
    place: {q: theta, v: omega}
  alpha: {type: gain, of: torque, k: 1/J}
events:
  - {when: theta - k, crosses: up, set: {omega: -0.5*omega*k}}
  - {every: T, offset: T/2, set: {theta: theta}}
subsystems:
  hinge:
    inputs: [rate]
    outputs: {torque: total}
    parameters:
      slip: {value: 1.5e-4, unit: N m, fit: [0, 1e-3]}
      width: 0.1
    effect:
      coefficient: slip
      inputs: {rate: v}
      sign: either
      shapes: {width: {at: [0.1, 0.5], of: Q, low: 0}}
    blocks:
      slide: {type: integrator, of: rate}
      total: {type: expression, formula: -slip*tanh(slide/width)*sign(rate)}
presets:
  printed: {k: 3.0e-3, hinge.slip: k/10}
measured:
  run_1:
    file: run_1.csv
    time: {column: t, unit: ms, zero: 0}
    signals:
      theta: {column: theta, unit: deg, sigma: 1e-3, offset: {fit: [-1, 1]}}
      hinge.torque: k
    inputs: {drive: {column: u, hold: linear}, load: load}
    clean: [{detrend: theta}, {lowpass: {signals: [theta, drive], cutoff: 10}}]
    start: {theta: free, hinge.slide: free}
    preset: printed
    parameters: {k: {value: 2, fit: [0, 3]}, hinge.width: 2*T}
    use: {train: [0, 1], gate: [1, {value: 2000, unit: ms}]}
    burn_in: 0.1
scene:
  - rod: {from: [0, 0], to: ["min(sin(theta), 1)", -cos(theta)], color: blue}
  - disc: {at: [sin(theta), -cos(theta)], radius: k}
expect:
  - {that: "max(abs(theta))/k", is: k, within: 5 %, source: Table 1, name: swing, unit: rad}
  - {that: "at(theta, 2*T)/k", above: 0, run: {preset: printed, set: {k: 2}, samples: 20}}
  - {that: end(theta)/reference(end(theta)), between: [0, 1], reference: {since: 1}}
  - {that: "band_low(up, 0.1)", below: 1, run: {over: {T: 0.2:0.4:3}}}
"""
