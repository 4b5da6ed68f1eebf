"""Statements that share a run are judged alone."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from tracewire.analyse import judge
from tracewire.diagram import read_text

BALL = """
title: Ball
span: [0, 1.2]
every: 0.01
blocks:
  h: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: g, start: 0}
  g: {type: constant, value: -2}
  root: {type: expression, formula: sqrt(h - 0.5)}
  late: {type: integrator, of: steep, start: 0}
  steep: {type: expression, formula: 1/(2 - t)}
events:
  - {when: h, crosses: down, set: {v: -0.5*v}}
expect:
  - {that: count(), is: 1, within: 0}
  - {that: min(h), is: 0, within: 0.01}
  - {that: "at(late, 1)", is: 0.6931, within: 0.001}
"""


@pytest.mark.parametrize(
    ("bad", "why"),
    [
        ("at(h, -5)", "a quantity reads a signal at -5 s, and the run begins at 0 s"),
        ("max(root)", "the recorded signal 'root' is not finite"),
        ("at(late, 2.5)", "2"),
        ("end(h)/0", "'end(h)/0' has no value"),
    ],
)
@pytest.mark.parametrize("first", [True, False])
def test_a_statement_that_cannot_be_measured_spoils_no_other(
    bad: str, why: str, first: bool
) -> None:
    line = f'  - {{that: "{bad}", above: -9}}\n'
    text = BALL.replace("expect:\n", "expect:\n" + line) if first else BALL + line
    rows = judge(read_text(text, Path("a.yaml")))
    lost = rows[0 if first else -1]
    assert lost.verdict == "could not be measured" and why in lost.why
    good = [row for row in rows if row is not lost]
    assert [row.value for row in good] == pytest.approx([1, 0, math.log(2)], abs=0.01)
    assert all(row.holds and not row.why for row in good)


def test_what_is_read_after_the_end_adds_no_events() -> None:
    steady = BALL.replace("1/(2 - t)", "1")  # so that the run goes on, past the impact at 2 s
    text = steady.replace("expect:\n", 'expect:\n  - {that: "at(h, 2.4)", above: 0.01}\n')
    rows = judge(read_text(text, Path("a.yaml")))
    assert [row.value for row in rows[1:3]] == pytest.approx([1, 0], abs=0.01)
    assert rows[0].holds
