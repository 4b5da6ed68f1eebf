"""What the functions of the core are to those who make its library: units, or parts of these.

The functions are ordinary Python, and Python can run them: slowly, and with a debugger. The
library has each `unit` as a function of its own, whose annotations are its types, and which others
call by its symbol: written into each of its callers, the core would take ten times as long to
compile. A `helper` is compiled for the types that it is called with, and becomes part of its
callers where the compiler thinks that this pays; an `inlined` one always.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

UNITS: dict[str, Callable[..., Any]] = {}
"""The units by their symbols."""
HELPERS: list[Callable[..., Any]] = []
INLINED: list[Callable[..., Any]] = []
READERS: list[Callable[..., Any]] = []


def symbol_of(function: Callable[..., Any]) -> str:
    """What a unit is called in the library."""
    return f"{function.__module__}.{function.__name__}".replace(".", "_")


def unit(function: Function) -> Function:
    """A function of the library; it is given numbers and whole arrays, and says so."""
    UNITS[symbol_of(function)] = function
    return function


def helper(function: Function) -> Function:
    """A part of its callers."""
    HELPERS.append(function)
    return function


def inlined(function: Function) -> Function:
    """A helper whose instructions stand in its callers: loops over what these know are unrolled."""
    INLINED.append(function)
    return function


def reader(function: Function) -> Function:
    """The arrays of a group by the address of their table: the library reads each where it is used.

    The annotation of what it returns names the group.
    """
    READERS.append(function)
    return function
