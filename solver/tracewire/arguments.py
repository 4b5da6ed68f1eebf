"""Arguments of public functions: one place that says in words what is given instead of what."""

from __future__ import annotations

import inspect
import os
import sys
import textwrap
import types
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import is_dataclass
from functools import cache, lru_cache, wraps
from pathlib import Path
from typing import (
    Any,
    Literal,
    ParamSpec,
    TypeVar,
    Union,
    Unpack,
    get_args,
    get_origin,
    get_type_hints,
)

from tracewire.errors import OptionError, Problem

P = ParamSpec("P")
T = TypeVar("T")
LISTS = (Sequence, Collection, Iterable)
WORDS: dict[Any, str] = {float: "a number", int: "a whole number", str: "a text", Path: "a path"}
MADE_BY = {
    "Model": ("a model", "Make one: tracewire.compile(tracewire.read(path))."),
    "Diagram": ("a diagram", "Read it first: tracewire.read(path), or tracewire.read_text(text)."),
    "Run": ("a run", "Make one: tracewire.simulate(model)."),
    "Fit": ("a fit", "Make one: tracewire.fit(model)."),
    "Found": ("a trace", "Make one: tracewire.trace(model). A run has run.save(path) of its own."),
    "Measured": ("a measured series", "Load all: tracewire.load_measured(model)."),
    "Result": ("a result", "Give what a run, a fit, a trace or an analysis has returned."),
}
"""Of classes that are made by a function: what it is, and how to get it."""


class _Array:
    """Stands for all kinds of which numpy makes an array."""


def checked(function: Callable[P, T]) -> Callable[P, T]:
    """The function, which refuses arguments of another kind than its annotations say.

    Raises OptionError before the function runs: which argument, what it is, and what to give.
    """
    parameters, name = inspect.signature(function).parameters, function.__name__
    defaults = {p.name: p.default for p in parameters.values()}
    order = [p.name for p in parameters.values() if p.kind is p.POSITIONAL_OR_KEYWORD]

    @lru_cache(maxsize=1)
    def kinds() -> dict[str, Any]:
        found = get_type_hints(function)
        for argument, kind in list(found.items()):
            if get_origin(kind) is Unpack:
                found |= get_type_hints(get_args(found.pop(argument))[0])
        return found

    @wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> T:
        known = kinds()  # of what is missing, or too much, Python says so
        given = [*zip(order, args, strict=False), *kwargs.items()]
        problems = [
            Problem(f"{name}: {wrong}", hint=_remedy(argument, known[argument]))
            for argument, value in given
            if argument in known and value is not defaults.get(argument, call)
            for wrong in misfits(argument, value, known[argument])
        ]
        if problems:
            raise OptionError(problems)
        return function(*args, **kwargs)

    return call


def misfits(name: str, value: Any, kind: Any) -> Iterator[str]:
    """What of a value is of another kind: itself, or what is in it."""
    kinds = _branches(kind)
    if any(_fits(value, one) for one in kinds):
        return
    for one in kinds:
        if get_origin(one) is Mapping and isinstance(value, Mapping):
            of_name, of_value = get_args(one)
            for key, inner in value.items():
                if not _fits(key, of_name):
                    yield f"{name} has {_shown(key)}, and not {_words(of_name)}, for a name"
                yield from misfits(f"{name}[{key!r}]", inner, of_value)
            return
        if get_origin(one) in LISTS and isinstance(value, list | tuple):
            for n, inner in enumerate(value):
                yield from misfits(f"{name}[{n}]", inner, get_args(one)[0])
            return
    yield f"{name} is {_shown(value)}, and not {_words(kind)}"


def _branches(kind: Any) -> list[Any]:
    """The kinds of which a value may be one; all that makes an array is one of them."""
    if get_origin(kind) not in (Union, types.UnionType):
        return [kind]
    # a command that needs no numpy must not wait for it
    return _with_array(kind) if "numpy" in sys.modules else list(get_args(kind))


@cache
def _with_array(kind: Any) -> list[Any]:
    """The same of a union, where numpy is there."""
    kinds = list(get_args(kind))
    from numpy.typing import ArrayLike

    array = get_args(ArrayLike)
    if not set(kinds) >= set(array):
        return kinds
    return [_Array, *(one for one in kinds if one not in array)]


