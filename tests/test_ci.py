"""`.ci/run`: what it does where programs cannot be installed."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
NEEDED = ("bash", "dirname", "id", "timeout")
pytestmark = pytest.mark.skipif(os.name != "posix", reason="a shell script")


def run(folder: Path, installs: str) -> subprocess.CompletedProcess[str]:
    """Run it with a `make` that only says what it was asked for, and an apt-get of our own."""
    for name in NEEDED:
        (folder / name).symlink_to(str(shutil.which(name)))
    for name, text in {"make": 'echo "made: $*"', "apt-get": installs, "sudo": '"$@"'}.items():
        file = folder / name
        file.write_text(f"#!/bin/bash\n{text}\n", encoding="utf-8")
        file.chmod(0o755)
    return subprocess.run(
        ["bash", str(ROOT / ".ci" / "run")],
        env={"PATH": str(folder)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def test_what_cannot_be_installed_is_said_and_the_rest_goes_on(tmp_path: Path) -> None:
    done = run(tmp_path, "exit 100")
    assert done.returncode == 0
    for name in ("ffmpeg", "chromium"):
        assert f"== {name}: apt-get cannot install this. THE TESTS THAT NEED IT" in done.stderr
    assert done.stdout.splitlines()[-1] == "made: test ARGS=-rs"
    assert "made: demo" in done.stdout and "made: check" in done.stdout


def test_one_program_that_cannot_be_installed_does_not_keep_away_the_other(tmp_path: Path) -> None:
    done = run(tmp_path, '[ "${@: -1}" != chromium ]')
    assert "ffmpeg: apt-get" not in done.stderr
    assert "== chromium: apt-get cannot install this" in done.stderr
    assert done.stdout.splitlines()[-1] == "made: test ARGS=-rs"


def test_where_all_is_installed_no_test_may_be_skipped(tmp_path: Path) -> None:
    done = run(tmp_path, "exit 0")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines()[-1] == "made: test ARGS=--none-skipped"
