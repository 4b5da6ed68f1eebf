"""Options as a record or as a plain dictionary: one place that makes the record of both."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar, get_origin, get_type_hints

from tracewire.arguments import misfits
from tracewire.errors import OptionError, Problem, unknown

T = TypeVar("T")


def options_of(
    kind: type[T],
    given: T | Mapping[str, Any] | None,
    what: str,
    arguments: Collection[str] = (),
) -> T:
    """The record of options that is given, or made of a dictionary; the defaults where None.

    A dictionary may stand for a record inside, and a list for a tuple:
    `{"only": ["force"], "search": {"rivals": 8}}`. `what` is what the options are those of,
    `arguments` the names that the function takes beside its options. Raises OptionError with every
    name that does not exist.
    """
    if given is None:
        return kind()
    if isinstance(given, kind):
        return given
    if not isinstance(given, Mapping):
        text = f"the options of {what} are a {type(given).__name__}"
        raise OptionError([Problem(text, hint=f"Give a dictionary, or {kind.__name__}(...).")])
    beside = [name for name in given if name in arguments]
    problems = [
        Problem(f"{name!r} is no option of {what}", hint=f"It is an argument: {name}=...")
        for name in beside
    ]
    problems += _wrong(kind, {n: v for n, v in given.items() if n not in beside}, what)
    if problems:
        raise OptionError(problems)
    return _made(kind, given)


def _wrong(kind: type[Any], given: Mapping[str, Any], what: str) -> Iterator[Problem]:
    """The names that no field of a record has, and values of another kind, also those of records
    inside."""
    hints = get_type_hints(kind)
    names = [field.name for field in fields(kind)]
    for name, value in given.items():
        if name not in names:
            alike = [known for known in names if known.lower() == str(name).lower()]
            hint = f"Write {alike[0]!r}." if alike else ""
            yield unknown(f"option of {what}", str(name), names, hint=hint)
        elif is_dataclass(hints[name]) and isinstance(value, Mapping):
            yield from _wrong(hints[name], value, f"{what}, {name}")
        else:
            for wrong in misfits(str(name), value, hints[name]):
                yield Problem(f"{what}: {wrong}")


def _made(kind: type[T], given: Mapping[str, Any]) -> T:
    """A record of values whose names are known."""
    hints = get_type_hints(kind)
    values = {}
    for name, value in given.items():
        if is_dataclass(hints[name]) and isinstance(value, Mapping):
            value = _made(hints[name], value)
        elif get_origin(hints[name]) is tuple and isinstance(value, list):
            value = tuple(value)
        values[name] = value
    return kind(**values)
