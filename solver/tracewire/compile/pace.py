"""The pace of guards: how fast what they read turns round, apart from the states that are felt.

A step follows the error of the states. A guard that reads sin(499*t) may cross its level many times
within a step that the states allow. The pace of an entry, in 1/s, says how often its graph can
turn in a second, to order of magnitude:

    a + b, a - b    the larger of the two
    a*b             the sum of the two
    sin a, cos a    pace(a) + |a'|
    tan a           pace(a) + |a'|
    exp a, tanh a   pace(a) + |a'|/(1 + |a|): resolved where the argument is small; and what is far
                    away in time is approached by ever shorter steps, and not passed over
    a/b             pace(a) + pace(b) + |b'|/|b|
    a**b            likewise, with a, unless b is a whole number that is not negative

with a' the derivative along the flow. A leaf, and what is linear in t and the states, has none.
Steps of a fraction of 1/pace see all crossings of a guard that the states do not feel.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tracewire.compile.differentiate import differentiate
from tracewire.compile.tape import Tape
from tracewire.formula import FUNCTIONS

TURNING = {name for name, function in FUNCTIONS.items() if function.pace == "turns"}
FADING = {name for name, function in FUNCTIONS.items() if function.pace == "fades"}
STILL = ("ge", "gt", "and", "or", "not", "floor", "slope")


def pace(tape: Tape, roots: Sequence[int], flow: Mapping[int, int]) -> int:
    """The entry of the largest pace of `roots`; `flow` has the rates of the states and of t."""
    needed = [i for i in tape.needed(roots) if tape.entries[i].op not in ("newton", "table")]
    arguments = {i: a for i in needed if (a := _argument(tape, i)) is not None}
    read = list(dict.fromkeys(arguments.values()))
    rates = dict(zip(read, differentiate(tape, read, flow), strict=True))
    found: dict[int, int] = {}
    for index in needed:
        found[index] = _pace(tape, index, found)
        if index in arguments:
            argument = arguments[index]
            own = _own(tape, index, argument, tape.push("abs", rates[argument]))
            found[index] = tape.push("+", found[index], own)
    largest = tape.constant(0.0)
    for root in dict.fromkeys(roots):
        largest = _larger(tape, largest, found[root])
    return largest


def _argument(tape: Tape, index: int) -> int | None:
    """The operand whose rate adds to the pace of an entry."""
    entry = tape.entries[index]
    if entry.op in TURNING | FADING:
        return entry.operands[0]
    if entry.op == "/":
        return entry.operands[1]
    if entry.op == "**":
        exponent = tape.value(entry.operands[1])
        whole = exponent is not None and exponent >= 0 and exponent == int(exponent)
        return None if whole else entry.operands[0]
    return None


def _own(tape: Tape, index: int, argument: int, speed: int) -> int:
    """What an entry adds to the pace of its operands, of the rate `speed` of its argument."""
    op, size = tape.entries[index].op, tape.push("abs", argument)
    if op in TURNING or tape.value(speed) == 0.0:
        return speed
    if op in FADING:
        size = tape.push("+", tape.constant(1.0), size)
    return tape.push("/", speed, size)


def _pace(tape: Tape, index: int, found: Mapping[int, int]) -> int:
    """The pace that an entry has from its operands."""
    entry, zero = tape.entries[index], tape.constant(0.0)
    inner = [found.get(operand, zero) for operand in entry.operands]
    if not inner or entry.op in STILL or entry.op == "pick":
        return zero
    match entry.op:
        case "+" | "-" | "atan2":
            return _larger(tape, *inner)
        case "*" | "/" | "**":
            return tape.push("+", *inner)
        case "select":
            return tape.push("select", entry.operands[0], inner[1], inner[2])
        case "segment" | "past" | "recorded":  # operands: table, history or record, u
            return inner[1]
    return inner[0]


def _larger(tape: Tape, a: int, b: int) -> int:
    if a == b or tape.value(b) == 0.0:
        return a
    if tape.value(a) == 0.0:
        return b
    return tape.push("select", tape.push("ge", a, b), a, b)
