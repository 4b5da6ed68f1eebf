"""Limited: an integrator between limits, one that a signal resets, and a limit to a rate."""

from tracewire.library import Block, Event, Input, Output, Parameter, State

OF = Input("of", doc="the rate of the state")
START = Parameter("start", doc="the value at the start of the run", default=0.0)

limited_integrator = Block(
    name="limited_integrator",
    doc="The integral of a signal, which stops at its limits and leaves them with the signal.",
    require=("low <= start", "start <= high"),
    inputs=(OF,),
    parameters=(
        Parameter("low", doc="the lower limit"),
        Parameter("high", doc="the upper limit"),
        START,
    ),
    states=(State("y", "0 if (y >= high and of > 0) or (y <= low and of < 0) else of", "start"),),
    outputs=(Output("y", "y"),),
)

reset_integrator = Block(
    name="reset_integrator",
    doc="The integral of a signal, which takes a new value each time that a trigger rises.",
    inputs=(
        OF,
        Input("trigger", doc="resets where it rises over the threshold"),
        Input("value", doc="what it is reset to", default="start"),
    ),
    parameters=(START, Parameter("threshold", default=0.5)),
    states=(State("y", "of", "start"),),
    events=(Event("reset", when="trigger - threshold", crosses="up", set={"y": "value"}),),
    outputs=(Output("y", "y"),),
)

rate_limiter = Block(
    name="rate_limiter",
    doc="A signal followed as fast as limits of the rate allow, exactly where they allow it.",
    inputs=(Input("of"),),
    parameters=(
        Parameter("rising", doc="the highest rate, in 1/s of the signal", low=0.0),
        Parameter("falling", doc="the highest rate downwards", default="rising", low=0.0),
        START,
    ),
    # it slides on y = of wherever the signal is slower than the limits
    states=(State("y", "rising if of >= y else -falling", "start"),),
    outputs=(Output("y", "y", unit_of="of"),),
)
