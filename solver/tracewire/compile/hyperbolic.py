"""sinh, cosh and tanh by one exponential, which those of the same argument share.

With e = expm1(|u|), which is exact to the last digits for small u, too:

    cosh u = 1 + e/2*e/(1 + e)      sinh |u| = e/2 + e/(1 + e)/2      tanh |u| = s/(s + 2)

where s = e*(e + 2) = expm1(2|u|). From |u| = `CODE.far` on cosh u and sinh |u| are (e + 1)/2 and
tanh |u| is 1, to the last digit. Python and machine code take the same steps in the same order, so
that both give the same bits. They are within three units in the last place of the true values. The
largest |u| is that of exp, 709.78; beyond it sinh and cosh are infinite.

A friction law with a bump reads cosh and tanh of one speed: two functions of the C library cost it
a tenth of a run.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from tracewire.compile.limits import CODE

BASE = "expm1"
COPY_SIGN = "llvm.copysign.f64"

Real = Callable[[float], float]


def hyperbolic(expm1: Real) -> dict[str, Real]:
    """The three as Python functions, made of this one."""

    def sinh(u: float) -> float:
        e = expm1(abs(u))
        half = 0.5 * e
        return math.copysign(half + (0.5 if abs(u) > CODE.far else 0.5 * (e / (1.0 + e))), u)

    def cosh(u: float) -> float:
        e = expm1(abs(u))
        half = 0.5 * e
        return half + 0.5 if abs(u) > CODE.far else 1.0 + half * (e / (1.0 + e))

    def tanh(u: float) -> float:
        e = expm1(abs(u))
        s = e * (e + 2.0)
        return math.copysign(1.0 if abs(u) > CODE.far else s / (s + 2.0), u)

    return {"sinh": sinh, "cosh": cosh, "tanh": tanh}


def exponential(u: str, name: str, prefix: str) -> list[str]:
    """The IR of e and of whether |u| is far out, `%name` and `%name.far`; they serve all three."""
    return [
        f"%{name}.abs = call double @llvm.fabs.f64(double {u})",
        f"%{name}.far = fcmp ogt double %{name}.abs, {CODE.far}",
        f"%{name} = call double @{prefix}{BASE}(double %{name}.abs)",
        f"%{name}.half = fmul double 0.5, %{name}",
    ]


def from_exponential(function: str, u: str, e: str, to: str) -> list[str]:
    """The IR of one of the three, of u, into `to`; `e` is the name that `exponential` was given."""
    if function == "tanh":
        return [
            f"{to}.q = fadd double %{e}, 2.0",
            f"{to}.s = fmul double %{e}, {to}.q",
            f"{to}.t = fadd double {to}.s, 2.0",
            f"{to}.near = fdiv double {to}.s, {to}.t",
            f"{to}.size = select i1 %{e}.far, double 1.0, double {to}.near",
            f"{to} = call double @{COPY_SIGN}(double {to}.size, double {u})",
        ]
    share = [
        f"{to}.one = fadd double 1.0, %{e}",
        f"{to}.share = fdiv double %{e}, {to}.one",
    ]
    if function == "sinh":
        return [
            *share,
            f"{to}.part = fmul double 0.5, {to}.share",
            f"{to}.rest = select i1 %{e}.far, double 0.5, double {to}.part",
            f"{to}.size = fadd double %{e}.half, {to}.rest",
            f"{to} = call double @{COPY_SIGN}(double {to}.size, double {u})",
        ]
    return [
        *share,
        f"{to}.part = fmul double %{e}.half, {to}.share",
        f"{to}.near = fadd double 1.0, {to}.part",
        f"{to}.away = fadd double %{e}.half, 0.5",
        f"{to} = select i1 %{e}.far, double {to}.away, double {to}.near",
    ]
