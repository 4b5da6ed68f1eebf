"""One family of errors: each problem says where it is, what is wrong, what exists, and what to do.

Problems are collected, so that a user repairs a diagram in one go. The command line prints them one
a line and ends with the exit code of the error's class: 2 where the input is wrong, 1 where the
work failed.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

MOST_NAMES = 12


@dataclass(frozen=True, order=True)
class Location:
    """Where something stands: file, line and column (both from 1; 0 is unknown), block path."""

    file: str = ""
    line: int = 0
    column: int = 0
    block: str = ""

    def __str__(self) -> str:
        numbers = ":".join(str(n) for n in (self.line, self.column) if n)
        spot = ":".join(part for part in (self.file, numbers) if part)
        block = f"block '{self.block}'" if self.block else ""
        return ": ".join(part for part in (spot, block) if part)


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong: the place, what it is, the names that exist there, what to do."""

    what: str
    place: Location = Location()
    exists: tuple[str, ...] = ()
    hint: str = ""

    def __str__(self) -> str:
        where = str(self.place)
        text = f"{where}: {self.what}" if where else self.what
        if self.exists:
            shown = ", ".join(self.exists[:MOST_NAMES])
            more = len(self.exists) - MOST_NAMES
            text += f"; there are: {shown}" + (f" and {more} more" if more > 0 else "")
        return f"{text}. {self.hint}" if self.hint else f"{text}."


MOST_MEANT = 6  # names that are proposed


def unknown(
    kind: str,
    name: str,
    existing: Iterable[str],
    place: Location = Location(),
    hint: str = "",
    otherwise: str = "",
) -> Problem:
    """The problem "unknown KIND 'NAME'", with what exists, and what of that is spelled alike or has
    the name as one of its words; `otherwise` where nothing has."""
    names = tuple(sorted(existing))
    near = difflib.get_close_matches(name, names, n=1, cutoff=0.6)
    near = near or [known for known in names if name.lower() in known.lower().split("_")]
    shown = " or ".join(f"'{known}'" for known in near[:MOST_MEANT])
    meant = f"Did you mean {shown}?" if near else otherwise
    nothing = "" if names else f"; there is no {kind} here"
    text = " ".join(part for part in (meant, hint) if part)
    return Problem(f"unknown {kind} '{name}'{nothing}", place, names, text)


@dataclass(eq=False)
class TracewireError(Exception):
    """The base of every error of tracewire: a non-empty collection of problems."""

    problems: Sequence[Problem] = field(default_factory=tuple)
    exit_code = 2

    def __str__(self) -> str:
        return "\n".join(str(problem) for problem in self.problems)

    @classmethod
    def one(
        cls, what: str, place: Location = Location(), exists: Iterable[str] = (), hint: str = ""
    ) -> TracewireError:
        """An error of this class that holds a single problem."""
        return cls([Problem(what, place, tuple(exists), hint)])


class FormulaError(TracewireError):
    """A formula that does not parse, is too large, or names what does not exist."""


class BlockError(TracewireError):
    """A block declaration, or a library of them, that is not well formed."""


class DiagramError(TracewireError):
    """A diagram file that cannot be read or is wired wrongly."""


class DataError(TracewireError):
    """Measured data that cannot be read or used."""


class DownloadError(TracewireError):
    """A file that could not be fetched: no network, a missing package, or another content."""

    exit_code = 1


class InstallationError(TracewireError):
    """What belongs to tracewire is not there, and cannot be made."""

    exit_code = 1


class OptionError(TracewireError):
    """An argument of a function or a command that does not exist or has no meaning."""


class SimulationError(TracewireError):
    """A run that could not be finished: it names block, signal, time and what to try."""

    exit_code = 1


class FitError(TracewireError):
    """A fit or a trace that could not be carried out on valid input."""

    exit_code = 1


class AnalysisError(TracewireError):
    """An analysis that could not be carried out on valid input."""

    exit_code = 1
