"""Numbers of a measured series that read what a fit changes are refused: they would not follow."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tracewire.cli.app import main
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.errors import OptionError
from tracewire.fit import fit
from tracewire.residual import load_measured
from tracewire.trace import trace

DIAGRAM = """\
span: [0, 2]
record: [x]
parameters:
  k: {value: 3, fit: [0.1, 10]}
  begin: {value: 1, BEGIN}
  late: {value: 20, unit: ms, LATE}
  twice: {value: 2*late, unit: s}
blocks:
  x: {type: integrator, of: rate, start: 1, unit: m}
  rate: {type: sum, of: [loss]}
  loss: {type: gain, of: x, k: -k}
measured:
  run:
    file: run.csv
    use: train
    time: t
    signals: {x: {column: x, unit: m, sigma: 0.001, delay: DELAY}}
    start: {x: START}
"""


def written(folder: Path, **words: str) -> Path:
    t = np.arange(0.0, 2.0, 0.01)
    rows = [f"{a:.4f},{np.exp(-2 * max(a - 0.03, 0.0)):.6f}" for a in t.tolist()]
    (folder / "run.csv").write_text("\n".join(["t,x", *rows]) + "\n", encoding="utf-8")
    text = DIAGRAM
    for word in ("BEGIN", "LATE", "DELAY", "START"):
        text = text.replace(word, words[word])
    file = folder / "run.yaml"
    file.write_text(text.replace(", }", "}"), encoding="utf-8")
    return file


FREE = {"BEGIN": "fit: [0, 2]", "LATE": "fit: [0, 100]", "DELAY": "twice", "START": "begin"}
FIXED = {"BEGIN": "", "LATE": "", "DELAY": "late", "START": "begin"}


def test_a_start_and_a_delay_that_read_free_parameters_are_refused(tmp_path: Path) -> None:
    model = compile(read(written(tmp_path, **FREE)))
    for command in (fit, trace):
        with pytest.raises(OptionError) as caught:
            command(model)  # type: ignore[operator]
        text = str(caught.value)
        assert "run.yaml:" in text
        assert "the delay of 'x' in the series 'run' reads 'twice', which is free" in text
        assert "the start of 'x' in the series 'run' reads 'begin', which is free" in text
        assert "Write {value: ..., fit: [low, high]}, or fix the parameter." in text


def test_check_refuses_them_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(written(tmp_path, **FREE))]) != 0
    assert "reads 'twice', which is free" in capsys.readouterr().err


def test_parameters_that_a_fit_leaves_alone_may_be_read(tmp_path: Path) -> None:
    model = compile(read(written(tmp_path, **FREE)))
    found = fit(model, free=["k"], method="least_squares")
    assert found.values["k"] == pytest.approx(2.0, rel=0.1)


def test_values_given_to_a_fit_reach_what_a_series_reads(tmp_path: Path) -> None:
    model = compile(read(written(tmp_path, **FIXED)))
    (plain,) = load_measured(model)
    (given,) = load_measured(model, parameters={"late": 0.03, "begin": 1.5})
    assert plain.sensor("x").delay == pytest.approx(0.02)
    assert given.sensor("x").delay == pytest.approx(0.03)
    assert given.start["x"] == pytest.approx(1.5)
    found = fit(model, parameters={"late": 0.03}, method="least_squares")
    assert found.values["k"] == pytest.approx(2.0, rel=1e-3)
