"""A few blocks and a valid diagram for the tests of this room."""

from __future__ import annotations

from pathlib import Path

from tracewire.diagram import Diagram, read_text
from tracewire.errors import TracewireError
from tracewire.library import Block, Event, Input, Library, Output, Parameter, State

BLOCKS = (
    Block(
        name="integrator",
        doc="x' = of",
        inputs=(Input("of"),),
        parameters=(Parameter("start", default=0.0),),
        states=(State("x", "of", "start"),),
        outputs=(Output("y", "x"),),
    ),
    Block(
        name="gain",
        doc="y = k*of",
        inputs=(Input("of"),),
        parameters=(Parameter("k"),),
        outputs=(Output("y", "k*of"),),
    ),
    Block(
        name="sum",
        doc="y = sum(of)",
        inputs=(Input("of", many=True),),
        outputs=(Output("y", "sum(of)"),),
    ),
    Block(
        name="viscous",
        doc="force = -c*rate",
        inputs=(Input("rate"),),
        parameters=(Parameter("c", unit="N m s/rad", low=0.0, high=100.0),),
        outputs=(Output("force", "-c*rate"),),
    ),
    Block(
        name="expression",
        doc="a formula",
        parameters=(Parameter("formula", kind="formula"),),
        outputs=(Output("y", "formula"),),
    ),
    Block(
        name="lookup",
        doc="a table",
        inputs=(Input("of"),),
        parameters=(Parameter("points", kind="points"),),
        outputs=(Output("y", "interp(of, points)"),),
    ),
    Block(
        name="oscillator",
        doc="two states and an event; only the output `force` reads the input at once",
        inputs=(Input("push", default="0"),),
        states=(State("x", "v", "0"), State("v", "push - x", "0")),
        outputs=(Output("x", "x"), Output("force", "push - x")),
        events=(Event("top", when="v", crosses="down", set={"x": "0"}),),
    ),
)
LIBRARY = Library({block.name: block for block in BLOCKS}, {})

PENDULUM = """\
title: Torsion pendulum with a bearing
span: [0, 40]                     # s
every: 0.01
record: [theta, bearing.friction]
inputs: {drive: {unit: N m, default: 0}}
parameters:
  J:  {value: 4.2e-4, unit: kg m^2}
  stiffness: {value: 3.1e-3, unit: N m/rad, fit: [1e-3, 1e-2]}     # bounds; free in a fit
  half: stiffness/2
blocks:
  theta:   {type: integrator, of: omega, start: -1.2, unit: rad}
  omega:   {type: integrator, of: alpha, unit: rad/s}   # the rate
  # the column pulls back
  column:  {type: gain, of: theta, k: -stiffness}
  bearing: {type: journal_bearing, rate: omega}
  torque:  {type: sum, of: [column, bearing.torque, drive], place: {q: theta, v: omega}}
  alpha:   {type: gain, of: torque, k: 1/J}
subsystems:
  journal_bearing:
    inputs: [rate]
    outputs: {torque: total}
    parameters: {slip: {value: 1.5e-4, unit: N m, fit: [0, 1e-3]}}
    blocks:
      friction: {type: expression, formula: -slip*sign(rate)}
      total:
        type: sum
        of:
          - friction   # dry
events:                            # a reset that spans blocks: right-hand sides read x⁻
  - {when: theta - 1.0, crosses: up, set: {omega: -0.5*omega}}
presets: {as_printed: {stiffness: 3.0e-3, bearing.slip: 2e-4}}
"""


def made(text: str, file: Path = Path("<text>")) -> Diagram:
    return read_text(text, file, library=LIBRARY)


def refused(text: str, file: Path = Path("<text>")) -> str:
    """The message with which a text is refused; '' where it is not."""
    try:
        made(text, file)
    except TracewireError as error:
        return str(error)
    return ""
