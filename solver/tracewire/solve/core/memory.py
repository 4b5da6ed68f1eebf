"""Arrays and functions by their addresses.

These are the functions of the core that the library does not take from their Python: it has an
instruction or two in their place.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
MODEL_FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_double, *[ctypes.c_void_p] * 5)
ADDRESSED = ctypes.c_char * 0  # of an array: by far the fastest way to its address


def floats_at(address: int, shape: Sequence[int]) -> Any:
    """The array of float64 at an address."""
    return _array_at(ctypes.c_double, address, shape)


def ints_at(address: int, shape: Sequence[int]) -> Any:
    """The array of int64 at an address."""
    return _array_at(ctypes.c_int64, address, shape)


def _array_at(kind: Any, address: int, shape: Sequence[int]) -> Any:
    data = (kind * int(np.prod(shape, dtype=np.int64))).from_address(int(address))
    return np.frombuffer(data, dtype=kind).reshape(shape)


def invoke(address: int, t: float, x: Vector, m: Vector, c: Vector, k: Vector, out: Vector) -> None:
    """Call the function of a model at an address: f(t, x, m, c, k, out), arrays without gaps."""
    data = [ADDRESSED.from_buffer(array.data) for array in (x, m, c, k, out)]
    MODEL_FUNCTION(int(address))(t, *data)
