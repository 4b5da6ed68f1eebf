"""A file of a diagram with a measured file beside it."""

from __future__ import annotations

from pathlib import Path

import pytest
from residual.series_files import CSV


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "run.csv").write_text(CSV, encoding="utf-8")
    return tmp_path / "diagram.yaml"
