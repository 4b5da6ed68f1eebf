"""A trace as a file: JSON with plain numbers, so that a report can be made again without the work.

A saved trace may come from a stranger: it is read as data, nothing in it is run.
"""

from __future__ import annotations

import copyreg
import json
import math
import types
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, fields, is_dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np

from tracewire.arguments import checked
from tracewire.diagram import Diagram, read_text
from tracewire.errors import Location, OptionError, Problem, TracewireError
from tracewire.files import write_file, writing
from tracewire.library import load_library
from tracewire.result import plain
from tracewire.trace.found import Force, Found
from tracewire.trace.units import known_units, users_unit

COMPUTED = frozenset({"find_forces", "find_diagram"})
"""What a trace computes when it is asked for, and no file can hold."""
KIND, VERSION = "a trace of tracewire", 1
OTHER_KINDS = {
    "a fit of tracewire": "This is a saved fit: go on from it with `tracewire fit ... --resume`."
}
INFINITE = {math.inf: "inf", -math.inf: "-inf"}


class _DamagedError(Exception):
    """Data that are not what a field of a trace holds; the text says where."""


@checked
def save(found: Found, path: str | Path) -> Path:
    """Write a trace to a JSON file, with all that its report needs; the path of the file.

    The needed forces are computed for that. An older file stays until the new one is complete.
    Raises OptionError: the file cannot be written.
    """
    path = Path(path)
    text = json.dumps(to_data(found), allow_nan=False, ensure_ascii=False)
    with writing(path):
        return write_file(path, text)


@checked
def load(path: str | Path, libraries: Iterable[str | Path] = ()) -> Found:
    """The trace that `save`, or `tracewire trace --save`, has written.

    `libraries` are files of further blocks that its diagram uses. A diagram whose files are not
    where they were has its text only. Raises OptionError: no such file, another kind of file, a
    damaged one, or one of a newer tracewire.
    """
    place = Location(str(path))
    try:
        data = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        what = f"the saved trace cannot be read: {error.strerror or error}"
        raise OptionError.one(what, place, hint="Check its path.") from None
    except (ValueError, RecursionError):
        data = None
    kind = data.get("kind") if isinstance(data, dict) else None
    if kind != KIND:
        hint = "Name a file that `tracewire trace --save` has written."
        if isinstance(kind, str):
            hint = OTHER_KINDS.get(kind, hint)
        raise OptionError.one("this is no saved trace", place, hint=hint)
    version = data.get("version")
    if isinstance(version, int) and version > VERSION:
        what = f"the trace was saved by a newer tracewire (format {version}; this one reads 1)"
        raise OptionError.one(what, place, hint="Update tracewire, or trace again.")
    try:
        return from_data(data, libraries)
    except _DamagedError as error:
        what = f"the saved trace is damaged: {error}"
        raise OptionError([Problem(what, place, hint="Trace again.")]) from None


def to_data(found: Found) -> dict[str, Any]:
    """A trace as data of JSON types."""
    words = found.words
    try:
        forces = found.forces
    except Exception as error:  # what a report shows beside the result must not cost the result
        forces = ()
        words = (*words, f"the needed force could not be computed: {error}")
    held = {f.name: getattr(found, f.name) for f in fields(found) if f.name not in COMPUTED}
    # units follow from the diagram; where the file is loaded, its measured files may be missing
    signals = {*found.sigma, *(e.signal for e in found.errors)}
    users = {name: users_unit(found, name) for name in sorted(signals)}
    units = {**found.units, **known_units(found)}
    held |= {"forces": forces, "words": words, "units": units, "users_units": users}
    return {"kind": KIND, "version": VERSION} | {name: _plain(v) for name, v in held.items()}


def from_data(data: Mapping[str, Any], libraries: Iterable[str | Path] = ()) -> Found:
    """The trace that `to_data` made data of. Raises _DamagedError."""
    libraries = tuple(libraries)
    forces = _read(tuple[Force, ...], data.get("forces", []), "forces")
    held: dict[str, Any] = {
        "find_forces": partial(_kept, forces),
        "original": _diagram(data.get("original"), "original", libraries),
        "diagram": _diagram(data.get("diagram"), "diagram", libraries),
    }
    return Found(**held | _fields(Found, data, "", skip=COMPUTED | frozenset(held)))


