"""The first back end: readable Python source from the tape.

Every function takes the time `t`, the states `x`, the modes `m` (behind them, what is held), the
constants `c` that `prepare` made of the parameters, and the tables `k`. A second, `careful` version
of each function gives NaN or infinity where Python would raise, as C does; it runs only where the
first one failed.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from tracewire.compile import libm
from tracewire.compile.constants import OF_THE_PAST, Constants
from tracewire.compile.hyperbolic import hyperbolic
from tracewire.compile.limits import CODE, SEARCH
from tracewire.compile.past import past
from tracewire.compile.tape import Tape

INLINE = ("const", "table", "history", "history_rate", "record")

Function = Callable[..., tuple[float, ...]]


def _floor(a: float) -> float:
    return math.copysign(math.floor(a), a)  # math.floor(-0.0) is 0, and that of C is -0.0


def _divide(a: float, b: float) -> float:
    if b == 0.0:
        return math.nan if a == 0.0 or a != a else math.copysign(math.inf, a) * math.copysign(1, b)
    return a / b


def _segment(k: Sequence[float], table: int, u: float, piece: float) -> float:
    """The straight line of a piece of a table; outside the points the table is held."""
    at = int(k[table])
    count = int(k[at])
    x, y = at + 1, at + 1 + count
    if not piece >= 1.0:
        return k[y]
    if piece >= count:
        return k[y + count - 1]
    i = int(piece) - 1
    return k[y + i] + k[y + count + i] * (u - k[x + i])


def _slope(k: Sequence[float], table: int, piece: float) -> float:
    at = int(k[table])
    count = int(k[at])
    inside = 1.0 <= piece < count
    return k[at + 1 + 2 * count + int(piece) - 1] if inside else 0.0


def _newton(equations: Callable[..., Sequence[float]], guess: Sequence[float]) -> Sequence[float]:
    """The search that the tape describes; `equations` gives the residuals and then the steps."""
    size = len(guess)
    z = old = list(guess)
    old_step, old_worst, share = [0.0] * size, math.inf, 1.0
    scale = [abs(value) for value in guess]
    for _ in range(SEARCH.most_steps):
        found = equations(*z)
        step = found[size:]
        worst = found[0] * found[0]
        for residual in found[1:size]:
            worst += residual * residual
        if not worst < old_worst and share > SEARCH.least_share and not _close(step, scale):
            share *= 0.5
            z = [a - share * b for a, b in zip(old, old_step, strict=True)]
            continue
        old, old_step, old_worst, share = z, list(step), worst, 1.0
        z = [a - b for a, b in zip(z, step, strict=True)]
        scale = [abs(a) if abs(a) > s else s for a, s in zip(z, scale, strict=True)]
        if _close(step, scale):
            return z
    return [math.nan] * size


def _close(step: Sequence[float], scale: Sequence[float]) -> bool:
    return all(abs(a) <= SEARCH.close * s for a, s in zip(step, scale, strict=True))


SHARED: dict[str, Any] = {
    "abs": abs,
    "max": max,
    "segment": _segment,
    "slope": _slope,
    "past": past,
    "newton": _newton,
}
FAST: dict[str, Any] = {name: getattr(math, name) for name in (*libm.ONE, *libm.TWO, "sqrt")}
FAST |= {**SHARED, "floor": _floor, **hyperbolic(math.exp)}


def _careful() -> dict[str, Any]:
    names = (*libm.ONE, *libm.TWO, "sqrt", "floor")
    called = {name: libm.function(name) for name in names}
    return {**SHARED, "divide": _divide, **called, **hyperbolic(called["exp"])}


class Writer:
    """Writes functions of one tape; `modes` is the number of modes."""

    def __init__(self, tape: Tape, constants: Constants, labels: Mapping[int, str], modes: int):
        self.tape, self.constants, self.labels, self.modes = tape, constants, labels, modes

    def function(self, name: str, doc: str, roots: Sequence[int], careful: bool = False) -> str:
        """The text of a function that returns the roots as a tuple."""
        body = _Body(self, roots, careful)
        lines = [f"def {name}(t, x, m, c, k):", f'    """{doc}"""', *body.lines]
        comma = "," if len(roots) == 1 else ""
        return "\n".join([*lines, f"    return ({body.returned}{comma})", ""])

    def prepare(self, careful: bool = False) -> str:
        """The text of the function that makes the constants `c` of the parameters `p`."""
        body = _Body(self, list(self.constants.places), careful, preparing=True)
        doc = (
            '    """The constants of a run: its parameters, and what is computed of them alone."""'
        )
        nothing = ", ".join(["0.0"] * OF_THE_PAST) if self.constants.delays else ""
        returned = ", ".join(part for part in ("*p", nothing, body.returned) if part)
        return "\n".join(["def prepare(p):", doc, *body.lines, f"    return ({returned},)", ""])


class _Body:
    def __init__(
        self, writer: Writer, roots: Sequence[int], careful: bool, preparing: bool = False
    ) -> None:
        self.writer, self.careful, self.preparing = writer, careful, preparing
        self.tape = writer.tape
        self.lines: list[str] = []
        self.texts: dict[int, str] = {}
        order = self.tape.needed(roots) if preparing else writer.constants.order(roots)
        uses = Counter(o for i in order if not self.is_leaf(i) for o in self.operands(i))
        uses.update(roots)
        for index in order:
            if self.tape.entries[index].op == "newton":  # what a search reads is computed before
                uses.update(self.operands(index))
        for index in order:
            text = self.text(index)
            label = writer.labels.get(index)
            plain = self.is_leaf(index) and uses[index] < 2
            short = uses[index] < 2 and len(text) <= CODE.longest_inline and label is None
            if plain or short or self.tape.entries[index].op in INLINE:
                self.texts[index] = text
            else:
                self.texts[index] = label or f"v{index}"
                self.lines.append(f"    {self.texts[index]} = {text}")
        self.returned = ", ".join(_bare(self.texts[root]) for root in roots)

    def is_leaf(self, index: int) -> bool:
        return not self.operands(index)

    def operands(self, index: int) -> tuple[int, ...]:
        return () if self.place(index) is not None else self.tape.entries[index].operands

    def place(self, index: int) -> int | None:
        return None if self.preparing else self.writer.constants.place(index)

    def text(self, index: int) -> str:
        entry = self.tape.entries[index]
        if entry.op == "const":
            value = float(entry.payload)
            return f"({value!r})" if value < 0 else repr(value)
        place = self.place(index)
        if place is not None:
            return f"c[{place}]"
        match entry.op:
            case "t":
                return "t"
            case "state":
                return f"x[{entry.payload}]"
            case "param":
                return f"p[{entry.payload}]"
            case "mode":
                return f"m[{entry.payload}]"
            case "hold":
                return f"m[{self.writer.modes} + {entry.payload}]"
            case "table":
                return f"k, {entry.payload}"
            case "history" | "history_rate":
                return f"c[{self.writer.constants.parameters}], {entry.payload}"
            case "record":
                return f"c[{self.writer.constants.parameters + 1}], {entry.payload}"
            case "record_begin":
                return f"c[{self.writer.constants.parameters + 2}]"
            case "past" | "recorded":
                texts = [_bare(self.texts[operand]) for operand in entry.operands]
                stretch = ["0.0"] if entry.op == "recorded" else []
                return f"past({', '.join([*texts, *stretch])}, {entry.payload})"
            case "newton":
                return self.search(index)
            case "pick":
                return f"{self.texts[entry.operands[0]]}[{entry.payload}]"
        return self.operation(entry.op, [self.texts[operand] for operand in entry.operands])

    def search(self, index: int) -> str:
        """Write the function of a search, and give the text that calls it."""
        entry = self.tape.entries[index]
        implicit = self.tape.implicits[int(entry.payload)]
        roots = (*implicit.residuals, *implicit.steps)
        unknowns = [f"z{n}" for n in range(len(implicit.unknowns))]
        self.texts |= dict(zip(implicit.unknowns, unknowns, strict=True))
        self.lines.append(f"    def equations{entry.payload}({', '.join(unknowns)}):")
        for inner in self.tape.searched(roots):
            text = self.text(inner)
            self.texts[inner] = f"v{inner}"
            self.lines.append(f"        v{inner} = {text}")
        returned = ", ".join(_bare(self.texts[root]) for root in roots)
        self.lines.append(f"        return ({returned})")
        guesses = "".join(f"{_bare(self.texts[g])}, " for g in entry.operands[: len(unknowns)])
        return f"newton(equations{entry.payload}, ({guesses.rstrip()}))"

    def operation(self, op: str, a: list[str]) -> str:
        match op:
            case "neg":
                return f"(-{a[0]})"
            case "/" if self.careful:
                return f"divide({_bare(a[0])}, {_bare(a[1])})"
            case "+" | "-" | "*" | "/":
                return f"({a[0]} {op} {a[1]})"
            case "**":
                return f"pow({_bare(a[0])}, {_bare(a[1])})"
            case "select":
                return f"({a[1]} if {a[0]} else {_bare(a[2])})"
            case "not":
                return f"(1.0 - {a[0]})"
            case "and":
                return f"({a[0]} * {a[1]})"
            case "or":
                return f"max({a[0]}, {a[1]})"
            case "ge":
                return f"(1.0 if {a[0]} >= {a[1]} else 0.0)"
            case "gt":
                return f"(1.0 if {a[0]} > {a[1]} else 0.0)"
        return f"{op}({', '.join(map(_bare, a))})"


def _bare(text: str) -> str:
    """The text without a pair of brackets round the whole of it."""
    if not (text.startswith("(") and text.endswith(")")):
        return text
    depth = 0
    for position, sign in enumerate(text):
        depth += (sign == "(") - (sign == ")")
        if depth == 0:
            return text[1:-1] if position == len(text) - 1 else text
    return text


def load(source: str, careful: bool) -> dict[str, Any]:
    """The functions of a source text that a Writer made."""
    namespace: dict[str, Any] = {"__builtins__": {}}
    namespace |= _careful() if careful else FAST
    exec(compile(source, "<tracewire model>", "exec"), namespace)
    return namespace


def guarded(fast: Function, careful: Function) -> Function:
    """The fast function; where it raises, what the careful one gives."""

    def call(*arguments: Any) -> tuple[float, ...]:
        try:
            return fast(*arguments)
        except (ZeroDivisionError, ValueError, OverflowError):
            return careful(*arguments)

    return call
