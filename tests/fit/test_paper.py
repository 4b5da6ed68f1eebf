"""The criterion of paper A's appendix on the shipped record, against the independent solution."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from oracles import double_torsion, make_records
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.fit import Criterion, load_measured
from tracewire.fit.starts import whole_segment
from tracewire.fit.unknowns import free_unknowns
from tracewire.solve import parameter_values

DIAGRAM = Path(__file__).parents[2] / "diagrams" / "papers" / "a_torsion" / "pendulum.yaml"


@pytest.fixture(scope="module")
def criterion() -> Criterion:
    model = compile(read(DIAGRAM))
    (record,) = load_measured(model)
    values = parameter_values(model, {}, record.preset)
    return Criterion(model, [whole_segment(model, record)], free_unknowns(model, None, values), {})


def test_the_fit_of_the_appendix_has_its_nine_unknowns_and_start(criterion: Criterion) -> None:
    begin = {u.name: u.value for u in criterion.unknowns}
    assert begin == pytest.approx(make_records.TORSION_START)


@pytest.mark.parametrize(
    "parameters", [make_records.TORSION_START, make_records.torsion_parameters()]
)
def test_the_criterion_is_that_of_the_independent_solution(
    criterion: Criterion, parameters: dict[str, float]
) -> None:
    """mean((phi2 measured - phi2 simulated)^2)/2."""
    (segment,) = criterion.segments
    simulated = double_torsion.solve(parameters, segment.t).states[2]
    by_oracle = np.mean((segment.measured.values["phi2"] - simulated) ** 2) / 2
    z = np.array([parameters[u.name] for u in criterion.unknowns]) / criterion.scales
    assert criterion.value(z) == pytest.approx(by_oracle, rel=1e-4)
