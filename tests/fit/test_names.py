"""A parameter is fitted whatever its block is called: `gain.k` is no number of a sensor."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import SetValues, patch, read_text
from tracewire.errors import DiagramError, OptionError
from tracewire.fit import fit
from tracewire.library import SENSOR_TERMS
from tracewire.residual import Measured
from tracewire.solve import parameter_values

DECAY = """\
title: Decay
span: [0, 4]
blocks:
  x: {type: integrator, of: NAME, start: 2, unit: m}
  NAME: {type: gain, of: x, k: {value: -0.1, fit: [-5, 0]}}
"""
T = np.linspace(0.0, 4.0, 81)


def decay(name: str = "x") -> Measured:
    return Measured("run", "train", T, {name: 2 * np.exp(-0.7 * T)})


@pytest.mark.parametrize("name", [*SENSOR_TERMS, "start", "sensor", "slow"])
@pytest.mark.parametrize("method", ["least_squares", "fminsearch", "multiple_shooting"])
def test_a_block_may_have_the_name_of_a_number_of_a_sensor(name: str, method: str) -> None:
    model = compile(read_text(DECAY.replace("NAME", name), Path("decay.yaml")))
    found = fit(model, [decay()], method=method)
    assert found.values == pytest.approx({f"{name}.k": -0.7}, rel=1e-3)
    again = compile(patch(model.diagram, [SetValues(found.values)]))
    assert parameter_values(again, {})[f"{name}.k"] == pytest.approx(-0.7, rel=1e-3)


CLASH = """\
title: Two of one name
span: [0, 4]
blocks:
  k: {type: integrator, of: BLOCK, start: 2, unit: m}
  BLOCK: {type: gain, of: k, k: {value: -0.1, fit: [-5, 0]}}
"""
SERIES = """\
measured:
  run: {file: run.csv, time: t, signals: {k: {column: k}}}
"""


@pytest.mark.parametrize("term", SENSOR_TERMS)
def test_a_parameter_with_the_name_of_a_number_of_a_sensor_is_refused(term: str) -> None:
    text = CLASH.replace("BLOCK", term)
    with pytest.raises(DiagramError) as refused:
        compile(read_text(text + SERIES, Path("clash.yaml")))
    what = f"the parameter '{term}.k' has the name of the {term} of the sensor of 'k'"
    assert str(refused.value) == (
        f"clash.yaml:5:{28 + len(term)}: block '{term}': {what}. "
        f"Give the block '{term}' another name."
    )
    with pytest.raises(OptionError, match=what):
        fit(compile(read_text(text, Path("clash.yaml"))), [decay("k")])


def test_a_parameter_with_the_name_of_a_start_is_refused() -> None:
    with pytest.raises(DiagramError, match=r"'start\.k' has the name of the start of 'k'"):
        compile(read_text(CLASH.replace("BLOCK", "start"), Path("clash.yaml")))
