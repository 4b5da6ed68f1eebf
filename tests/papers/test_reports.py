"""What the papers state, measured on the shipped diagrams, and the report of it."""

from __future__ import annotations

import itertools
import json
import re
from functools import cache
from pathlib import Path

import pytest
from tracewire.analyse import Judge
from tracewire.diagram import Diagram, Statement, read_text
from tracewire.errors import OptionError
from tracewire.paper.document import data_of, report_of, summary, verdicts_table
from tracewire.paper.identification import FLOOR, with_identification
from tracewire.paper.reproduction import reproduce
from tracewire.paper.statements import diagrams_of, system_of

PAPERS = ("a", "b", "c")
COUNTS = {"a": 28, "b": 25, "c": 115}
JUDGES = {paper: Judge() for paper in PAPERS}
STEPS = {paper: with_identification(judge) for paper, judge in JUDGES.items()}
LONG = re.compile(r"A (step|final)|B (coexisting|lower|upper|regular|exponents|sum)")
# the text names one irregular region; 200 skipped periods leave more on the way down
BESIDE = "B regular beside, down"


def cases(long: bool) -> list[tuple[str, Diagram, Statement]]:
    found = [
        (paper, diagram, statement)
        for paper in PAPERS
        for diagram in diagrams_of(paper)
        for statement in diagram.expect
    ]
    return [case for case in found if bool(LONG.match(case[2].name)) is long]


def name_of(value: object) -> str:
    if isinstance(value, Diagram):
        return value.file.stem
    return value.name if isinstance(value, Statement) else str(value)


@cache
def quick_verdicts(paper: str) -> dict[str, str]:
    """The verdicts of a paper's statements that take a short time, by name."""
    found: dict[str, str] = {}
    for diagram in diagrams_of(paper):
        chosen = [one for one in diagram.expect if not LONG.match(one.name)]
        found |= {row.statement.name: row.verdict for row in JUDGES[paper].judge(diagram, chosen)}
    return found


@pytest.mark.parametrize(("paper", "diagram", "statement"), cases(long=False), ids=name_of)
def test_a_statement_agrees_or_its_print_is_wrong(
    paper: str, diagram: Diagram, statement: Statement
) -> None:
    expected = "the print is wrong" if statement.erratum else "agrees"
    assert quick_verdicts(paper)[statement.name] == expected


@pytest.mark.slow
@pytest.mark.parametrize(("paper", "diagram", "statement"), cases(long=True), ids=name_of)
def test_a_long_statement_agrees_but_for_the_bands_beside_the_region(
    paper: str, diagram: Diagram, statement: Statement
) -> None:
    expected = "does not agree" if statement.name == BESIDE else "agrees"
    (row,) = JUDGES[paper].judge(diagram, [statement])
    assert row.verdict == expected


@pytest.mark.parametrize("paper", PAPERS)
def test_every_statement_says_what_it_is(paper: str) -> None:
    statements = [one for diagram in diagrams_of(paper) for one in diagram.expect]
    names = [statement.name for statement in statements]
    assert len(set(names)) == len(names) == COUNTS[paper]
    for statement in statements:
        assert statement.says.endswith(".") and statement.source and statement.what
        bounds = (statement.value, statement.above, statement.below)
        assert any(bound is not None for bound in bounds)


def test_every_system_of_paper_c_has_a_statement() -> None:
    told = {system_of(one) for diagram in diagrams_of("c") for one in diagram.expect}
    assert told == {f"C{n:02d}" for n in range(1, 36)}


def test_paper_a_is_told_by_stages_and_steps() -> None:
    told = {system_of(one) for diagram in diagrams_of("a") for one in diagram.expect}
    assert told == {"A", "S1", "S2", "S3", "S4", "S5"}


SWING = """
title: Pendulum
span: [0, 20]
blocks:
  phi: {type: integrator, of: w, start: 1}
  w: {type: expression, formula: -phi}
expect:
"""
FALSE = """
  - name: C07 false
    says: The pendulum of constant length gains energy.
    source: nowhere
    that: end(phi) - 1
    above: 0.5
"""
PRINT = """
  - name: C07 misprint
    says: It does.
    source: Eq 0
    that: "at(phi, 0)"
    below: 0
    erratum: A misprint.
"""
LOST = """
  - name: C07 lost
    says: It has a rod.
    source: Eq 0
    that: time(impact)
    below: 0
"""


