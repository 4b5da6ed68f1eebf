"""Guards that are straight in the states: sums of states times numbers that a run does not change.

Such a guard is as far from the straight line through its values at two times as its states are from
theirs, each times its weight. A step knows that of its states, and so need not look at the guard
in between where both values are far from zero.

The weight of a state in an entry is at least the absolute value of the derivative:

    a + b, a - b    weight(a) + weight(b)
    a*c             weight(a) |c|, c made of parameters
    a/c             weight(a)/|c|
    a if c else b   the one or the other
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tracewire.compile.tape import Tape

Weights = Mapping[int, int]
MOVING = ("state", "t", "history", "history_rate", "record", "unknown")


def weights(tape: Tape, roots: Sequence[int]) -> list[Weights | None]:
    """The weights of the states in each root, entries by the number of the state; None where it is
    not straight. Modes stand still."""
    bits = tape.bits
    moving = sum(bits.get(leaf, 0) for leaf in MOVING)
    lasting = bits.get("param", 0) | bits.get("const", 0)
    found: dict[int, Weights | None] = {}
    for index in tape.needed(roots):
        moves = bool(tape.kinds[index] & moving)
        found[index] = _weights(tape, index, found, lasting) if moves else {}
    return [found[root] for root in roots]


def _weights(
    tape: Tape, index: int, found: Mapping[int, Weights | None], lasting: int
) -> Weights | None:
    """The weights in an entry that moves, by those in its operands; `lasting`: the leaves of what
    a run does not change."""
    entry = tape.entries[index]
    parts = [found[operand] for operand in entry.operands]
    lasts = [not tape.kinds[operand] & ~lasting for operand in entry.operands]
    match entry.op, parts:
        case "state", _:
            return {int(entry.payload): tape.constant(1.0)}
        case "neg", [part]:
            return part
        case "+" | "-", [dict() as one, dict() as other]:
            return _joined(tape, one, other)
        case "*", [_, dict() as part] if lasts[0]:
            return _scaled(tape, "*", part, entry.operands[0])
        case "*" | "/", [dict() as part, _] if lasts[1]:
            return _scaled(tape, entry.op, part, entry.operands[1])
        case "select", [{}, dict() as one, dict() as other] if lasts[0]:
            condition, zero = entry.operands[0], tape.constant(0.0)
            return {
                state: tape.push("select", condition, one.get(state, zero), other.get(state, zero))
                for state in {**one, **other}
            }
    return None


def _joined(tape: Tape, one: Weights, other: Weights) -> Weights:
    """The weights in a sum."""
    joined = dict(one)
    for state, weight in other.items():
        joined[state] = tape.push("+", joined[state], weight) if state in joined else weight
    return joined


def _scaled(tape: Tape, op: str, weights: Weights, factor: int) -> Weights:
    """The weights in a multiple or a part."""
    size = tape.push("abs", factor)
    return {state: tape.push(op, weight, size) for state, weight in weights.items()}
