"""Closed and full streams end a command quietly, and no text of a file steers a terminal."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

ESCAPES = "\x1b[31m\x07\x9b2J\x7f\u202e"


def shell(command: str, folder: Path) -> tuple[int, str, str]:
    """The exit code, stdout and stderr of a line for the shell; `tw` stands for the command."""
    line = command.replace("tw", f"{sys.executable} -m tracewire", 1)
    environment = {**os.environ, "PYTHONPATH": ":".join(p for p in sys.path if p)}
    done = subprocess.run(
        ["bash", "-o", "pipefail", "-c", line],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert "Traceback" not in done.stdout + done.stderr
    assert "Exception ignored" not in done.stdout + done.stderr
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize(
    ("command", "code", "said"),
    [
        ("tw blocks >&-", 0, ""),
        ("tw blocks 2>&-", 0, ""),
        ("tw blocks >&- 2>&-", 0, ""),
        ("tw blocks >/dev/full", 1, "stdout cannot be written: No space left on device.\n"),
        ("tw blocks --json >/dev/full", 1, "stdout cannot be written: No space left on device.\n"),
        ("tw blocks --json >/dev/full 2>/dev/full", 1, ""),
        ("tw run swing.yaml >/dev/full", 1, "stdout cannot be written: No space left on device.\n"),
        ("tw check no.yaml 2>/dev/full", 2, ""),
        ("tw check no.yaml >&- 2>&-", 2, ""),
        ("tw check no.yaml --json >/dev/full 2>/dev/full", 2, ""),
    ],
)
def test_a_stream_that_takes_nothing_ends_quietly(
    tmp_path: Path, command: str, code: int, said: str
) -> None:
    swing = "span: [0, 1]\nblocks:\n  x: {type: integrator, of: x, start: 1}\n"
    (tmp_path / "swing.yaml").write_text(swing, encoding="utf-8")
    assert shell(command, tmp_path)[::2] == (code, said)


def test_a_reader_that_has_gone_ends_it_quietly(tmp_path: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    command = [sys.executable, "-m", "tracewire", "blocks", "--json"]
    environment = {**os.environ, "PYTHONPATH": ":".join(p for p in sys.path if p)}
    done = subprocess.run(command, stdout=writing, stderr=subprocess.PIPE, env=environment)
    os.close(writing)
    assert (done.returncode, done.stderr) == (1, b"")


@pytest.fixture
def coloured(tmp_path: Path) -> Path:
    """A diagram whose title, names in the file and header of the data have control characters."""
    (tmp_path / "run.csv").write_text(f"t,x,odd{ESCAPES}\n0,1,1\n1,2,1\n2,1,1\n", encoding="utf-8")
    written = json.dumps(ESCAPES)[1:-1]
    file = tmp_path / "coloured.yaml"
    text = f"""\
title: "Oscillator {written}"
span: [0, 1]
blocks:
  x: {{type: integrator, of: v, start: 1, unit: m}}
  v: {{type: integrator, of: a}}
  a: {{type: gain, of: x, k: -1}}
measured:
  "run {written}": {{file: run.csv, time: t, signals: {{x: {{column: x, sigma: 0.1}}}}}}
"""
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize(
    "arguments",
    [
        ["check", "{}"],
        ["check", "{}", "--json"],
        ["show", "{}", "--equations"],
        ["show", "{}", "--tree"],
        ["run", "{}"],
        ["run", "{}", "--json"],
        ["run", "{}", "--series", ESCAPES],
        ["run", f"no{ESCAPES}.yaml"],
        ["run", "{}", f"--{ESCAPES}"],
        ["blocks", ESCAPES],
    ],
)
def test_no_control_character_reaches_the_terminal(
    call: Any, coloured: Path, arguments: list[str]
) -> None:
    told = call(*(text.replace("{}", str(coloured)) for text in arguments))
    assert told.out + told.err != ""
    assert set(ESCAPES) - set("[31m2J") & set(told.out + told.err) == set()


def test_an_escape_is_shown_as_text_and_stays_in_json(call: Any, coloured: Path) -> None:
    assert "Oscillator \\x1b[31m\\x07\\x9b2J\\x7f\\u202e" in call("run", coloured).out
    assert call("run", coloured, "--json").data["title"] == f"Oscillator {ESCAPES}"
