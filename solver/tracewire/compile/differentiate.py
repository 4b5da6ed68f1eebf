"""Forward mode on the tape: the derivative of an entry in a direction, as further entries."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from tracewire.compile.tape import Tape


def differentiate(tape: Tape, roots: Iterable[int], seeds: Mapping[int, int]) -> list[int]:
    """The directional derivatives of `roots`, as entries.

    `seeds` maps leaf entries to the entries of their own derivative; every other leaf has the
    derivative 0. Modes are frozen: a mode is a constant here.
    """
    roots = list(roots)
    zero = tape.constant(0.0)
    rates = dict(seeds)
    for index in tape.needed(roots):
        if index not in rates:
            rates[index] = _rate(tape, index, rates, zero)
    return [rates[root] for root in roots]


def _rate(tape: Tape, index: int, rates: Mapping[int, int], zero: int) -> int:
    entry = tape.entries[index]
    push = tape.push
    if not entry.operands or entry.op in ("ge", "gt", "and", "or", "not", "floor", "slope"):
        return zero
    inner = [rates[operand] for operand in entry.operands]
    if all(rate == zero for rate in inner):
        return zero
    a = entry.operands[0]
    da = inner[0]
    if entry.op == "select":
        return push("select", a, inner[1], inner[2])
    if entry.op == "segment":  # operands: table, u, mode
        slope = push("slope", entry.operands[0], entry.operands[2])
        return push("*", slope, inner[1])
    if len(entry.operands) == 1:
        return (
            push("*", _slope(tape, entry.op, a, index), da)
            if entry.op != "neg"
            else (push("neg", da))
        )
    b, db = entry.operands[1], inner[1]
    match entry.op:
        case "+" | "-":
            return push(entry.op, da, db)
        case "*":
            return push("+", push("*", da, b), push("*", a, db))
        case "/":
            return push("/", push("-", da, push("*", index, db)), b)
        case "**":
            return _power_rate(tape, index, (a, da), (b, db))
        case "atan2":
            square = push("+", push("*", a, a), push("*", b, b))
            return push("/", push("-", push("*", da, b), push("*", a, db)), square)
    raise AssertionError(f"no derivative of {entry.op}")


def _power_rate(tape: Tape, index: int, base: tuple[int, int], exponent: tuple[int, int]) -> int:
    push = tape.push
    (a, da), (b, db) = base, exponent
    lower = push("**", a, push("-", b, tape.constant(1.0)))
    by_base = push("*", push("*", b, lower), da)
    if db == tape.constant(0.0):
        return by_base
    by_exponent = push("*", push("*", index, push("log", a)), db)
    return push("+", by_base, by_exponent)


def _slope(tape: Tape, op: str, a: int, value: int) -> int:
    """The derivative of a function of one argument; `value` is the entry of the function itself."""
    push, one = tape.push, tape.constant(1.0)

    def square(index: int) -> int:
        return push("*", index, index)

    match op:
        case "sin":
            return push("cos", a)
        case "cos":
            return push("neg", push("sin", a))
        case "tan":
            return push("+", one, square(value))
        case "asin":
            return push("/", one, push("sqrt", push("-", one, square(a))))
        case "acos":
            return push("neg", push("/", one, push("sqrt", push("-", one, square(a)))))
        case "atan":
            return push("/", one, push("+", one, square(a)))
        case "sinh":
            return push("cosh", a)
        case "cosh":
            return push("sinh", a)
        case "tanh":
            return push("-", one, square(value))
        case "exp":
            return value
        case "log":
            return push("/", one, a)
        case "sqrt":
            return push("/", tape.constant(0.5), value)
    raise AssertionError(f"no derivative of {op}")


def linear_in_t(tape: Tape, index: int, t: int) -> tuple[int, int] | None:
    """The entries (a, b) with entry = a*t + b where a and b read only parameters and modes."""
    if not tape.leaves([index]) <= {"t", "param", "const", "mode"}:
        return None
    rate = differentiate(tape, [index], {t: tape.constant(1.0)})[0]
    if "t" in tape.leaves([rate]):
        return None
    at_zero = substitute(tape, index, {t: tape.constant(0.0)})
    value = tape.value(rate)
    if value is not None and not (math.isfinite(value) and value != 0.0):
        return None
    return rate, at_zero


def substitute(tape: Tape, root: int, changes: Mapping[int, int]) -> int:
    """The entry that `root` becomes when the entries in `changes` are replaced."""
    new = dict(changes)
    for index in tape.needed([root]):
        if index not in new:
            entry = tape.entries[index]
            operands = tuple(new[operand] for operand in entry.operands)
            new[index] = tape.push(entry.op, *operands, payload=entry.payload)
    return new[root]
