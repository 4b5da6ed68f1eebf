"""`demo`: the main job on the shipped example leaves figures and a report that can be read."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest


@pytest.mark.slow
def test_the_demo_names_what_the_diagram_lacks(call: Any, tmp_path: Path) -> None:
    folder = tmp_path / "new" / "out"
    told = call("demo", "--output", folder)
    assert told.code == 0
    for step in (
        "no problems",
        "s simulated in",
        "sided_spring @ column",
        "asym_coulomb @ contact",
    ):
        assert step in told.out
    assert f"figures and reports are in {folder}/" in told.out
    for figure in ("torsion.png", "trace/report_free_runs.png", "trace/report_law.png"):
        assert (folder / figure).read_bytes().startswith(b"\x89PNG")
    traced = (folder / "trace" / "report.md").read_text(encoding="utf-8")
    assert traced.startswith("# Trace of Double torsion pendulum, as first declared\n")
    patch = (folder / "pendulum.patch").read_text(encoding="utf-8")
    assert "+  sided_spring_column: {type: sided_spring, of: phi1, base: f_e, k: " in patch
    assert "+  asym_coulomb_contact: {type: asym_coulomb, rate: phi2_dot, level: " in patch


def test_a_folder_that_cannot_be_made_is_told_before_the_work(call: Any, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file", encoding="utf-8")
    told = call("demo", "--output", tmp_path / "out")
    assert (told.code, told.out) == (2, "")
    assert told.err.startswith(f"'{tmp_path / 'out'}' cannot be written: ")
