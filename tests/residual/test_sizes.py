"""Numbers whose squares are no numbers are refused before a fit, by series, signal and column."""

from __future__ import annotations

from pathlib import Path

import pytest
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.errors import DataError
from tracewire.residual import load_measured

DIAGRAM = """\
blocks: {x: {type: integrator, of: v, unit: m}, v: {type: constant, value: 1}}
measured:
  run: {file: run.csv, time: t, signals: {x: {column: way, unit: mm}}}
"""


@pytest.mark.parametrize(("reading", "told"), [("1e300", "1e\\+297"), ("-1e120", "1e\\+117")])
def test_a_reading_whose_square_is_no_number_is_refused(
    tmp_path: Path, reading: str, told: str
) -> None:
    (tmp_path / "run.csv").write_text(f"t,way\n0,1\n1,{reading}\n", encoding="utf-8")
    (tmp_path / "diagram.yaml").write_text(DIAGRAM, encoding="utf-8")
    message = f"'x' of the series 'run' reaches {told}, too large to fit. .*column 'way'"
    with pytest.raises(DataError, match=message):
        load_measured(compile(read(tmp_path / "diagram.yaml")))
