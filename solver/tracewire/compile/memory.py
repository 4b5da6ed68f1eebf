"""Resets and blocks with memory on the tape: modes that keep themselves.

A **reset** fires where the mode `trigger` crosses in its `direction`: the guard of a sign mode goes
through zero, the floor mode of a clock goes up by one where its guard is a whole number, and at the
start of a run where that is such a time. A reset without a trigger (-1) fires with the transitions
that name it: those of a memory, or those of an event whose guard only jumps (see `jumps`). All
resets of one instant read x⁻ and the modes before, and write x⁺ together.

A **memory** is a mode of kind `memory`: 0.0, 1.0, 2.0, ... in the order of the names of its modes.
It has no crossing: what stands as its guard is the number of the mode in which it starts, to be
read once, at the start, when the sign modes are known. From then on only its **transitions** change
it: while it has the value `source` and the sign mode `trigger` has the value `level`, it becomes
`target`, and the reset `reset` (-1: none) fires. They are evaluated in event iteration, after the
sign modes have been set; of several of one memory that are due, the first one is taken. A trigger
whose guard is held at zero (by a slide, sticking friction or a closed contact), or stays at zero
because of one that is held, is true there where `at_zero` says so.

Formulas read a memory by its leaf, as a number that is frozen between events, so that a comparison
with it is no guard.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import reduce

from tracewire.compile.declared_events import describe_clock
from tracewire.compile.flat import Flat, FlatMemory
from tracewire.compile.lowered import Reset, Transition
from tracewire.compile.lowering import Lowering
from tracewire.formula import Call, Expression, Number, to_text


def declare_memories(lowering: Lowering) -> None:
    """The modes of the memories; formulas read their leaves."""
    for memory in lowering.flat.memories:
        lowering.signal = block_of(memory)
        lowering.out.entries[memory.name] = lowering.memory(memory.modes)


def block_of(memory: FlatMemory) -> str:
    """The path of the block whose memory it is."""
    return memory.name.rpartition(".")[0]


def values_of(lowering: Lowering, values: Mapping[str, Expression]) -> dict[int, int]:
    """The entries of new values by the numbers of the states that get them."""
    return {lowering.index[name]: lowering.lower(formula) for name, formula in values.items()}


def lower_memories(lowering: Lowering) -> None:
    """The starts and transitions of the memories, and the resets that these fire."""
    out = lowering.out
    for memory in lowering.flat.memories:
        lowering.signal = block_of(memory)
        number = int(lowering.tape.entries[out.entries[memory.name]].payload)
        start = _on_the_spot(lowering, memory.start)
        out.modes[number] = replace(out.modes[number], guard=start)
        for transition in memory.transitions:
            guard, strict = as_guard(transition.when)
            trigger, level = _side(lowering, guard, strict)
            reset = -1
            if transition.set:
                reset = len(out.resets)
                ends = (memory.modes[transition.source], memory.modes[transition.target])
                name = f"{lowering.signal}: {ends[0]} -> {ends[1]}"
                values = values_of(lowering, transition.set)
                out.resets.append(Reset(name, "reset", -1, "both", values, memory.place))
            out.transitions.append(
                Transition(
                    memory=number,
                    source=transition.source,
                    trigger=trigger,
                    target=transition.target,
                    reset=reset,
                    level=level,
                    at_zero=not strict,
                )
            )


def _side(lowering: Lowering, guard: Expression, strict: bool) -> tuple[int, int]:
    """The number of the mode of a guard, and its value where the guard is positive."""
    if isinstance(guard, Call) and guard.function == "neg":
        trigger, level = _side(lowering, guard.arguments[0], not strict)
        return trigger, 1 - level
    return lowering.side(lowering.condition(guard, strict))


def as_guard(condition: Expression) -> tuple[Expression, bool]:
    """The formula that is zero or positive where a condition holds; strict: positive."""
    if not isinstance(condition, Call):
        raise AssertionError(f"'{to_text(condition)}' is no condition")
    function, arguments = condition.function, condition.arguments
    if function in (">=", ">"):
        return Call("-", arguments), function == ">"
    if function in ("<=", "<"):
        right = arguments[1] == Number(0.0)
        guard = Call("neg", arguments[:1]) if right else Call("-", arguments[::-1])
        return guard, function == "<"
    parts = [as_guard(argument) for argument in arguments]
    guards = tuple(guard for guard, _ in parts)
    strict = [strict for _, strict in parts]
    match function:
        case "not":
            return Call("neg", guards), not strict[0]
        case "and":
            return Call("min", guards), any(strict)
        case _:
            return Call("max", guards), all(strict)


def _on_the_spot(lowering: Lowering, node: Expression) -> int:
    """The entry of a formula whose comparisons are made when it is read, and are no guards."""
    push = lowering.tape.push
    if not isinstance(node, Call) or node.function not in (*COMPARED, "and", "or", "not", "if"):
        return lowering.lower(node)
    given = [_on_the_spot(lowering, argument) for argument in node.arguments]
    match node.function:
        case "if":
            return push("select", *given)
        case "not":
            return push("not", given[0])
        case "and" | "or":
            return reduce(lambda one, other: push(node.function, one, other), given)
        case _:
            operation, mirrored = COMPARED[node.function]
            return push("not", push(operation, *given)) if mirrored else push(operation, *given)


COMPARED = {">=": ("ge", False), ">": ("gt", False), "<": ("ge", True), "<=": ("gt", True)}


def describe_memories(flat: Flat) -> list[str]:
    """The events and memories of a model as lines of text."""
    lines = []
    for event in flat.events:
        sets = ", ".join(f"{name} := {to_text(value)}" for name, value in event.set.items())
        crosses = f"{to_text(event.when)} crosses {event.crosses}"
        lines.append(f"when {describe_clock(event.when) if event.clocked else crosses}: {sets}")
    return lines + [line for memory in flat.memories for line in _describe_memory(memory)]


def _describe_memory(memory: FlatMemory) -> list[str]:
    """Its start, and each transition with what it sets."""
    lines = [f"{memory.name}(t0) = {to_text(memory.start)}"]
    for transition in memory.transitions:
        sets = [f"{memory.name} := {transition.target}"]
        sets += [f"{name} := {to_text(value)}" for name, value in transition.set.items()]
        when = f"{memory.name} is {transition.source} ({memory.modes[transition.source]})"
        lines.append(f"while {when} and {to_text(transition.when)}: {', '.join(sets)}")
    return lines
