"""A long session keeps only what it uses."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = """
import sys
sys.path[:0] = {path!r}
import tracewire
TEXT = '''
span: [0, 1]
blocks:
  x: {{type: integrator, of: v, start: 1}}
  v: {{type: integrator, of: a}}
  friction: {{type: coulomb, rate: v, level: 0.5}}
  a: {{type: expression, formula: "-NUMBER*x + friction"}}
'''
def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096 / 1e6
for number in range(500):
    text = TEXT.replace("NUMBER", str(5 + number / 1000))
    tracewire.simulate(tracewire.compile(tracewire.read_text(text)))
    if number == 100:  # all that is made once is there
        before = resident()
print(resident() - before)
"""
MOST = 10.0  # MB


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_four_hundred_models_leave_little_behind() -> None:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(path=sys.path)],
        capture_output=True,
        text=True,
        check=True,
    )
    assert float(done.stdout) < MOST
