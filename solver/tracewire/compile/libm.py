"""The C library's mathematical functions: machine code and careful Python call the same ones."""

from __future__ import annotations

import ctypes
import ctypes.util
import os
from collections.abc import Callable
from functools import cache

from tracewire.formula import OPERATIONS

PREFIX = "tracewire."
"""Of their names in machine code, so that LLVM knows nothing about them."""
CALLED = [operation for operation in OPERATIONS.values() if operation.library]
ONE = tuple(operation.library for operation in CALLED if operation.most == 1)
TWO = tuple(operation.library for operation in CALLED if operation.most == 2)
BOTH = "sincos"
"""Functions of one and of two numbers, and the one of GNU that gives sine and cosine together."""


@cache
def _library() -> ctypes.CDLL:
    if os.name == "nt":
        return ctypes.CDLL("ucrtbase")
    process = ctypes.CDLL(None)  # Python itself is linked with it
    if all(hasattr(process, name) for name in (*ONE, *TWO)):
        return process
    return ctypes.CDLL(ctypes.util.find_library("m"))


def has_sincos() -> bool:
    """Whether one call may give a sine and its cosine; they are the bits of the single ones."""
    return hasattr(_library(), BOTH)


def addresses() -> dict[str, int]:
    """The address of each function in this process, by name."""
    names = (*ONE, *TWO, *((BOTH,) if has_sincos() else ()))
    library = _library()
    return {name: ctypes.cast(getattr(library, name), ctypes.c_void_p).value or 0 for name in names}


def function(name: str) -> Callable[..., float]:
    """A function of the C library: it never raises, and gives NaN or infinity instead."""
    found = _library()[name]
    found.restype = ctypes.c_double
    found.argtypes = [ctypes.c_double] * (2 if name in TWO else 1)
    call: Callable[..., float] = found
    return call
