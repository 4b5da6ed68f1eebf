"""What the papers state, measured on the shipped diagrams, and the report of it."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest
from tracewire.errors import OptionError
from tracewire.paper.document import data_of, report_of, statements_table, summary
from tracewire.paper.identification import FLOOR, Step, identification
from tracewire.paper.reproduction import reproduce
from tracewire.paper.runs import Systems
from tracewire.paper.statement import Bounds, Statement, about, above, below, between
from tracewire.paper.statements import DIAGRAMS, statements_of
from tracewire.paper.statements_b import frequencies, main_band

ROOT = Path(__file__).parents[2]
SYSTEMS = {paper: Systems(folder) for paper, folder in DIAGRAMS.items()}
LONG = re.compile(r"A (step|final)|B (coexisting|lower|upper|regular|exponents|sum)")
# the text names one irregular region; 200 skipped periods leave more on the way down
BESIDE = "B regular beside, down"


def cases(long: bool) -> list[tuple[str, Statement]]:
    found = [(paper, statement) for paper in DIAGRAMS for statement in statements_of(paper)]
    return [case for case in found if bool(LONG.match(case[1].name)) is long]


def name_of(value: object) -> str:
    return value.name if isinstance(value, Statement) else str(value)


def judge(paper: str, statement: Statement) -> str:
    return statement.judge(float(statement.measure(SYSTEMS[paper])))


@pytest.mark.parametrize(("paper", "statement"), cases(long=False), ids=name_of)
def test_a_statement_agrees_or_its_print_is_wrong(paper: str, statement: Statement) -> None:
    expected = "the print is wrong" if statement.erratum else "agrees"
    assert judge(paper, statement) == expected


@pytest.mark.slow
@pytest.mark.parametrize(("paper", "statement"), cases(long=True), ids=name_of)
def test_a_long_statement_agrees_but_for_the_bands_beside_the_region(
    paper: str, statement: Statement
) -> None:
    expected = "does not agree" if statement.name == BESIDE else "agrees"
    assert judge(paper, statement) == expected


@pytest.mark.parametrize("paper", DIAGRAMS)
def test_every_statement_says_what_it_is(paper: str) -> None:
    statements = statements_of(paper)
    names = [statement.name for statement in statements]
    assert len(set(names)) == len(names)
    for statement in statements:
        assert statement.says.endswith(".") and statement.source and statement.what
        assert statement.expected.low > -math.inf or statement.expected.high < math.inf


def test_every_system_of_paper_c_has_a_statement() -> None:
    told = {statement.system for statement in statements_of("c")}
    assert told == {f"C{n:02d}" for n in range(1, 36)}


def test_paper_a_is_told_by_stages_and_steps() -> None:
    told = {statement.system for statement in statements_of("a")}
    assert told == {"A", "S1", "S2", "S3", "S4", "S5"}


@pytest.mark.parametrize(
    ("bounds", "inside", "outside"),
    [
        (about(2.0, 0.5), [1.5, 2.5], [1.4, 2.6]),
        (below(1.0), [1.0, -5.0], [1.1]),
        (above(1.0), [1.0, 5.0], [0.9]),
        (between(0.3, 0.8), [0.3, 0.8], [0.2, 0.9]),
    ],
)
def test_bounds_hold_inside_and_no_number_is_inside(
    bounds: Bounds, inside: list[float], outside: list[float]
) -> None:
    assert all(bounds.hold(value) for value in inside)
    assert not any(bounds.hold(value) for value in (*outside, math.nan))


FALSE = Statement(
    "C07 false",
    "The pendulum of constant length gains energy.",
    "nowhere",
    "gain over 20 s, parts",
    lambda s: float(s.run("c07")["energy"][-1] / s.run("c07")["energy"][0]) - 1,
    above(0.5),
)
PRINT = Statement(
    "C07 misprint", "It does.", "Eq 0", "a number", lambda s: 1.0, below(0.0), erratum="A misprint."
)
LOST = Statement(
    "C07 lost", "It has a rod.", "Eq 0", "a number", lambda s: s.run("rod")["x"][0], below(0.0)
)


def test_a_false_statement_is_told_as_not_agreeing() -> None:
    found = reproduce("c", statements=[FALSE])
    (row,) = found.rows
    assert row.verdict == "does not agree"
    assert row.why == "≥ 0.5 was expected."
    assert found.open == (row,)
    assert "C07 false" in report_of(found).markdown().split("## What does not agree")[1]


def test_a_wrong_print_is_told_as_such_with_its_reason() -> None:
    found = reproduce("c", statements=[PRINT])
    assert (found.rows[0].verdict, found.rows[0].why) == ("the print is wrong", "A misprint.")
    assert found.open == ()
    assert "A misprint." in report_of(found).markdown().split("## Where the print is wrong")[1]


def test_what_cannot_be_measured_is_a_row_that_says_why() -> None:
    found = reproduce("c", statements=[LOST, PRINT])
    assert found.rows[0].verdict == "could not be measured"
    assert "there is no diagram 'rod'" in found.rows[0].why
    assert found.rows[0].value is None
    assert len(found.rows) == 2


def test_progress_counts_the_statements() -> None:
    told: list[str] = []
    reproduce("c", statements=[FALSE, PRINT], progress=told.append)
    assert told == ["C07 false (1 of 2)", "C07 misprint (2 of 2)"]


def test_an_unknown_paper_is_told_with_those_that_exist() -> None:
    with pytest.raises(OptionError, match="unknown paper 'd'; there are: a, b, c"):
        reproduce("d")


def test_the_report_is_a_document_and_data(tmp_path: Path) -> None:
    found = reproduce("c", statements=[FALSE, PRINT, LOST])
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
    table = statements_table(found.rows, short=True)
    assert table.header == ("statement", "measured", "expected", "verdict")


def test_the_report_lists_the_errata_of_all_diagrams() -> None:
    text = report_of(reproduce("a", statements=[PRINT])).markdown()
    errata = text.split("## All errata")[1]
    assert all(f"- {stage} (a_torsion/" in errata for stage in ("S1", "S2", "S3", "S4", "S5"))
    assert "Eq 23b prints kappa2_r in both branches" in errata


def test_the_coarse_diagram_is_as_dense_as_the_full_one_at_the_edges() -> None:
    full, coarse = frequencies(True), frequencies(False)
    assert (len(full), full[0], full[-1]) == (800, 0.3, 0.9)
    assert len(coarse) < 150 and coarse[0] == pytest.approx(0.3) and coarse[-1] > 0.895
    for edge in (0.700, 0.768):
        near = coarse[abs(coarse - edge) < 0.005]
        assert max(near[1:] - near[:-1]) < 0.00076


def test_bands_a_step_apart_are_one_region() -> None:
    assert main_band([(0.40, 0.42), (0.700, 0.719), (0.721, 0.768)]) == (0.700, 0.768)


@pytest.mark.slow
def test_the_strategy_comes_closer_at_each_step() -> None:
    """Down to the noise of the record, which only the final model reaches."""
    steps: tuple[Step, ...] = identification(SYSTEMS["a"])
    assert [step.name for step in steps] == ["M1", "M2", "M3", "M4, M5", "M6", "M7", "M8"]
    assert [step.stage for step in steps] == ["S1", "S1", "S1", "S1", "S2", "S3", "S4"]
    criteria = [step.disk for step in steps]
    assert sorted(criteria, reverse=True) == criteria
    assert criteria[-2] > 3 * FLOOR
    assert FLOOR / 2 < criteria[-1] < 1.5 * FLOOR
