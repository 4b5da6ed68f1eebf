"""Blocks with memory, their events, and those of diagrams: what they become on the tape."""

from __future__ import annotations

import pytest
from compile.formulas import worked_out
from solve.models import made
from tracewire.compile import Model
from tracewire.compile.lowered import Reset
from tracewire.compile.memory import as_guard
from tracewire.formula import parse_condition, to_text

RELAY = """
parameters: {top: 1, first: 0}
blocks:
  x: {type: integrator, of: rate}
  rate: {type: expression, formula: sign(x) - 2*relay}
  relay: {type: relay, of: x, on_at: top, off_at: 0, on_value: 5, off_value: -5, start: first}
"""


def value(model: Model, entry: int, modes: dict[int, float], **names: float) -> float:
    """An entry for values of modes, states and parameters; the others are zero."""
    low = model.lowered
    known = {mode.leaf: modes.get(i, 0.0) for i, mode in enumerate(low.modes)}
    given = dict.fromkeys([*model.states, *model.parameters], 0.0) | names
    return worked_out(low.tape, [entry], known | {low.entries[n]: v for n, v in given.items()})[0]


def test_a_memory_is_a_mode_that_only_transitions_change() -> None:
    model = made(RELAY)
    memory = next(i for i, mode in enumerate(model.modes) if mode.kind == "memory")
    assert (model.modes[memory].names, model.modes[memory].signal) == (
        ("released", "operated"),
        "relay",
    )
    rise, fall = model.lowered.transitions
    assert (rise.memory, rise.source, rise.target, rise.reset) == (memory, 0, 1, -1)
    assert (fall.memory, fall.source, fall.target, fall.reset) == (memory, 1, 0, -1)
    assert model.modes[rise.trigger].text == "x - top"
    assert model.lowered.resets == []


def test_formulas_read_the_memory_without_a_guard() -> None:
    model = made(RELAY)
    memory = model.lowered.transitions[0].memory
    output = model.lowered.entries["relay"]
    assert [value(model, output, {memory: m}) for m in (0.0, 1.0)] == [-5, 5]
    assert [mode.text for mode in model.modes if mode.kind == "sign"] == ["x", "x - top"]


def test_what_stands_as_the_guard_of_a_memory_is_its_start() -> None:
    model = made(RELAY)
    guard = model.modes[model.lowered.transitions[0].memory].guard
    assert value(model, guard, {}, first=0.0) == 0
    assert value(model, guard, {}, first=1.0) == 1


def test_a_condition_below_zero_shares_the_mode_of_the_sign_and_wants_its_zero() -> None:
    model = made(RELAY)
    rise, fall = model.lowered.transitions
    assert model.modes[fall.trigger].text == "x"
    assert (rise.level, fall.level) == (1, 0)
    assert rise.at_zero and fall.at_zero


@pytest.mark.parametrize(
    ("condition", "guard", "strict"),
    [
        ("a >= b", "a - b", False),
        ("a > 0", "a - 0", True),
        ("a <= b", "b - a", False),
        ("a < 0", "-a", True),
        ("not a > b", "-(a - b)", False),
        ("not a >= b", "-(a - b)", True),
        ("a >= 1 and b < 2", "min(a - 1, 2 - b)", True),
        ("0 <= a <= 1", "min(a - 0, 1 - a)", False),
        ("a > 1 or b >= 2", "max(a - 1, b - 2)", False),
    ],
)
def test_a_condition_is_a_guard_that_is_not_negative(
    condition: str, guard: str, strict: bool
) -> None:
    found, above = as_guard(parse_condition(condition))
    assert (to_text(found), above) == (guard, strict)


BACKLASH = """
blocks:
  u: {type: integrator, of: w}
  w: {type: integrator, of: u}
  play: {type: play_operator, of: u, rate: w, width: 1}
"""


def test_a_transition_may_reset_states() -> None:
    model = made(BACKLASH)
    low = model.lowered
    up, down = (low.resets[move.reset] for move in low.transitions if move.reset >= 0)
    assert (up.name, up.trigger, up.kind) == ("play: up -> free", -1, "reset")
    at = model.states.index("play.at")
    assert list(up.values) == list(down.values) == [at]
    assert value(model, up.values[at], {}, u=3.0) == 2.5
    assert value(model, down.values[at], {}, u=3.0) == 3.5


def test_a_mirrored_pair_of_conditions_is_one_mode() -> None:
    low = made(BACKLASH).lowered
    up, down = (move for move in low.transitions if move.reset >= 0)
    assert up.trigger == down.trigger
    assert {up.level, down.level} == {0, 1}
    assert not (up.at_zero or down.at_zero)


STOP = """
parameters: {e: 0.5}
blocks:
  stop: {type: hard_stop, force: pull, high: 2, restitution: e}
  pull: {type: expression, formula: "-stop.x"}
  n: {type: integrator, of: zero}
  zero: {type: constant, value: 0}
events:
  - {when: stop.x - 5, crosses: down, set: {n: 0}}
  - {when: stop.impact, set: {n: n + stop.v, stop.x: 1}}
"""


