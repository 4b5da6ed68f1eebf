"""What is measured: each file is a family of tables, found here by name."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from benchmarks.cases import (
    analyses,
    appendix,
    bifurcation,
    coverage,
    delays,
    fit_evaluation,
    many,
    networks,
    paper_a,
    paper_b,
    sensitivities,
    triple,
)
from benchmarks.options import Options
from benchmarks.table import Result

Case = Callable[[Options], Iterator[Result]]

CASES: Mapping[str, Case] = {
    "paper_a": paper_a.measure,
    "triple": triple.measure,
    "bifurcation": bifurcation.measure,
    "analyses": analyses.measure,
    "networks": networks.measure,
    "delays": delays.measure,
    "sensitivities": sensitivities.measure,
    "fit_evaluation": fit_evaluation.measure,
    "many": many.measure,
    "appendix": appendix.measure,
    "coverage": coverage.measure,
    "paper_b": paper_b.measure,
}
