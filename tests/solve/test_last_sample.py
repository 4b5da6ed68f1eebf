"""Samples that end before the run does are told."""

from __future__ import annotations

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.solve import Run, simulate

TEXT = "span: [0, 10]\nblocks: {x: {type: integrator, of: x, start: 1}}\n"


def ran(**options: float) -> Run:
    return simulate(compile(read_text(TEXT)), every=options["every"])


def test_samples_that_end_before_the_run_are_told() -> None:
    (warning,) = ran(every=0.7).warnings
    assert warning.startswith(
        "the run ends at 10 s and its last sample is at 9.8 s, as `every` 0.7 s does not divide"
    )


@pytest.mark.parametrize("every", [0.1, 1 / 3, 10.0])
def test_samples_up_to_the_end_are_not_told(every: float) -> None:
    assert ran(every=every).warnings == ()


def test_samples_that_were_chosen_are_not_told() -> None:
    model = compile(read_text(TEXT))
    assert simulate(model, times=np.array([0.0, 1.0])).warnings == ()
    assert simulate(model).warnings == ()