def _kept(forces: tuple[Force, ...]) -> tuple[Force, ...]:
    return forces


def _plain(value: Any) -> Any:
    """A field of a trace in JSON types; nan is null, and what is infinite a text."""
    if isinstance(value, Diagram):
        return {"file": str(value.file), "title": value.title, "text": value.text}
    return plain(value, lambda x: None if math.isnan(x) else INFINITE.get(x, float(x)))


def _diagram(data: Any, where: str, libraries: tuple[str | Path, ...]) -> Diagram:
    if not isinstance(data, dict):
        raise _DamagedError(f"'{where}' is missing")
    text, file = _read(str, data.get("text"), where), Path(_read(str, data.get("file"), where))
    try:
        return read_text(text, file, libraries)
    except TracewireError:  # files that it names are elsewhere: its text is still known
        title = _read(str, data.get("title", ""), where)
        return Diagram(file.stem, file, text, load_library(), title=title)


@lru_cache
def _hints(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)


def _fields(
    kind: type, data: Any, where: str, skip: frozenset[str] = frozenset()
) -> dict[str, Any]:
    """The fields of a dataclass; one that is not there has its default."""
    if not isinstance(data, Mapping):
        raise _DamagedError(f"'{where}' is no object")
    found = {}
    for f in fields(kind):
        name = f"{where}.{f.name}" if where else f.name
        if f.name in skip:
            continue
        if f.name in data:
            found[f.name] = _read(_hints(kind)[f.name], data[f.name], name)
        elif f.default is MISSING and f.default_factory is MISSING:
            raise _DamagedError(f"'{name}' is missing")
    return found


def _read(kind: Any, data: Any, where: str) -> Any:
    """Data as a value of a type. Raises _DamagedError: it is none."""
    origin, parts = get_origin(kind), get_args(kind)
    if kind is float:
        return _number(data, where)
    if kind in (str, bool, int):
        known = isinstance(data, kind) and (kind is bool or not isinstance(data, bool))
    elif origin is Literal:
        known = data in parts
    elif origin in (Union, types.UnionType):
        if data is None and type(None) in parts:
            return None
        return _read(next(part for part in parts if part is not type(None)), data, where)
    elif origin is tuple:
        return _sequence(parts, data, where)
    elif isinstance(origin, type) and issubclass(origin, Mapping):
        if not isinstance(data, dict):
            raise _DamagedError(f"'{where}' is no object")
        return {key: _read(parts[1], item, f"{where}.{key}") for key, item in data.items()}
    elif origin is np.ndarray:
        return _array(data, where)
    elif isinstance(kind, type) and is_dataclass(kind):
        return kind(**_fields(kind, data, where))
    else:
        raise TypeError(f"{where}: a saved trace holds no {kind}")
    if not known:
        raise _DamagedError(f"'{where}' is {json.dumps(data)[:40]}")
    return data


def _number(data: Any, where: str) -> float:
    if data is None:
        return math.nan
    if isinstance(data, str) and data in INFINITE.values():
        return float(data)
    if isinstance(data, int | float) and not isinstance(data, bool):
        return float(data)
    raise _DamagedError(f"'{where}' is no number")


def _sequence(parts: tuple[Any, ...], data: Any, where: str) -> tuple[Any, ...]:
    if not isinstance(data, list):
        raise _DamagedError(f"'{where}' is no list")
    if parts[-1] is Ellipsis:
        parts = parts[:1] * len(data)
    if len(parts) != len(data):
        raise _DamagedError(f"'{where}' has {len(data)} parts instead of {len(parts)}")
    return tuple(_read(kind, item, where) for kind, item in zip(parts, data, strict=True))


def _array(data: Any, where: str) -> Any:
    if not isinstance(data, list):
        raise _DamagedError(f"'{where}' is no list")
    if data and all(isinstance(row, list) for row in data):
        rows = [_array(row, where) for row in data]
        if len({row.shape for row in rows}) > 1:
            raise _DamagedError(f"the rows of '{where}' differ in length")
        return np.array(rows)
    return np.array([_number(item, where) for item in data], dtype=np.float64)


def _reduced(found: Found) -> tuple[Any, tuple[dict[str, Any]]]:
    """A trace for `pickle` and `copy`: what a file of it holds, and not the search behind it."""
    return from_data, (to_data(found),)


copyreg.pickle(Found, _reduced)
