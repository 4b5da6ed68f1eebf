"""How a result shows itself: sentences and tables, a figure, and data for programs.

Each kind of result has one `Presentation`. The command line prints it, and so do the methods of the
results.
"""

from __future__ import annotations

import html
import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from typing import TYPE_CHECKING, Any

from tracewire.arguments import checked
from tracewire.errors import OptionError, Problem, unknown
from tracewire.result import Result
from tracewire.show.style import drawn
from tracewire.show.table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Part = str | Table
FILES = {
    "solve": "present_runs",
    "fit": "present_fits",
    "trace": "present_traces",
    "analyse": "present_analyses",
}
"""Where the presentations of a subpackage's results are."""


@dataclass(frozen=True)
class Presentation:
    """How a kind of result looks: in a line, in sentences and tables in their order, as data, and
    the function `plot(result, path, ...)` that draws it, where there is a figure.

    pictures: the HTML of what a notebook shows above the tables.
    """

    headline: Callable[[Any], str]
    parts: Callable[[Any], Sequence[Part]]
    data: Callable[[Any], Mapping[str, Any]]
    plot: Callable[..., Any] | None = None
    pictures: Callable[[Any], str] | None = None


@dataclass(frozen=True)
class Presented:
    """A result, and how it looks."""

    result: Result
    how: Presentation

    @property
    def headline(self) -> str:
        """The result in a line."""
        return self.how.headline(self.result)

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """Its sentences and tables, in their order."""
        return tuple(self.how.parts(self.result))

    @property
    def data(self) -> Mapping[str, Any]:
        """The result as data for programs."""
        return self.how.data(self.result)

    @property
    def table(self) -> Table:
        """The first of its tables. Raises OptionError where it has none."""
        tables = [part for part in self.parts if isinstance(part, Table)]
        if not tables:
            raise OptionError([self._lacks("table", "text() says all there is.")])
        return tables[0]

    @property
    def text(self) -> str:
        """Sentences and tables as plain text."""
        texts = (f"\n{part}\n" if isinstance(part, Table) else part for part in self.parts)
        return "\n".join(texts).strip("\n")

    @property
    def html(self) -> str:
        """Its pictures, sentences and tables as HTML."""
        pictures = self.how.pictures(self.result) if self.how.pictures is not None else ""
        parts = (
            part.html() if isinstance(part, Table) else f"<p>{html.escape(part)}</p>"
            for part in self.parts
        )
        return "\n".join([pictures, *parts]).strip("\n")

    def draw(self, path: object, options: Mapping[str, Any]) -> None:
        """Draw its figure to a file. Raises OptionError: no figure, an option that is none."""
        if self.how.plot is None:
            raise OptionError([self._lacks("figure", "table() and text() show it.")])
        known = list(inspect.signature(self.how.plot).parameters)[2:]
        wrong = [unknown("option of the figure", name, known) for name in options
                 if name not in known]  # fmt: skip
        if wrong:
            raise OptionError(wrong)
        self.how.plot(self.result, path, **options)

    def figure(self, options: Mapping[str, Any]) -> Figure:
        """Its figure, not saved."""
        return drawn(lambda path: self.draw(path, options))

    def _lacks(self, what: str, hint: str) -> Problem:
        return Problem(f"a {type(self.result).__name__} has no {what}", hint=hint)


@checked
def present(result: Result) -> Presented:
    """A result as it shows itself."""
    room = type(result).__module__.split(".")[1]
    file = import_module(f"tracewire.show.{FILES[room]}")
    return Presented(result, file.PRESENTATIONS[type(result)])
