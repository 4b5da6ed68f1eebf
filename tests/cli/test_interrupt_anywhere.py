"""Ctrl-C at any moment of a verb: words, exit code 130, and no half file."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

SWING = """\
span: [0, 20]
parameters: {k: 4}
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: expression, formula: "-k*x - 0.1*sign(v) + cos(1.3*t)"}
"""
VERBS = {
    "blocks": ["blocks"],
    "check": ["check", "swing.yaml"],
    "show": ["show", "swing.yaml", "--equations"],
    "run": ["run", "swing.yaml", "--output", "a.npz"],
    "sweep": ["sweep", "swing.yaml", "--over", "k=1:5:9", "--keep", "max(x)", "--output", "a.npz"],
    "steady": ["analyse", "steady", "rest.yaml", "--json"],
}
# from the first line of `main` on: what Python does before is not ours
CHILD = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
from tracewire.cli import main
print("begun", flush=True)
sys.exit(main())
"""
DRAWS = 6


def begun(folder: Path, arguments: list[str]) -> subprocess.Popen[str]:
    child = subprocess.Popen(
        [sys.executable, "-c", CHILD, *arguments],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": ":".join(p for p in sys.path if p)},
    )
    assert child.stdout is not None
    assert child.stdout.readline() == "begun\n"
    return child


@pytest.mark.slow
@pytest.mark.parametrize("verb", VERBS)
def test_an_interrupt_at_any_moment_is_told(verb: str, tmp_path: Path) -> None:
    (tmp_path / "swing.yaml").write_text(SWING, encoding="utf-8")
    rest = SWING.replace(" + cos(1.3*t)", "")
    (tmp_path / "rest.yaml").write_text(rest, encoding="utf-8")
    start = time.monotonic()
    begun(tmp_path, VERBS[verb]).communicate(timeout=300)
    whole = time.monotonic() - start
    (tmp_path / "a.npz").unlink(missing_ok=True)
    seed = random.randrange(10**6)
    draw = random.Random(seed)
    for _ in range(DRAWS):
        child = begun(tmp_path, VERBS[verb])
        time.sleep(whole * draw.random())
        child.send_signal(signal.SIGINT)
        _, err = child.communicate(timeout=300)
        assert child.returncode in (0, 130), f"seed {seed}: {err}"
        assert "Traceback" not in err, f"seed {seed}: {err}"
        if child.returncode == 130:
            assert "interrupted" in err
        if (tmp_path / "a.npz").exists():
            with np.load(tmp_path / "a.npz") as file:
                assert len(file.files) > 0


LOADING = """
import sys
class Interrupt:
    def find_spec(self, name, *_):
        if name == "tracewire.cli.app":
            raise KeyboardInterrupt
sys.meta_path.insert(0, Interrupt())
from tracewire.cli import main
sys.exit(main())
"""


LOST = """
import sys
class Lost:
    def __del__(self):
        raise KeyboardInterrupt
class Interrupt:
    def find_spec(self, name, *_):
        if name == "tracewire.cli.app":
            Lost()
sys.meta_path.insert(0, Interrupt())
from tracewire.cli import main
sys.exit(main())
"""


@pytest.mark.parametrize("program", [LOADING, LOST])
def test_an_interrupt_while_the_program_loads_is_told(program: str) -> None:
    environment = {**os.environ, "PYTHONPATH": ":".join(p for p in sys.path if p)}
    command = [sys.executable, "-c", program, "blocks"]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=300)
    assert (done.returncode, done.stderr) == (130, "interrupted; nothing was finished.\n")
