"""From the Python of the core to the text of LLVM, by numba.

A unit is compiled for the types that its annotations name. An array is given as a pointer and its
shape: one as numba has it has an owner, who is told whenever a function takes the array and leaves
it, which costs more than many of the functions.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Callable
from typing import Any

import numba
from llvmlite import ir
from numba import types
from numba.core import cgutils, compiler
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import cpu_target
from numba.extending import intrinsic

from tracewire.solve import core
from tracewire.solve.core import arrays, memory, units
from tracewire.solve.core_build import rows, without_python
from tracewire.solve.core_build.groups import KINDS, reader_of

FAULT = "tracewire_core_fault"  # not zero where a unit met an error; support.ll has it
OPTIONS = {"nogil": True, "error_model": "numpy"}  # division by zero is infinity
TYPES = {
    "int": types.int64,
    "float": types.float64,
    "bool": types.boolean,
    "None": types.void,
    **KINDS,
}


class Unit:
    """A unit with its types, and what others call in its place."""

    def __init__(self, symbol: str, function: Callable[..., Any]) -> None:
        hints = function.__annotations__
        self.symbol, self.function = symbol, function
        self.result = TYPES[hints["return"]]
        self.given = {name: TYPES[hint] for name, hint in hints.items() if name != "return"}
        self.stub = self._stub()

    @global_compiler_lock  # type: ignore[untyped-decorator]
    def lower(self) -> None:
        """Let numba make its text, and that of the helpers that it is the first to call."""
        flags = compiler.Flags()
        flags.nrt = flags.no_compile = True
        flags.error_model = "numpy"
        typing, target = cpu_target.typing_context, cpu_target.target_context
        typing.refresh()
        target.refresh()
        given = tuple(self._plain())
        made = compiler.compile_extra(
            typing, target, self._entry(), given, self.result, flags, locals={}
        )
        without_python.TEXTS.append(str(self._function(target, made.fndesc)))

    def _plain(self) -> list[Any]:
        """The types of the arguments, where an array is a pointer and its shape."""
        found: list[Any] = []
        for kind in self.given.values():
            if isinstance(kind, types.Array):
                found += [types.CPointer(kind.dtype), *[types.int64] * kind.ndim]
            else:
                found.append(kind)
        return found

    def _entry(self) -> Any:
        """The function with plain arguments."""
        plain, full = [], []
        for name, kind in self.given.items():
            if isinstance(kind, types.Array):
                shape = [f"{name}_{axis}" for axis in range(kind.ndim)]
                plain += [name, *shape]
                full.append(f"carray({name}, ({', '.join(shape)},))")
            else:
                plain.append(name)
                full.append(name)
        name, code = self.function.__name__, self.function.__code__
        text = f"def {name}({', '.join(plain)}):\n    return body({', '.join(full)})\n"
        body = numba.njit(self.function, forceinline=True, **OPTIONS)
        entry = _written(name, text, {"body": body, "carray": numba.carray}, code.co_filename)
        entry.__module__ = self.function.__module__  # a part of its symbol
        return entry

    def _function(self, target: Any, made: Any) -> Any:
        """A module with the function of C that calls what numba made, and notes its errors."""
        module = target.create_module(self.symbol)
        kinds = target.call_conv.get_function_type(made.restype, made.argtypes)
        inside = ir.Function(module, kinds, made.llvm_func_name)
        result, *given = self._c_types(target)
        outside = ir.Function(module, ir.FunctionType(result, given), self.symbol)
        fault = ir.GlobalVariable(module, ir.IntType(64), FAULT)
        builder = ir.IRBuilder(outside.append_basic_block("entry"))
        status, value = target.call_conv.call_function(
            builder, inside, made.restype, made.argtypes, outside.args
        )
        with builder.if_then(status.is_error, likely=False):
            builder.store(ir.IntType(64)(1), fault)
        builder.ret(value)
        return module

    def _c_types(self, target: Any) -> list[Any]:
        return [target.get_value_type(kind) for kind in (self.result, *self._plain())]

    def _stub(self) -> Any:
        """What other functions call; numba wants each argument by its name."""
        name, names = self.function.__name__, ", ".join(self.given)
        text = f"def {name}(typing, {names}):\n"
        text += "    return unit.result(*unit.given.values()), unit.call"
        return intrinsic(_written(name, text, {"unit": self}))

    def call(self, context: Any, builder: Any, _: Any, values: Any) -> Any:
        """The instructions of a call."""
        plain = []
        for kind, value in zip(self.given.values(), values, strict=True):
            if isinstance(kind, types.Array):
                array = context.make_array(kind)(context, builder, value)
                plain += [array.data, *cgutils.unpack_tuple(builder, array.shape, kind.ndim)]
            else:
                plain.append(value)
        result, *given = self._c_types(context)
        there = ir.FunctionType(result, given)
        outside = cgutils.get_or_insert_function(builder.module, there, self.symbol)
        value = builder.call(outside, plain)
        return context.get_dummy_value() if self.result is types.void else value


def _by_name(function: Callable[..., Any], typing: Callable[..., Any]) -> Any:
    """An intrinsic whose arguments have the names of a function's: numba wants them."""
    names = ", ".join(inspect.signature(function).parameters)
    text = f"def {function.__name__}(typing, {names}):\n    return given(typing, {names})\n"
    return intrinsic(_written(function.__name__, text, {"given": typing}))


