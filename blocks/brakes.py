"""Brakes and clutches: every block outputs what acts ON the body, against its rate.

What presses the surfaces together is an input, so that it may change while they slip or stick. A
rate is in rad/s and the output a torque in N m, or m/s and a force in N.
"""

from tracewire.library import Block, Input, Output, Parameter

NORMAL = Input(
    "normal", doc="the force that presses the surfaces together: N; below 0: they are apart"
)
PRESSING = "(normal if normal >= 0 else 0)"
SURFACES = (
    Parameter("friction", doc="the coefficient of friction while slipping", low=0.0),
    Parameter("stick", doc="that at which it breaks away", default="friction", low=0.0),
    Parameter(
        "radius",
        doc="the mean radius of the surfaces: m; 1 for a body that moves along a line",
        default=1.0,
        low=0.0,
    ),
    Parameter("faces", doc="how many surfaces rub, side by side", default=1.0, low=0.0),
)
SOURCE = "Coulomb's law with one mean radius: the torque is friction*normal*radius*faces."


def _levels(rate: str) -> str:
    """What the surfaces do while they slip, and up to which torque they stick."""
    lever = f"radius*faces*{PRESSING}"
    return f"-dry({rate}, friction*{lever}, stick*{lever})"


brake = Block(
    name="brake",
    doc="Dry friction under a normal force that may change, which stops the body and holds it.",
    require=("friction <= stick",),
    inputs=(Input("rate", doc="of the body, against what brakes it"), NORMAL),
    parameters=SURFACES,
    outputs=(Output("force", _levels("rate"), doc="acts on the body"),),
    source=SOURCE,
)

clutch = Block(
    name="clutch",
    doc="Dry friction between two bodies under a normal force, which lets them turn as one.",
    require=("friction <= stick",),
    inputs=(
        Input("rate", doc="of the body: rad/s, or m/s"),
        Input("other_rate", doc="of the other body, on which the opposite acts"),
        NORMAL,
    ),
    parameters=SURFACES,
    outputs=(
        Output(
            "force", _levels("rate - other_rate"), doc="acts on the body; its opposite on the other"
        ),
    ),
    source=SOURCE,
)

eddy_brake = Block(
    name="eddy_brake",
    doc="An eddy current brake, whose torque rises with the rate up to a peak and falls beyond.",
    inputs=(Input("rate", doc="of the body: rad/s, or m/s"),),
    parameters=(
        Parameter("peak", doc="the largest torque or force: N m, or N", low=0.0),
        Parameter("speed", doc="the rate at the peak: rad/s, or m/s", above=0.0),
    ),
    outputs=(Output("force", "-2*peak*speed*rate/(speed**2 + rate**2)", doc="acts on the body"),),
    source="J. H. Wouterse, Critical torque and speed of eddy current brake with widely separated"
    " soft iron poles, IEE Proc. B 138 (1991) 153: 2*peak/(speed/rate + rate/speed).",
)
