"""A filter, a delay or a limit has the unit of the signal that goes in."""

from __future__ import annotations

import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import BlockError
from tracewire.library import Block, Input, Output

DIAGRAM = """\
span: [0, 1]
blocks:
  seen: {type: BLOCK}
  angle: {type: integrator, of: speed, unit: rad}
  speed: {type: integrator, of: "-angle", unit: rad/s}
"""


@pytest.mark.parametrize(
    "use",
    [
        "low_pass, of: speed, frequency: 3",
        "first_order, of: speed, lag: 0.1",
        "delay, of: -speed, time: 0.1",
        "zero_order_hold, of: speed, period: 0.1",
        "saturation, of: speed, low: -1, high: 1",
        "quantizer, of: speed, interval: 0.1",
    ],
)
def test_it_has_the_unit_of_its_input(use: str) -> None:
    assert compile(read_text(DIAGRAM.replace("BLOCK", use))).flat.units["seen"] == "rad/s"


def test_filters_in_a_row_have_it_in_any_order() -> None:
    text = DIAGRAM.replace("BLOCK", "low_pass, of: held, frequency: 3")
    text += "  held: {type: sample_and_hold, of: late, trigger: angle}\n"
    text += "  late: {type: delay, of: angle, time: 0.1}\n"
    flat = compile(read_text(text)).flat
    assert [flat.units[name] for name in ("seen", "held", "late")] == ["rad"] * 3
    assert {state.name: state.unit for state in flat.states}["held"] == "rad"


def test_filters_in_a_loop_have_none() -> None:
    text = DIAGRAM.replace("BLOCK", "first_order, of: -other, lag: 0.1")
    text += "  other: {type: first_order, of: seen, lag: 0.1}\n"
    assert compile(read_text(text)).flat.units["seen"] == ""


@pytest.mark.parametrize(
    ("use", "unit"),
    [
        ("first_order, of: speed, lag: 0.1, k: 2", ""),
        ("low_pass, of: speed, frequency: 3, unit: 1/s", "1/s"),
        ("first_order, of: speed, lag: 0.1, k: 2, unit: V", "V"),
    ],
)
def test_a_factor_may_have_a_unit_and_what_is_said_goes_first(use: str, unit: str) -> None:
    assert compile(read_text(DIAGRAM.replace("BLOCK", use))).flat.units["seen"] == unit


def test_a_block_that_names_no_input_of_its_own_is_refused() -> None:
    with pytest.raises(BlockError) as caught:
        Block(
            name="strange",
            doc="It is strange.",
            inputs=(Input("of"),),
            outputs=(Output("y", "of", unit_of="off"),),
        )
    assert str(caught.value).endswith(
        "unknown input 'off'; there are: of. Did you mean 'of'? The output 'y' has its unit."
    )
