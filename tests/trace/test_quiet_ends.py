"""A record whose last sixth stands still confirms no effect of a moving drive, and refutes none."""

from __future__ import annotations

import numpy as np
import tracewire as tw
from scipy.signal import lfilter
from tracewire.residual import Measured
from tracewire.solve import Held
from tracewire.trace import Found, TraceOptions, trace

STAGE = """
span: [0, 400]
inputs: [u]
parameters:
  g: {value: 1, fit: [0.5, 2]}
  tau: {value: 6, fit: [0.2, 50]}
blocks:
  y: {type: integrator, of: rate}
  feed: {type: gain, of: u, k: g/tau}
  leak: {type: gain, of: y, k: -1/tau}
  rate: {type: sum, of: [feed, leak]}
"""
T = np.arange(400.0)
QUIET = 320
U = np.where((T // 40) % 2 == 0, 1.0, 2.0)
U[QUIET:] = U[QUIET]
SAYS = "they do not move alike, and confirm nothing"


def traced(options: TraceOptions) -> Found:
    """The trace of a stage whose drive is late by two samples, under slow noise that is twice what
    is declared; the drive does not move in the last fifth."""
    model = tw.compile(tw.read_text(STAGE))
    late = np.concatenate([np.full(2, U[0]), U[:-2]])
    run = tw.simulate(model, times=T, inputs={"u": Held(T, late)}, start={"y": 1.0})
    noise = lfilter([1.0], [1.0, -0.7], np.random.default_rng(2).standard_normal(len(T)))
    y = run["y"] + 0.02 * noise / np.std(noise)
    inputs, start = {"u": Held(T, U)}, {"y": None}
    record = Measured("run", "train", T, {"y": y}, {"y": 0.01}, inputs=inputs, start=start)
    return trace(model, [record], options=options)


def test_an_unseen_part_in_which_nothing_moves_does_not_refuse_a_delay() -> None:
    found = traced(TraceOptions())
    assert found.verdict == "effect"
    assert [effect.name for effect in found.effects] == ["drive_delay"]
    assert abs(found.effects[0].params["tau"] - 2.0) < 0.1
    assert any(SAYS in words for words in found.words)


def test_it_would_if_any_unseen_part_could() -> None:
    found = traced(TraceOptions(excited=0.0))
    assert found.verdict == "unexplained"
    assert not any(SAYS in words for words in found.words)
