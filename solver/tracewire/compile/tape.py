"""The tape: every value of a model once, in single static assignment, folded and shared.

An entry is an operation on earlier entries. Entries with the same operation and operands are the
same entry (common subexpressions), operations on constants are done at once (folding), and what
nothing reads is never written out (dead code).

Systems of equations. A linear system needs no operation of its own: `linear.solve_linear` writes
its elimination out in entries, and notes each unknown in `Tape.systems`, so that a derivative
solves the same matrix again and does not go through the elimination. A nonlinear system is two
operations:

- `newton`, payload i, describes the search for z with r(z) = 0 of `Tape.implicits[i]`. Its operands
  are the n guesses and behind them every entry that the search reads from outside. The entries
  `residuals` (r) and `steps` (J^-1 r with J = dr/dz) read the leaves `unknowns` (op `unknown`);
  these leaves have a value in the search only, and nothing outside of it reads them. Its value is
  n numbers, so it is never a constant of the run, never folded, and read by `pick` only.
- `pick`, payload j, operand a `newton`: its unknown j.

The search, the same in every back end, to the bit, with the numbers of `limits.SEARCH`:

    z = z_old = guess; step_old = 0; worst_old = inf; share = 1; scale_j = |guess_j|
    most_steps times:
        r, step = residuals and steps at z;   worst = r_0*r_0 + r_1*r_1 + ... (from the left)
        if not worst < worst_old and share > least_share and not (all |step_j| <= close*scale_j):
            share = share/2; z_j = z_old_j - share*step_old_j       (it went too far, or NaN)
        else:
            z_old = z; step_old = step; worst_old = worst; share = 1
            z_j = z_j - step_j; scale_j = |z_j| if |z_j| > scale_j else scale_j
            if all |step_j| <= close*scale_j (the new scale): the result is z
    the result is NaN, n times

It is infinite where J is singular at the guess.

Delays. `past`, payload r, operands a leaf, a time s and a mode, is the derivative of order r at the
time s of what a delayed signal was. The mode is the number of the smooth stretch in which s lies.
The leaf says which signal, `history` for r = 0 and `history_rate` beyond: how the past moves with a
parameter is what a derivative by the leaf is multiplied with. `recorded` is the same of what a
record tells of the time before the run, from `record_begin` on, which moves with nothing; its leaf
is `record`, and it has no mode.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from tracewire.formula import OPERATIONS

COMPUTED = {
    name: operation.value
    for name, operation in OPERATIONS.items()
    if operation.value
    and (operation.library or operation.intrinsic or operation.instruction or operation.base)
}
UNARY: dict[str, Callable[[float], float]] = {
    **{name: value for name, value in COMPUTED.items() if OPERATIONS[name].most == 1},
    "neg": lambda a: -a,
    "not": lambda a: 1.0 - a,
}
BINARY: dict[str, Callable[[float, float], float]] = {
    **{name: value for name, value in COMPUTED.items() if OPERATIONS[name].most == 2},
    "ge": lambda a, b: 1.0 if a >= b else 0.0,
    "gt": lambda a, b: 1.0 if a > b else 0.0,
    "and": lambda a, b: a * b,
    "or": lambda a, b: max(a, b),
}
"""What operations of the tape give for numbers; conditions are 0.0 and 1.0."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One operation: its name, the entries it reads, and the payload of a leaf (index or value)."""

    op: str
    operands: tuple[int, ...] = ()
    payload: float | int = 0


@dataclass(frozen=True)
class System:
    """A solved linear system M x = f: entries of M row by row, of f, of x; and which x it is."""

    matrix: tuple[int, ...]
    right: tuple[int, ...]
    solution: tuple[int, ...]
    position: int


@dataclass(frozen=True)
class Implicit:
    """A nonlinear system r(z) = 0: entries of the leaves z, of r, of J row by row, of J^-1 r."""

    unknowns: tuple[int, ...]
    residuals: tuple[int, ...]
    jacobian: tuple[int, ...]
    steps: tuple[int, ...]


@dataclass
class Tape:
    """Entries in an order in which each stands after those it reads."""

    entries: list[Entry] = field(default_factory=list)
    known: dict[Entry, int] = field(default_factory=dict)
    kinds: list[int] = field(default_factory=list)  # of each entry, its leaves as bits
    bits: dict[str, int] = field(default_factory=dict)  # the bit of each kind of leaf
    systems: dict[int, System] = field(default_factory=dict)  # of an unknown, where it comes from
    solved: dict[tuple[tuple[int, ...], tuple[int, ...]], tuple[int, ...]] = field(
        default_factory=dict
    )  # of a matrix and a right side, the unknowns
    implicits: list[Implicit] = field(default_factory=list)

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
            kinds = 0 if operands else self.bits.setdefault(op, 1 << len(self.bits))
            for operand in operands:
                kinds |= self.kinds[operand]
            self.kinds.append(kinds)
        return found

    def unknown(self) -> int:
        """A new leaf for an unknown of a system of equations, until its solution is known."""
        return self.push("unknown", payload=len(self.entries))

    def constant(self, value: float) -> int:
        """The entry of a constant."""
        return self.push("const", payload=float(value))

    def value(self, index: int) -> float | None:
        """The number that an entry is, None where it is no constant."""
        entry = self.entries[index]
        return float(entry.payload) if entry.op == "const" else None

    def _simplified(self, op: str, operands: tuple[int, ...]) -> int | None:
        if not operands or op in ("segment", "slope", "past", "recorded", "newton", "pick"):
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
        if not math.isfinite(result):
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
            case "/" if self.entries[b].op == "cosh":  # which shares its division with tanh
                return self.push("*", a, self.push("sech", self.entries[b].operands[0]))
            case "**" if y == 2:
                return self.push("*", a, a)
            case "**" if y == 3:
                return self.push("*", self.push("*", a, a), a)
            case "**" if y == 0.5:
                return self.push("sqrt", a)
        return None

    def moved_by(self, index: int) -> tuple[int, ...]:
        """The entries by which an entry changes: its operands, but for an unknown of a system.

        Of a linear system these are its matrix and right side, and of a nonlinear one what the
        search reads from outside.
        """
        system = self.systems.get(index)
        if system is not None:
            return system.matrix + system.right
        entry = self.entries[index]
        if entry.op == "pick":
            newton = self.entries[entry.operands[0]]
            return newton.operands[len(self.implicits[int(newton.payload)].unknowns) :]
        return entry.operands

    def searched(self, roots: Iterable[int]) -> list[int]:
        """The operations behind the roots that read unknowns, in order: the body of a search."""
        unknown = self.bits["unknown"]
        wanted: set[int] = set()
        stack = list(roots)
        while stack:
            index = stack.pop()
            operands = self.entries[index].operands
            if operands and index not in wanted and self.kinds[index] & unknown:
                wanted.add(index)
                stack.extend(operands)
        return sorted(wanted)

    def needed(
        self, roots: Iterable[int], is_known: Callable[[int], bool] | None = None
    ) -> list[int]:
        """The entries that the roots depend on, themselves included, in order; not what an entry
        that `is_known` depends on."""
        wanted: set[int] = set()
        stack = list(roots)
        while stack:
            index = stack.pop()
            if index not in wanted:
                wanted.add(index)
                if is_known is None or not is_known(index):
                    stack.extend(self.entries[index].operands)
        return sorted(wanted)

    def leaves(self, roots: Iterable[int]) -> set[str]:
        """The kinds of leaf that the roots depend on: t, state, param, mode, hold."""
        kinds = 0
        for root in roots:
            kinds |= self.kinds[root]
        return {op for op, bit in self.bits.items() if kinds & bit}
