"""The search of a nonlinear system in LLVM IR: the steps that the docstring of the tape gives."""

from __future__ import annotations

import struct
from collections.abc import Sequence

from tracewire.compile.limits import SEARCH
from tracewire.formula import FUNCTIONS

FABS = FUNCTIONS["abs"].intrinsic


def bits(value: float) -> str:
    """A number as LLVM writes it exactly."""
    return f"0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016X}"


class SearchText:
    """The IR of one search: `begin`, then the caller's equations at the unknowns, then `end`.

    tag: makes its names its own; size: how many unknowns it has.
    """

    def __init__(self, tag: str, size: int) -> None:
        self.tag, self.range = tag, range(size)
        self.unknowns = [f"%{tag}.z{j}" for j in self.range]
        self.results = [f"%{tag}.x{j}" for j in self.range]
        numbered = (f"{n}{j}" for n in ("at", "old", "step", "scale") for j in self.range)
        self.slots = [self.slot(name) for name in (*numbered, "worst", "share")]

    def slot(self, name: str) -> str:
        return f"%{self.tag}.slot.{name}"

    def allocations(self) -> list[str]:
        """What stands at the begin of the function."""
        count = f"{self.slot('count')} = alloca i64"
        return [*(f"{slot} = alloca double" for slot in self.slots), count]

    def store(self, value: str, name: str) -> str:
        return f"store double {value}, ptr {self.slot(name)}"

    def load(self, result: str, name: str) -> str:
        return f"%{self.tag}.{result} = load double, ptr {self.slot(name)}"

    def size_of(self, value: str, result: str) -> str:
        return f"%{self.tag}.{result} = call double @{FABS}(double {value})"

    def begin(self, guesses: Sequence[str]) -> list[str]:
        """Up to the place where the residuals and steps at `unknowns` are computed."""
        lines = []
        for j, guess in enumerate(guesses):
            lines += [
                self.size_of(guess, f"first{j}"),
                *(self.store(guess, f"{name}{j}") for name in ("at", "old")),
                self.store("0.0", f"step{j}"),
                self.store(f"%{self.tag}.first{j}", f"scale{j}"),
            ]
        return [
            *lines,
            self.store(bits(float("inf")), "worst"),
            self.store("1.0", "share"),
            f"store i64 0, ptr {self.slot('count')}",
            f"br label %{self.tag}.search",
            f"{self.tag}.search:",
            *(self.load(f"z{j}", f"at{j}") for j in self.range),
        ]

    def end(self, residuals: Sequence[str], steps: Sequence[str]) -> list[str]:
        """From the residuals and steps on; the unknowns are `results` then."""
        tag = self.tag
        lines = self.judge(residuals, steps)
        lines += [
            f"br i1 %{tag}.shorter, label %{tag}.back, label %{tag}.on",
            f"{tag}.back:",
            f"%{tag}.half = fmul double %{tag}.share, {bits(0.5)}",
            self.store(f"%{tag}.half", "share"),
        ]
        for j in self.range:
            lines += [
                self.load(f"o{j}", f"old{j}"),
                self.load(f"l{j}", f"step{j}"),
                f"%{tag}.b{j} = fmul double %{tag}.half, %{tag}.l{j}",
                f"%{tag}.c{j} = fsub double %{tag}.o{j}, %{tag}.b{j}",
                self.store(f"%{tag}.c{j}", f"at{j}"),
            ]
        lines += [f"br label %{tag}.next", f"{tag}.on:", self.store("1.0", "share")]
        lines.append(self.store(f"%{tag}.worst", "worst"))
        for j, step in enumerate(steps):
            lines += [
                self.store(self.unknowns[j], f"old{j}"),
                self.store(step, f"step{j}"),
                f"%{tag}.n{j} = fsub double {self.unknowns[j]}, {step}",
                self.store(f"%{tag}.n{j}", f"at{j}"),
                self.size_of(f"%{tag}.n{j}", f"m{j}"),
                f"%{tag}.g{j} = fcmp ogt double %{tag}.m{j}, %{tag}.s{j}",
                f"%{tag}.t{j} = select i1 %{tag}.g{j}, double %{tag}.m{j}, double %{tag}.s{j}",
                self.store(f"%{tag}.t{j}", f"scale{j}"),
            ]
        lines += self.close("t", "now")
        return [
            *lines,
            f"br i1 %{tag}.now, label %{tag}.done, label %{tag}.next",
            f"{tag}.next:",
            f"%{tag}.i = load i64, ptr {self.slot('count')}",
            f"%{tag}.j = add i64 %{tag}.i, 1",
            f"store i64 %{tag}.j, ptr {self.slot('count')}",
            f"%{tag}.more = icmp slt i64 %{tag}.j, {SEARCH.most_steps}",
            f"br i1 %{tag}.more, label %{tag}.search, label %{tag}.lost",
            f"{tag}.lost:",
            *(self.store(bits(float("nan")), f"at{j}") for j in self.range),
            f"br label %{tag}.done",
            f"{tag}.done:",
            *(self.load(f"x{j}", f"at{j}") for j in self.range),
        ]

    def judge(self, residuals: Sequence[str], steps: Sequence[str]) -> list[str]:
        """Whether the last step went too far."""
        tag, worst = self.tag, ""
        lines = []
        for j, (residual, step) in enumerate(zip(residuals, steps, strict=True)):
            lines.append(f"%{tag}.r{j} = fmul double {residual}, {residual}")
            if j:
                lines.append(f"%{tag}.w{j} = fadd double {worst}, %{tag}.r{j}")
            worst = f"%{tag}.w{j}" if j else f"%{tag}.r{j}"
            lines += [self.size_of(step, f"a{j}"), self.load(f"s{j}", f"scale{j}")]
        return [
            *lines,
            f"%{tag}.worst = fadd double {worst}, {bits(-0.0)}",
            *self.close("s", "near"),
            self.load("least", "worst"),
            self.load("share", "share"),
            f"%{tag}.worse = fcmp uge double %{tag}.worst, %{tag}.least",
            f"%{tag}.long = fcmp ogt double %{tag}.share, {bits(SEARCH.least_share)}",
            f"%{tag}.far = xor i1 %{tag}.near, true",
            f"%{tag}.both = and i1 %{tag}.worse, %{tag}.long",
            f"%{tag}.shorter = and i1 %{tag}.both, %{tag}.far",
        ]

    def close(self, scale: str, result: str) -> list[str]:
        """Whether each step is small against its scale."""
        tag = self.tag
        lines = [f"%{tag}.{result}.0 = and i1 true, true"]
        for j in self.range:
            lines += [
                f"%{tag}.{result}.p{j} = fmul double {bits(SEARCH.close)}, %{tag}.{scale}{j}",
                f"%{tag}.{result}.q{j} = fcmp ole double %{tag}.a{j}, %{tag}.{result}.p{j}",
                f"%{tag}.{result}.{j + 1} = and i1 %{tag}.{result}.{j}, %{tag}.{result}.q{j}",
            ]
        return [*lines, f"%{tag}.{result} = and i1 true, %{tag}.{result}.{len(self.range)}"]
