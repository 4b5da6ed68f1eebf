"""The statements of each paper, in the order of its systems."""

from __future__ import annotations

from collections.abc import Mapping

from tracewire.errors import OptionError, unknown
from tracewire.paper.figure import PAPERS
from tracewire.paper.statement import Statement

DIAGRAMS: Mapping[str, str] = {"a": "a_torsion", "b": "b_triple", "c": "c_review"}
"""The folder of each paper's diagrams."""


def statements_of(paper: str) -> tuple[Statement, ...]:
    """The statements of paper "a", "b" or "c". Raises OptionError: no such paper."""
    from tracewire.paper import (
        statements_a,
        statements_b,
        statements_c_atwood,
        statements_c_hill,
        statements_c_pendulums,
    )

    if paper not in PAPERS:
        raise OptionError([unknown("paper", paper, PAPERS)])
    c = (
        *statements_c_hill.STATEMENTS,
        *statements_c_pendulums.STATEMENTS,
        *statements_c_atwood.STATEMENTS,
    )
    return {"a": statements_a.STATEMENTS, "b": statements_b.STATEMENTS, "c": c}[paper]
