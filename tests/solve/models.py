"""Models from YAML text for the tests, and a few diagrams that several of them use."""

from __future__ import annotations

from typing import Any

from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.solve import Limits, Run, simulate

LIMITS = Limits(steps=20_000, seconds=60.0)

OSCILLATOR = """
span: [0, 30]
blocks:
  x: {type: integrator, of: v, start: 1.05}
  v: {type: integrator, of: a}
  spring: {type: stiffness, of: x, k: 1}
  friction: {type: coulomb, rate: v, level: 0.1}
  a: {type: sum, of: [spring, friction]}
"""

BALL = """
span: [0, 12]
parameters: {restitution: 0.8}
blocks:
  x: {type: integrator, of: v, start: 10}
  v: {type: integrator, of: g}
  g: {type: constant, value: -9.81}
events:
  - {when: x, crosses: down, set: {v: -restitution*v}}
"""


def made(text: str, record: tuple[str, ...] = ()) -> Model:
    """The model of a diagram text."""
    return compile(read_text(text), record=record)


def run(text: str, record: tuple[str, ...] = (), **options: Any) -> Run:
    """A run of a diagram text that cannot hang."""
    options.setdefault("limits", LIMITS)
    return simulate(made(text, record), **options)


def one(rate: str, start: float = 0.0, more: str = "") -> str:
    """The diagram of one state: x' = rate."""
    return f"""
span: [0, 1]
blocks:
  x: {{type: integrator, of: rate, start: {start}}}
  rate: {{type: expression, formula: "{rate}"}}
{more}
"""


def kinds(run: Run) -> list[str]:
    """The kinds of all events, in order."""
    return [event.kind for event in run.events]
