"""The tape: every value of a model once, in single static assignment, folded and shared.

An entry is an operation on earlier entries. Entries with the same operation and operands are the
same entry (common subexpressions), operations on constants are done at once (folding), and what
nothing reads is never written out (dead code).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

UNARY: dict[str, Callable[[float], float]] = {
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "asin": math.asin,
    "acos": math.acos,
    "atan": math.atan,
    "sinh": math.sinh,
    "cosh": math.cosh,
    "tanh": math.tanh,
    "exp": math.exp,
    "log": math.log,
    "sqrt": math.sqrt,
    "floor": math.floor,
    "neg": lambda a: -a,
    "not": lambda a: 1.0 - a,
}
BINARY: dict[str, Callable[[float, float], float]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "**": lambda a, b: a**b,
    "atan2": math.atan2,
    "ge": lambda a, b: 1.0 if a >= b else 0.0,
    "gt": lambda a, b: 1.0 if a > b else 0.0,
    "and": lambda a, b: a * b,
    "or": lambda a, b: max(a, b),
}


@dataclass(frozen=True, slots=True)
class Entry:
    """One operation: its name, the entries it reads, and the payload of a leaf (index or value)."""

    op: str
    operands: tuple[int, ...] = ()
    payload: float | int = 0


@dataclass
class Tape:
    """Entries in an order in which each stands after those it reads."""

    entries: list[Entry] = field(default_factory=list)
    known: dict[Entry, int] = field(default_factory=dict)

    def push(self, op: str, *operands: int, payload: float | int = 0) -> int:
        """The entry of an operation: an old one where it is known, folded where it can be."""
        simpler = self._simplified(op, operands)
        if simpler is not None:
            return simpler
        entry = Entry(op, operands, payload)
        found = self.known.get(entry)
        if found is None:
            found = self.known[entry] = len(self.entries)
            self.entries.append(entry)
        return found

    def constant(self, value: float) -> int:
        """The entry of a constant."""
        return self.push("const", payload=float(value))

    def value(self, index: int) -> float | None:
        """The number that an entry is, None where it is no constant."""
        entry = self.entries[index]
        return float(entry.payload) if entry.op == "const" else None

    def _simplified(self, op: str, operands: tuple[int, ...]) -> int | None:
        if not operands or op in ("segment", "slope"):
            return None
        values = [self.value(operand) for operand in operands]
        if all(value is not None for value in values):
            return self._folded(op, [value for value in values if value is not None])
        if op in ("neg", "not") and self.entries[operands[0]].op == op:
            return self.entries[operands[0]].operands[0]
        if len(operands) == 2:
            return self._identity(op, operands[0], operands[1], values[0], values[1])
        if op == "select":
            if values[0] is not None:
                return operands[1] if values[0] else operands[2]
            if operands[1] == operands[2]:
                return operands[1]
        return None

    def _folded(self, op: str, values: list[float]) -> int | None:
        if op == "select":
            return self.constant(values[1] if values[0] else values[2])
        try:
            result = UNARY[op](values[0]) if len(values) == 1 else BINARY[op](*values)
        except (ValueError, ZeroDivisionError, OverflowError):
            return None  # left to fail where it is used, with a name
        if isinstance(result, complex) or not math.isfinite(result):
            return None
        return self.constant(result)

    def _identity(self, op: str, a: int, b: int, x: float | None, y: float | None) -> int | None:
        match op:
            case "+" if x == 0:
                return b
            case "+" | "-" if y == 0:
                return a
            case "-" if x == 0:
                return self.push("neg", b)
            case "-" if a == b:
                return self.constant(0.0)
            case "*" if x == 0 or y == 0:
                return self.constant(0.0)
            case "*" if x == 1:
                return b
            case "*" | "/" | "**" if y == 1:
                return a
            case "*" if x == -1:
                return self.push("neg", b)
            case "*" if y == -1:
                return self.push("neg", a)
            case "/" if x == 0:
                return self.constant(0.0)
            case "**" if y == 2:
                return self.push("*", a, a)
            case "**" if y == 3:
                return self.push("*", self.push("*", a, a), a)
            case "**" if y == 0.5:
                return self.push("sqrt", a)
        return None

    def needed(self, roots: Iterable[int]) -> list[int]:
        """The entries that the roots depend on, themselves included, in order."""
        wanted: set[int] = set()
        stack = list(roots)
        while stack:
            index = stack.pop()
            if index not in wanted:
                wanted.add(index)
                stack.extend(self.entries[index].operands)
        return sorted(wanted)

    def leaves(self, roots: Iterable[int]) -> set[str]:
        """The kinds of leaf that the roots depend on: t, state, param, mode, hold."""
        return {e.op for e in map(self.entries.__getitem__, self.needed(roots)) if not e.operands}
