"""`reproduce`: every statement of a paper measured on its shipped diagrams, and what came out."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from tracewire.analyse import Judge, Judged, Verdict, counts_of
from tracewire.diagram import Diagram
from tracewire.paper.figure import PaperFigure
from tracewire.paper.figures import figures_of
from tracewire.paper.identification import with_identification
from tracewire.paper.statements import diagrams_of, system_of
from tracewire.paper.tables import tables_of
from tracewire.show import Table


@dataclass(frozen=True)
class Reproduction:
    """What a paper states and what its diagrams do.

    `tables` are what a statement cannot hold: the steps of an identification, the bands of a
    bifurcation diagram; `figures` are those that a report draws. `full` tells that the runs were as
    long as the paper's; `seconds` is the time of all.
    """

    paper: str
    rows: tuple[Judged, ...]
    tables: tuple[Table, ...]
    figures: tuple[PaperFigure, ...]
    full: bool
    seconds: float

    @property
    def counts(self) -> Mapping[Verdict, int]:
        """How many statements have each verdict, in the order of VERDICTS."""
        return counts_of(self.rows)

    @property
    def systems(self) -> tuple[str, ...]:
        """The systems in the order of their statements."""
        return tuple(dict.fromkeys(system_of(row.statement) for row in self.rows))

    @property
    def open(self) -> tuple[Judged, ...]:
        """The rows that neither agree nor show a wrong print."""
        return tuple(row for row in self.rows if not row.holds)


def reproduce(
    paper: str,
    *,
    full: bool = False,
    diagrams: Sequence[Diagram] | None = None,
    workers: int | None = None,
    progress: Callable[[str], None] | None = None,
) -> Reproduction:
    """Measure the statements of paper "a", "b" or "c" on the shipped diagrams.

    `full` makes the runs as long and as fine as the paper's. The statements of `diagrams` are
    measured instead of the paper's own, and then there are no tables and figures. `progress` is
    told what is done next, in words that end on `(3 of 40)`.
    A statement that cannot be measured is a row that says why. Raises OptionError: no such paper.
    """
    chosen = diagrams_of(paper) if diagrams is None else tuple(diagrams)
    count = sum(len(diagram.expect) for diagram in chosen)
    names = [statement.name for diagram in chosen for statement in diagram.expect]

    def tell(what: str) -> None:
        if progress is not None:
            number = f" ({names.index(what) + 1} of {count})" if what in names else ""
            progress(what + number)

    judge = Judge(full=full, workers=workers, tell=tell)
    steps = with_identification(judge)
    began = time.perf_counter()
    rows = tuple(row for diagram in chosen for row in judge.judge(diagram))
    own = diagrams is None
    tables = tables_of(paper, judge, steps, chosen) if own else ()
    figures = figures_of(paper) if own else ()
    return Reproduction(paper, rows, tables, figures, full, time.perf_counter() - began)
