"""`tracewire view`: the address in one line, and the ways to end it."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from http.client import HTTPException
from pathlib import Path
from typing import Any
from urllib.request import Request, urlopen

import pytest
from tracewire.cli import main

ROOT = Path(__file__).parents[2]
LESSON = ROOT / "diagrams" / "lessons" / "cart.yaml"
# the signal is what a terminal sends; where tests run in the background it would be ignored
CHILD = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
from tracewire.cli import main
sys.exit(main(sys.argv[1:]))
"""
LONG = """\
span: [0, 1e8]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: expression, formula: "-x + cos(1.3*t)"}
"""
ADDRESS = r"http://127\.0\.0\.1:\d+/[\w-]{32}/"


def test_ctrl_c_ends_it_quietly() -> None:
    child = subprocess.Popen(
        [sys.executable, "-c", CHILD, "view", str(LESSON), "--no-browser"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": ":".join(p for p in sys.path if p)},
    )
    assert child.stdout is not None
    assert re.fullmatch(rf"{ADDRESS}   \(Ctrl-C ends it\)\n", child.stdout.readline())
    child.send_signal(signal.SIGINT)
    out, err = child.communicate(timeout=30)
    assert (child.returncode, out, err) == (0, "", "")


def test_ctrl_c_ends_it_while_a_page_waits_for_a_run(tmp_path: Path) -> None:
    file = tmp_path / "long.yaml"
    file.write_text(LONG, encoding="utf-8")
    child = subprocess.Popen(
        [sys.executable, "-c", CHILD, "view", str(file), "--no-browser", "--limit", "60"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": ":".join(p for p in sys.path if p)},
    )
    assert child.stdout is not None
    address = child.stdout.readline().split()[0]
    key = asked(address, "read", {"text": LONG})["key"]
    waiting = threading.Thread(target=lambda: ends(address, {"key": key, "number": 1}))
    waiting.start()
    time.sleep(1.0)
    assert waiting.is_alive()
    child.send_signal(signal.SIGINT)
    out, err = child.communicate(timeout=30)
    assert (child.returncode, out, err) == (0, "", "")
    waiting.join()


def asked(address: str, action: str, request: dict[str, object]) -> Any:
    given = {"Content-Type": "application/json"}
    body = json.dumps(request).encode()
    with urlopen(Request(address + action, body, given), timeout=60) as answer:
        return json.loads(answer.read())


def ends(address: str, request: dict[str, object]) -> None:
    """Ask for a run whose server goes away meanwhile."""
    with contextlib.suppress(OSError, HTTPException):
        asked(address, "run", request)


def test_it_ends_by_itself_after_a_time(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["view", str(LESSON), "--no-browser", "--for", "0.2", "--json"]) == 0
    assert re.fullmatch(ADDRESS, json.loads(capsys.readouterr().out)["address"])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["no.yaml"], "unknown file 'no.yaml'"),
        ([str(LESSON), "--for", "0"], "--for 0 leaves no time"),
        ([str(LESSON), "--limit", "-1"], "--limit -1 leaves no time"),
        ([str(LESSON), "--port", "70000"], "the port 70000 of this machine cannot be used"),
        ([str(LESSON), "--library", "no.py"], "no.py"),
    ],
)
def test_what_cannot_be_served_is_told(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["view", "--no-browser", *arguments]) == 2
    assert said in capsys.readouterr().err
