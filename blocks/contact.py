"""Contact: bodies that hit a stop or each other, and a clutch that holds one way.

An impact turns the rate round at an instant. Where impacts follow each other faster and faster the
body comes to rest on the contact, which then holds it by whatever force that takes, and lets it go
where it would have to pull. That force is found by the run, so that no block has an input for it.
"""

from tracewire.library import Block, Event, Input, Output, Parameter, State

NEWTON = "Newton's law of impact: the rate of separation is restitution times that of approach."
RESTITUTION = Parameter(
    "restitution", doc="1: elastic, 0: the body stays", default=0.0, low=0.0, high=1.0
)
FORCE = Input("force", doc="on the body, but for that of the contact: N, or N m", default="0")
MASS = Parameter("mass", doc="kg, or kg m^2", default=1.0, above=0.0)
START = Parameter("start", doc="the position at the start: m, or rad", default=0.0)
START_RATE = Parameter("start_rate", doc="the rate at the start: m/s, or rad/s", default=0.0)
BODY = (
    State("x", rate="v", start="start"),
    State("v", rate="force/mass", start="start_rate"),
)
MOTION = (
    Output("x", "x", doc="the position: m, or rad"),
    Output("v", "v", doc="the rate: m/s, or rad/s; jumps at an impact"),
)

hard_stop = Block(
    name="hard_stop",
    doc="A body that moves between two stops, bounces off them and may come to rest on them.",
    require=("low <= start", "start <= high"),
    inputs=(FORCE,),
    parameters=(
        MASS,
        Parameter("high", doc="the upper stop: m, or rad"),
        Parameter("low", doc="the lower stop", default="-high"),
        RESTITUTION,
        START,
        START_RATE,
    ),
    states=BODY,
    events=(
        Event(
            "impact",
            when=("x - high", "low - x"),
            crosses="up",
            set={"v": "-restitution*v"},
            kind="impact",
            doc="a stop is hit",
        ),
    ),
    outputs=(
        *MOTION,
        Output("held", "is_held(x - high) + is_held(low - x)", doc="1 while it rests on a stop"),
    ),
    source=NEWTON,
)

bouncing_body = Block(
    name="bouncing_body",
    doc="A body above a floor, which bounces off it and may come to rest on it.",
    require=("level <= start",),
    inputs=(FORCE,),
    parameters=(
        MASS,
        Parameter("level", doc="of the floor: m, or rad", default=0.0),
        RESTITUTION,
        START,
        START_RATE,
    ),
    states=BODY,
    events=(
        Event(
            "impact",
            when="x - level",
            crosses="down",
            set={"v": "-restitution*v"},
            kind="impact",
            doc="the floor is hit",
        ),
    ),
    outputs=(*MOTION, Output("held", "is_held(x - level)", doc="1 while it rests on the floor")),
    source=NEWTON,
)

collision = Block(
    name="collision",
    doc="Two bodies on a line, which bounce off each other and may stay together.",
    require=("distance <= start2 - start1",),
    inputs=(
        Input("force1", doc="on the first body, but for that of the contact", default="0"),
        Input("force2", doc="on the second body, but for that of the contact", default="0"),
    ),
    parameters=(
        Parameter("mass1", doc="kg, or kg m^2", default=1.0, low=0.0),
        Parameter("mass2", doc="kg, or kg m^2", default=1.0, low=0.0),
        Parameter("distance", doc="x2 - x1 where they touch: m, or rad", default=0.0),
        RESTITUTION,
        Parameter("start1", doc="the position of the first at the start", default=0.0),
        Parameter("start2", doc="the position of the second, beyond the first", default=0.0),
        Parameter("start_rate1", doc="the rate of the first at the start", default=0.0),
        Parameter("start_rate2", doc="the rate of the second at the start", default=0.0),
    ),
    states=(
        State("x1", rate="v1", start="start1"),
        State("v1", rate="force1/mass1", start="start_rate1"),
        State("x2", rate="v2", start="start2"),
        State("v2", rate="force2/mass2", start="start_rate2"),
    ),
    events=(
        Event(
            "impact",
            when="x2 - x1 - distance",
            crosses="down",
            set={
                "v1": "v1 - (1 + restitution)*mass2/(mass1 + mass2)*(v1 - v2)",
                "v2": "v2 + (1 + restitution)*mass1/(mass1 + mass2)*(v1 - v2)",
            },
            kind="impact",
            doc="the bodies meet",
        ),
    ),
    outputs=(
        Output("x1", "x1"),
        Output("v1", "v1", doc="jumps at an impact"),
        Output("x2", "x2"),
        Output("v2", "v2", doc="jumps at an impact"),
        Output("held", "is_held(x2 - x1 - distance)", doc="1 while they stay together"),
    ),
    source=NEWTON,
)

one_way_clutch = Block(
    name="one_way_clutch",
    doc="A freewheel: nothing while the rate is positive, and a hold against going back.",
    inputs=(Input("rate", doc="of the body, against what the clutch holds on to"),),
    parameters=(
        Parameter("capacity", doc="up to which it holds, and with which it slips: N m", low=0.0),
    ),
    # no memory: at zero rate the run finds the torque from 0 to the capacity that holds the body
    outputs=(Output("force", "0 if rate > 0 else capacity", doc="acts on the body, forwards"),),
)
