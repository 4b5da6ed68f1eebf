"""Events whose guard only jumps: which these are, and what they become on the tape."""

from __future__ import annotations

import pytest
from compile.test_memory import value
from solve.models import made, one
from tracewire.compile import Model

MORE = """
  wave: {type: square, amplitude: 1, frequency: 2}
  relay: {type: relay, of: x, on_at: 1, off_at: 0}
  n: {type: integrator, of: zero}
  zero: {type: constant, value: 0}
"""


def with_event(guard: str, crosses: str = "both") -> Model:
    """A model with an event on a guard."""
    text = one("1", more=MORE).replace("blocks:", "parameters: {k: 1}\nblocks:")
    return made(f"{text}events:\n  - {{when: {guard}, crosses: {crosses}, set: {{x: 0}}}}\n")


@pytest.mark.parametrize(
    "guard",
    ["wave", "relay - 0.5", "n - 3", "k*wave - n", "sign(x)", "floor(x) - 2", "is_held(x) - 0.5"],
)
def test_a_guard_that_is_constant_between_events_becomes_transitions(guard: str) -> None:
    low = with_event(guard).lowered
    (reset,) = low.resets
    assert (reset.name, reset.trigger) == ("events[0]", -1)
    assert [mode.jumps for mode in low.modes if mode.jumps] == ["side", "up", "down"]
    fires = [move for move in low.transitions if move.reset == 0]
    assert {low.modes[move.memory].jumps for move in fires} == {"up", "down"}


@pytest.mark.parametrize("guard", ["x - 1", "x*wave", "x - relay", "t - wave", "k", "k - 2", "3"])
def test_a_guard_that_moves_or_never_changes_keeps_its_own_crossing(guard: str) -> None:
    low = with_event(guard).lowered
    assert low.resets[0].trigger >= 0
    assert not any(mode.jumps for mode in low.modes)


def test_a_direction_needs_one_memory_and_the_side_is_shared() -> None:
    low = with_event("wave", "down").lowered
    assert [mode.jumps for mode in low.modes if mode.jumps] == ["side", "down"]
    twice = with_event("wave, set: {n: 0}}\n  - {when: wave").lowered
    assert [mode.jumps for mode in twice.modes].count("side") == 1


@pytest.mark.parametrize(("n", "side"), [(2.0, 0), (3.0, 1), (4.0, 2)])
def test_the_side_tells_below_at_and_above_zero(n: float, side: int) -> None:
    model = with_event("n - 3")
    (mode,) = (mode for mode in model.modes if mode.jumps == "side")
    assert value(model, mode.guard, {}, n=n) == side + 0.5
