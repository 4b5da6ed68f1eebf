"""Forward mode on the tape: the derivative of an entry in a direction, as further entries.

The unknowns of a system of equations follow from the equations: dx = M^-1 (df - dM x) of M x = f,
and dz = -J^-1 dr of r(z) = 0 with J = dr/dz, where dr is the change of r with z held.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from tracewire.compile.linear import solve_linear
from tracewire.compile.tape import Implicit, System, Tape
from tracewire.formula import FUNCTIONS, Expression, Name, Number, parse


def differentiate(tape: Tape, roots: Iterable[int], seeds: Mapping[int, int]) -> list[int]:
    """The directional derivatives of `roots`, as entries.

    `seeds` maps leaf entries to the entries of their own derivative; every other leaf has the
    derivative 0. Modes are frozen: a mode is a constant here.
    """
    roots = list(roots)
    zero = tape.constant(0.0)
    rates = dict(seeds)
    for index in _moving(tape, roots, rates):
        inner = [rates[operand] for operand in tape.moved_by(index)]
        moves = any(rate != zero for rate in inner)
        rates[index] = _rate(tape, index, inner) if moves else zero
    return [rates[root] for root in roots]


def gradients(tape: Tape, roots: Iterable[int], leaves: Iterable[int]) -> list[dict[int, int]]:
    """Of each root the entries d root / d leaf, by leaf; a derivative that is always 0 is left out.

    All leaves in one sweep over the tape, so that the work is that of the derivatives there are.
    """
    roots = list(roots)
    zero, one = tape.constant(0.0), tape.constant(1.0)
    found: dict[int, dict[int, int]] = {leaf: {leaf: one} for leaf in leaves}
    for index in _moving(tape, roots, found):
        operands = tape.moved_by(index)
        own = found[index] = {}
        for leaf in dict.fromkeys(leaf for operand in operands for leaf in found[operand]):
            inner = [found[operand].get(leaf, zero) for operand in operands]
            rate = _rate(tape, index, inner)
            if rate != zero:
                own[leaf] = rate
    return [found[root] for root in roots]


def _moving(tape: Tape, roots: Iterable[int], known: Mapping[int, object]) -> list[int]:
    """The entries whose derivatives those of the roots are made of, in order; not the known."""
    wanted: set[int] = set()
    stack = list(roots)
    while stack:
        index = stack.pop()
        if index not in wanted and index not in known:
            wanted.add(index)
            stack.extend(tape.moved_by(index))
    return sorted(wanted)


def _rate(tape: Tape, index: int, inner: list[int]) -> int:
    """The derivative of an entry from those of what moves it, `inner`, of which one is not 0."""
    entry = tape.entries[index]
    push = tape.push
    if index in tape.systems:
        return _linear_rate(tape, tape.systems[index], inner)
    if entry.op == "pick":
        return _implicit_rate(tape, index, inner)
    if entry.op in ("ge", "gt", "and", "or", "not", "floor", "slope"):
        return tape.constant(0.0)
    a = entry.operands[0]
    da = inner[0]
    if entry.op == "select":
        return push("select", a, inner[1], inner[2])
    if entry.op == "segment":  # operands: table, u, mode
        slope = push("slope", entry.operands[0], entry.operands[2])
        return push("*", slope, inner[1])
    if entry.op == "past":  # operands: history, s, mode
        return push("+", da, push("*", past_rate(tape, index), inner[1]))
    if entry.op == "recorded":  # operands: record, s
        return push("*", past_rate(tape, index), inner[1])
    if entry.op == "neg":
        return push("neg", da)
    if entry.op == "sqrt":
        return _root_rate(tape, a, da)
    if len(entry.operands) == 1:
        return push("*", slope_of(tape, entry.op, a, index), da)
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


def _root_rate(tape: Tape, a: int, da: int) -> int:
    """The derivative of the square root of an entry, which has the derivative `da`.

    That of sqrt(max(h, 0)) is 0 where the 0 is chosen, and not 0/0.
    """
    if da == tape.constant(0.0):
        return da
    chosen, rates = tape.entries[a], tape.entries[da]
    if chosen.op == rates.op == "select" and chosen.operands[0] == rates.operands[0]:
        sides = zip(chosen.operands[1:], rates.operands[1:], strict=True)
        return tape.push("select", chosen.operands[0], *(_root_rate(tape, *one) for one in sides))
    return tape.push("*", slope_of(tape, "sqrt", a, tape.push("sqrt", a)), da)


def past_rate(tape: Tape, index: int) -> int:
    """The next derivative of a delayed signal by its own time."""
    entry = tape.entries[index]
    leaf, *at = entry.operands
    if entry.op == "past":
        leaf = tape.push("history_rate", payload=tape.entries[leaf].payload)
    return tape.push(entry.op, leaf, *at, payload=entry.payload + 1)


def _linear_rate(tape: Tape, system: System, inner: list[int]) -> int:
    """The derivative of an unknown of M x = f, from those of the entries of M and f."""
    size = len(system.right)
    changes = inner[size * size :]
    for row in range(size):
        for column, x in enumerate(system.solution):
            product = tape.push("*", inner[row * size + column], x)
            changes[row] = tape.push("-", changes[row], product)
    return solve_linear(tape, system.matrix, changes)[system.position]


def _implicit_rate(tape: Tape, index: int, inner: list[int]) -> int:
    """The derivative of an unknown of r(z) = 0, from those of what r reads from outside."""
    (newton,) = tape.entries[index].operands
    implicit = tape.implicits[int(tape.entries[newton].payload)]
    zero = tape.constant(0.0)
    seeds = dict.fromkeys(implicit.unknowns, zero)
    seeds |= dict(zip(tape.moved_by(index), inner, strict=True))
    changes = differentiate(tape, implicit.residuals, seeds)
    size = len(implicit.unknowns)
    found = [tape.push("pick", newton, payload=position) for position in range(size)]
    at = dict(zip(implicit.unknowns, found, strict=True))
    entries = substitute_all(tape, [*implicit.jacobian, *changes], at)
    right = [tape.push("neg", change) for change in entries[size * size :]]
    solution = solve_linear(tape, entries[: size * size], right)
    return solution[int(tape.entries[index].payload)]


def _power_rate(tape: Tape, index: int, base: tuple[int, int], exponent: tuple[int, int]) -> int:
    push = tape.push
    (a, da), (b, db) = base, exponent
    lower = push("**", a, push("-", b, tape.constant(1.0)))
    by_base = push("*", push("*", b, lower), da)
    if db == tape.constant(0.0):
        return by_base
    by_exponent = push("*", push("*", index, push("log", a)), db)
    return push("+", by_base, by_exponent)


def slope_of(tape: Tape, op: str, a: int, value: int) -> int:
    """The derivative of a function of one argument; `value` is the entry of the function itself."""
    slope = FUNCTIONS[op].slope if op in FUNCTIONS else ""
    if not slope:
        raise AssertionError(f"no derivative of {op}")
    return _pushed(tape, parse(slope), {"u": a, "f": value})


def _pushed(tape: Tape, formula: Expression, entries: Mapping[str, int]) -> int:
    """The entry of a formula over entries by their names."""
    if isinstance(formula, Number):
        return tape.constant(formula.value)
    if isinstance(formula, Name):
        return entries[formula.name]
    arguments = (_pushed(tape, argument, entries) for argument in formula.arguments)
    return tape.push(formula.function, *arguments)


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
    return substitute_all(tape, [root], changes)[0]


def substitute_all(tape: Tape, roots: Sequence[int], changes: Mapping[int, int]) -> list[int]:
    """The entries that `roots` become when the entries in `changes` are replaced."""
    new = dict(changes)
    wanted: set[int] = set()
    stack = list(roots)
    while stack:
        index = stack.pop()
        if index not in wanted and index not in new:
            wanted.add(index)
            stack.extend(_made_of(tape, index))
    for index in sorted(wanted):
        entry, old = tape.entries[index], _made_of(tape, index)
        parts = tuple(new[part] for part in old)
        system = tape.systems.get(index)
        if parts == old:
            new[index] = index
        elif system is not None:
            size = len(system.matrix)
            new[index] = solve_linear(tape, parts[:size], parts[size:])[system.position]
        elif entry.op == "newton":
            new[index] = _same_search(tape, index, new)
        else:
            new[index] = tape.push(entry.op, *parts, payload=entry.payload)
    return [new[root] for root in roots]


def _made_of(tape: Tape, index: int) -> tuple[int, ...]:
    """The entries behind an entry; behind an unknown of a linear system those of the system."""
    system = tape.systems.get(index)
    return tape.entries[index].operands if system is None else system.matrix + system.right


def _same_search(tape: Tape, index: int, new: Mapping[int, int]) -> int:
    """The search of a nonlinear system that reads other entries from outside."""
    entry = tape.entries[index]
    implicit = tape.implicits[int(entry.payload)]
    size = len(implicit.unknowns)
    fresh = [tape.unknown() for _ in range(size)]
    inside = {old: new[old] for old in entry.operands[size:]}
    inside |= dict(zip(implicit.unknowns, fresh, strict=True))
    residuals = substitute_all(tape, implicit.residuals, inside)
    return search(tape, fresh, residuals, [new[guess] for guess in entry.operands[:size]])


def search(
    tape: Tape, unknowns: Sequence[int], residuals: Sequence[int], guesses: Sequence[int]
) -> int:
    """The entry `newton` that solves residuals = 0 for the unknowns; `pick` reads it.

    unknowns: leaves of `Tape.unknown` that the residuals read; guesses: where the search begins.
    """
    matrix = jacobian_of(tape, residuals, unknowns)
    steps = solve_linear(tape, matrix, residuals)
    body = tape.searched([*steps, *residuals])
    inside = {*unknowns, *body}
    read = (operand for index in body for operand in tape.entries[index].operands)
    outside = dict.fromkeys(i for i in (*read, *steps, *residuals) if i not in inside)
    number = len(tape.implicits)
    tape.implicits.append(Implicit(tuple(unknowns), tuple(residuals), tuple(matrix), tuple(steps)))
    return tape.push("newton", *guesses, *outside, payload=number)


def jacobian_of(tape: Tape, roots: Sequence[int], leaves: Sequence[int]) -> list[int]:
    """The entries of d root / d leaf, row by row."""
    zero = tape.constant(0.0)
    return [row.get(leaf, zero) for row in gradients(tape, roots, leaves) for leaf in leaves]
