"""The object files of the core as one content: before each stands its length."""

from __future__ import annotations

import struct
from collections.abc import Iterable

LENGTH = struct.Struct("<Q")


def join(objects: Iterable[bytes]) -> bytes:
    """The content of several object files."""
    return b"".join(LENGTH.pack(len(one)) + one for one in objects)


def split(content: bytes) -> list[bytes]:
    """The object files of a content."""
    objects, begin = [], 0
    while begin < len(content):
        (length,) = LENGTH.unpack_from(content, begin)
        begin += LENGTH.size
        objects.append(content[begin : begin + length])
        begin += length
    return objects
