"""Transmission: what passes a force or a torque from one body to another, or to the ground.

Every block outputs what acts ON the body. The other body gets it with the opposite sign: where the
one has `spring` in its sum, the other has `-spring`. A coordinate is in rad and the output a torque
in N m, or m and a force in N.
"""

from tracewire.library import Block, Input, Output, Parameter

OF = Input("of", doc="the coordinate of the body: rad, or m")
RATE = Input("rate", doc="its rate: rad/s, or m/s")
OTHER = Input("other", doc="the coordinate of the other body", default="0")
OTHER_RATE = Input("other_rate", doc="its rate", default="0")
STIFFNESS = Parameter("k", doc="stiffness: N m/rad, or N/m", low=0.0)
DAMPING = Parameter("c", doc="damping: N m s/rad, or N s/m", default=0.0, low=0.0)

spring_damper = Block(
    name="spring_damper",
    doc="A spring and a damper side by side, between a body and another one or the ground.",
    inputs=(OF, RATE, OTHER, OTHER_RATE),
    parameters=(
        STIFFNESS,
        DAMPING,
        Parameter("length", doc="of - other where the spring is slack: rad, or m", default=0.0),
    ),
    outputs=(
        Output("force", "-k*(of - other - length) - c*(rate - other_rate)", doc="acts on the body"),
    ),
    source="The element of Kelvin and Voigt.",
)

STRETCHED = "of - other - length"
PULL = f"k*({STRETCHED}) + c*(rate - other_rate)"

rope = Block(
    name="rope",
    doc="An elastic rope between a body and another one or the ground, which only pulls.",
    inputs=(OF, RATE, OTHER, OTHER_RATE),
    parameters=(
        STIFFNESS,
        DAMPING,
        Parameter("length", doc="of - other where the rope is taut: rad, or m", low=0.0),
    ),
    outputs=(
        Output(
            "force",
            f"(-({PULL}) if {PULL} >= 0 else 0) if {STRETCHED} >= 0 else 0",
            doc="acts on the body, towards the other; of is above other",
        ),
    ),
    source="The element of Kelvin and Voigt where it is stretched and pulls, else nothing.",
)

# by how much the first shaft is ahead, seen at the second one, and what the teeth press with there
AHEAD = "angle1/ratio - angle2"
UP = f"k*({AHEAD} - gap/2) + c*(rate1/ratio - rate2)"
DOWN = f"k*({AHEAD} + gap/2) + c*(rate1/ratio - rate2)"


def _teeth(up: str, down: str) -> str:
    """What the teeth press with, times a factor while they press the second shaft up or down."""
    return (
        f"(({up}*({UP}) if {UP} >= 0 else 0) if {AHEAD} >= gap/2"
        f" else (({down}*({DOWN}) if {DOWN} <= 0 else 0) if {AHEAD} <= -gap/2 else 0))"
    )


# power flows to the second shaft while it is pressed to where the first one turns; without a loss
# the relation compares a constant, and is no event
TURNS = "(rate1/ratio if efficiency < 1 else 1) >= 0"

elastic_gear = Block(
    name="elastic_gear",
    doc="A gear between two shafts whose elastic teeth only push, with play and a loss of power.",
    require=("ratio**2 > 0",),
    inputs=(
        Input("angle1", "rad", "of the first shaft"),
        Input("rate1", "rad/s", "its rate"),
        Input("angle2", "rad", "of the second shaft"),
        Input("rate2", "rad/s", "its rate"),
    ),
    parameters=(
        Parameter("k", "N m/rad", "stiffness of the teeth, at the second shaft", low=0.0),
        Parameter("c", "N m s/rad", "their damping, at the second shaft", default=0.0, low=0.0),
        Parameter("gap", "rad", "the whole play, at the second shaft", default=0.0, low=0.0),
        Parameter(
            "ratio", doc="rate1 over rate2; below 0: they turn against each other", default=1.0
        ),
        Parameter(
            "efficiency",
            doc="the part of the power that passes, in either direction",
            default=1.0,
            above=0.0,
            high=1.0,
        ),
    ),
    outputs=(
        Output(
            "torque1",
            "-"
            + _teeth(
                f"(1/efficiency if {TURNS} else efficiency)",
                f"(efficiency if {TURNS} else 1/efficiency)",
            )
            + "/ratio",
            "N m",
            "acts on the first shaft",
        ),
        Output("torque2", _teeth("1", "1"), "N m", "acts on the second shaft"),
    ),
    source="M. Nordin, P.-O. Gutman, Controlling mechanical systems with backlash - a survey,"
    " Automatica 38 (2002) 1633: the dead-zone model, without the part of it that would pull. The"
    " loss is that of Modelica.Mechanics.Rotational.Components.LossyGear.",
)

HAULED = "k*(r1*angle1 - r2*angle2) + c*(r1*rate1 - r2*rate2)"

belt = Block(
    name="belt",
    doc="An elastic belt between two pulleys, both strands of which stay taut.",
    require=("r2**2 > 0",),
    inputs=(
        Input("angle1", "rad", "of the first pulley"),
        Input("rate1", "rad/s", "its rate"),
        Input("angle2", "rad", "of the second pulley"),
        Input("rate2", "rad/s", "its rate"),
    ),
    parameters=(
        Parameter("r1", "m", "the radius of the first pulley", above=0.0),
        Parameter("r2", "m", "the radius of the second pulley; below 0: the belt is crossed"),
        Parameter("k", "N/m", "stiffness of both strands together", low=0.0),
        Parameter("c", "N s/m", "their damping", default=0.0, low=0.0),
    ),
    outputs=(
        Output("torque1", f"-r1*({HAULED})", "N m", "acts on the first pulley"),
        Output("torque2", f"r2*({HAULED})", "N m", "acts on the second pulley"),
        Output("force", HAULED, "N", "the tension of the pulling strand less that of the other"),
    ),
    source="The element of Kelvin and Voigt on the way of the belt at both pulleys, without creep."
    " Where a strand may hang through, it is a 'rope'.",
)
