"""States that events alone change: what is compared with them is exact where they reach it."""

from __future__ import annotations

from pathlib import Path

import pytest
from solve.logs import METHODS
from solve.models import run
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.library import load_library
from tracewire.solve import simulate

COUNTED = """
span: [0, 6.5]
every: 1
blocks:
  wave: {type: square, amplitude: -1, frequency: 1}
  n: {type: counter, of: wave}
  reached: {type: expression, formula: "1 if n >= 3 else 0"}
  above: {type: expression, formula: "1 if n > 3 else 0"}
  within: {type: saturation, of: n, low: 2, high: 4}
  pairs: {type: expression, formula: floor(n/2)}
  parity: {type: expression, formula: "mod(n, 2)"}
record: [n, reached, above, within, pairs, parity]
"""


@pytest.mark.parametrize("method", METHODS)
def test_what_counts_up_to_a_level_has_reached_it(method: str) -> None:
    result = run(COUNTED, method=method)
    assert result["n"].tolist() == [0, 1, 2, 3, 4, 5, 6]
    assert result["reached"].tolist() == [0, 0, 0, 1, 1, 1, 1]
    assert result["above"].tolist() == [0, 0, 0, 0, 1, 1, 1]
    assert result["within"].tolist() == [2, 2, 2, 3, 4, 4, 4]
    assert result["pairs"].tolist() == [0, 0, 1, 1, 2, 2, 3]
    assert result["parity"].tolist() == [0, 1, 0, 1, 0, 1, 0]


def test_what_is_held_at_a_level_has_reached_it() -> None:
    """Samples of the time at 0, 0.5, ...: the comparison is true from 1.5 on, and counted so."""
    result = run("""
span: [0, 3]
blocks:
  now: {type: time}
  held: {type: zero_order_hold, of: now, period: 0.5}
  on: {type: expression, formula: "1 if held >= 1.5 else 0"}
  area: {type: integrator, of: on}
  n: {type: counter, of: on}
record: [area, n]
""")
    assert result["area"][-1] == pytest.approx(1.5, abs=1e-12)
    assert result["n"][-1] == 1


PUCK = """
from tracewire.library import Block, Event, Input, Output, State

puck = Block(
    name="puck",
    doc="A free body in front of a wall that moves, whose speed it takes over when it is hit.",
    inputs=(Input("wall", "m"), Input("speed", "m/s")),
    states=(State("x", "v", "0.5", "m"), State("v", "0", "0", "m/s")),
    events=(Event("hit", when="x - wall", crosses="down", set={"v": "speed"}, kind="impact"),),
    outputs=(Output("position", "x", "m"), Output("fast", "1 if v >= 2 else 0")),
)
"""


def test_a_state_without_a_rate_that_a_contact_pushes_is_not_taken_for_one_that_stands(
    tmp_path: Path,
) -> None:
    """The wall is at t^2/2, and pushes the puck from t = 1 on: v = t, and v reaches 2 at t = 2."""
    (tmp_path / "pucks.py").write_text(PUCK, encoding="utf-8")
    text = """
span: [0, 3]
blocks:
  speed: {type: time}
  wall: {type: expression, formula: t**2/2}
  body: {type: puck, wall: wall, speed: speed}
  area: {type: integrator, of: body.fast}
record: [body.x, body.v, area]
"""
    library = load_library([tmp_path / "pucks.py"])
    result = simulate(compile(read_text(text, library=library)))
    assert result["body.v"][-1] == pytest.approx(3, abs=1e-9)
    assert result["area"][-1] == pytest.approx(1, abs=1e-9)
    assert any(event.time == pytest.approx(2, abs=1e-9) for event in result.events)
