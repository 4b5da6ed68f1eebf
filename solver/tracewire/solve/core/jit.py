"""How the core is compiled: by numba, once per installation; and how it calls a model's functions.

The functions of the core are ordinary Python as far as a reader is concerned. `unit` makes machine
code of one, on its own, which others call by its symbol: linked into each of its callers, as numba
does it, the core would take ten times as long to compile. `helper` is for small functions that are
built into their callers. The machine code is kept in a folder of the user, under a name that
changes with any of the core's files.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable
from pathlib import Path
from threading import RLock
from types import FunctionType, ModuleType
from typing import Any, TypeVar, cast

import networkx as nx
import numba
import numpy as np
import platformdirs
from llvmlite import binding, ir
from numba import types
from numba.core import cgutils
from numba.core.ccallback import CFunc
from numba.extending import intrinsic
from numpy.typing import NDArray

from tracewire.solve.code_store import COMPLETE, CodeStore, FunctionCode, tell

Vector = NDArray[np.float64]
Function = TypeVar("Function", bound=Callable[..., Any])


def _folder() -> Path:
    """The folder for the machine code of these sources."""
    here = Path(__file__).parent
    digest = hashlib.sha256(f"{numba.__version__} {sys.implementation.cache_tag}".encode())
    for file in sorted(here.rglob("*.py")):
        digest.update(file.read_bytes())
    root = numba.config.CACHE_DIR or platformdirs.user_cache_path("tracewire")
    return Path(root) / f"core-{digest.hexdigest()[:16]}"


STORE = CodeStore(_folder())


TYPES = {
    "int": types.int64,
    "float": types.float64,
    "bool": types.boolean,
    "Vector": types.float64[::1],
    "Matrix": types.float64[:, ::1],
    "Ints": types.int64[::1],
    "None": types.void,
}
UNITS: dict[str, Unit] = {}
STUBS: dict[int, Unit] = {}
KEPT: list[Any] = []
LOCK = RLock()  # of all that makes machine code
FIRST = "compiling the integrators, once for this installation (one to two minutes) ..."


def helper(function: Function) -> Function:
    """The function as part of its callers: no Python objects, division by zero is infinity."""
    built = numba.njit(nogil=True, error_model="numpy")(function)
    built._cache = FunctionCode(function, STORE)
    return cast(Function, built)


def inlined(function: Function) -> Function:
    """A helper whose instructions stand in its callers: loops over what these know are unrolled."""
    built = numba.njit(nogil=True, error_model="numpy", forceinline=True)
    return cast(Function, built(function))


def _written(name: str, text: str, names: dict[str, Any], file: str = "<core>") -> Any:
    """The function that a text defines: numba wants each argument by its name."""
    exec(compile(text, file, "exec"), names)
    return names[name]


class Unit:
    """A function of the core with its symbol and its types; compiled when a run first needs it."""

    def __init__(self, function: Callable[..., Any]) -> None:
        hints = function.__annotations__
        self.function = function
        self.symbol = f"{function.__module__}.{function.__name__}".replace(".", "_")
        self.result = TYPES[hints["return"]]
        self.given = {name: TYPES[hint] for name, hint in hints.items() if name != "return"}
        self.code: Any = None

    def compile(self) -> None:
        """Make the machine code, or get it from the cache, and let the symbol be known."""
        entry = self._entry()
        kinds = (tuple(self._plain()), self.result)
        code: Any = CFunc(entry, kinds, {}, {"error_model": "numpy"})
        code._cache = FunctionCode(self.function, STORE)
        code.compile()
        self.code = code
        binding.add_symbol(self.symbol, self.code.address)

    def _plain(self) -> list[Any]:
        """The types of the arguments, where an array is a pointer and its shape.

        An array as numba has it has an owner, who is told whenever a function takes the array and
        leaves it: that costs more than many of the functions.
        """
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
        names = {"body": inlined(self.function), "carray": numba.carray}
        entry = _written(name, text, names, code.co_filename)
        entry.__module__ = self.function.__module__  # a part of its symbol
        return entry

    def call(self, context: Any, builder: Any, _: Any, values: Any) -> Any:
        """The instructions of a call."""
        plain = []
        for kind, value in zip(self.given.values(), values, strict=True):
            if isinstance(kind, types.Array):
                array = context.make_array(kind)(context, builder, value)
                plain += [array.data, *cgutils.unpack_tuple(builder, array.shape, kind.ndim)]
            else:
                plain.append(value)
        kinds = [context.get_value_type(kind) for kind in (self.result, *self._plain())]
        there = ir.FunctionType(kinds[0], kinds[1:])
        outside = cgutils.get_or_insert_function(builder.module, there, self.symbol)
        value = builder.call(outside, plain)
        return context.get_dummy_value() if self.result is types.void else value

    def stub(self) -> Any:
        """What other functions call."""
        name, names = self.function.__name__, ", ".join(self.given)
        text = f"def {name}(typing, {names}):\n"
        text += "    return unit.result(*unit.given.values()), unit.call"
        return intrinsic(_written(name, text, {"unit": self}))


def unit(function: Function) -> Function:
    """The function as machine code of its own; its annotations are its types."""
    new = Unit(function)
    stub = new.stub()
    UNITS[new.symbol] = new
    STUBS[id(stub)] = new
    KEPT.append(stub)
    return cast(Function, stub)


def _called(function: Callable[..., Any]) -> set[Unit]:
    """The units whose names stand in a function, or in the helpers that it calls."""
    found: set[Unit] = set()
    waiting, seen = [function], {function}
    while waiting:
        reader = waiting.pop()
        names, known = reader.__code__.co_names, reader.__globals__
        rooms = [known[name] for name in names if isinstance(known.get(name), ModuleType)]
        rooms = [room for room in rooms if room.__name__.startswith(__package__)]
        for name in names:
            for thing in (known.get(name), *(getattr(room, name, None) for room in rooms)):
                inside = getattr(thing, "py_func", None)
                if id(thing) in STUBS:
                    found.add(STUBS[id(thing)])
                elif isinstance(inside, FunctionType) and inside not in seen:
                    seen.add(inside)
                    waiting.append(inside)
    return found


def ready(function: Callable[..., Any]) -> Any:
    """The C function of a unit, with all that it calls, for Python to call."""
    if STUBS[id(function)].code is None:
        with LOCK:  # what another thread has made meanwhile is not made again
            _make_all()
    return STUBS[id(function)].code.ctypes


def _make_all() -> None:
    """Make the units that have no machine code yet, each after those that it calls."""
    graph: nx.DiGraph[Unit] = nx.DiGraph()
    graph.add_nodes_from(UNITS.values())
    for caller in UNITS.values():
        found = _called(caller.function) - {caller}
        graph.add_edges_from((callee, caller) for callee in found)
    waiting = [made for made in nx.topological_sort(graph) if made.code is None]
    if STORE.read(COMPLETE) is not None:
        for made in waiting:
            made.compile()
        return
    with STORE.alone():
        if STORE.works and STORE.read(COMPLETE) is None:
            tell(FIRST)
        for made in waiting:
            made.compile()
        STORE.write(COMPLETE, b"")


def _invoke(
    typing: Any, address: Any, t: Any, x: Any, m: Any, c: Any, k: Any, out: Any
) -> tuple[Any, Any]:
    """Call the C function at an address: f(t, x, m, c, k, out) with the data of the arrays."""
    signature = types.void(address, t, x, m, c, k, out)

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

    return signature, generate


invoke: Callable[..., None] = intrinsic(_invoke)


@helper
def invoke_at(
    address: int, t: float, x: Vector, m: Vector, c: Vector, k: Vector, out: Vector
) -> None:
    """Call the C function at an address, from Python."""
    invoke(address, t, x, m, c, k, out)
