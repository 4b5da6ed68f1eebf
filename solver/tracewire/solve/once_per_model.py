"""What those who run a model make of it once, and forget with it."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

from tracewire.compile import Model

T = TypeVar("T")


def once_per_model(make: Callable[[Model], T]) -> Callable[[Model], T]:
    """The function, which is called once for each model.

    What it makes must not refer to the model: else neither of them would ever be freed.
    """
    known: WeakKeyDictionary[Model, T] = WeakKeyDictionary()

    @wraps(make)
    def found(model: Model) -> T:
        try:
            return known[model]
        except KeyError:
            return known.setdefault(model, make(model))  # another thread may have made it

    return found
