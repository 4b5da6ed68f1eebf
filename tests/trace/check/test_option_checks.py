"""What a user asks of a trace must exist on the diagram, and is told all at once where not."""

from __future__ import annotations

import math

import pytest
from show.traces import TEXT
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import OptionError
from tracewire.trace import TraceOptions, check_options

MODEL = compile(read_text(TEXT))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            TraceOptions(only=("torqe",)),
            "unknown place 'torqe'; there are: torque. Did you mean 'torque'? `tracewire show",
        ),
        (
            TraceOptions(without=("coulom",)),
            "Did you mean 'coulomb'? `tracewire blocks` lists the effects.",
        ),
        (
            TraceOptions(without=("coulomb @ force",)),
            "unknown place 'force'; there are: torque. It stands in 'coulomb @ force'.",
        ),
        (TraceOptions(effects=-1), "a trace cannot add -1 effects. Give the most effects"),
        (TraceOptions(horizon=0.0), "the horizon must be longer than 0 s, got 0 s. Give a time"),
        (TraceOptions(horizon=math.inf), "the horizon must be longer than 0 s, got inf s"),
        (TraceOptions(budget=-2.0), "the budget must be more than 0 s, got -2 s. Give the seconds"),
        (TraceOptions(budget=math.nan), "the budget must be more than 0 s, got nan s"),
    ],
)
def test_what_does_not_exist_is_told(options: TraceOptions, said: str) -> None:
    with pytest.raises(OptionError) as caught:
        check_options(options, MODEL)
    assert said in str(caught.value)


def test_all_that_is_wrong_is_told_at_once() -> None:
    with pytest.raises(OptionError) as caught:
        check_options(TraceOptions(only=("a", "b"), without=("x",), effects=-1), MODEL)
    assert len(caught.value.problems) == 4


def test_what_exists_passes() -> None:
    options = TraceOptions(
        only=("torque",), without=("coulomb @ torque", "sensor_delay"), effects=0, horizon=1.0
    )
    check_options(options, MODEL)  # must not raise
