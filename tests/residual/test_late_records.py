"""A record that begins late: which time is 0 matters where the diagram reads the time."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.residual import load_measured

SWING = """\
span: [0, 6]
blocks:
  theta: {{type: integrator, of: omega, unit: rad}}
  omega: {{type: integrator, of: pull, unit: rad/s}}
  pull: {{type: expression, formula: {formula}}}
measured:
  run: {{file: run.csv, time: t, signals: {{theta: angle}}}}
"""


@pytest.mark.parametrize(
    ("formula", "begin", "told"),
    [("-theta", 173, False), ("sin(t) - theta", 173, True), ("-theta", 1700000000, True)],
    ids=["no time", "reads the time", "a date"],
)
def test_a_late_first_sample_is_remarked_where_it_matters(
    tmp_path: Path, formula: str, begin: int, told: bool
) -> None:
    rows = "".join(f"{begin + i / 8},{math.sin(i / 4)}\n" for i in range(49))
    (tmp_path / "run.csv").write_text(f"t,angle\n{rows}", encoding="utf-8")
    file = tmp_path / "swing.yaml"
    file.write_text(SWING.format(formula=formula), encoding="utf-8")
    (run,) = load_measured(compile(read(file)))
    far = [one for one in run.remarks if one.startswith("the first sample is at t = ")]
    assert bool(far) is told
