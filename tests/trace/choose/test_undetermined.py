"""An effect whose coefficient may be zero is named only where a ratio with it is known."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import tracewire as tw
from tracewire.diagram import read_text
from tracewire.trace.choose import safeguards
from tracewire.trace.choose.safeguards import undetermined_effects

VALUES = {"k": 90.0, "c": 7.5, "rub.level": 13000.0}
MOTOR = """\
inputs: {{pwm: {{default: 0}}}}
parameters: {{k: {{value: 30, fit: [1, 500]}}, c: {{value: 10, fit: [0.5, 200]}}}}
blocks:
  position: {{type: integrator, of: rate}}
  rate: {{type: integrator, of: acceleration}}
  torque: {{type: gain, of: pwm, k: k}}
  friction: {{type: viscous, rate: rate, c: c}}
  acceleration: {{type: sum, of: [torque, friction{more}], place: {{q: position, v: rate}}}}
"""
HIDDEN = """\
  rub: {type: coulomb, rate: rate, level: 9500}
  teeth: {type: expression, formula: 700*sin(position/80)}
"""


class Effect:
    candidate = SimpleNamespace(coefficient="rub.level")

    def __str__(self) -> str:
        return "coulomb @ acceleration"


def trial_with(common: float, own: float) -> Any:
    """A trial whose values err together by a part `common` of each, and each alone by `own`."""
    values = np.array(list(VALUES.values()))
    errors = (common**2 + own**2) ** 0.5 * values
    ends = np.stack((values - 2 * errors, values + 2 * errors), axis=1).tolist()
    return SimpleNamespace(
        values=VALUES,
        standard_errors=dict(zip(VALUES, errors.tolist(), strict=True)),
        intervals=lambda confidence: dict(zip(VALUES, map(tuple, ends), strict=True)),
        effects=[Effect()],
        model=SimpleNamespace(flat=SimpleNamespace(parameters=dict.fromkeys(VALUES))),
    )


@pytest.mark.parametrize(
    ("common", "own", "undetermined"),
    [(0.0, 0.1, False), (0.0, 0.6, True), (0.6, 0.1, False), (0.6, 0.6, True)],
)
def test_a_common_factor_that_is_not_known_is_no_doubt(
    common: float, own: float, undetermined: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    alike = common**2 / (common**2 + own**2)
    known = dict.fromkeys(VALUES, alike) | {"rub.level": 1.0}
    monkeypatch.setattr(safeguards, "_correlations", lambda trial, name: known)
    found = undetermined_effects(trial_with(common, own), 0.95)
    assert found == (["coulomb @ acceleration"] if undetermined else [])


def test_a_friction_is_found_where_samples_are_slower_than_the_motor() -> None:
    """Pulses of a motor of 0.08 s at 10 Hz, one of them with a loose contact for a second: k, c and
    the friction are known up to a factor, and the interval of each holds zero."""
    t = np.arange(271) * 0.1
    told = np.zeros(271)
    begin = 0.0
    for n, pwm in enumerate((165, 175, 185, 195, 205, 215, 225, 235)):
        end = begin + 2.5 - 0.15 * n
        told[(t >= begin - 1e-9) & (t < end - 1e-9)] = pwm
        begin = end + 2.2 - 0.1 * n
    acts = np.where((t > 5.2) & (t < 6.4), 0.0, told)
    whole = tw.compile(read_text(MOTOR.format(more=", rub, teeth") + HIDDEN))
    run = tw.simulate(
        whole, inputs={"pwm": tw.Held(t, acts)}, times=t, parameters={"k": 82.0, "c": 12.0}
    )
    series = tw.Measured(
        "pulses", "train", t, {"position": np.round(run["position"])},
        inputs={"pwm": tw.Held(t, told)}, sigma={"position": 0.5},
        start={"position": None, "rate": 0.0},
    )  # fmt: skip
    found = tw.trace(tw.compile(read_text(MOTOR.format(more=""))), [series])
    assert found.verdict == "effect"
    (effect,) = found.effects
    assert str(effect) == "coulomb @ acceleration"
    assert effect.intervals["level"][0] <= 0, "alone it may as well be zero"
