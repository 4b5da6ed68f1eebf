"""Memory: blocks that are in one of a few named modes until a transition leads them to another.

A formula for each mode says what the block does in it. Counters keep a number that events change.
"""

from tracewire.library import Block, Event, Input, Mode, Output, Parameter, State, Transition

THRESHOLD = Parameter("threshold", doc="a signal at or above it counts as 1", default=0.5)

relay = Block(
    name="relay",
    doc="A switch with hysteresis, also called Schmitt trigger.",
    require=("off_at <= on_at",),
    inputs=(Input("of"),),
    parameters=(
        Parameter("on_at", doc="switches on where the signal reaches it from below"),
        Parameter("off_at", doc="switches off where the signal falls to it, at most on_at"),
        Parameter("on_value", doc="the output while it is on", default=1.0),
        Parameter("off_value", doc="the output while it is off", default=0.0),
        Parameter("start", doc="1: it starts on, where the signal is between", default=0.0),
    ),
    modes=(Mode("released"), Mode("operated", start="start >= 0.5")),
    transitions=(
        Transition("released", "operated", when="of >= on_at"),
        Transition("operated", "released", when="of <= off_at"),
    ),
    outputs=(Output("y", {"released": "off_value", "operated": "on_value"}, doc="jumps"),),
)

play_operator = Block(
    name="play_operator",
    doc="Play between a driving part and one that it pushes at either end of the gap.",
    inputs=(
        Input("of", doc="the position of the driving part", continuous=True),
        Input("rate", doc="its rate: where it turns round, the driven part is left"),
    ),
    parameters=(
        Parameter("width", doc="of the gap", low=0.0),
        Parameter("start", doc="where the driven part is, if that is in the gap", default=0.0),
    ),
    # the driven part stays where it was left, in any mode but those that push it
    states=(State("at", rate="0", start="start"),),
    modes=(
        Mode("free", doc="the driven part stays where it is"),
        Mode("up", doc="it is pushed to higher positions"),
        Mode("down", doc="it is pushed to lower positions"),
    ),
    transitions=(
        Transition("free", "up", when="of - at >= width/2"),
        Transition("free", "down", when="at - of >= width/2"),
        Transition("up", "free", when="rate < 0", set={"at": "of - width/2"}),
        Transition("down", "free", when="rate > 0", set={"at": "of + width/2"}),
    ),
    outputs=(
        Output(
            "y",
            {"free": "at", "up": "of - width/2", "down": "of + width/2"},
            doc="the position of the driven part",
        ),
    ),
    source="The play operator: M. A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis.",
)

latch = Block(
    name="latch",
    doc="A flip-flop that one signal sets and another resets, which wins where both do.",
    inputs=(
        Input("set", doc="sets it while it is at or above the threshold"),
        Input("reset", doc="resets it while it is at or above the threshold"),
    ),
    parameters=(THRESHOLD, Parameter("start", doc="1: it starts set", default=0.0)),
    modes=(Mode("off"), Mode("on", start="start >= 0.5")),
    transitions=(
        Transition("off", "on", when="set >= threshold and reset < threshold"),
        Transition("on", "off", when="reset >= threshold"),
    ),
    outputs=(Output("y", {"off": "0", "on": "1"}, doc="0 or 1, jumps"),),
)

toggle = Block(
    name="toggle",
    doc="A switch that changes between 0 and 1 each time that a signal rises over a threshold.",
    inputs=(Input("of"),),
    parameters=(THRESHOLD, Parameter("start", doc="0 or 1", default=0.0)),
    states=(State("y", rate="0", start="start"),),
    events=(Event("edge", when="of - threshold", crosses="up", set={"y": "1 - y"}),),
    outputs=(Output("y", "y", doc="jumps"),),
)

counter = Block(
    name="counter",
    doc="The number of times that a signal has risen over a threshold.",
    inputs=(Input("of"),),
    parameters=(THRESHOLD, Parameter("start", default=0.0)),
    states=(State("n", rate="0", start="start"),),
    events=(Event("edge", when="of - threshold", crosses="up", set={"n": "n + 1"}),),
    outputs=(Output("n", "n", doc="jumps"),),
)
