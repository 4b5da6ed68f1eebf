"""What every result can do: show itself as a table, a figure, text, and data for programs."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any


class Result:
    """A result that shows itself; `tracewire.show` says how each kind of them looks.

    A notebook shows its tables; of a run, a fit and a trace also the curves, above them.
    """

    def table(self) -> Any:
        """Its main table: `table().rows` are texts, `print(run.table())` prints it."""
        return self._presented().table

    def figure(self, **options: Any) -> Any:
        """Its figure, a `Figure` of matplotlib that is not yet saved.

        The options are those of the function that draws it: `run.figure(measured=series)`.
        Raises OptionError where there is no figure of it, or no such option.
        """
        return self._presented().figure(options)

    def plot(self, **options: Any) -> Any:
        """The same as `figure`."""
        return self.figure(**options)

    def text(self) -> str:
        """What the command line prints of it."""
        return str(self._presented().text)

    def json(self) -> dict[str, Any]:
        """What the command line gives with --json: numbers, texts, lists and dictionaries."""
        return dict(plain(self._presented().data))

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self._presented().headline}>"

    def _repr_html_(self) -> str:
        """Its pictures, sentences and tables, as a notebook shows them."""
        return str(self._presented().html)

    def _presented(self) -> Any:
        # the package stands above its subpackages: they do not import it, but it is there
        return sys.modules["tracewire"].present(self)


def finite(value: float) -> float | None:
    """A number, or None where JSON has none."""
    return value if math.isfinite(value) else None


def plain(data: Any, number: Callable[[float], Any] = finite) -> Any:
    """Data in the types of JSON: arrays are lists, dataclasses objects; `number` says what a
    floating-point number becomes, without it null where it is not finite."""
    if isinstance(data, bool | int | str | None):
        return data
    if isinstance(data, float):
        return number(data)
    if isinstance(data, Mapping):
        return {str(key): plain(value, number) for key, value in data.items()}
    if is_dataclass(data) and not isinstance(data, type):
        return {field.name: plain(getattr(data, field.name), number) for field in fields(data)}
    if hasattr(data, "tolist"):
        return plain(data.tolist(), number)
    if isinstance(data, Sequence | set | frozenset):
        return [plain(value, number) for value in data]
    return str(data)
