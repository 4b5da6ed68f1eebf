"""What a finished search says of experiments."""

from __future__ import annotations

import numpy as np
import tracewire as tw
from scipy.integrate import solve_ivp
from tracewire.diagram import read_text
from tracewire.residual import Measured
from tracewire.trace.options import TraceOptions

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
