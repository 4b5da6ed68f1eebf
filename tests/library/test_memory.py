"""Blocks with memory: what their declarations mean, and what is said where they are wrong."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from library.values import library, output, value
from tracewire.errors import BlockError
from tracewire.formula import parse
from tracewire.library import (
    Block,
    Event,
    Input,
    Library,
    Mode,
    Output,
    Parameter,
    State,
    Transition,
    describe,
    describe_json,
)

GOOD: dict[str, Any] = {
    "name": "lift",
    "doc": "A lift.",
    "inputs": (Input("of"),),
    "parameters": (Parameter("top", "m"), Parameter("T", "s", default=0.5)),
    "states": (State("x", rate={"halted": "0", "moving": "of"}, start="0"),),
    "modes": (Mode("halted"), Mode("moving", start="of > 0", doc="under way")),
    "transitions": (
        Transition("halted", "moving", when="of > 0 and x < top"),
        Transition("moving", "halted", when="x >= top", set={"x": "top"}),
    ),
    "events": (
        Event(
            "bump",
            when=("x - top", "-x"),
            crosses="up",
            set={"x": {"halted": "0", "moving": "x"}},
        ),
        Event("tick", every="T", offset="T/2", set={"x": "x - of"}),
    ),
    "outputs": (Output("y", {"halted": "x", "moving": "x + of"}),),
}


def test_a_formula_for_each_mode_is_a_choice_by_its_number() -> None:
    block = Block(**GOOD)
    assert block.rates["x"] == parse("of if mode >= 1 else 0")
    assert block.formulas["y"] == parse("x + of if mode >= 1 else x")
    assert block.feedthrough("y") == {"of"}
    assert (block.number("halted"), block.number("moving")) == (0, 1)
    assert {block: 1}[Block(**GOOD)] == 1


@given(st.integers(0, 3))
def test_each_of_many_modes_has_its_own_formula(mode: int) -> None:
    names = "abcd"
    block = Block(
        "many",
        "Many modes.",
        modes=tuple(Mode(name, start="t >= 0") for name in names),
        outputs=(Output("y", {name: str(10 * i) for i, name in reversed([*enumerate(names)])}),),
    )
    assert value(block.formulas["y"], {"mode": float(mode)}) == 10 * mode


@pytest.mark.parametrize(("of", "other", "number"), [(1, 0, 1), (-1, 1, 2), (-1, 0, 0), (1, 1, 1)])
def test_a_block_starts_in_the_first_mode_whose_condition_holds(
    of: float, other: float, number: float
) -> None:
    modes = (Mode("rest"), Mode("one", start="of > 0"), Mode("two", start="other > 0"))
    ports = (Input("of"), Input("other"))
    block = Block("b", "A block.", inputs=ports, modes=modes, outputs=(Output("y", "mode"),))
    assert value(block.start_mode, {"of": of, "other": other}) == number


def test_an_event_has_one_guard_or_several_or_is_a_clock() -> None:
    bump, tick = Block(**GOOD).events
    assert bump.guards == ("x - top", "-x")
    assert Event("e", when="x", set={"x": "0"}).guards == ("x",)
    assert tick.guards == ()


def event(**given: Any) -> dict[str, Any]:
    return {"events": (Event(**{"name": "bump", "when": "x", "set": {"x": "0"}} | given),)}


def move(**given: Any) -> dict[str, Any]:
    first = {"source": "halted", "target": "moving", "when": "of > 0"}
    return {"transitions": (Transition(**first | given), GOOD["transitions"][1])}


COMPLAINTS: dict[str, tuple[dict[str, Any], str]] = {
    "transition from an unknown mode": (
        move(source="halt"),
        "unknown mode 'halt'; there are: halted, moving. Did you mean 'halted'?"
        " It is of the transition from 'halt' to 'moving'.",
    ),
    "transition to an unknown mode": (move(target="up"), "unknown mode 'up'"),
    "transition to itself": (
        move(target="halted"),
        "the transition from 'halted' to 'halted' leads nowhere. It would never end",
    ),
    "transition at a number": (move(when="of"), "a condition must be a comparison"),
    "transition that reads nothing": (move(when="off > 0"), "unknown name 'off'"),
    "transition that sets no state": (
        move(set={"z": "0"}),
        "unknown state 'z'; there are: x. It is set by the transition from 'halted' to 'moving'.",
    ),
    "transition that sets nonsense": (move(set={"x": "z"}), "unknown name 'z'"),
    "mode that is never reached": (
        {"modes": (*GOOD["modes"], Mode("broken"))}
        | {"states": (State("x", "of", "0"),), "outputs": (Output("y", "x"),), "events": ()},
        "the mode 'broken' is never reached. Give it a start condition, or a transition",
    ),
    "mode twice": (
        {"modes": (*GOOD["modes"], Mode("halted"))},
        "two modes are called 'halted'.",
    ),
    "mode without a name": (
        {"modes": (*GOOD["modes"], Mode("2", start="of > 0"))}
        | {"states": (State("x", "of", "0"),), "outputs": (Output("y", "x"),), "events": ()},
        "'2' cannot be the name of a mode. Use letters",
    ),
    "only one mode": (
        {"modes": (Mode("a"),), "transitions": (), "states": (State("x", "of", "0"),)}
        | {"outputs": (Output("y", "x"),), "events": ()},
        "'a' is the only mode of the block. Declare a second one, or none.",
    ),
    "start at a number": (
        {"modes": (Mode("halted"), Mode("moving", start="of"))},
        "a condition must be a comparison",
    ),
    "start that reads the mode": (
        {"modes": (Mode("halted"), Mode("moving", start="mode > 0"))},
        "unknown name 'mode'",
    ),
    "formula for an unknown mode": (
        {"outputs": (Output("y", {"halted": "0", "moving": "1", "up": "2"}),)},
        "unknown mode 'up'; there are: halted, moving. It is of output 'y'.",
    ),
    "no formula for a mode": (
        {"outputs": (Output("y", {"halted": "0"}),)},
        "output 'y' has no formula for the mode moving.",
    ),
    "rate without a mode": (
        {"states": (State("x", {"moving": "of"}, "0"),)},
        "the rate of 'x' has no formula for the mode halted.",
    ),
    "formula for modes without modes": (
        {"modes": (), "transitions": (), "events": (), "states": (State("x", "of", "0"),)},
        "unknown mode 'halted'; there is no mode here",
    ),
    "a port called mode": (
        {"inputs": (Input("of"), Input("mode"))},
        "'mode' is declared twice.",
    ),
    "two events of one name": (
        {"events": (*GOOD["events"], GOOD["events"][0])},
        "two events are called 'bump'. One event may have several guards",
    ),
    "event called like an output": (event(name="y"), "'y' is an event and an output."),
    "event without a name": (event(name="a b"), "'a b' cannot be the name of an event."),
    "event that never happens": (event(when=()), "event 'bump' needs 'when' or 'every'."),
    "event and clock": (event(every="T"), "event 'bump' needs 'when' or 'every', and not both."),
    "event in no direction": (event(crosses="sideways"), "unknown direction 'sideways'; there are"),
    "event of no kind": (event(kind="blow"), "unknown kind of event 'blow'; there are: impact, re"),
    "event that sets nothing": (event(set={}), "event 'bump' sets no state. Say which: set={"),
    "event that sets no state": (
        event(set={"z": "0"}),
        "unknown state 'z'; there are: x. It is set by event 'bump'.",
    ),
    "event that reads nothing": (event(when="z"), "unknown name 'z'"),
    "event that sets nonsense": (event(set={"x": "z + 1"}), "unknown name 'z'"),
    "event at a condition": (event(when="x > 0"), "a comparison is not a number"),
    "clock that reads a signal": (
        event(when=(), every="of"),
        "unknown name 'of'; there are: T, top. It stands in 'of'.",
    ),
    "output that is another state": (
        {"outputs": (Output("x", "2*x"), Output("z", "x"))},
        "'x' is a state, and an output that is not it. Rename one",
    ),
}


@pytest.mark.parametrize("case", COMPLAINTS)
def test_what_is_wrong_is_said(case: str) -> None:
    changes, message = COMPLAINTS[case]
    with pytest.raises(BlockError) as caught:
        Block(**GOOD | changes)
    assert message in str(caught.value)


def test_one_mistake_is_one_problem() -> None:
    for case in ("transition at a number", "two events of one name", "event that sets nothing"):
        with pytest.raises(BlockError) as caught:
            Block(**GOOD | COMPLAINTS[case][0])
        assert len(caught.value.problems) == 1


def test_modes_transitions_and_events_are_described() -> None:
    told = describe(Library({"lift": Block(**GOOD)}), "lift").splitlines()
    first = told.index("states")
    assert told[first : told.index("outputs")] == [
        "states",
        "  x  rate = halted: 0; moving: of  start = 0",
        "",
        "modes",
        "  halted  at the start",
        "  moving  at the start where of > 0  under way",
        "",
        "transitions",
        "  halted -> moving  while of > 0 and x < top",
        "  moving -> halted  while x >= top            x := top",
        "",
        "events",
        "  bump  x - top or -x crosses zero up  x := halted: 0; moving: x",
        "  tick  every T s, first at t = T/2    x := x - of",
        "",
    ]
    assert "  y = halted: x; moving: x + of" in told


def test_a_program_is_told_of_them_too() -> None:
    told = json.loads(json.dumps(describe_json(Library({"lift": Block(**GOOD)}), "lift")))
    assert told["modes"][1] == {"name": "moving", "start": "of > 0", "doc": "under way"}
    assert told["transitions"][1]["set"] == {"x": "top"}
    assert told["events"][0]["when"] == ["x - top", "-x"]
    assert told["events"][1]["every"] == "T"


def test_a_clutch_pushes_forwards_up_to_its_capacity() -> None:
    assert [output("one_way_clutch", rate=v, capacity=3) for v in (-1, 0, 1e-9)] == [3, 3, 0]


def test_a_limited_integrator_stops_only_where_its_signal_leads_beyond() -> None:
    rate = library()["limited_integrator"].rates["y"]
    names = {"low": -1.0, "high": 2.0}
    cases = [(2, 1, 0), (2, -1, -1), (2.5, 1, 0), (0, 7, 7), (-1, -1, 0), (-1, 1, 1)]
    for y, of, found in cases:
        assert value(rate, {"y": float(y), "of": float(of)} | names) == found


@given(st.floats(0.1, 9), st.floats(0.1, 9), st.floats(0, 1), st.floats(-5, 5), st.floats(-5, 5))
def test_a_collision_keeps_momentum_and_turns_the_rate_of_approach(
    m1: float, m2: float, e: float, v1: float, v2: float
) -> None:
    block = library()["collision"]
    (impact,) = block.events
    names: dict[str, object] = {"mass1": m1, "mass2": m2, "restitution": e, "v1": v1, "v2": v2}
    after = [value(block.read(impact.set[name]), names) for name in ("v1", "v2")]
    assert m1 * after[0] + m2 * after[1] == pytest.approx(m1 * v1 + m2 * v2, abs=1e-9)
    assert after[1] - after[0] == pytest.approx(-e * (v2 - v1), abs=1e-9)
