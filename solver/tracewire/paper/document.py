"""A reproduction as a document and as data for programs."""

from __future__ import annotations

from collections.abc import Iterable

from tracewire.analyse import Judged
from tracewire.paper.draw import draw
from tracewire.paper.figure import PAPERS, PaperFigure
from tracewire.paper.headers import read_headers
from tracewire.paper.reproduction import Reproduction
from tracewire.paper.setting import Amount
from tracewire.paper.statements import system_of
from tracewire.show import Report, Table, expected_text, measured_text, statement_data
from tracewire.show.document import Figure, Section

HEADER = ("statement", "the paper", "source", "measured", "expected", "verdict")
READING = (
    "Each row is a statement of the paper, or of the theory that it rests on, with a number that "
    "the shipped diagrams give. `agrees`: the number is as expected. `the print is wrong`: what is "
    "printed cannot hold; the reason stands below, and the corrected statement is a row of its own "
    "or is what the diagrams have. `does not agree`: neither."
)


def report_of(found: Reproduction) -> Report:
    """The document: the verdicts, all statements, where and why they do not agree, the figures."""
    sections = [
        Section(PAPERS[found.paper], (summary(found), READING)),
        Section("What the paper states, and what the diagrams do", tables=tuple(_tables(found))),
    ]
    wrong = [row for row in found.rows if row.verdict == "the print is wrong"]
    if wrong:
        sections.append(Section("Where the print is wrong", points=tuple(map(_point, wrong))))
    if found.open:
        sections.append(Section("What does not agree", points=tuple(map(_point, found.open))))
    notes = [row for row in found.rows if row.verdict == "agrees" and row.why]
    if notes:
        points = tuple(f"{names}: {why}" for why, names in _by_note(notes).items())
        sections.append(Section("Remarks", points=points))
    if found.tables:
        sections.append(Section("Details", tables=found.tables))
    amount: Amount = "full" if found.full else "usual"
    drawn = tuple(_figure(figure, amount) for figure in found.figures)
    if drawn:
        sections.append(Section("The figures of the paper, as its models draw them", figures=drawn))
    errata = [header for header in read_headers(found.paper) if header.errata]
    if errata:
        points = tuple(f"{header.name} ({header.file}): {header.errata}" for header in errata)
        sections.append(Section("All errata, by the diagrams", points=points))
    return Report(f"Paper {found.paper.upper()}: reproduction report", tuple(sections))


def summary(found: Reproduction) -> str:
    """How many statements have which verdict, in a sentence."""
    counts = "; ".join(f"{verdict}: {n}" for verdict, n in found.counts.items() if n)
    plural = "s" * (len(found.rows) != 1)
    runs = "as finely as the paper" if found.full else "in short runs (`--full`: the paper's)"
    needs_runs = found.paper == "b"
    how = f", {runs}" if needs_runs else ""
    return f"{len(found.rows)} statement{plural}: {counts}. Measured in {found.seconds:.0f} s{how}."


def verdicts_table(rows: Iterable[Judged], title: str = "", *, short: bool = False) -> Table:
    """Rows of a reproduction as a table; `short` without what the paper says."""
    cells = []
    for row in rows:
        statement = row.statement
        says = f"{statement.says} ({statement.what})"
        numbers = measured_text(row), expected_text(row)
        cells.append((statement.name, says, statement.source, *numbers, row.verdict))
    columns = [n for n in range(len(HEADER)) if not short or n not in (1, 2)]
    kept = tuple(tuple(cell[n] for n in columns) for cell in cells)
    return Table(title, tuple(HEADER[n] for n in columns), kept)


def data_of(found: Reproduction) -> dict[str, object]:
    """The same for programs: plain types, what is not finite as None."""
    return {
        "paper": found.paper,
        "title": PAPERS[found.paper],
        "full": found.full,
        "seconds": found.seconds,
        "counts": dict(found.counts),
        "statements": [
            {"system": system_of(row.statement), **statement_data(row)} for row in found.rows
        ],
        "tables": [
            {"title": table.title, "header": table.header, "rows": table.rows}
            for table in found.tables
        ],
    }


def _tables(found: Reproduction) -> Iterable[Table]:
    for system in found.systems:
        rows = [row for row in found.rows if system_of(row.statement) == system]
        yield verdicts_table(rows, system)


def _figure(figure: PaperFigure, amount: Amount) -> Figure:
    # the picture holds the paper's caption: Markdown would not show it
    name = f"Fig. {figure.number} of paper {figure.paper.upper()}"
    return Figure(f"{figure.stem}.png", name, lambda path: draw(figure, [path], amount))


def _point(row: Judged) -> str:
    statement = row.statement
    value = "" if row.value is None else f" Measured: {statement.what} {measured_text(row)}."
    return f"{statement.name}, {statement.source}: {statement.says} {row.why}{value}"


def _by_note(rows: Iterable[Judged]) -> dict[str, str]:
    """The names of the statements with each note."""
    found: dict[str, list[str]] = {}
    for row in rows:
        found.setdefault(row.why, []).append(row.statement.name)
    return {why: ", ".join(names) for why, names in found.items()}
