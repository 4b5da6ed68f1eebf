"""The sizes of entries: how large the numbers are of which a value is made.

The size of an entry is the bound of its rounding error, in units of the machine's precision, to
first order:

    a + b, a - b    size(a) + size(b)
    a*b             |a| size(b) + size(a) |b|; but size(a) |b| where b is a leaf or its like
    a/b             (size(a) + |a/b| size(b))/|b|
    f(a)            |f'(a)| size(a) + |f(a)|

and that of a leaf is its absolute value. But a state passes through zero and keeps the rounding
errors of what it has been: its size is a leaf of its own, the state of number n + j for state j of
n, whose value the caller gives. So a size has the unit of its entry, and depends on nothing that
the entry does not read. A value whose absolute value is a small part of its size is zero.
"""

from __future__ import annotations

from collections.abc import Sequence

from tracewire.compile.differentiate import gradients, past_rate, slope_of
from tracewire.compile.tape import Tape

NO_VALUE = ("newton", "table", "unknown", "history", "history_rate", "record")
EXACT = ("ge", "gt", "and", "or", "not", "floor", "slope")


def sizes(tape: Tape, roots: Sequence[int], states: int) -> list[int]:
    """The entries of the sizes of `roots`, for a model of so many states."""
    found: dict[int, int] = {}
    for index in tape.needed(roots):
        if tape.entries[index].op not in NO_VALUE:
            found[index] = _size(tape, index, found, states)
    return [found[root] for root in roots]


def _size(tape: Tape, index: int, found: dict[int, int], states: int) -> int:
    entry, push = tape.entries[index], tape.push
    if entry.op == "state":
        return push("state", payload=states + int(entry.payload))
    own = push("abs", index)
    if not entry.operands or entry.op in EXACT or tape.leaves([index]) <= {"param", "const"}:
        return own
    if entry.op == "pick":
        return _of_search(tape, index, own, states)
    a, b = entry.operands[0], entry.operands[-1]
    match entry.op:
        case "neg" | "abs":
            return found[a]
        case "+" | "-":
            return push("+", found[a], found[b])
        case "*":
            left, right = (push("abs", operand) for operand in (a, b))
            if found[b] == right:
                return push("*", found[a], right)
            if found[a] == left:
                return push("*", left, found[b])
            return push("+", push("*", left, found[b]), push("*", found[a], right))
        case "/":
            above = push("+", found[a], push("*", own, found[b]))
            return push("/", above, push("abs", b))
        case "select":
            return push("select", a, found[entry.operands[1]], found[b])
        case "segment":  # operands: table, u, mode
            steep = push("abs", push("slope", a, b))
            return push("+", push("*", steep, found[entry.operands[1]]), own)
        case "past" | "recorded":  # operands: history or record, s
            steep = push("abs", past_rate(tape, index))
            return push("+", push("*", steep, found[entry.operands[1]]), own)
        case "atan2":
            square = push("+", push("*", a, a), push("*", b, b))
            left = push("*", found[a], push("abs", b))
            both = push("+", left, push("*", push("abs", a), found[b]))
            return push("+", push("/", both, square), own)
        case "**":
            lower = push("*", b, push("**", a, push("-", b, tape.constant(1.0))))
            size = push("+", push("*", push("abs", lower), found[a]), own)
            if tape.leaves([b]) <= {"param", "const"}:
                return size
            steep = push("abs", push("*", index, push("log", a)))
            return push("+", size, push("*", steep, found[b]))
    steep = push("abs", slope_of(tape, entry.op, a, index))
    return push("+", push("*", steep, found[a]), own)


def _of_search(tape: Tape, index: int, own: int, states: int) -> int:
    """The size of an unknown of a nonlinear system: by its derivatives in the states and t."""
    outside = tape.needed(tape.moved_by(index))
    leaves = [i for i in outside if tape.entries[i].op in ("state", "t")]
    size = own
    for leaf, rate in gradients(tape, [index], leaves)[0].items():
        part = tape.push("*", tape.push("abs", rate), _size(tape, leaf, {}, states))
        size = tape.push("+", size, part)
    return size
