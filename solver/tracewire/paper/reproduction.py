"""`reproduce`: every statement of a paper measured on its shipped diagrams, and what came out."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from tracewire.errors import TracewireError
from tracewire.paper.figure import PaperFigure
from tracewire.paper.figures import figures_of
from tracewire.paper.runs import Systems
from tracewire.paper.statement import VERDICTS, Statement, Verdict
from tracewire.paper.statements import DIAGRAMS, statements_of
from tracewire.paper.tables import tables_of
from tracewire.show import Table


@dataclass(frozen=True)
class Row:
    """A statement with the number that was measured, and how long that took in s.

    `value` is None where it could not be measured; `why` tells the reason of every verdict but
    plain agreement, and what else the statement has to say.
    """

    statement: Statement
    value: float | None
    verdict: Verdict
    why: str
    seconds: float


@dataclass(frozen=True)
class Reproduction:
    """What a paper states and what its diagrams do.

    `tables` are what a statement cannot hold: the steps of an identification, the bands of a
    bifurcation diagram; `figures` are those that a report draws. `full` tells that the runs were as
    long as the paper's; `seconds` is the time of all.
    """

    paper: str
    rows: tuple[Row, ...]
    tables: tuple[Table, ...]
    figures: tuple[PaperFigure, ...]
    full: bool
    seconds: float

    @property
    def counts(self) -> Mapping[Verdict, int]:
        """How many statements have each verdict, in the order of VERDICTS."""
        found = Counter(row.verdict for row in self.rows)
        return {verdict: found[verdict] for verdict in VERDICTS}

    @property
    def systems(self) -> tuple[str, ...]:
        """The systems in the order of their statements."""
        return tuple(dict.fromkeys(row.statement.system for row in self.rows))

    @property
    def open(self) -> tuple[Row, ...]:
        """The rows that neither agree nor show a wrong print."""
        return tuple(row for row in self.rows if row.verdict in VERDICTS[2:])


def reproduce(
    paper: str,
    *,
    full: bool = False,
    statements: Sequence[Statement] | None = None,
    workers: int | None = None,
    progress: Callable[[str], None] | None = None,
) -> Reproduction:
    """Measure the statements of paper "a", "b" or "c" on the shipped diagrams.

    `full` makes the runs as long and as fine as the paper's. `statements` are measured instead of
    the paper's own, and then there are no tables and figures. `progress` is told what is done next,
    in words that end on `(3 of 40)`.
    A statement that cannot be measured is a row that says why. Raises OptionError: no such paper.
    """
    own = statements_of(paper)
    chosen = own if statements is None else tuple(statements)
    systems = Systems(DIAGRAMS[paper], full=full, workers=workers, tell=progress)
    began = time.perf_counter()
    rows = []
    for n, statement in enumerate(chosen, start=1):
        systems.tell(f"{statement.name} ({n} of {len(chosen)})")
        rows.append(_row(statement, systems))
    tables = tables_of(paper, systems) if statements is None else ()
    figures = figures_of(paper) if statements is None else ()
    return Reproduction(paper, tuple(rows), tables, figures, full, time.perf_counter() - began)


def _row(statement: Statement, systems: Systems) -> Row:
    began = time.perf_counter()
    value: float | None = None
    verdict: Verdict
    try:
        value = float(statement.measure(systems))
        verdict = statement.judge(value)
        told = [statement.erratum if verdict == "the print is wrong" else "", statement.note]
    except TracewireError as error:
        verdict, told = "could not be measured", [" ".join(str(error).split()), statement.note]
    if verdict == "does not agree":
        told = [f"{statement.expected.text} was expected.", *told]
    why = " ".join(text for text in told if text)
    return Row(statement, value, verdict, why, time.perf_counter() - began)
