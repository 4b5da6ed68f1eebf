"""What the library has in the place of the functions of `core/rows.py`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils

from tracewire.solve.core import rows

NUMBER = ir.DoubleType()
PAIR = ir.VectorType(NUMBER, 2)
WORD = ir.IntType(64)
BYTES = 8  # of a number: rows begin anywhere


def typing_of(adds: bool) -> Callable[..., Any]:
    """What an intrinsic of numba does: the type of a call, and its instructions.

    `adds`: whether to what stands in the row.
    """

    def added(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        out = _Row(context, builder, signature.args[0], values[0], values[1])
        x = signature.args[3], values[3]
        places = [values[4], *values[6::2]]
        weights = [values[2], *values[5::2]]
        terms = [
            (weight, _Row(context, builder, *x, place))
            for weight, place in zip(weights, places, strict=True)
        ]

        def step(at: Any, kind: Any) -> None:
            total = out.load(at, kind) if adds else None
            for weight, row in terms:
                part = builder.fmul(_spread(builder, weight, kind), row.load(at, kind))
                total = part if total is None else builder.fadd(total, part)
            out.store(total, at, kind)

        pairs = builder.lshr(out.length, WORD(1))
        with cgutils.for_range(builder, pairs) as loop:
            step(builder.shl(loop.index, WORD(1)), PAIR)
        odd = builder.trunc(out.length, ir.IntType(1))
        with builder.if_then(odd):
            step(builder.sub(out.length, WORD(1)), NUMBER)
        return context.get_dummy_value()

    def typing(_: Any, *given: Any) -> tuple[Any, Any]:
        return types.void(*given), added

    return typing


class _Row:
    """A row of a matrix in the library."""

    def __init__(self, context: Any, builder: Any, kind: Any, value: Any, place: Any) -> None:
        array = context.make_array(kind)(context, builder, value)
        self.builder = builder
        self.length = cgutils.unpack_tuple(builder, array.shape, 2)[1]
        self.data = builder.gep(array.data, [builder.mul(place, self.length)])

    def _at(self, at: Any, kind: Any) -> Any:
        pointer = self.builder.gep(self.data, [at])
        return self.builder.bitcast(pointer, kind.as_pointer())

    def load(self, at: Any, kind: Any) -> Any:
        return self.builder.load(self._at(at, kind), align=BYTES)

    def store(self, value: Any, at: Any, kind: Any) -> None:
        self.builder.store(value, self._at(at, kind), align=BYTES)


def _spread(builder: Any, number: Any, kind: Any) -> Any:
    if kind is NUMBER:
        return number
    pair = builder.insert_element(ir.Constant(PAIR, ir.Undefined), number, ir.IntType(32)(0))
    return builder.insert_element(pair, number, ir.IntType(32)(1))


def typings() -> dict[Any, Callable[..., Any]]:
    """The functions, and what an intrinsic is made of for each."""
    return {
        rows.add_row: typing_of(adds=True),
        rows.add_two: typing_of(adds=True),
        rows.put_three: typing_of(adds=False),
    }
