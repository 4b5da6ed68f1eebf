"""The first back end: readable Python source from the tape.

Every function takes the time `t`, the states `x`, the modes `m` (holds behind them), the constants
`c` that `prepare` made of the parameters, and the tables `k`. A second, `careful` version of each
function gives NaN or infinity where Python would raise; it runs only where the first one failed.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from tracewire.compile.tape import Tape

LONGEST_INLINE = 60
MATH = "sin cos tan asin acos atan atan2 sinh cosh tanh exp log sqrt floor pow"

Function = Callable[..., tuple[float, ...]]


def _careful(function: Callable[..., float]) -> Callable[..., float]:
    def call(*arguments: float) -> float:
        try:
            return function(*arguments)
        except OverflowError:
            return math.inf
        except (ValueError, ZeroDivisionError):
            return math.nan

    return call


def _divide(a: float, b: float) -> float:
    if b == 0.0:
        return math.nan if a == 0.0 or a != a else math.copysign(math.inf, a) * math.copysign(1, b)
    return a / b


def _segment(table: tuple[Sequence[float], ...], u: float, piece: float) -> float:
    """The straight line of a piece; outside the points the table is held."""
    x, y, slope = table
    i = int(piece)
    if i <= 0:
        return y[0]
    if i >= len(x):
        return y[-1]
    return y[i - 1] + slope[i - 1] * (u - x[i - 1])


def _slope(table: tuple[Sequence[float], ...], piece: float) -> float:
    x, _, slope = table
    i = int(piece)
    return 0.0 if i <= 0 or i >= len(x) else slope[i - 1]


FAST: dict[str, Any] = {name: getattr(math, name) for name in MATH.split()}
FAST |= {"segment": _segment, "slope": _slope}
CAREFUL: dict[str, Any] = {name: _careful(getattr(math, name)) for name in MATH.split()}
CAREFUL |= {"segment": _segment, "slope": _slope, "divide": _divide}


class Writer:
    """Writes functions of one tape; what only reads parameters is collected for `prepare`."""

    def __init__(self, tape: Tape, labels: Mapping[int, str], parameters: Sequence[str]) -> None:
        self.tape, self.labels, self.parameters = tape, labels, parameters
        self.constants: dict[int, int] = {}
        self.fixed: dict[int, bool] = {}

    def is_fixed(self, index: int) -> bool:
        """Whether an entry reads only parameters."""
        found = self.fixed.get(index)
        if found is None:
            for i in self.tape.needed([index]):
                entry = self.tape.entries[i]
                self.fixed[i] = entry.op in ("param", "const") or (
                    bool(entry.operands) and all(self.fixed[o] for o in entry.operands)
                )
            found = self.fixed[index]
        return found

    def function(self, name: str, doc: str, roots: Sequence[int], careful: bool = False) -> str:
        """The text of a function that returns the roots as a tuple."""
        body = _Body(self, roots, careful)
        lines = [f"def {name}(t, x, m, c, k):", f'    """{doc}"""', *body.lines]
        return "\n".join([*lines, f"    return ({body.returned})", ""])

    def prepare(self, careful: bool = False) -> str:
        """The text of the function that makes the constants `c` of the parameters `p`."""
        body = _Body(self, list(self.constants), careful, preparing=True)
        doc = '    """The constants of a run, from its parameters."""'
        return "\n".join(["def prepare(p):", doc, *body.lines, f"    return ({body.returned})", ""])


class _Body:
    def __init__(
        self, writer: Writer, roots: Sequence[int], careful: bool, preparing: bool = False
    ) -> None:
        self.writer, self.careful, self.preparing = writer, careful, preparing
        self.tape = writer.tape
        self.lines: list[str] = []
        self.texts: dict[int, str] = {}
        order = self.reached(roots)
        uses = Counter(o for i in order if not self.is_leaf(i) for o in self.operands(i))
        uses.update(roots)
        for index in order:
            text = self.text(index)
            label = writer.labels.get(index)
            plain = self.is_leaf(index) and uses[index] < 2
            short = uses[index] < 2 and len(text) <= LONGEST_INLINE and label is None
            if plain or short or self.tape.entries[index].op in ("const", "table"):
                self.texts[index] = text
            else:
                self.texts[index] = label or f"v{index}"
                self.lines.append(f"    {self.texts[index]} = {text}")
        returned = ", ".join(_bare(self.texts[root]) for root in roots)
        self.returned = returned + ("," if len(roots) == 1 else "")

    def is_leaf(self, index: int) -> bool:
        return not self.operands(index)

    def operands(self, index: int) -> tuple[int, ...]:
        if not self.preparing and self.writer.is_fixed(index):
            return ()
        return self.tape.entries[index].operands

    def reached(self, roots: Sequence[int]) -> list[int]:
        """The entries that this function computes, in order; it stops at constants of the run."""
        wanted: set[int] = set()
        stack = list(roots)
        while stack:
            index = stack.pop()
            if index not in wanted:
                wanted.add(index)
                stack.extend(self.operands(index))
        return sorted(wanted)

    def text(self, index: int) -> str:
        entry = self.tape.entries[index]
        if entry.op == "const":
            value = float(entry.payload)
            return f"({value!r})" if value < 0 else repr(value)
        if not self.preparing and self.writer.is_fixed(index):
            position = self.writer.constants.setdefault(index, len(self.writer.constants))
            return f"c[{position}]"
        match entry.op:
            case "t":
                return "t"
            case "state":
                return f"x[{entry.payload}]"
            case "param":
                return f"p[{entry.payload}]"
            case "mode":
                return f"m[0][{entry.payload}]"
            case "hold":
                return f"m[1][{entry.payload}]"
            case "table":
                return f"k[{entry.payload}]"
        return self.operation(entry.op, [self.texts[operand] for operand in entry.operands])

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
    namespace: dict[str, Any] = {"__builtins__": {"max": max}}
    namespace |= CAREFUL if careful else FAST
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
