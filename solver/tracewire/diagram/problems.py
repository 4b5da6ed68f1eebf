"""The problems of a diagram, collected while it is read, so that they are told together."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from tracewire.diagram.limits import LIMITS
from tracewire.errors import DiagramError, Location, Problem, TracewireError, unknown

NO_UNIT = " is not a unit"
REFUSED = re.compile(r"'(\w+)' cannot be the name of ")


def clip(text: str) -> str:
    """The text as it is quoted in a message: one line, and not too long of it."""
    line = " ".join(text.split())
    return line if len(line) <= LIMITS.longest_quote else f"{line[: LIMITS.longest_quote - 3]}..."


class Problems:
    """What is wrong, in the order in which it was found; beyond `LIMITS.most_problems` only a
    count."""

    def __init__(self) -> None:
        self.found: list[Problem] = []
        self.more = 0
        self.compared = 0

    def add(self, what: str, place: Location, exists: Iterable[str] = (), hint: str = "") -> None:
        """Note one problem."""
        self._note(Problem(what, place, tuple(exists), hint))

    def is_told(self, place: Location) -> bool:
        """Whether something is noted of a place already: what follows from it is not told."""
        return any(problem.place == place for problem in self.found)

    def unknown(
        self,
        kind: str,
        name: str,
        existing: Iterable[str],
        place: Location,
        hint: str = "",
        otherwise: str = "",
    ) -> None:
        """Note that there is no such name, and which there are; `otherwise` is said where none of
        them is near."""
        if self.skips():
            return
        names = sorted(set(existing))
        self.compared += len(names)
        if self.compared <= LIMITS.most_compared:
            self._note(unknown(kind, clip(name), names, place, hint, otherwise))
        else:  # the search for a near name takes a tenth of a millisecond for each that exists
            self._note(Problem(f"unknown {kind} '{clip(name)}'", place, tuple(names), hint))

    def skips(self) -> bool:
        """Whether there are enough problems already; if so this one is only counted."""
        full = len(self.found) >= LIMITS.most_problems
        self.more += full
        return full

    def take(self, error: TracewireError) -> None:
        """Note the problems of an error that ends here."""
        for problem in error.problems:
            self._note(problem)

    def raise_found(self, file: str) -> None:
        """Raise what was noted, as `told` has it."""
        if self.found:
            raise DiagramError(self.told(file))

    def told(self, file: str) -> tuple[Problem, ...]:
        """What was noted, by line; the problems of `file` come before those of others."""

        def order(problem: Problem) -> tuple[bool, str, int, int]:
            place = problem.place
            return place.file != file, place.file, place.line, place.column

        told = _together(sorted(dict.fromkeys(self.found), key=order))
        if self.more:
            told.append(Problem(f"and {self.more} more problems", Location(file)))
        return tuple(told)

    def _note(self, problem: Problem) -> None:
        if not self.skips():
            self.found.append(problem)


def _together(problems: list[Problem]) -> list[Problem]:
    """Units that are refused in several places of a file are told at the first, with all lines; a
    name that is refused is not refused again as the word of formulas that it is."""
    words = [f": {hit[1]} is a function" for p in problems if (hit := REFUSED.match(p.what))]
    problems = [p for p in problems if not p.what.endswith(tuple(words))]
    alike: dict[object, list[Problem]] = {}
    for problem in problems:
        once = problem.what.endswith(NO_UNIT)
        key = (problem.place.file, problem.what, problem.hint) if once else problem
        alike.setdefault(key, []).append(problem)
    found = []
    for first, *others in alike.values():
        lines = ", ".join(dict.fromkeys(str(other.place.line) for other in others))
        also = f", also in line {lines}" if others else ""
        found.append(replace(first, what=first.what + also))
    return found
