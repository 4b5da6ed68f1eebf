"""Python functions behind C addresses: the Python back end, and code that is compiled when called.

The compiled core only knows addresses of the one signature of C (see `machine`).
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.compile.source import Function

DOUBLES = ctypes.POINTER(ctypes.c_double)
SIGNATURE = ctypes.CFUNCTYPE(None, ctypes.c_double, *[DOUBLES] * 5)
FORWARD = ctypes.CFUNCTYPE(None, ctypes.c_double, *[ctypes.c_void_p] * 5)
ADDRESSED = ctypes.c_char * 0


def place_of(array: NDArray[np.float64]) -> Any:
    """An array as a function of C takes it: by far the fastest way to its address."""
    return ADDRESSED.from_buffer(array.data)


UNREAD = place_of(np.zeros(1))  # an argument that a function of the model does not read


def address_of(callback: Any) -> int:
    """The address of a callback; it is good as long as the callback lives."""
    return ctypes.cast(callback, ctypes.c_void_p).value or 0


def as_c(function: Function, places: Sequence[int], states: int, modes: int, constants: int) -> Any:
    """A callback round a Python function of t, x, m, c, k; its values go to `places` of `out`."""

    def call(t: float, x: Any, m: Any, c: Any, k: Any, out: Any) -> None:
        try:
            given = x[:states] if states else [], m[: 2 * modes] if modes else []
            values = function(t, *given, c[:constants] if constants else [], k)
        except BaseException:
            values = (math.nan,) * len(places)
            raise  # ctypes prints it
        finally:
            for place, value in zip(places, values, strict=True):
                out[place] = value

    return SIGNATURE(call)


def when_called(compiled: Callable[[], int], size: int) -> Any:
    """A callback that gets the address of the real function at its first call, and forwards."""

    forward: list[Any] = []

    def call(t: float, *pointers: int | None) -> None:
        try:
            if not forward:
                forward.append(FORWARD(compiled()))
        except BaseException:
            out = (ctypes.c_double * size).from_address(pointers[-1] or 0)
            out[:] = [math.nan] * size
            raise
        forward[0](t, *pointers)

    return FORWARD(call)
