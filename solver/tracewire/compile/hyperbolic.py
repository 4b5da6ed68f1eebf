"""sinh, cosh, tanh and sech by what those of the same argument share.

From |u| = `CODE.near` on that is g = exp(|u|):

    tanh |u| = (g^2 - 1)/(g^2 + 1)      sinh |u| = (g^2 - 1)/(2g)
    sech u = 2g/(g^2 + 1)               cosh u = (g^2 + 1)/(2g)

and from `CODE.far` on, where 1 is less than half a digit of g^2, tanh |u| is 1 and the others are
g/2 and 2/g. Below `CODE.near` it is Pade's tanh z = z*P/D of z = u/2, right to a part of 2e-18:

    sech u = (D^2 - z^2*P^2)/(D^2 + z^2*P^2)

and cosh u its inverse. tanh u = 2*z*P*D/(D^2 + z^2*P^2) and sinh u = 2*z*P*D/(D^2 - z^2*P^2) are
computed as u and what differs from it, which loses no digit: with D = P + z^2*T

    tanh u = u - u*z^2*(P^2 + D*T)/(D^2 + z^2*P^2)
    sinh u = u + u*z^2*(P^2 - D*T)/(D^2 - z^2*P^2)

Python and machine code take the same steps in the same order, so that both give the same bits. They
are within three units in the last place of the true values. The largest |u| is that of exp, 709.78;
beyond it sinh and cosh are infinite.

A friction law with a bump reads tanh and sech of one speed, which is small most of the time: a run
waits for them, and what counts is how many steps follow on each other, of which each division is
the longest.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from tracewire.compile.libm import PREFIX
from tracewire.compile.limits import CODE

COPY_SIGN = "llvm.copysign.f64"
# of z^2, added as (a + b*z^2) + z^4*(c + d*z^2): fewer steps follow on each other
P = (135135.0, 17325.0, 378.0, 1.0)
D = (135135.0, 62370.0, 3150.0, 28.0)
T = (45045.0, 2772.0, 27.0)


class Parts(NamedTuple):
    """What the four share: tanh u = start + odd/plus, sinh u = start + bent/minus, sech u =
    minus/plus and cosh u = plus/minus."""

    start: float
    odd: float
    bent: float
    plus: float
    minus: float


Real = Callable[[float], float]


def _polynomial(coefficients: tuple[float, ...], q: float, qq: float) -> float:
    a, b, high, *more = coefficients
    for d in more:
        high += d * q
    return (a + b * q) + qq * high


def hyperbolic(exp: Real) -> dict[str, Real]:
    """The four as Python functions, made of this one."""

    def parts(u: float) -> Parts:
        if abs(u) < CODE.near:
            z = 0.5 * u
            q = z * z
            qq, uq = q * q, u * q
            p, d, t = _polynomial(P, q, qq), _polynomial(D, q, qq), _polynomial(T, q, qq)
            pp, dd, dt = p * p, d * d, d * t
            less = q * pp
            return Parts(u, -uq * (pp + dt), uq * (pp - dt), dd + less, dd - less)
        g = exp(abs(u))
        if abs(u) > CODE.far:
            odd = math.copysign(g, u)
            return Parts(0.0, odd, odd, g, 2.0)
        square = g * g
        odd = math.copysign(square - 1.0, u)
        return Parts(0.0, odd, odd, square + 1.0, 2.0 * g)

    def sinh(u: float) -> float:
        of = parts(u)
        return of.start + of.bent / of.minus

    def cosh(u: float) -> float:
        of = parts(u)
        return of.plus / of.minus

    def tanh(u: float) -> float:
        of = parts(u)  # of -0.0 the sum is 0.0
        return math.copysign(1.0 if abs(u) > CODE.far else of.start + of.odd / of.plus, u)

    def sech(u: float) -> float:
        of = parts(u)
        return of.minus / of.plus

    return {"sinh": sinh, "cosh": cosh, "tanh": tanh, "sech": sech}


STRUCT = f"{{{', '.join(['double'] * len(Parts._fields))}}}"
"""The IR of the type of `Parts`."""


def _polynomial_lines(name: str, coefficients: tuple[float, ...]) -> list[str]:
    """The IR of the polynomial into `%name`."""
    a, b, c, *more = coefficients
    lines, high = [], repr(c)
    for d in more:
        high = f"%{name}.cd"
        lines += [f"%{name}.d = fmul double {d!r}, %q", f"{high} = fadd double {c!r}, %{name}.d"]
    return [
        *lines,
        f"%{name}.high = fmul double %qq, {high}",
        f"%{name}.b = fmul double {b!r}, %q",
        f"%{name}.low = fadd double {a!r}, %{name}.b",
        f"%{name} = fadd double %{name}.low, %{name}.high",
    ]


def _returned(where: str, **parts: str) -> list[str]:
    """The IR that returns `Parts`, each by what it is."""
    lines, whole = [], "undef"
    for place, part in enumerate(Parts._fields):
        to = f"%{where}.{part}"
        lines.append(f"{to} = insertvalue {STRUCT} {whole}, double {parts[part]}, {place}")
        whole = to
    return [*lines, f"ret {STRUCT} {whole}"]


HYPERBOLIC = "\n".join(
    [
        f"define internal {STRUCT} @hyperbolic(double %u) nounwind {{",
        "%size = call double @llvm.fabs.f64(double %u)",
        f"%is.near = fcmp olt double %size, {CODE.near}",
        "br i1 %is.near, label %near, label %away",
        "near:",
        "%z = fmul double 0.5, %u",
        "%q = fmul double %z, %z",
        "%qq = fmul double %q, %q",
        "%uq = fmul double %u, %q",
        *_polynomial_lines("p", P),
        *_polynomial_lines("d", D),
        *_polynomial_lines("t", T),
        "%pp = fmul double %p, %p",
        "%dd = fmul double %d, %d",
        "%dt = fmul double %d, %t",
        "%less = fmul double %q, %pp",
        "%both = fadd double %pp, %dt",
        "%uq.less = fneg double %uq",
        "%odd = fmul double %uq.less, %both",
        "%apart = fsub double %pp, %dt",
        "%bent = fmul double %uq, %apart",
        "%plus = fadd double %dd, %less",
        "%minus = fsub double %dd, %less",
        *_returned("near", start="%u", odd="%odd", bent="%bent", plus="%plus", minus="%minus"),
        "away:",
        f"%g = call double @{PREFIX}exp(double %size)",
        f"%is.far = fcmp ogt double %size, {CODE.far}",
        "br i1 %is.far, label %far, label %between",
        "far:",
        f"%whole = call double @{COPY_SIGN}(double %g, double %u)",
        *_returned("far", start="0.0", odd="%whole", bent="%whole", plus="%g", minus="2.0"),
        "between:",
        "%square = fmul double %g, %g",
        "%rest = fsub double %square, 1.0",
        f"%side = call double @{COPY_SIGN}(double %rest, double %u)",
        "%sum = fadd double %square, 1.0",
        "%twice = fmul double 2.0, %g",
        *_returned("between", start="0.0", odd="%side", bent="%side", plus="%sum", minus="%twice"),
        "}",
    ]
)
"""The IR of the function that makes `Parts` of u."""


def parts_of(u: str, name: str) -> list[str]:
    """The IR of the parts of u, `%name.PART` each."""
    taken = [
        f"%{name}.{part} = extractvalue {STRUCT} %{name}, {place}"
        for place, part in enumerate(Parts._fields)
    ]
    return [f"%{name} = call {STRUCT} @hyperbolic(double {u})", *taken]


def from_parts(function: str, u: str, name: str, to: str) -> list[str]:
    """The IR of one of the four, of u, into `to`; `name` is what `parts_of` was given."""
    match function:
        case "tanh":
            return [
                f"{to}.size = call double @llvm.fabs.f64(double {u})",
                f"{to}.is.far = fcmp ogt double {to}.size, {CODE.far}",
                f"{to}.bent = fdiv double %{name}.odd, %{name}.plus",
                f"{to}.near = fadd double %{name}.start, {to}.bent",
                f"{to}.value = select i1 {to}.is.far, double 1.0, double {to}.near",
                f"{to} = call double @{COPY_SIGN}(double {to}.value, double {u})",
            ]
        case "sinh":
            return [
                f"{to}.bent = fdiv double %{name}.bent, %{name}.minus",
                f"{to} = fadd double %{name}.start, {to}.bent",
            ]
        case "sech":
            return [f"{to} = fdiv double %{name}.minus, %{name}.plus"]
    return [f"{to} = fdiv double %{name}.plus, %{name}.minus"]
