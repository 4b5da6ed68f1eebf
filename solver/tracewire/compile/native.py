"""From LLVM IR to functions in memory: machine code for this processor, kept by its content."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from threading import RLock
from typing import Any

from tracewire.compile import libm
from tracewire.compile.libm import PREFIX
from tracewire.compile.limits import CODE

_lock = RLock()
_kept: OrderedDict[bytes, Native] = OrderedDict()


@dataclass(frozen=True)
class Native:
    """Functions in memory by their addresses; they live as long as this does."""

    addresses: Mapping[str, int]
    engine: Any = field(repr=False)


def assemble(text: str, names: Iterable[str], *, quickly: bool = False) -> Native:
    """The machine code of the functions `names` of an IR text; the same text is compiled once.

    `quickly`: by the quick compiler, which large texts get anyway.
    """
    quickly = quickly or len(text) > CODE.large
    key = hashlib.sha256(text.encode()).digest() + bytes([quickly])
    with _lock:
        found = _kept.pop(key, None)
        if found is None:
            engine = _engine(text, quickly)
            found = Native({name: engine.get_function_address(name) for name in names}, engine)
        _kept[key] = found
        if len(_kept) > CODE.kept:
            _kept.popitem(last=False)  # a model that uses it holds it still
        return found


def load_objects(codes: Iterable[bytes]) -> Any:
    """An engine with the functions of object files, which know each other; they are in memory as
    long as it is."""
    import llvmlite.binding as llvm

    _initialize()
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _target(quickly=True))
    for code in codes:
        engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return engine


def _engine(text: str, quickly: bool) -> Any:
    import llvmlite.binding as llvm  # a tenth of a second: a check needs no machine code

    _initialize()
    # The tape is folded and shared already; passes over the IR only cost time, and they would join
    # the parts of long functions again. An engine that compiles itself keeps fifteen times as much.
    return load_objects([_compiler(quickly).emit_object(llvm.parse_assembly(text))])


@cache
def _compiler(quickly: bool) -> Any:
    return _target(quickly)


def _target(quickly: bool) -> Any:
    import llvmlite.binding as llvm

    return llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=0 if quickly else 2,
        jit=True,
    )


@cache
def _initialize() -> None:
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    for name, address in libm.addresses().items():
        llvm.add_symbol(PREFIX + name, address)
