"""`judge`: each statement of a diagram is measured, and compared with what it says."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from tracewire.analyse.quantities import (
    NOTHING_FURTHER,
    Further,
    Recorder,
    Subject,
    ask,
    conditions_of,
    measure,
    silent,
)
from tracewire.arguments import checked
from tracewire.compile import Model, compile
from tracewire.diagram import Diagram, Setting, Statement, read
from tracewire.errors import TracewireError
from tracewire.formula import CONSTANTS, Expression, names_of
from tracewire.solve import Interrupted, Options

Verdict = Literal["agrees", "the print is wrong", "does not agree", "could not be measured"]
VERDICTS: tuple[Verdict, ...] = (
    "agrees",
    "the print is wrong",
    "does not agree",
    "could not be measured",
)


@dataclass(frozen=True)
class Bounds:
    """Where a measured number must lie: low <= value <= high; `text` says so in words."""

    text: str
    low: float = -math.inf
    high: float = math.inf

    def hold(self, value: float) -> bool:
        """Whether the value lies within; a value that is no number does not."""
        return self.low <= value <= self.high


@dataclass(frozen=True)
class Judged:
    """A statement with what was measured, in its unit, and how long that took in s.

    `value` is None where it could not be measured; `why` tells the reason of every verdict but
    plain agreement, and what else the statement has to say. `bounds` are None for a word.
    """

    statement: Statement
    value: float | str | None
    bounds: Bounds | None
    verdict: Verdict
    why: str
    seconds: float

    @property
    def holds(self) -> bool:
        """Whether it is as stated, or as wrong as its erratum says."""
        return self.verdict in VERDICTS[:2]

    @property
    def expected(self) -> str:
        """What was expected, in words."""
        if self.bounds is not None:
            return self.bounds.text
        return self.statement.word or "?"


class Judge:
    """Measures statements. Models, runs and analyses of one setting are made once.

    `full` asks for the longest runs that a setting has; `further` are quantities that the caller
    knows; `tell` is told what is done, in words.
    """

    def __init__(
        self,
        *,
        full: bool = False,
        further: Further = NOTHING_FURTHER,
        workers: int | None = None,
        libraries: Sequence[str | Path] = (),
        tell: Callable[[str], None] | None = None,
    ) -> None:
        self.full, self.further, self.workers = full, further, workers
        self.libraries = tuple(libraries)
        self.tell = tell if tell is not None else silent
        self._recorders: dict[Path, Recorder] = {}
        self._subjects: dict[tuple[Path, str, str], Subject] = {}

    def model(self, diagram: Diagram | Path) -> Model:
        """The model of a diagram, or of a file. Raises DiagramError."""
        file = diagram if isinstance(diagram, Path) else diagram.file
        if file not in self._recorders:
            found = read(diagram, self.libraries) if isinstance(diagram, Path) else diagram
            self._recorders[file] = Recorder(compile(found))
        return self._recorders[file].model

    def subject(self, diagram: Diagram, setting: Setting) -> Subject:
        """A diagram, or the other one that a setting names, in that setting. Raises
        TracewireError."""
        model = self.model(diagram if setting.file is None else setting.file)
        conditions = conditions_of(model, setting, self.full)
        plain = Options(**{**conditions.options, "inputs": None})  # those are of the series
        key = model.diagram.file, setting.series, repr(replace(conditions, options=plain))
        if key not in self._subjects:
            found = Subject(
                self._recorders[model.diagram.file],
                conditions,
                workers=self.workers,
                tell=self.tell,
            )
            self._subjects[key] = found
        return self._subjects[key]

    def judge(
        self, diagram: Diagram, statements: Sequence[Statement] | None = None
    ) -> tuple[Judged, ...]:
        """All statements of a diagram, or these, in their order."""
        chosen = diagram.expect if statements is None else tuple(statements)
        for statement in chosen:  # so that a run that several of them need has all
            try:
                ask([statement.that], *self._subjects_of(diagram, statement))
            except TracewireError:
                continue  # it is told when the statement is measured
        rows = []
        for statement in chosen:
            self.tell(statement.name)
            rows.append(self._row(diagram, statement))
        return tuple(rows)

    def _subjects_of(
        self, diagram: Diagram, statement: Statement
    ) -> tuple[Subject, Subject | None]:
        reference = statement.reference
        other = None if reference is None else self.subject(diagram, reference)
        return self.subject(diagram, statement.run), other

    def _measured(
        self, diagram: Diagram, statement: Statement, subject: Subject, other: Subject | None
    ) -> float | str:
        """The value of a statement. Where a run fails that others need, too, its own decides."""
        try:
            return measure(statement.that, subject, other, self.further)
        except Interrupted:
            raise
        except TracewireError:
            if not (subject.failed or (other is not None and other.failed)):
                raise
        alone = Judge(full=self.full, further=self.further, workers=self.workers)
        alone.libraries, alone.tell = self.libraries, self.tell
        alone._recorders = {file: found.fresh() for file, found in self._recorders.items()}
        subjects = alone._subjects_of(diagram, statement)
        ask([statement.that], *subjects)
        return measure(statement.that, *subjects, self.further)

    def _row(self, diagram: Diagram, statement: Statement) -> Judged:
        began = time.perf_counter()
        bounds: Bounds | None = None
        try:
            subject, other = self._subjects_of(diagram, statement)
            bounds = bounds_of(statement, subject)
            found = self._measured(diagram, statement, subject, other)
        except TracewireError as error:
            why = " ".join([*str(error).split(), *statement.note.split()])
            seconds = time.perf_counter() - began
            return Judged(statement, None, bounds, "could not be measured", why, seconds)
        value = found if isinstance(found, str) else found / statement.factor + 0.0  # no -0
        verdict = _verdict(statement, bounds, value)
        told = [statement.erratum if verdict == "the print is wrong" else "", statement.note]
        if verdict == "does not agree":
            expected = statement.word if bounds is None else bounds.text
            told = [f"{expected} was expected.", *told]
        why = " ".join(text for text in told if text)
        return Judged(statement, value, bounds, verdict, why, time.perf_counter() - began)


@checked
def judge(
    diagram: Diagram,
    *,
    full: bool = False,
    further: Further = NOTHING_FURTHER,
    workers: int | None = None,
    libraries: Sequence[str | Path] = (),
    tell: Callable[[str], None] | None = None,
) -> tuple[Judged, ...]:
    """Measure the statements of the section `expect` of a diagram, and say which hold.

    `full` makes the runs as long as a setting's `full` says. Runs that several statements need are
    made once. A statement that cannot be measured is a row that says why; its verdict is "could
    not be measured". `libraries` are those of other diagrams that statements name.

    Raises DiagramError: the diagram does not compile.
    """
    found = Judge(full=full, further=further, workers=workers, libraries=libraries, tell=tell)
    found.model(diagram)
    return found.judge(diagram)


def bounds_of(statement: Statement, subject: Subject) -> Bounds | None:
    """The numbers of what is expected, in the unit of the statement; None for a word."""
    if statement.word:
        return None

    def number(bound: Expression) -> float:
        value = measure(bound, subject)
        assert isinstance(value, float)
        # a formula that reads parameters is in SI, as these are
        in_si = any(name not in CONSTANTS for name in names_of(bound))
        return value / statement.factor if in_si else value

    if statement.value is not None:
        value = number(statement.value)
        off = abs(value) * statement.within if statement.relative else statement.within
        return Bounds(f"{value:.7g} ± {off:.2g}", value - off, value + off)
    low = -math.inf if statement.above is None else number(statement.above)
    high = math.inf if statement.below is None else number(statement.below)
    if statement.below is None:
        return Bounds(f"≥ {low:.7g}", low=low)
    if statement.above is None:
        return Bounds(f"≤ {high:.7g}", high=high)
    return Bounds(f"{low:.7g} to {high:.7g}", low, high)


def _verdict(statement: Statement, bounds: Bounds | None, value: float | str) -> Verdict:
    if isinstance(value, str) or bounds is None:
        holds = value == statement.word
    else:
        holds = bounds.hold(value)
    if holds:
        return "agrees"
    return "the print is wrong" if statement.erratum else "does not agree"


def counts_of(rows: Sequence[Judged]) -> Mapping[Verdict, int]:
    """How many rows have each verdict, in the order of VERDICTS."""
    return {verdict: sum(row.verdict == verdict for row in rows) for verdict in VERDICTS}