def swing(*statements: str) -> list[Diagram]:
    return [read_text(SWING + "".join(statements), Path("swing.yaml"))]


def test_a_false_statement_is_told_as_not_agreeing() -> None:
    found = reproduce("c", diagrams=swing(FALSE))
    (row,) = found.rows
    assert row.verdict == "does not agree"
    assert row.why == "≥ 0.5 was expected."
    assert found.open == (row,)
    assert "C07 false" in report_of(found).markdown().split("## What does not agree")[1]


def test_a_wrong_print_is_told_as_such_with_its_reason() -> None:
    found = reproduce("c", diagrams=swing(PRINT))
    assert (found.rows[0].verdict, found.rows[0].why) == ("the print is wrong", "A misprint.")
    assert found.open == ()
    assert "A misprint." in report_of(found).markdown().split("## Where the print is wrong")[1]


def test_what_cannot_be_measured_is_a_row_that_says_why() -> None:
    found = reproduce("c", diagrams=swing(LOST, PRINT))
    assert found.rows[0].verdict == "could not be measured"
    assert "there is no event 'impact' number 1" in found.rows[0].why
    assert found.rows[0].value is None
    assert len(found.rows) == 2


def test_progress_counts_the_statements() -> None:
    told: list[str] = []
    reproduce("c", diagrams=swing(FALSE, PRINT), progress=told.append)
    assert told == ["C07 false (1 of 2)", "C07 misprint (2 of 2)"]


def test_an_unknown_paper_is_told_with_those_that_exist() -> None:
    with pytest.raises(OptionError, match="unknown paper 'd'; there are: a, b, c"):
        reproduce("d")


def test_the_report_is_a_document_and_data(tmp_path: Path) -> None:
    found = reproduce("c", diagrams=swing(FALSE, PRINT, LOST))
    assert summary(found).startswith(
        "3 statements: the print is wrong: 1; does not agree: 1; could not be measured: 1."
    )
    for ending in ("md", "html"):
        text = report_of(found).write(tmp_path / f"report.{ending}").read_text(encoding="utf-8")
        assert all(row.statement.says in text for row in found.rows)
    data = json.loads(json.dumps(data_of(found)))
    assert data["counts"]["does not agree"] == 1
    assert [row["value"] for row in data["statements"]][1:] == [1.0, None]
    assert data["statements"][0]["low"] == 0.5 and data["statements"][0]["high"] is None
    table = verdicts_table(found.rows, short=True)
    assert table.header == ("statement", "measured", "expected", "verdict")


def test_the_report_lists_the_errata_of_all_diagrams() -> None:
    text = report_of(reproduce("a", diagrams=swing(PRINT))).markdown()
    errata = text.split("## All errata")[1]
    assert all(f"- {stage} (a_torsion/" in errata for stage in ("S1", "S2", "S3", "S4", "S5"))
    assert "Eq 23b prints kappa2_r in both branches" in errata


def test_the_short_bifurcation_diagram_is_as_dense_as_the_full_one_at_the_edges() -> None:
    """The paper's 800 frequencies, or as dense near the edges only."""
    (diagram,) = diagrams_of("b")
    run = next(one.run for one in diagram.expect if one.name == "B lower edge down")
    assert run.full is not None
    full, coarse = run.full.over["f"], run.over["f"]
    assert (len(full), full[0], full[-1]) == (800, 0.3, 0.9)
    assert len(coarse) < 150 and (coarse[0], coarse[-1]) == (0.3, 0.9)
    for edge in (0.700, 0.768):
        near = [f for f in coarse if abs(f - edge) < 0.005]
        assert max(b - a for a, b in itertools.pairwise(near)) < 0.00076


@pytest.mark.slow
def test_the_strategy_comes_closer_at_each_step() -> None:
    """Down to the noise of the record, which only the final model reaches."""
    steps = STEPS["a"].steps
    assert [step.name for step in steps] == ["M1", "M2", "M3", "M4, M5", "M6", "M7", "M8"]
    assert [step.stage for step in steps] == ["S1", "S1", "S1", "S1", "S2", "S3", "S4"]
    criteria = [step.disk for step in steps]
    assert sorted(criteria, reverse=True) == criteria
    assert criteria[-2] > 3 * FLOOR
    assert FLOOR / 2 < criteria[-1] < 1.5 * FLOOR
