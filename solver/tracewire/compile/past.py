"""What delayed signals were: how the functions of a model read it, in both back ends.

A run keeps it as rows of numbers, at an address that it writes behind the parameters. The first row
holds how many pieces there are, and how wide a row is. Each other one is a piece, in order of
time:

    its begin, its middle, 2/its length; then of each delayed signal the number of the smooth
    stretch in which the piece lies, and the coefficients of z**0 to z**8 of its polynomial in
    z = (s - middle)*2/length

At a time s the piece is read that holds s, or the next one to it within the stretch that is asked
for: so that what is read up to a jump is what was before it.
"""

from __future__ import annotations

import ctypes
import math

COEFFICIENTS = 9
HEAD = 3
EACH = 1 + COEFFICIENTS


def past(address: float, signal: int, s: float, stretch: float, order: int) -> float:
    """The derivative of this order at s; NaN where nothing is kept, as while a message is made."""
    if not address:
        return math.nan
    at = int(address)
    count, width = (int(number) for number in (ctypes.c_double * 2).from_address(at))
    rows = (ctypes.c_double * ((1 + max(count, 1)) * width)).from_address(at)
    own, piece, high = HEAD + EACH * signal, 1, count
    while piece < high:
        middle = (piece + high + 1) // 2
        if rows[middle * width] <= s:
            piece = middle
        else:
            high = middle - 1
    while piece > 1 and rows[piece * width + own] > stretch:
        piece -= 1
    while piece < count and rows[piece * width + own] < stretch:
        piece += 1
    row = piece * width
    scale = rows[row + 2]
    z, value = (s - rows[row + 1]) * scale, 0.0
    for k in range(COEFFICIENTS - 1, order - 1, -1):
        term = rows[row + own + 1 + k]
        for i in range(order):
            term *= float(k - i)
        value = value * z + term
    for _ in range(order):
        value *= scale
    return value


PAST = f"""define internal double @past(double %address.f, i64 %signal, double %s, double %stretch,
    i64 %order) {{
  %nowhere = fcmp oeq double %address.f, 0.0
  br i1 %nowhere, label %none, label %some
none:
  ret double 0x7FF8000000000000
some:
  %address = fptoui double %address.f to i64
  %rows = inttoptr i64 %address to ptr
  %count.f = load double, ptr %rows
  %count = fptosi double %count.f to i64
  %width.p = getelementptr double, ptr %rows, i64 1
  %width.f = load double, ptr %width.p
  %width = fptosi double %width.f to i64
  %skipped = mul i64 %signal, {EACH}
  %own = add i64 %skipped, {HEAD}
  br label %search
search:
  %low = phi i64 [1, %some], [%low.next, %halve]
  %high = phi i64 [%count, %some], [%high.next, %halve]
  %open = icmp slt i64 %low, %high
  br i1 %open, label %halve, label %back
halve:
  %sum = add i64 %low, %high
  %sum.1 = add i64 %sum, 1
  %middle = ashr i64 %sum.1, 1
  %middle.at = mul i64 %middle, %width
  %begin.p = getelementptr double, ptr %rows, i64 %middle.at
  %begin = load double, ptr %begin.p
  %before = fcmp ole double %begin, %s
  %middle.1 = sub i64 %middle, 1
  %low.next = select i1 %before, i64 %middle, i64 %low
  %high.next = select i1 %before, i64 %high, i64 %middle.1
  br label %search
back:
  %piece = phi i64 [%low, %search], [%piece.1, %back.on]
  %may.back = icmp sgt i64 %piece, 1
  br i1 %may.back, label %back.look, label %forth
back.look:
  %back.at = mul i64 %piece, %width
  %back.own = add i64 %back.at, %own
  %back.p = getelementptr double, ptr %rows, i64 %back.own
  %back.stretch = load double, ptr %back.p
  %late = fcmp ogt double %back.stretch, %stretch
  br i1 %late, label %back.on, label %forth
back.on:
  %piece.1 = sub i64 %piece, 1
  br label %back
forth:
  %found = phi i64 [%piece, %back], [%piece, %back.look], [%found.1, %forth.on]
  %row = mul i64 %found, %width
  %row.own = add i64 %row, %own
  %may.forth = icmp slt i64 %found, %count
  br i1 %may.forth, label %forth.look, label %read
forth.look:
  %forth.p = getelementptr double, ptr %rows, i64 %row.own
  %forth.stretch = load double, ptr %forth.p
  %early = fcmp olt double %forth.stretch, %stretch
  br i1 %early, label %forth.on, label %read
forth.on:
  %found.1 = add i64 %found, 1
  br label %forth
read:
  %row.p = getelementptr double, ptr %rows, i64 %row
  %mid.p = getelementptr double, ptr %row.p, i64 1
  %mid = load double, ptr %mid.p
  %scale.p = getelementptr double, ptr %row.p, i64 2
  %scale = load double, ptr %scale.p
  %apart = fsub double %s, %mid
  %z = fmul double %apart, %scale
  %first = add i64 %row.own, 1
  br label %next
next:
  %k = phi i64 [{COEFFICIENTS - 1}, %read], [%k.1, %add]
  %value = phi double [0.0, %read], [%value.next, %add]
  %more = icmp sge i64 %k, %order
  br i1 %more, label %term, label %scaled
term:
  %place = add i64 %first, %k
  %c.p = getelementptr double, ptr %rows, i64 %place
  %c = load double, ptr %c.p
  br label %factor
factor:
  %i = phi i64 [0, %term], [%i.1, %times]
  %part = phi double [%c, %term], [%part.next, %times]
  %less = icmp slt i64 %i, %order
  br i1 %less, label %times, label %add
times:
  %power = sub i64 %k, %i
  %power.f = sitofp i64 %power to double
  %part.next = fmul double %part, %power.f
  %i.1 = add i64 %i, 1
  br label %factor
add:
  %product = fmul double %value, %z
  %value.next = fadd double %product, %part
  %k.1 = sub i64 %k, 1
  br label %next
scaled:
  %r = phi i64 [0, %next], [%r.1, %scaled.on]
  %result = phi double [%value, %next], [%result.next, %scaled.on]
  %rest = icmp slt i64 %r, %order
  br i1 %rest, label %scaled.on, label %done
scaled.on:
  %result.next = fmul double %result, %scale
  %r.1 = add i64 %r, 1
  br label %scaled
done:
  ret double %result
}}"""
