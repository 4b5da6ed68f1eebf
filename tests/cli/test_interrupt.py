"""Ctrl-C during `run`: what was computed is in a file, and the message says so."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from tracewire.cli.output import telling

PRINTED = 1e-8  # of a number: a message has nine digits of it
LONG = """\
span: [0, 1e7]
every: 100
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: expression, formula: "-x - 0.1*sign(v) + cos(1.3*t)"}
"""
# the signal is what a terminal sends; where tests run in the background it would be ignored
CHILD = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
from tracewire.cli import main
from tracewire.solve import integrator
usual = integrator.next_budget
def begun(budget, steps, seconds):
    if budget > 5000:
        print("begun", flush=True)
    return usual(budget, steps, seconds)
integrator.next_budget = begun
sys.exit(main(sys.argv[1:]))
"""


def interrupted(folder: Path, *arguments: str) -> tuple[int, str]:
    """The exit code and the last line of stderr of a long run that gets a SIGINT."""
    (folder / "long.yaml").write_text(LONG, encoding="utf-8")
    child = subprocess.Popen(
        [sys.executable, "-c", CHILD, "run", "long.yaml", *arguments],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": ":".join(p for p in sys.path if p)},
    )
    assert child.stdout is not None
    assert child.stdout.readline() == "begun\n"
    child.send_signal(signal.SIGINT)
    _, err = child.communicate(timeout=120)
    assert "Traceback" not in err
    return child.returncode, err.splitlines()[-1]


def test_an_interrupted_run_is_kept_where_the_user_wants_it(tmp_path: Path) -> None:
    code, said = interrupted(tmp_path, "--output", "swing.npz")
    found = re.fullmatch(
        r"interrupted at t = (\S+) s, on the way from 0 to 1e\+07 s\. "
        r"The run up to there is in 'swing.npz': (\d+) samples and (\d+) events\.",
        said,
    )
    assert found is not None
    assert code == 130
    reached, samples, events = float(found[1]), int(found[2]), int(found[3])
    saved = np.load(tmp_path / "swing.npz")
    assert len(saved["t"]) == len(saved["x"]) == samples > 0
    assert len(saved["event_time"]) == events > 100
    assert saved["event_time"][-1] <= reached * (1 + PRINTED) < 1e7
    assert np.isfinite(saved["x"]).all()


def test_an_interrupted_run_is_kept_though_nobody_asked(tmp_path: Path) -> None:
    code, said = interrupted(tmp_path)
    assert code == 130
    assert "The run up to there is in 'long.interrupted.npz': " in said
    assert len(np.load(tmp_path / "long.interrupted.npz")["event_time"]) > 100


def test_a_csv_file_says_that_it_has_no_events(tmp_path: Path) -> None:
    code, said = interrupted(tmp_path, "--output", "swing.csv", "--json")
    assert code == 130
    assert "in 'swing.csv': " in said
    assert said.endswith("events (events go into .npz only).")
    assert (tmp_path / "swing.csv").read_text(encoding="utf-8").startswith("t,x,v")


def test_progress_is_shown_from_the_first_second_on(monkeypatch: pytest.MonkeyPatch) -> None:
    clock, shown = [0.0], list[str]()
    monkeypatch.setattr("tracewire.cli.output.time.monotonic", lambda: clock[0])
    tell = telling("simulating a.yaml", shown.append)
    for now, part, left in ((0.5, 0.1, 4.5), (2.0, 0.25, 5.2), (3.0, 0.5, 83.0), (4.0, 0, np.inf)):
        clock[0] = now
        tell(part, left)
    tell(0.0, 7300.0)
    assert shown == [
        "simulating a.yaml: 25 %, 6 s left",
        "simulating a.yaml: 50 %, 1 min 23 s left",
        "simulating a.yaml: 0 %",
        "simulating a.yaml: 0 %, 2 h 1 min left",
    ]
