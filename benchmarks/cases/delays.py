"""Delays and sampled blocks beside exact solutions: the error, and the time for each step."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction

import tracewire as tw

from benchmarks.measure import least
from benchmarks.options import Options
from benchmarks.table import Result, seconds

DECAY = """
span: [0, 12]
blocks:
  x: {type: integrator, of: rate, start: 1}
  late: {type: delay, of: x, time: 1, before: 1}
  rate: {type: gain, of: late, k: -1}
"""
RELAY = """
span: [0, 1000]
blocks:
  x: {type: integrator, of: rate, start: 0.5}
  late: {type: delay, of: x, time: 1, before: 0.5}
  rate: {type: expression, formula: -sign(late)}
"""
ROW = """
span: [0, 20]
blocks:
  u: {type: sine, amplitude: 1, omega: 1}
  sent: {type: delay, of: previous, time: 0.1, replicate: {count: 10, first: {of: u}}}
  x: {type: integrator, of: sent.last}
"""
LOOP = """
span: [0, 2]
blocks:
  x: {type: integrator, of: rate, start: 1}
  held: {type: zero_order_hold, of: x, period: 0.01, start: 1}
  rate: {type: gain, of: held, k: -2}
"""
REGISTERS = """
span: [0, 100]
blocks:
  u: {type: time}
  sample: {type: unit_delay, of: previous, period: 0.01, replicate: {count: 20, first: {of: u}}}
"""
INTEGRALS = """
span: [0, 100]
blocks:
  u: {type: constant, value: 3}
  y: {type: discrete_integrator, of: u, period: 0.01}
  z: {type: discrete_integrator, of: y, period: 0.01}
"""


@dataclass(frozen=True)
class Exact:
    """A diagram, the signal that is compared, and what it is in the end."""

    name: str
    text: str
    signal: str
    end: Callable[[], float]


def _decay() -> float:
    """x(12) of x' = -x(t - 1), by the method of steps: sum of (-1)^k (t - k + 1)^k/k!."""
    return float(sum(Fraction((13 - k) ** k * (-1) ** k, math.factorial(k)) for k in range(14)))


CASES = (
    Exact("x' = -x(t - 1), 12 s", DECAY, "x", _decay),
    # between -1 and 1 with a period of 4 s: it turns up at 1.5 s
    Exact("x' = -sign(x(t - 1)), 1000 s", RELAY, "x", lambda: 0.5),
    Exact("ten delays in a row, 20 s", ROW, "x", lambda: 1.0 - math.cos(19.0)),
    Exact("an integrator under a sampled gain, 2 s", LOOP, "x", lambda: 0.98**200),
    Exact("20 registers in a row, 100 s", REGISTERS, "sample_20", lambda: 99.8),
    Exact("a sum of a sum of samples, 100 s", INTEGRALS, "z", lambda: 3e-4 * 9999 * 5000),
)


def measure(options: Options) -> Iterator[Result]:
    """Each diagram at the tolerance that is asked for."""
    rows = []
    for case in CASES[:3] if options.quick else CASES:
        model = tw.compile(tw.read_text(case.text), record=[case.signal])

        def run(model: tw.Model = model) -> tw.Run:
            return tw.simulate(model, rtol=options.rtol)

        found = run()
        error = abs(found[case.signal][-1] - case.end())
        spent, steps = least(run, options.seconds_each / 10), found.statistics.steps
        shown = (f"{error:.1e}", str(steps), str(len(found.events)))
        rows.append((case.name, *shown, seconds(spent), f"{1e9 * spent / steps:.0f} ns"))
    columns = ("diagram", "error at the end", "steps", "events", "run", "time per step")
    yield Result("Delays and sampled blocks beside exact solutions", columns, rows)
