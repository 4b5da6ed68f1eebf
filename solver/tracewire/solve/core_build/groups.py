"""A group of arrays in the library: the address of their table, where each is read when it is used.

As numba knows it, a tuple of twenty arrays has a hundred parts, which it makes at each call of a
reader and throws away again: more than half of what there was to compile.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core.imputils import lower_getattr_generic
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import intrinsic, models, register_model
from numba.np import arrayobj

from tracewire.solve.core import arrays

WORD = ir.IntType(64)
SIZE = 8  # bytes of a number

KINDS = {
    "Vector": types.float64[::1],
    "Matrix": types.float64[:, ::1],
    "Ints": types.int64[::1],
    "IntMatrix": types.int64[:, ::1],
}


class Group(types.Type):  # type: ignore[misc]
    """The type of a group; `arrays` has the place and the type of each array by its name."""

    def __init__(self, group: Any) -> None:
        super().__init__(name=f"Group({group.__name__})")
        kinds = arrays.kinds_of(group).items()
        first = arrays.FIRST[group]
        self.arrays = {name: (first + i, KINDS[kind]) for i, (name, kind) in enumerate(kinds)}


@register_model(Group)
class GroupModel(models.PrimitiveModel):  # type: ignore[misc]
    """A group is an address."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, WORD)


@infer_getattr
class GroupAttribute(AttributeTemplate):  # type: ignore[misc]
    """The type of an array of a group."""

    key = Group

    def generic_resolve(self, kind: Group, name: str) -> Any:
        """None where there is no array of this name."""
        return kind.arrays[name][1] if name in kind.arrays else None


@lower_getattr_generic(Group)  # type: ignore[untyped-decorator]
def read_array(context: Any, builder: Any, kind: Group, address: Any, name: str) -> Any:
    """The array whose address and shape stand in the table.

    LLVM is told that these never change, so that it reads them before a loop and not in it. That
    holds inside of a unit: `spans` changes the table of a run, and calls `advance` after that,
    which therefore must not become a part of it (`noinline` in `link`).
    """
    place, array_kind = kind.arrays[name]
    table = builder.inttoptr(address, WORD.as_pointer())
    always = builder.module.add_metadata([])

    def number(column: int) -> Any:
        loaded = builder.load(builder.gep(table, [WORD(3 * place + column)]))
        loaded.set_metadata("invariant.load", always)
        return loaded

    array = context.make_array(array_kind)(context, builder)
    data = builder.inttoptr(number(0), context.get_data_type(array_kind.dtype).as_pointer())
    shape = [number(1 + axis) for axis in range(array_kind.ndim)]
    strides = [WORD(SIZE)]
    if len(shape) > 1:
        strides.insert(0, builder.mul(shape[1], WORD(SIZE)))
    arrayobj.populate_array(array, data, shape, strides, WORD(SIZE), meminfo=None)
    return array._getvalue()


def reader_of(group: Any) -> Any:
    """What stands in the place of a function that reads a group."""
    kind = Group(group)

    def reader(_: Any, address: Any) -> tuple[Any, Any]:
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            return values[0]

        return kind(types.int64), generate

    return intrinsic(reader)
