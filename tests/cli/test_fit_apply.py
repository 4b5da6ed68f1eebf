"""`tracewire fit --apply` refuses, before the work, what it could not write after it."""

from __future__ import annotations

from pathlib import Path

import pytest
from tracewire.cli import main

PARTS = """\
subsystems:
  osc:
    outputs: [x]
    parameters: {k: {value: 4, fit: [1, 9]}}
    blocks:
      x: {type: integrator, of: v, start: 1}
      v: {type: integrator, of: a}
      a: {type: gain, of: x, k: -k}
"""
TOP = """\
span: [0, 1]
include: parts.yaml
blocks: {body: {type: osc}}
measured: {s: {file: s.csv, time: t, signals: {body.x: x}}}
"""


def test_values_of_an_included_subsystem_are_refused_before_the_fit(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "parts.yaml").write_text(PARTS, encoding="utf-8")
    (tmp_path / "top.yaml").write_text(TOP, encoding="utf-8")
    (tmp_path / "s.csv").write_text("t,x\n0,1\n0.5,0.6\n1,-0.4\n", encoding="utf-8")
    assert main(["fit", str(tmp_path / "top.yaml"), "--apply"]) == 2
    out, err = capsys.readouterr()
    assert "fitted parameters" not in out
    assert "the subsystem 'osc' is defined in another file. Edit that file, or write one" in err
