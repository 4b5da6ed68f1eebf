"""The growth of a wave against that of waves that are known."""

from __future__ import annotations

import pytest
from analyse.models import row_of, value_of

DAMPING = 5
DAMPED = """
title: Damped
span: [0, 20]
parameters: {c: 5}
blocks:
  x: {type: integrator, of: v, start: 0.005}
  v: {type: integrator, of: a}
  a: {type: expression, formula: -400*x - c*v}
  second: {type: expression, formula: 1000*x}
"""


@pytest.mark.parametrize("x", ["x", "v", "a", "second"])
@pytest.mark.parametrize("run", ["run: {since: 0}", "run: {since: 2}"])
def test_noise_of_a_run_that_has_decayed_is_no_wave(run: str, x: str) -> None:
    """exp(-c t/2) cos(w t) falls by exp(-50), and a run has nine digits of it."""
    rate = value_of(DAMPED, f"growth_rate({x})", run)
    assert rate == pytest.approx(-DAMPING / 2, rel=2e-3)


def test_what_is_noise_only_has_no_rate() -> None:
    run = "run: {since: 10, samples: 1001}"
    why = row_of(DAMPED, "growth_rate(x)", run).why
    assert "'x' has 0 peaks there" in why and "the tolerances of the run do not resolve it" in why
    slow = "run: {set: {c: 50}}"  # beyond the critical damping it has no waves
    assert "'x' has 0 peaks there" in row_of(DAMPED, "growth_rate(x)", slow).why
