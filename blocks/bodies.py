"""Bodies: what a net force or torque moves. Their outputs are positions and rates, without jumps.

What acts on a body stands in a sum before it, where a trace looks for what is missing.
"""

from tracewire.library import Block, Input, Output, Parameter, State

mass = Block(
    name="mass",
    doc="A body that a force moves along a line, mass*v' = force.",
    inputs=(Input("force", "N", "the sum of what acts on the body", default="0"),),
    parameters=(
        Parameter("mass", "kg", above=0.0),
        Parameter("start", "m", "the position at the start", default=0.0),
        Parameter("start_rate", "m/s", "the rate at the start", default=0.0),
    ),
    states=(
        State("x", rate="v", start="start", unit="m"),
        State("v", rate="force/mass", start="start_rate", unit="m/s"),
    ),
    outputs=(Output("x", "x", "m", "the position"), Output("v", "v", "m/s", "the rate")),
    source="Newton's second law.",
)

rotating_mass = Block(
    name="rotating_mass",
    doc="A body that a torque turns about a fixed axis, inertia*rate' = torque.",
    inputs=(Input("torque", "N m", "the sum of what acts on the body", default="0"),),
    parameters=(
        Parameter("inertia", "kg m^2", "the moment of inertia about the axis", above=0.0),
        Parameter("start", "rad", "the angle at the start", default=0.0),
        Parameter("start_rate", "rad/s", "the rate at the start", default=0.0),
    ),
    states=(
        State("angle", rate="rate", start="start", unit="rad"),
        State("rate", rate="torque/inertia", start="start_rate", unit="rad/s"),
    ),
    outputs=(Output("angle", "angle", "rad"), Output("rate", "rate", "rad/s")),
    source="Newton's second law for a body on a fixed axis.",
)

gear = Block(
    name="gear",
    doc="Two shafts coupled by a gear without play or loss, rate1 = ratio*rate2.",
    require=("ratio**2 > 0",),
    inputs=(
        Input("torque1", "N m", "the sum of what acts on the first shaft", default="0"),
        Input("torque2", "N m", "the sum of what acts on the second shaft", default="0"),
    ),
    parameters=(
        Parameter("ratio", doc="rate1 over rate2; below 0: they turn against each other"),
        Parameter("inertia1", "kg m^2", "of what turns with the first shaft", above=0.0),
        Parameter("inertia2", "kg m^2", "of what turns with the second shaft", above=0.0),
        Parameter("start", "rad", "the angle of the second shaft at the start", default=0.0),
        Parameter("start_rate", "rad/s", "the rate of the second shaft at the start", default=0.0),
    ),
    states=(
        State("angle2", rate="rate2", start="start", unit="rad"),
        State(
            "rate2",
            rate="(torque2 + ratio*torque1)/(inertia2 + ratio**2*inertia1)",
            start="start_rate",
            unit="rad/s",
        ),
    ),
    outputs=(
        Output("angle1", "ratio*angle2", "rad"),
        Output("rate1", "ratio*rate2", "rad/s"),
        Output("angle2", "angle2", "rad"),
        Output("rate2", "rate2", "rad/s"),
    ),
    source="Newton's second law of both shafts; 'elastic_gear' has play and a loss.",
)

rack = Block(
    name="rack",
    doc="A pinion on a rack without play or loss, v = radius*rate.",
    inputs=(
        Input("torque", "N m", "the sum of what acts on the pinion", default="0"),
        Input("force", "N", "the sum of what acts on the rack", default="0"),
    ),
    parameters=(
        Parameter("radius", "m", "of the pinion", above=0.0),
        Parameter("inertia", "kg m^2", "of what turns with the pinion", low=0.0),
        Parameter("mass", "kg", "of what moves with the rack", above=0.0),
        Parameter("start", "m", "the position of the rack at the start", default=0.0),
        Parameter("start_rate", "m/s", "the rate of the rack at the start", default=0.0),
    ),
    states=(
        State("x", rate="v", start="start", unit="m"),
        State(
            "v",
            rate="(force + torque/radius)/(mass + inertia/radius**2)",
            start="start_rate",
            unit="m/s",
        ),
    ),
    outputs=(
        Output("angle", "x/radius", "rad", "of the pinion"),
        Output("rate", "v/radius", "rad/s", "of the pinion"),
        Output("x", "x", "m", "the position of the rack"),
        Output("v", "v", "m/s", "the rate of the rack"),
    ),
    source="Newton's second law of both; a wheel that rolls without slip is the same.",
)

lever = Block(
    name="lever",
    doc="A rigid lever whose ends move by x1 = a*angle and x2 = -b*angle: the angle is small.",
    require=("b**2 > 0",),
    inputs=(
        Input("force1", "N", "the sum of what acts on the first end", default="0"),
        Input("force2", "N", "the sum of what acts on the second end", default="0"),
    ),
    parameters=(
        Parameter("a", "m", "from the fulcrum to the first end", above=0.0),
        Parameter("b", "m", "to the second end; below 0: both ends are on one side"),
        Parameter("inertia", "kg m^2", "of the lever about its fulcrum", above=0.0),
        Parameter("mass1", "kg", "of what moves with the first end", default=0.0, low=0.0),
        Parameter("mass2", "kg", "of what moves with the second end", default=0.0, low=0.0),
        Parameter("start", "rad", "the angle at the start", default=0.0),
        Parameter("start_rate", "rad/s", "the rate at the start", default=0.0),
    ),
    states=(
        State("angle", rate="rate", start="start", unit="rad"),
        State(
            "rate",
            rate="(a*force1 - b*force2)/(inertia + mass1*a**2 + mass2*b**2)",
            start="start_rate",
            unit="rad/s",
        ),
    ),
    outputs=(
        Output("x1", "a*angle", "m", "the position of the first end"),
        Output("v1", "a*rate", "m/s", "its rate"),
        Output("x2", "-b*angle", "m", "the position of the second end"),
        Output("v2", "-b*rate", "m/s", "its rate"),
        Output("angle", "angle", "rad"),
        Output("rate", "rate", "rad/s"),
    ),
    source="The law of the lever, and the balance of angular momentum about its fulcrum.",
)
