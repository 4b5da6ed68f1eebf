"""The variables of a MATLAB file of version 5 to 7, read with every length checked.

scipy.io.loadmat reads them too, but ends the whole process (a segmentation fault) on some damaged
files. Format: MAT-File Format, The MathWorks; little or big endian, compressed or not.
"""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.data.limits import FILE

MATRIX, COMPRESSED = range(14, 16)
NUMBERS = {
    1: "i1",
    2: "u1",
    3: "i2",
    4: "u2",
    5: "i4",
    6: "u4",
    7: "f4",
    9: "f8",
    12: "i8",
    13: "u8",
}
CELL, STRUCT, OBJECT = range(1, 4)
NUMERIC = range(6, 16)
OTHERS = {4: "a text", 5: "a sparse matrix", 16: "a function", 17: "an object of a class"}
IS_COMPLEX = 0x08


class Damaged(Exception):
    """The file ends too early, or says of itself what cannot be."""


class Cells(tuple[Any, ...]):
    """The entries of a cell array, down its columns."""


class Structs(tuple[Mapping[str, Any], ...]):
    """The fields of each entry of a struct array, down its columns."""


class Other(str):
    """What an array holds that is no array of numbers, in words."""


Value = NDArray[Any] | Cells | Structs | Other


def variables_of(content: bytes) -> dict[str, Value]:
    """The variables by name. Raises Damaged."""
    marks = {b"IM": "<", b"MI": ">"}
    order = marks.get(content[126:128])
    if order is None:
        raise Damaged("its header has no mark of the byte order")
    found: dict[str, Value] = {}
    left = [FILE.most_unpacked]
    at = 128
    while at + 8 <= len(content):
        kind, data, at = _element(content, at, order)
        if kind == COMPRESSED:
            kind, data, _ = _element(_unpacked(data, left), 0, order)
        if kind == MATRIX and data:
            name, value = _matrix(data, order, 0)
            if name:  # what has no name is MATLAB's own store of its objects
                found[name] = value
    return found


def _unpacked(data: bytes, left: list[int]) -> bytes:
    """The bytes that were compressed; of all in a file together not more than a limit."""
    try:
        made = zlib.decompressobj().decompress(data, left[0] + 1)
    except zlib.error as error:
        raise Damaged(str(error)) from None
    left[0] -= len(made)
    if left[0] < 0:
        raise Damaged(f"it holds more than {FILE.most_unpacked / 1e9:g} GB")
    return made


def _element(data: bytes, at: int, order: str) -> tuple[int, bytes, int]:
    """Kind and bytes of the element at a place, and the place of the next."""
    if at + 8 > len(data):
        raise Damaged("it ends too early")
    (first,) = struct.unpack_from(f"{order}I", data, at)
    if first >> 16:  # a small element: its bytes stand in the second half of the tag
        kind, count, begin = first & 0xFFFF, first >> 16, at + 4
        end = at + 8
    else:
        kind, begin = first, at + 8
        (count,) = struct.unpack_from(f"{order}I", data, at + 4)
        end = begin + count if kind == COMPRESSED else begin + -(-count // 8) * 8
    if begin + count > len(data) or (first >> 16 and count > 4):
        raise Damaged("it ends too early")
    return kind, data[begin : begin + count], end


def _numbers(kind: int, data: bytes, order: str) -> NDArray[Any]:
    if kind not in NUMBERS:
        raise Damaged(f"it has numbers of the unknown kind {kind}")
    numbers = np.dtype(order + NUMBERS[kind])
    if len(data) % numbers.itemsize:
        raise Damaged("a number in it is cut off")
    return np.frombuffer(data, numbers)


def _matrix(data: bytes, order: str, depth: int) -> tuple[str, Value]:
    """Name and value of an array."""
    if depth > FILE.most_depth:
        raise Damaged(f"it is nested deeper than {FILE.most_depth} levels")
    if not data:
        return "", np.zeros((0, 0))
    kind, flags, at = _element(data, 0, order)
    words = _numbers(kind, flags, order)
    if kind != 6 or len(words) != 2:
        raise Damaged("an array in it has no flags")
    kind_of_array, is_complex = int(words[0]) & 0xFF, bool(int(words[0]) >> 8 & IS_COMPLEX)
    kind, shape_data, at = _element(data, at, order)
    if kind_of_array == 17:  # objects have another layout: their name stands where the shape does
        return _text(shape_data), Other(OTHERS[17])
    shape = tuple(int(n) for n in _numbers(kind, shape_data, order))
    if len(shape) < 2 or min(shape) < 0 or math.prod(shape) > FILE.most_unpacked:
        raise Damaged(f"an array in it has the shape {shape}")
    _, name_data, at = _element(data, at, order)
    name, count = _text(name_data), math.prod(shape)
    if kind_of_array in NUMERIC:
        real, at = _part(data, at, order, shape)
        if not is_complex:
            return name, real
        whole = real.astype(np.complex128)
        whole.imag = _part(data, at, order, shape)[0]
        return name, whole
    if kind_of_array == CELL:
        cells = []
        for _ in range(count):
            value, at = _inner(data, at, order, depth)
            cells.append(value)
        return name, Cells(cells)
    if kind_of_array in (STRUCT, OBJECT):
        if kind_of_array == OBJECT:
            _, _, at = _element(data, at, order)  # the name of the class
        return name, _structs(data, at, order, count, depth)
    return name, Other(OTHERS.get(kind_of_array, "of an unknown kind"))


def _part(data: bytes, at: int, order: str, shape: tuple[int, ...]) -> tuple[NDArray[Any], int]:
    kind, part, at = _element(data, at, order)
    numbers = _numbers(kind, part, order)
    if numbers.size != math.prod(shape):
        raise Damaged(f"an array in it has {numbers.size} numbers, and the shape {shape}")
    return numbers.reshape(shape, order="F"), at


def _inner(data: bytes, at: int, order: str, depth: int) -> tuple[Value, int]:
    kind, inner, at = _element(data, at, order)
    if kind != MATRIX:
        raise Damaged("an array in it holds what is no array")
    return _matrix(inner, order, depth + 1)[1], at


def _structs(data: bytes, at: int, order: str, count: int, depth: int) -> Structs:
    kind, length_data, at = _element(data, at, order)
    lengths = _numbers(kind, length_data, order)
    _, names_data, at = _element(data, at, order)
    length = int(lengths[0]) if len(lengths) == 1 else 0
    if length <= 0 or len(names_data) % length:
        raise Damaged("a struct in it has no names of fields")
    names = [_text(names_data[i : i + length]) for i in range(0, len(names_data), length)]
    if not names:
        return Structs(({},) * min(count, 1))
    entries = []
    for _ in range(count):
        entry = {}
        for name in names:
            entry[name], at = _inner(data, at, order, depth)
        entries.append(entry)
    return Structs(entries)


def _text(data: bytes) -> str:
    return data.partition(b"\0")[0].decode("ascii", "replace")
