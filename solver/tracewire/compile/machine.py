"""The second back end: LLVM IR from the tape, and its machine code.

All functions have the signature of C

    void f(double t, const double *x, const double *m, const double *c, const double *k,
           double *out)

The IR is written as text: it is read back ten times faster than it could be built of objects. No
operation is marked as fast or may be contracted, and the functions of mathematics are those of the
C library under names that LLVM knows nothing about, so results are the bits of the Python source.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence

from tracewire.compile import libm
from tracewire.compile.constants import Constants
from tracewire.compile.hyperbolic import COPY_SIGN, HYPERBOLIC, from_parts, parts_of
from tracewire.compile.libm import PREFIX
from tracewire.compile.limits import CODE
from tracewire.compile.past import PAST
from tracewire.compile.search import SearchText
from tracewire.compile.tape import Entry, Tape
from tracewire.formula import OPERATIONS

ARITHMETIC = {name: o.instruction for name, o in OPERATIONS.items() if o.instruction}
ARITHMETIC |= {"and": "fmul"}  # of 0 and 1
LIBRARY = {name: o.library for name, o in OPERATIONS.items() if o.library}
INTRINSIC = {name: o.intrinsic for name, o in OPERATIONS.items() if o.intrinsic}
FROM_PARTS = {name for name, o in OPERATIONS.items() if o.base}
ARGUMENTS = "double %t, " + ", ".join(f"ptr noalias readonly %{a}" for a in "xmck")
PURE = "nounwind willreturn readnone"

TABLE = """
  %at = getelementptr double, ptr %k, i64 %table
  %offset.f = load double, ptr %at
  %offset = fptosi double %offset.f to i64
  %start = getelementptr double, ptr %k, i64 %offset
  %count.f = load double, ptr %start
  %count = fptosi double %count.f to i64
  %x = getelementptr double, ptr %start, i64 1
  %y = getelementptr double, ptr %x, i64 %count
  %slope = getelementptr double, ptr %y, i64 %count
  %above = fcmp oge double %piece, 1.0
  %below = fcmp olt double %piece, %count.f
"""
INSIDE = """
  %i = fptosi double %piece to i64
  %j = sub i64 %i, 1
  %slope.p = getelementptr double, ptr %slope, i64 %j
  %slope.j = load double, ptr %slope.p
