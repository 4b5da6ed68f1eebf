"""Steps in which no guard comes near zero are not sampled inside, and nothing else changes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from solve.models import BALL, OSCILLATOR
from tracewire.compile import Model, compile
from tracewire.diagram import read, read_text
from tracewire.solve import simulate
from tracewire.solve.setup import plan_of

PENDULUM = Path(__file__).parents[2] / "diagrams/papers/a_torsion/pendulum.yaml"
# a dip of 1e-4 below a level, inside of a step of any method
DIP = """
span: [0, 6]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a, start: 0}
  a: {type: expression, formula: "-x + 1e-6*(1 if x + 0.9999 > 0 else -1)"}
"""
TEXTS = {"ball": BALL, "oscillator": OSCILLATOR, "dip": DIP}


def model_of(name: str) -> Model:
    """A model that nobody has run."""
    return compile(read(PENDULUM) if name == "pendulum" else read_text(TEXTS[name]))


@pytest.mark.parametrize("method", ["auto", "dop853", "rosenbrock"])
@pytest.mark.parametrize("name", [*TEXTS, "pendulum"])
def test_a_run_is_that_in_which_every_step_is_sampled(name: str, method: str) -> None:
    model, sampled = model_of(name), model_of(name)
    assert plan_of(model).straight.any()
    plan_of(sampled).straight[:] = 0
    run, same = simulate(model, method=method), simulate(sampled, method=method)
    assert run.events == same.events
    assert run.events
    assert run.final == same.final
    for signal, values in run.signals.items():
        assert np.array_equal(values, same[signal])
