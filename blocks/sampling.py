"""Sampling: blocks that keep the value that a signal had at an instant, until the next one.

All samples of one instant are taken together, of the states as they were just before it. What jumps
there at a known time, as a step or a measured input that is held, counts as it is behind the jump.
"""

from tracewire.library import Block, Event, Input, Output, Parameter, State

START = Parameter("start", doc="the output before the first sample", default=0.0)

sample_and_hold = Block(
    name="sample_and_hold",
    doc="The value that a signal had when a trigger last rose over a threshold.",
    inputs=(Input("of"), Input("trigger")),
    parameters=(Parameter("threshold", default=0.5), START),
    states=(State("y", rate="0", start="start"),),
    events=(Event("sample", when="trigger - threshold", crosses="up", set={"y": "of"}),),
    outputs=(Output("y", "y", doc="jumps", unit_of="of"),),
)

zero_order_hold = Block(
    name="zero_order_hold",
    doc="The value that a signal had at the last of evenly spaced times.",
    inputs=(Input("of"),),
    parameters=(
        Parameter("period", "s", "between two samples", above=0.0),
        Parameter("offset", "s", "above zero, the time of the first sample", default=0.0),
        START,
    ),
    states=(State("y", rate="0", start="start"),),
    events=(Event("sample", every="period", offset="offset", set={"y": "of"}),),
    outputs=(Output("y", "y", doc="jumps; at a start on a sample, the sample", unit_of="of"),),
)