"""
SEGMENT = f"""define internal double @segment(ptr %k, i64 %table, double %u, double %piece)
{{{TABLE}
  br i1 %above, label %upper, label %first
first:
  %y.0 = load double, ptr %y
  ret double %y.0
upper:
  br i1 %below, label %inside, label %last
last:
  %last.j = sub i64 %count, 1
  %last.p = getelementptr double, ptr %y, i64 %last.j
  %last.y = load double, ptr %last.p
  ret double %last.y
inside:{INSIDE}
  %x.p = getelementptr double, ptr %x, i64 %j
  %x.j = load double, ptr %x.p
  %y.p = getelementptr double, ptr %y, i64 %j
  %y.j = load double, ptr %y.p
  %beyond = fsub double %u, %x.j
  %rise = fmul double %slope.j, %beyond
  %value = fadd double %y.j, %rise
  ret double %value
}}"""
SLOPE = f"""define internal double @slope(ptr %k, i64 %table, double %piece) {{{TABLE}
  %both = and i1 %above, %below
  br i1 %both, label %inside, label %outside
outside:
  ret double 0.0
inside:{INSIDE}
  ret double %slope.j
}}"""

FILL = """define internal void @fill(ptr %out, i64 %begin, i64 %end, double %value) {
  br label %next
next:
  %i = phi i64 [%begin, %0], [%j, %next]
  %place = getelementptr double, ptr %out, i64 %i
  store double %value, ptr %place
  %j = add i64 %i, 1
  %more = icmp ult i64 %j, %end
  br i1 %more, label %next, label %done
done:
  ret void
}"""
HELPERS = {"segment": SEGMENT, "slope": SLOPE, "fill": FILL, "past": PAST, "hyperbolic": HYPERBOLIC}


def _module(functions: Sequence[str]) -> str:
    """The IR of a module with these functions and what they call."""
    body = "\n".join(functions)
    heads = [f"declare double @{PREFIX}{name}(double) {PURE}" for name in libm.ONE]
    heads += [f"declare double @{PREFIX}{name}(double, double) {PURE}" for name in libm.TWO]
    heads.append(f"declare void @{PREFIX}{libm.BOTH}(double, ptr, ptr) nounwind")
    heads += [f"declare double @{name}(double)" for name in INTRINSIC.values()]
    heads.append(f"declare double @{COPY_SIGN}(double, double)")
    heads += [text for name, text in HELPERS.items() if f"@{name}(" in body]
    return "\n".join([*heads, body, ""])


class MachineWriter:
    """Writes the IR of functions of one tape; `modes` is the number of modes."""

    def __init__(self, tape: Tape, constants: Constants, modes: int) -> None:
        self.tape, self.constants, self.modes = tape, constants, modes
        self.has_sincos = libm.has_sincos()

    def text(self, functions: Mapping[str, Mapping[int, int] | None]) -> str:
        """The IR of a module with functions by their names: of one that writes each root to its
        place in `out`, these; of the one that prepares the constants, None."""
        return _module(
            [
                self._prepare(name) if roots is None else self._function(name, roots)
                for name, roots in functions.items()
            ]
        )

    def _function(self, name: str, roots: Mapping[int, int]) -> str:
        return _Body(self, name, roots, self.constants.order(roots.values())).text()

    def _prepare(self, name: str) -> str:
        """The IR of the function that makes the constants `c` of the parameters `x`."""
        tape, constants = self.tape, self.constants
        roots = {place: index for index, place in constants.places.items()}
        count = constants.parameters
        roots |= {i: tape.push("param", payload=i) for i in range(count)}
        order = tape.needed(roots.values())
        return _Body(self, name, dict(sorted(roots.items())), order, preparing=True).text()


class _Body:
    def __init__(
        self,
        writer: MachineWriter,
        name: str,
        roots: Mapping[int, int],
        order: Sequence[int],
        preparing: bool = False,
    ) -> None:
        self.writer, self.name, self.preparing = writer, name, preparing
        self.entries = writer.tape.entries
        self.lines: list[str] = []
        self.names: dict[int, str] = {}  # of the entries that have been computed
        self.shared: dict[int, str] = {}  # of entries of which a sinh, cosh, tanh or sech is known
        self.pairs = self.sines_with_cosines(order) if writer.has_sincos else {}
        self.leaves: dict[int, str] = {}  # those that were loaded in this part of the function
        self.parts = 0
        self.allocations: list[str] = []
        self.results: dict[int, list[str]] = {}  # of each search, its unknowns
        places: dict[int, list[int]] = {}
        for place, root in roots.items():
            places.setdefault(root, []).append(place)
        begin = 0
        for index in order:
            if index not in self.names and self.is_computed(index):
                self.compute(index)
            if index in self.names or index in places:
                for done in {index, *self.pairs.get(index, ())} & places.keys():
                    self.store(done, places.pop(done))
            if len(self.lines) > begin + CODE.part:
                self.begin_part()
                begin = len(self.lines)

    def store(self, index: int, places: Sequence[int]) -> None:
        """Write a root as soon as it is known: it need not be kept till the end."""
        value = self.value(index)
        for begin, end in _runs(places):
            if end - begin > CODE.longest_run:
                call = f"call void @fill(ptr %out, i64 {begin}, i64 {end}, double {value})"
                self.lines.append(call)
                continue
            for place in range(begin, end):
                self.lines.append(f"store double {value}, ptr {self.pointer('out', place)}")

    def begin_part(self) -> None:
        """Begin a new basic block. The time that a block takes to compile grows with its square.

        The branch is never taken, `out` is no null; but LLVM cannot know, and so does not join the
        parts again.
        """
        self.parts += 1
        name = f"part{self.parts}"
        self.lines += [f"br i1 %never, label %end, label %{name}", f"{name}:"]
        self.leaves.clear()

    def text(self) -> str:
        lines = [f"define void @{self.name}({ARGUMENTS}, ptr noalias %out) nounwind {{"]
        if self.pairs:
            lines += ["%sine = alloca double", "%cosine = alloca double"]
        lines += self.allocations
        if self.parts:
            lines.append("%never = icmp eq ptr %out, null")
        lines += self.lines
        if self.parts:
            lines += ["br label %end", "end:"]
        return "\n".join([*lines, "ret void", "}"])

    def sines_with_cosines(self, order: Sequence[int]) -> dict[int, tuple[int, int]]:
        """Sines and cosines of the same entry, each with both: one call gives the two."""
        found: dict[str, dict[int, int]] = {"sin": {}, "cos": {}}
        for index in order:
            entry = self.entries[index]
            if entry.op in found and self.is_computed(index):
                found[entry.op][entry.operands[0]] = index
        both = [(s, found["cos"][a]) for a, s in found["sin"].items() if a in found["cos"]]
        return {index: pair for pair in both for index in pair}

    def is_computed(self, index: int) -> bool:
        return bool(self.entries[index].operands) and self.place(index) is None

    def is_comparison(self, index: int) -> bool:
        """Whether an entry is computed here by a comparison, whose bit is there to be used."""
        return self.is_computed(index) and self.entries[index].op in ("ge", "gt")

    def place(self, index: int) -> int | None:
        return None if self.preparing else self.writer.constants.place(index)

    def pointer(self, array: str, place: int) -> str:
        pointer = f"%{array}.p{place}.{len(self.lines)}"
        self.lines.append(f"{pointer} = getelementptr inbounds double, ptr %{array}, i64 {place}")
        return pointer

    def value(self, index: int) -> str:
        """What stands for an entry in the IR; a leaf is loaded where it is first used."""
        name = self.names.get(index) or self.leaves.get(index)
        if name is None:
            name = self.leaves[index] = self.leaf(index)
        return name

    def leaf(self, index: int) -> str:
        entry, place = self.entries[index], self.place(index)
        if entry.op == "const":
            (bits,) = struct.unpack("<Q", struct.pack("<d", entry.payload))
            return f"0x{bits:016X}"
        if place is not None:
            return self.load("c", place)
        match entry.op:
            case "t":
                return "%t"
            case "table" | "history" | "history_rate" | "record":
                return f"i64 {entry.payload}"
            case "state" | "param":
                return self.load("x", int(entry.payload))
            case "mode":
                return self.load("m", int(entry.payload))
            case "hold":
                return self.load("m", self.writer.modes + int(entry.payload))
            case "record_begin":
                return self.load("c", self.writer.constants.parameters + 2)
        raise AssertionError(f"no IR of the leaf {entry.op}")

    def load(self, array: str, place: int) -> str:
        pointer = self.pointer(array, place)
        name = f"%{array}{place}.{len(self.lines)}"
        self.lines.append(f"{name} = load double, ptr {pointer}")
        return name

    def compute(self, index: int) -> None:
        entry = self.entries[index]
        if index in self.pairs:
            self.compute_pair(*self.pairs[index])
            return
        if entry.op == "pick":
            self.names[index] = self.results[entry.operands[0]][int(entry.payload)]
            return
        operands = [self.value(operand) for operand in entry.operands]
        name = self.names[index] = f"%v{index}"
        if entry.op == "newton":
            self.search(index, operands)
        elif entry.op in FROM_PARTS:
            parts = self.parts_of(entry.operands[0], operands[0])
            self.lines += from_parts(entry.op, operands[0], parts, name)
        else:
            self.lines += self.operation(entry, name, operands)

    def parts_of(self, index: int, u: str) -> str:
        """The name of what the hyperbolic functions of an entry share, computed once."""
        if index not in self.shared:
            self.shared[index] = f"h{index}"
            self.lines += parts_of(u, f"h{index}")
        return self.shared[index]

    def search(self, index: int, operands: Sequence[str]) -> None:
        """The search of a nonlinear system, with its equations in the middle of it."""
        tape = self.writer.tape
        implicit = tape.implicits[int(self.entries[index].payload)]
        text = SearchText(f"v{index}", len(implicit.unknowns))
        self.allocations += text.allocations()
        self.lines += text.begin(operands[: len(implicit.unknowns)])
        self.names |= dict(zip(implicit.unknowns, text.unknowns, strict=True))
        for inner in tape.searched((*implicit.residuals, *implicit.steps)):
            self.compute(inner)
        residuals = [self.value(entry) for entry in implicit.residuals]
        self.lines += text.end(residuals, [self.value(entry) for entry in implicit.steps])
        self.results[index] = text.results

    def compute_pair(self, sine: int, cosine: int) -> None:
        angle = self.value(self.entries[sine].operands[0])
        call = f"call void @{PREFIX}{libm.BOTH}(double {angle}, ptr %sine, ptr %cosine)"
        self.lines.append(call)
        for index, place in ((sine, "%sine"), (cosine, "%cosine")):
            self.names[index] = f"%v{index}"
            self.lines.append(f"%v{index} = load double, ptr {place}")

    def operation(self, entry: Entry, name: str, a: Sequence[str]) -> list[str]:
        """The lines that compute an entry from its operands."""
        op = entry.op
        listed = ", ".join(f"double {operand}" for operand in a)
        if op in ARITHMETIC:
            return [f"{name} = {ARITHMETIC[op]} double {a[0]}, {a[1]}"]
        if op in LIBRARY:
            return [f"{name} = call double @{PREFIX}{LIBRARY[op]}({listed})"]
        if op in INTRINSIC:
            return [f"{name} = call double @{INTRINSIC[op]}({listed})"]
        match op:
            case "neg":
                return [f"{name} = fneg double {a[0]}"]
            case "not":
                return [f"{name} = fsub double 1.0, {a[0]}"]
            case "ge" | "gt" | "or":
                lines = [f"{name}.i = fcmp o{op if op != 'or' else 'gt'} double {a[0]}, {a[1]}"]
                if op == "or":  # the larger one
                    return [*lines, f"{name} = select i1 {name}.i, {listed}"]
                return [*lines, f"{name} = uitofp i1 {name}.i to double"]
            case "select":
                if self.is_comparison(entry.operands[0]):
                    return [f"{name} = select i1 {a[0]}.i, double {a[1]}, double {a[2]}"]
                test = f"{name}.i = fcmp une double {a[0]}, 0.0"
                return [test, f"{name} = select i1 {name}.i, double {a[1]}, double {a[2]}"]
            case "segment" | "slope":
                rest = ", ".join(f"double {operand}" for operand in a[1:])
                return [f"{name} = call double @{op}(ptr %k, {a[0]}, {rest})"]
            case "past" | "recorded":
                own = op == "recorded"
                address = self.load("c", self.writer.constants.parameters + int(own))
                stretch = "0.0" if own else a[2]
                rest = f"double {a[1]}, double {stretch}, i64 {entry.payload}"
                return [f"{name} = call double @past(double {address}, {a[0]}, {rest})"]
        raise AssertionError(f"no IR of {op}")


def _runs(places: Sequence[int]) -> list[tuple[int, int]]:
    """Ascending places as runs [begin, end) of neighbours."""
    runs: list[tuple[int, int]] = []
    for place in places:
        if runs and runs[-1][1] == place:
            runs[-1] = runs[-1][0], place + 1
        else:
            runs.append((place, place + 1))
    return runs
