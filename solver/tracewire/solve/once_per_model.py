"""What those who run a model make of it once, and forget with it."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import ref

from tracewire.compile import Model

T = TypeVar("T")


def once_per_model(make: Callable[[Model], T]) -> Callable[[Model], T]:
    """The function, which is called once for each model: a copy of one is another model.

    What it makes must not refer to the model: else neither of them would ever be freed.
    """
    known: dict[int, tuple[ref[Model], T]] = {}

    @wraps(make)
    def found(model: Model) -> T:
        key = id(model)
        entry = known.get(key)
        if entry is None:
            gone = ref(model, lambda _: known.pop(key, None))
            entry = known.setdefault(key, (gone, make(model)))  # another thread may have made it
        return entry[1]

    return found
