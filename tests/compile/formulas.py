"""Random formulas over x, y and t that are defined for every value of these, and their entries."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from hypothesis import strategies as st
from tracewire.compile.tape import BINARY, UNARY, Tape

NAMES = ("x", "y", "t")
NUMBERS = st.sampled_from(["0.5", "1", "2", "3", "0.7", "1.3"])
LEAF = st.one_of(NUMBERS, st.sampled_from(NAMES))


ONE = """sin({0}) cos({0}) tanh({0}) atan({0}) -({0}) exp(sin({0})) log(2+cos({0}))
sqrt(1.5+sin({0})) sinh(sin({0})) cosh(cos({0})) asin(0.9*sin({0})) acos(0.9*cos({0}))
tan(sin({0})) ({0})**2 ({0})**3 (2+sin({0}))**1.5"""
TWO = """({0}+{1}) ({0}-{1}) ({0}*{1}) ({0}/(3+sin({1}))) atan2({0},2+cos({1}))
(2+sin({0}))**cos({1})"""


def _smooth(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    one, two = st.sampled_from(ONE.split()), st.sampled_from(TWO.split())
    return st.one_of(
        st.builds(lambda form, a: form.format(a), one, inner),
        st.builds(lambda form, a, b: form.format(a, b), two, inner, inner),
    )


def _jumping(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    forms = st.sampled_from(
        [
            "abs({0})",
            "sign({0})",
            "min({0}, {1})",
            "max({0}, {1}, 0.31)",
            "floor({0})",
            "mod({0}, 1.7)",
            "dry({0}, 0.4, 0.6)",
            "({0} if {1} >= 0.21 else {2})",
            "({0} if {1} > {2} and not ({2} < 0.13) else {1})",
            "({1} if {0} <= 0.17 or {1} > 0.37 else {0})",
        ]
    )
    return st.one_of(
        _smooth(inner),
        st.builds(lambda form, a, b, c: form.format(a, b, c), forms, inner, inner, inner),
    )


SMOOTH = st.recursive(LEAF, _smooth, max_leaves=8)
JUMPING = st.recursive(LEAF, _jumping, max_leaves=8)


def worked_out(tape: Tape, roots: Sequence[int], values: Mapping[int, float]) -> list[float]:
    """The values of entries, by the plainest interpreter there is."""
    known = dict(values)
    for index in tape.needed(roots):
        if index in known:
            continue
        entry = tape.entries[index]
        inner = [known[operand] for operand in entry.operands]
        if entry.op == "const":
            known[index] = float(entry.payload)
        elif entry.op == "select":
            known[index] = inner[1] if inner[0] else inner[2]
        elif len(inner) == 1:
            known[index] = UNARY[entry.op](inner[0])
        else:
            known[index] = BINARY[entry.op](*inner)
    return [known[root] for root in roots]


def near(a: float, b: float, relative: float) -> bool:
    return math.isclose(a, b, rel_tol=relative, abs_tol=relative)