def _fits(value: Any, kind: Any) -> bool:
    """Whether a value is of a kind; of a kind that is not told here, it is."""
    if kind is _Array:
        return _is_array(value)
    if get_origin(kind) in (Union, types.UnionType):
        return any(_fits(value, one) for one in _branches(kind))
    origin, inside = get_origin(kind), get_args(kind)
    if kind in (float, int):
        return _is_number(value)
    if kind in (str, Path):
        return isinstance(value, str if kind is str else str | os.PathLike)
    if origin is Literal:
        return isinstance(value, type(inside[0]))
    if origin is Mapping:
        return isinstance(value, Mapping) and all(
            _fits(key, inside[0]) and _fits(inner, inside[1]) for key, inner in value.items()
        )
    if origin is tuple and inside[-1] is not Ellipsis:
        return _is_list(value) and _has(list(value), inside)
    if origin in LISTS or origin is tuple:
        return _is_list(value) and (
            not isinstance(value, list | tuple) or all(_fits(inner, inside[0]) for inner in value)
        )
    if origin is Callable:
        return callable(value)
    if kind is types.NoneType or (inspect.isclass(kind) and _is_told(kind)):
        return isinstance(value, kind)
    return True


def _is_told(kind: type[Any]) -> bool:
    """Whether a class is one of tracewire, and no protocol."""
    return is_dataclass(kind) or kind.__name__ in MADE_BY


def _has(values: list[Any], kinds: tuple[Any, ...]) -> bool:
    """Whether there is one value of each kind."""
    pairs = zip(values, kinds, strict=False)
    return len(values) == len(kinds) and all(_fits(value, kind) for value, kind in pairs)


def _is_list(value: Any) -> bool:
    """Whether it has values one after the other, and is no text and no dictionary."""
    return isinstance(value, Iterable) and not isinstance(value, str | bytes | Mapping)


def _is_number(value: Any) -> bool:
    """Whether it is one real number, also of numpy."""
    if type(value) in (float, int):
        return True
    if isinstance(value, str | bytes | complex) or getattr(value, "ndim", False):
        return False
    try:
        float(value)
    except (TypeError, ValueError, OverflowError):
        return False
    return True


def _is_array(value: Any) -> bool:
    """Whether an array of numbers can be made of it."""
    if value is None or isinstance(value, str | bytes | Mapping):
        return False
    import numpy as np

    try:
        np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        return False
    return True


def _shown(value: Any) -> str:
    """A value as a message shows it."""
    plain = isinstance(value, str | bytes | int | float | complex | Sequence | Mapping)
    if plain or hasattr(value, "ndim"):
        return textwrap.shorten(repr(value), 60, placeholder=" ...")
    return "None" if value is None else f"a {type(value).__name__}"


def _words(kind: Any) -> str:
    """What a kind is, in words."""
    origin, inside = get_origin(kind), get_args(kind)
    if kind is _Array:
        return "an array of numbers"
    if origin in (Union, types.UnionType):
        kinds = [one for one in _branches(kind) if one is not types.NoneType]
        words = [_words(one) for one in kinds if not (one is str and Path in kinds)]
        return " or ".join(dict.fromkeys(words))
    if origin is Mapping:
        return "a dictionary" if inside[1] is Any else f"a dictionary of {_plural(inside[1])}"
    if origin in LISTS:
        return f"a list of {_plural(inside[0])}"
    if origin is tuple:
        several = inside[-1] is Ellipsis
        pair = "two numbers" if set(inside) == {float} else f"{len(inside)} values"
        return f"a list of {_plural(inside[0])}" if several else pair
    if origin is Literal:
        return _words(type(inside[0]))
    if origin is Callable:
        return "a function"
    name = getattr(kind, "__name__", str(kind))
    return (
        WORDS[kind] if kind in (float, int, str, Path) else MADE_BY.get(name, (f"{name}(...)",))[0]
    )


def _plural(kind: Any) -> str:
    """Several of a kind, in words."""
    words = _words(kind)
    if words.startswith("a ") and words.count(" ") < 3 and " or " not in words:
        return words[2:] if words.endswith("s") else f"{words[2:]}s"
    return "pairs of times and values" if get_origin(kind) is tuple else "values"


def _remedy(name: str, kind: Any) -> str:
    """What to write instead."""
    for one in _branches(kind):
        origin, inside = get_origin(one), get_args(one)
        made = MADE_BY.get(getattr(one, "__name__", ""))
        made = made or MADE_BY.get(getattr((*inside, one)[0], "__name__", ""))
        if made is not None:
            return made[1]
        if origin is Mapping and inside[1] == float | None:
            return f'Write {name}={{"name": 2.0}}, or None in place of a number that is free.'
        if origin is Mapping and inside[1] in (float, Any):
            return f'Write {name}={{"name": 2.0}}.'
        if origin is tuple and set(inside) == {float}:
            return f"Write {name}=(0, 10)."
        if origin in LISTS and inside[0] is str:
            return f'Write {name}=["name"].'
        if origin is Mapping and get_origin(inside[1]) is tuple:
            return f'Write {name}={{"name": (times, values)}}.'
    return ""