def named(resets: list[Reset]) -> list[tuple[str, str, str]]:
    return [(reset.name, reset.kind, reset.direction) for reset in resets]


def test_an_event_with_two_guards_is_two_resets_and_a_diagram_adds_to_both() -> None:
    model = made(STOP)
    resets = model.lowered.resets
    assert named(resets) == [
        ("stop.impact", "impact", "up"),
        ("stop.impact", "impact", "up"),
        ("events[0]", "reset", "down"),
        ("events[1]", "reset", "up"),
        ("events[1]", "reset", "up"),
    ]
    upper, lower, other, first, second = (reset.trigger for reset in resets)
    assert (first, second) == (upper, lower)
    assert len({upper, lower, other}) == 3
    assert [model.modes[i].signal for i in (upper, lower, other)] == ["stop", "stop", "events[0]"]
    n, x = model.states.index("n"), model.states.index("stop.x")
    assert set(resets[3].values) == {n, x}
    assert value(model, resets[3].values[n], {}, **{"stop.v": 3.0, "n": 1.0}) == 4.0


def test_what_says_that_a_contact_is_held_reads_the_hold_of_its_guard() -> None:
    model = made(STOP, record=("stop.held",))
    tape, low = model.lowered.tape, model.lowered
    needed = tape.needed([low.entries["stop.held"]])
    holds = {int(tape.entries[i].payload) for i in needed if tape.entries[i].op == "hold"}
    assert holds == {low.resets[0].trigger, low.resets[1].trigger}


def test_holding_is_known_of_friction_and_of_any_guard_of_a_formula() -> None:
    text = """
parameters: {c: 1}
blocks:
  v: {type: integrator, of: f}
  f: {type: coulomb, rate: v, level: 1}
  y: {type: expression, formula: is_held(v) + 2*is_held(-v) + 4*is_held(c)}
"""
    model = made(text)
    assert [mode.text for mode in model.modes] == ["v"]
    tape, low = model.lowered.tape, model.lowered
    (hold,) = (i for i, entry in enumerate(tape.entries) if entry.op == "hold")
    assert worked_out(tape, [low.entries["y"]], {hold: 1.0}) == [3.0]


CLOCKS = """
parameters: {T: 0.5}
blocks:
  x: {type: integrator, of: held}
  held: {type: zero_order_hold, of: x, period: T, offset: 0.25}
  again: {type: zero_order_hold, of: held, period: T, offset: 0.25}
  n: {type: integrator, of: held}
events:
  - {every: {value: 20, unit: ms}, set: {n: n + 1}}
"""


def test_clocks_are_timed_and_those_of_one_time_are_one() -> None:
    model = made(CLOCKS)
    first, second, own = model.lowered.resets
    assert first.trigger == second.trigger != own.trigger
    assert {reset.direction for reset in model.lowered.resets} == {"up"}
    mode = model.modes[first.trigger]
    assert (mode.kind, mode.signal) == ("floor", "held")
    assert mode.timed is not None
    (begun,) = (i for i, other in enumerate(model.modes) if other.jumps == "clock")
    line = [value(model, entry, {begun: 1.0}, T=0.5) for entry in mode.timed]
    assert line == [2.0, -0.5]
    line = [value(model, entry, {begun: 0.0}, T=0.5) for entry in mode.timed]
    assert line == [0.0, -0.5]  # no tick until half a period before the first
    assert model.modes[own.trigger].timed is not None
    slope = model.modes[own.trigger].timed[0]  # type: ignore[index]
    assert value(model, slope, {}) == pytest.approx(50.0)


def test_resets_of_transitions_stand_behind_those_of_events() -> None:
    model = made(BACKLASH + "events:\n  - {when: u, set: {w: 0}}\n")
    assert [reset.trigger >= 0 for reset in model.lowered.resets] == [True, False, False]
    assert len(model.flat.events) == 1


def test_the_equations_tell_memories_and_clocks() -> None:
    told = made(BACKLASH).equations
    assert "while play.mode is 1 (up) and w < 0: play.mode := 0, play.at := u - 1/2" in told
    clocks = made(CLOCKS.replace("T, offset: 0.25}\n  n", "T, offset: T}\n  n")).equations
    assert "when (t - 0.25)/T is a whole number, first at t = 0.25: held := x" in clocks
    assert "when (t - T)/T is a whole number, first at t = T if T > 0: again := held" in clocks
    assert "when t/0.02 is a whole number: n := n + 1" in clocks
    assert "when stop.x - 2 crosses up: stop.v := -e*stop.v" in made(STOP).equations


def test_the_mode_of_a_block_inside_a_subsystem_has_its_path() -> None:
    text = """
blocks:
  x: {type: integrator, of: heater.y}
  heater: {type: thermostat, of: x}
subsystems:
  thermostat:
    inputs: [of]
    outputs: {y: relay}
    blocks: {relay: {type: relay, of: of, on_at: 1, off_at: 0}}
"""
    model = made(text)
    assert [memory.name for memory in model.flat.memories] == ["heater.relay.mode"]
    assert model.modes[0].signal == "heater.relay"
