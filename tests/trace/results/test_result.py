"""What a result tells of fitted numbers, and of experiments."""

from __future__ import annotations

import numpy as np
import tracewire as tw
from oracles.oscillator import problem_of, record, trial_of
from scipy.integrate import solve_ivp
from tracewire.diagram import read_text
from tracewire.residual import Measured
from tracewire.trace.options import TraceOptions
from tracewire.trace.results.intervals import reported_intervals

DRUM = """\
span: [0, 20]
parameters: {c: {value: 0.1, unit: 1/s, fit: [0, 2]}}
blocks:
  phi: {type: integrator, of: omega, unit: rad}
  omega: {type: integrator, of: net, start: 8, unit: rad/s}
  friction: {type: viscous, rate: omega, c: c}
  net: {type: sum, of: [friction], unit: rad/s^2}
"""


def test_a_drum_that_coasts_down_is_not_released_to_tell_a_friction_from_a_torque() -> None:
    """It turns in one direction and stays where it is put: no release would tell anything."""
    t = np.arange(0.0, 16.0, 0.1)
    run = solve_ivp(lambda _, x: [x[1], -0.05 * x[1] - 0.3], (0, 16), [0, 8], t_eval=t, rtol=1e-8)
    noise = 0.01 * np.random.default_rng(3).standard_normal(len(t))
    start = {"phi": None, "omega": None}
    series = Measured("coast", "train", t, {"phi": run.y[0] + noise}, {"phi": 0.01}, start=start)
    options = TraceOptions(effects=1)
    found = tw.trace(tw.compile(read_text(DRUM)), [series], options=options)
    assert [effect.name for effect in found.effects] == ["coulomb"]
    assert "bias" in [tie.name for tie in found.effects[0].ties]
    assert found.experiments == ()
    (words,) = [w for w in found.words if "no experiment tells coulomb @ net from bias @ net" in w]
    assert words.startswith("within the range of these records")
    assert words.endswith("a friction turns with the motion, a constant force does not")


def test_an_interval_ends_at_the_bound_of_its_number() -> None:
    """More than the damping is taken away: c sits on 0, and a negative one is none."""
    trial = trial_of(problem_of(record(lambda x, v: 0.5 * v)))
    whole, told = trial.intervals(0.95), reported_intervals(trial, TraceOptions())
    assert whole["c"][0] < 0 == told["c"][0]
    assert told["c"][1] >= whole["c"][1]
    assert told["k"][0] <= whole["k"][0]
    assert told["k"][1] >= whole["k"][1]
