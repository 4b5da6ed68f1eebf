"""The generated record of paper A: its own diagram lacks nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.trace import trace

PENDULUM = Path(__file__).parents[2] / "diagrams/papers/a_torsion/pendulum.yaml"


@pytest.mark.slow
def test_the_full_model_of_paper_a_lacks_nothing_on_its_generated_record() -> None:
    found = trace(compile(read(PENDULUM)))
    assert found.verdict == "null"
    assert found.effects == ()
    assert found.s2_before < 1.3
