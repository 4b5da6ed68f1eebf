from __future__ import annotations

import math

import pytest
from tracewire.compile.tape import BINARY, UNARY, Tape


def leaves(tape: Tape) -> tuple[int, int]:
    return tape.push("state", payload=0), tape.push("state", payload=1)


def test_the_same_operation_is_the_same_entry() -> None:
    tape = Tape()
    x, y = leaves(tape)
    first = tape.push("sin", tape.push("*", x, y))
    count = len(tape.entries)
    assert tape.push("sin", tape.push("*", x, y)) == first
    assert len(tape.entries) == count


@pytest.mark.parametrize(
    ("op", "numbers", "value"),
    [
        *((op, (0.5,), function(0.5)) for op, function in UNARY.items()),
        *((op, (0.5, 2.0), function(0.5, 2.0)) for op, function in BINARY.items()),
        ("select", (1.0, 4.0, 5.0), 4.0),
        ("select", (0.0, 4.0, 5.0), 5.0),
    ],
)
def test_operations_on_constants_are_folded(
    op: str, numbers: tuple[float, ...], value: float
) -> None:
    tape = Tape()
    assert tape.value(tape.push(op, *map(tape.constant, numbers))) == value


@pytest.mark.parametrize(
    ("op", "numbers"),
    [
        ("/", (1.0, 0.0)),
        ("log", (-1.0,)),
        ("**", (-8.0, 1 / 3)),
        ("exp", (1e4,)),
        ("sqrt", (-1.0,)),
    ],
)
def test_what_has_no_value_is_left_to_the_run(op: str, numbers: tuple[float, ...]) -> None:
    tape = Tape()
    entry = tape.push(op, *map(tape.constant, numbers))
    assert tape.value(entry) is None
    assert tape.entries[entry].op == op


def test_neutral_operations_vanish() -> None:
    tape = Tape()
    x, y = leaves(tape)
    zero, one, minus = tape.constant(0.0), tape.constant(1.0), tape.constant(-1.0)
    for entry in (
        tape.push("+", x, zero),
        tape.push("+", zero, x),
        tape.push("-", x, zero),
        tape.push("*", x, one),
        tape.push("*", one, x),
        tape.push("/", x, one),
        tape.push("**", x, one),
        tape.push("neg", tape.push("neg", x)),
        tape.push("not", tape.push("not", x)),
        tape.push("select", one, x, y),
        tape.push("select", y, x, x),
    ):
        assert entry == x
    for entry in (tape.push("*", x, zero), tape.push("/", zero, x), tape.push("-", x, x)):
        assert entry == zero
    assert tape.push("-", zero, x) == tape.push("*", minus, x) == tape.push("neg", x)
    assert tape.push("**", x, tape.constant(3.0)) == tape.push("*", tape.push("*", x, x), x)
    assert tape.push("**", x, tape.constant(0.5)) == tape.push("sqrt", x)
    assert tape.push("/", y, tape.push("cosh", x)) == tape.push("*", y, tape.push("sech", x))


def test_what_nothing_reads_is_not_needed() -> None:
    tape = Tape()
    x, y = leaves(tape)
    root = tape.push("cos", x)
    dead = tape.push("exp", y)
    assert tape.needed([root]) == [x, root]
    assert dead not in tape.needed([root])
    assert tape.leaves([root, tape.constant(math.pi)]) == {"state", "const"}
