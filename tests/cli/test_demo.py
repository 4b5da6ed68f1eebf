"""`demo`: the main job on the shipped examples leaves figures and reports that can be read."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest


@pytest.mark.slow
def test_the_demo_writes_what_it_promises(call: Any, tmp_path: Path) -> None:
    folder = tmp_path / "new" / "out"
    told = call("demo", "--output", folder)
    assert told.code == 0
    for step in ("no problems", "s simulated in", "the criterion fell from", "verdict: effect"):
        assert step in told.out
    assert f"figures and reports are in {folder}/" in told.out
    for figure in ("torsion.png", "trace/held_out.png", "trace/residual.png"):
        assert (folder / figure).read_bytes().startswith(b"\x89PNG")
    fitted = (folder / "fit" / "report.html").read_text(encoding="utf-8")
    traced = (folder / "trace" / "report.md").read_text(encoding="utf-8")
    assert "<h1>Fit of Double torsion pendulum</h1>" in fitted
    assert traced.startswith("# Trace of Pendulum with viscous friction\n")
    assert "coulomb" in traced
    patch = (folder / "pendulum.patch").read_text(encoding="utf-8")
    assert "+  acceleration: {type: sum, of: [gravity, friction, coulomb]}" in patch


def test_a_folder_that_cannot_be_made_is_told_before_the_work(call: Any, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file", encoding="utf-8")
    told = call("demo", "--output", tmp_path / "out")
    assert (told.code, told.out) == (2, "")
    assert told.err.startswith(f"'{tmp_path / 'out'}' cannot be written: ")
