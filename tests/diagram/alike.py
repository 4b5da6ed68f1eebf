"""Whether two diagrams say the same, wherever it is written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path

from tracewire.diagram import Diagram
from tracewire.errors import Location

ELSEWHERE = {"place", "text", "library", "row", "counts", "variant", "variants"}


def said(part: object) -> object:
    """What a diagram, or a part of it, says: without places, texts, rows and names of its files."""
    if isinstance(part, Location):
        return None
    if isinstance(part, Diagram):
        given = {f.name: getattr(part, f.name) for f in fields(part) if f.name not in ELSEWHERE}
        return said(
            {k: v for k, v in given.items() if k not in ("file", "name", "subsystems", "sources")}
        )
    if is_dataclass(part) and not isinstance(part, type):
        return type(part).__name__, said(
            {f.name: getattr(part, f.name) for f in fields(part) if f.name not in ELSEWHERE}
        )
    if isinstance(part, Mapping):
        return {key: said(value) for key, value in part.items()}
    if isinstance(part, tuple | list):
        return [said(item) for item in part]
    return part.resolve() if isinstance(part, Path) else part