def _written(name: str, text: str, names: dict[str, Any], file: str = "<core>") -> Any:
    exec(compile(text, file, "exec"), names)
    return names[name]


def _invoke(
    typing: Any, address: Any, t: Any, x: Any, m: Any, c: Any, k: Any, out: Any
) -> tuple[Any, Any]:
    """Call the C function at an address with the data of the arrays."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        double, pointer = ir.DoubleType(), ir.DoubleType().as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [double, *[pointer] * 5])
        function = builder.inttoptr(arguments[0], kind.as_pointer())
        data = [
            builder.bitcast(context.make_array(given)(context, builder, value).data, pointer)
            for given, value in zip(signature.args[2:], arguments[2:], strict=True)
        ]
        builder.call(function, [arguments[1], *data])
        return context.get_dummy_value()

    return types.void(address, t, x, m, c, k, out), generate


def _array_at(kind: Any) -> Any:
    """The array of a kind of numbers at an address."""

    def pointer(_: Any, address: Any) -> tuple[Any, Any]:
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            return builder.inttoptr(values[0], context.get_value_type(types.CPointer(kind)))

        return types.CPointer(kind)(address), generate

    pointer_to, carray = intrinsic(pointer), numba.carray

    def array_at(address: Any, shape: Any) -> Any:
        return carray(pointer_to(address), shape)

    return numba.njit(array_at, **OPTIONS)


def read_core() -> dict[str, Unit]:
    """All units by their symbols; in the core's modules numba's own stand for its functions."""
    names = [entry.name for entry in pkgutil.walk_packages(core.__path__, core.__name__ + ".")]
    modules = [importlib.import_module(name) for name in names]
    found = {symbol: Unit(symbol, function) for symbol, function in units.UNITS.items()}
    made: dict[Any, Any] = {
        memory.invoke: intrinsic(_invoke),
        memory.floats_at: _array_at(types.float64),
        memory.ints_at: _array_at(types.int64),
    }
    made |= {function: _by_name(function, typing) for function, typing in rows.typings().items()}
    made |= {unit.function: unit.stub for unit in found.values()}
    made |= {helper: numba.njit(helper, **OPTIONS) for helper in units.HELPERS}
    made |= {part: numba.njit(part, forceinline=True, **OPTIONS) for part in units.INLINED}
    for reader in units.READERS:
        made[reader] = reader_of(getattr(arrays, reader.__annotations__["return"]))
    for module in modules:
        for name, value in list(vars(module).items()):
            if callable(value) and value in made:
                setattr(module, name, made[value])
    return found
