"""sinh, cosh, tanh and sech by one exponential, which those of the same argument share.

With e = exp(|u|) - 1, which is exact to the last digits for small u, too:

    cosh u = 1 + e/2*e/(1 + e)      sinh |u| = e/2 + e/(1 + e)/2
    tanh |u| = s/(s + 2)            sech u = 2*(1 + e)/(s + 2)

where s = e*(e + 2) = exp(2|u|) - 1. From |u| = `CODE.far` on cosh u and sinh |u| are (e + 1)/2 and
tanh |u| is 1, to the last digit. From |u| = 1 on e is the difference itself: it loses no digit
there, and exp takes half of the time of expm1. Python and machine code take the same steps in the
same order, so that both give the same bits. They are within three units in the last place of the
true values. The largest |u| is that of exp, 709.78; beyond it sinh and cosh are infinite.

A friction law with a bump reads tanh and 1/cosh of one speed. Two functions of the C library cost
it a tenth of a run, and cosh with a division by it a twentieth: sech divides once.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from tracewire.compile.libm import PREFIX
from tracewire.compile.limits import CODE

SMALL, LARGE = "expm1", "exp"
"""The functions of the C library that e is made of, below and from |u| = 1."""
COPY_SIGN = "llvm.copysign.f64"

GROWTH = f"""define internal double @growth(double %size) nounwind {{
  %is.large = fcmp oge double %size, 1.0
  br i1 %is.large, label %large, label %small
large:
  %power = call double @{PREFIX}{LARGE}(double %size)
  %difference = fsub double %power, 1.0
  ret double %difference
small:
  %exact = call double @{PREFIX}{SMALL}(double %size)
  ret double %exact
}}"""
"""The IR of the function that makes e of |u|."""

Real = Callable[[float], float]


def hyperbolic(expm1: Real, exp: Real) -> dict[str, Real]:
    """The four as Python functions, made of these two."""

    def growth(size: float) -> float:
        return exp(size) - 1.0 if size >= 1.0 else expm1(size)

    def sinh(u: float) -> float:
        e = growth(abs(u))
        half = 0.5 * e
        return math.copysign(half + (0.5 if abs(u) > CODE.far else 0.5 * (e / (1.0 + e))), u)

    def cosh(u: float) -> float:
        e = growth(abs(u))
        half = 0.5 * e
        return half + 0.5 if abs(u) > CODE.far else 1.0 + half * (e / (1.0 + e))

    def tanh(u: float) -> float:
        e = growth(abs(u))
        s = e * (e + 2.0)
        return math.copysign(1.0 if abs(u) > CODE.far else s / (s + 2.0), u)

    def sech(u: float) -> float:
        e = growth(abs(u))
        if abs(u) > CODE.far:
            return 2.0 / (1.0 + e)
        return 2.0 * (1.0 + e) / (e * (e + 2.0) + 2.0)

    return {"sinh": sinh, "cosh": cosh, "tanh": tanh, "sech": sech}


def exponential(u: str, name: str) -> list[str]:
    """The IR of e and of what all four need of it, under names that begin with `%name`."""
    return [
        f"%{name}.abs = call double @llvm.fabs.f64(double {u})",
        f"%{name}.far = fcmp ogt double %{name}.abs, {CODE.far}",
        f"%{name} = call double @growth(double %{name}.abs)",
        f"%{name}.half = fmul double 0.5, %{name}",
        f"%{name}.one = fadd double 1.0, %{name}",
        f"%{name}.and2 = fadd double %{name}, 2.0",
        f"%{name}.s = fmul double %{name}, %{name}.and2",
        f"%{name}.under = fadd double %{name}.s, 2.0",
    ]


def from_exponential(function: str, u: str, e: str, to: str) -> list[str]:
    """The IR of one of the four, of u, into `to`; `e` is the name that `exponential` was given."""
    if function == "tanh":
        return [
            f"{to}.near = fdiv double %{e}.s, %{e}.under",
            f"{to}.size = select i1 %{e}.far, double 1.0, double {to}.near",
            f"{to} = call double @{COPY_SIGN}(double {to}.size, double {u})",
        ]
    if function == "sech":
        return [
            f"{to}.twice = fmul double 2.0, %{e}.one",
            f"{to}.above = select i1 %{e}.far, double 2.0, double {to}.twice",
            f"{to}.under = select i1 %{e}.far, double %{e}.one, double %{e}.under",
            f"{to} = fdiv double {to}.above, {to}.under",
        ]
    share = [f"{to}.share = fdiv double %{e}, %{e}.one"]
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
