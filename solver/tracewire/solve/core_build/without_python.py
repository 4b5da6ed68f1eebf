"""numba for a library that no Python calls: it makes LLVM's text of each function, and no more.

As it comes, numba compiles each function for itself, with a caller for Python and with what an
exception needs, and writes helpers again into each of their callers. The core has no exceptions: a
function that meets an error returns a code, and the unit that Python called notes it.
"""

from __future__ import annotations

from typing import Any

from numba.core import callconv, codegen, lowering

TEXTS: list[str] = []
"""The functions in the order in which numba made them."""


def apply() -> None:
    """Let numba of this process be so from now on."""
    library = codegen.CPUCodeLibrary
    library.add_ir_module = _keep
    library.add_linking_library = _nothing
    library.finalize = _finalize
    codegen.JITCodeLibrary.get_pointer_to_function = _no_address
    codegen.JITCPUCodegen.set_env = _nothing
    lowering.Lower.create_cpython_wrapper = _nothing
    lowering.Lower.create_cfunc_wrapper = _nothing
    callconv.CPUCallConv.return_user_exc = _return_error
    callconv.CPUCallConv.return_dynamic_user_exc = _return_error


def _keep(library: Any, module: Any) -> None:
    if library.name != "nrt":  # support.ll has this
        TEXTS.append(str(module))


def _finalize(library: Any) -> None:
    library._finalized = True


def _no_address(*_: Any) -> int:
    return 0


def _nothing(*_: Any, **__: Any) -> None:
    pass


def _return_error(convention: Any, builder: Any, *_: Any, **__: Any) -> None:
    convention._return_errcode_raw(builder, callconv.RETCODE_USEREXC)
