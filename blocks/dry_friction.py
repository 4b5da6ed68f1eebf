"""Dry friction: every block outputs what acts ON the body, against its rate.

A rate is in rad/s and the output a torque in N m, or m/s and a force in N. Dry friction has a
`width`. At 0 its sign of the rate is exact and set-valued: the body sticks, held by whatever force
that takes up to the level. Above 0 it is tanh(rate/width): the body creeps. Letters l and r mark
the two directions: l while the rate is positive, r while it is negative.
"""

from tracewire.library import Block, Effect, Input, Output, Parameter, Shape

RATE = Input("rate", doc="of the body, against what it rubs on")
OF = Input("of", doc="the coordinate of the body: rad, or m")
LEVEL = Parameter("level", doc="N m, or N", low=0.0)
WIDTH = Parameter(
    "width",
    doc="of the rates around rest in which it is smoothed: rad/s, or m/s; 0: not at all",
    default=0.0,
    low=0.0,
)
WIDTHS = Shape((0.0, 0.02, 0.1), of="V")
# the rate is divided by 1 in the branch that is not taken: no number there is infinite
SMOOTHED = "tanh(rate/(width if width > 0 else 1))"
SIGN = f"({SMOOTHED} if width > 0 else sign(rate))"

coulomb = Block(
    name="coulomb",
    doc="Dry friction of one level, which holds the body at rest up to that level.",
    inputs=(RATE,),
    parameters=(LEVEL, WIDTH),
    outputs=(Output("force", f"-level*{SIGN}", doc="acts on the body"),),
    effect=Effect("level", {"rate": "v"}, sign=1, shapes={"width": WIDTHS}),
)

dry_friction = Block(
    name="dry_friction",
    doc="Dry friction with one level while slipping and another up to which it sticks.",
    require=("slip <= stick",),
    inputs=(RATE,),
    parameters=(
        Parameter("slip", doc="level while slipping: N m, or N", low=0.0),
        Parameter("stick", doc="level at which it breaks away", default="slip", low=0.0),
    ),
    outputs=(Output("force", "-dry(rate, slip, stick)", doc="acts on the body"),),
)

asymmetric_coulomb = Block(
    name="asymmetric_coulomb",
    doc="Dry friction with a level for each direction, which holds the body at rest between them.",
    inputs=(RATE,),
    parameters=(
        Parameter("level_l", doc="while rate > 0: N m, or N", low=0.0),
        Parameter("level_r", doc="while rate < 0", low=0.0),
    ),
    # one relation and no sign(): the formula is then affine in its mode, also while it sticks
    outputs=(Output("force", "-level_l if rate >= 0 else level_r", doc="acts on the body"),),
)

asym_coulomb = Block(
    name="asym_coulomb",
    doc="Dry friction that differs between the directions: half the difference.",
    inputs=(RATE,),
    parameters=(
        Parameter("level", doc="half the difference of the two levels: N m, or N"),
        WIDTH,
    ),
    # Beside a coulomb that is set-valued the limit of width 0 is a constant, also at rest: the
    # levels are then level_coulomb +- level, and the body sticks between just these. Only with a
    # width is it another law than a bias, as it then vanishes at rest.
    outputs=(Output("force", f"-level*({SMOOTHED}**2 if width > 0 else 1)", doc="on the body"),),
    effect=Effect(
        "level",
        {"rate": "v"},
        shapes={"width": Shape((0.02, 0.1), of="V")},
        alias=("bias", "sensor_offset"),
        both_signs=("v",),
    ),
)

stribeck = Block(
    name="stribeck",
    doc="Dry friction that is higher near rest, beside that at high rates: the Stribeck curve.",
    inputs=(RATE,),
    parameters=(
        LEVEL,
        Parameter("speed", doc="at which it has fallen to 1/e: rad/s, or m/s", low=0.0),
        WIDTH,
    ),
    outputs=(Output("force", f"-level*exp(-(rate/speed)**2)*{SIGN}", doc="acts on the body"),),
    effect=Effect(
        "level",
        {"rate": "v"},
        sign=1,
        shapes={"speed": Shape((0.0, 0.25, 0.5, 0.75, 0.95), of="rates"), "width": WIDTHS},
        alias=("coulomb", "quad_drag", "cubic_damping"),
        near_rest=("v",),
    ),
    source="The form of L. C. Bo, D. Pavelescu, The friction-speed relation, Wear 82 (1982) 277.",
)

disp_friction = Block(
    name="disp_friction",
    doc="Dry friction whose level grows with the distance from the middle, as of a wedge.",
    inputs=(OF, RATE),
    parameters=(Parameter("slope", doc="of the level: N m/rad, or N/m", low=0.0), WIDTH),
    outputs=(Output("force", f"-slope*abs(of)*{SIGN}", doc="acts on the body"),),
    effect=Effect("slope", {"of": "q", "rate": "v"}, sign=1, shapes={"width": WIDTHS}),
)

position_friction = Block(
    name="position_friction",
    doc="Dry friction whose level goes up and down along the way, between zero and its peak.",
    inputs=(OF, RATE),
    parameters=(
        Parameter("level", doc="at the peaks: N m, or N", low=0.0),
        Parameter("pitch", doc="from one peak to the next: rad, or m", low=0.0),
        Parameter("phase", "rad", "of the wave at the coordinate 0", default=0.0),
        WIDTH,
    ),
    # A journal that is not round or runs out rubs once a turn (pitch 2 pi) or a few times, a cart
    # on a rail has joints or a slope of the level (a pitch far above the way it goes). The wave
    # stands on its trough, so that the block alone never gives energy to the body.
    outputs=(
        Output(
            "force", f"-level*(1 + cos(2*pi*of/pitch + phase))/2*{SIGN}", doc="acts on the body"
        ),
    ),
    effect=Effect(
        "level",
        {"of": "q", "rate": "v"},
        sign=1,
        shapes={
            "pitch": Shape((2.0, 1.0, 0.5), of="stroke", most=2.0, wave=True),
            "phase": Shape((0.0, 1.5708, 3.1416, -1.5708), low=-6.2832),  # quarters of a circle
            "width": Shape((0.0, 0.1), of="V"),
        },
        alias=("coulomb",),
    ),
)

friction_drift = Block(
    name="friction_drift",
    doc="Dry friction that grows with the time of the run, or falls where its level is negative.",
    inputs=(RATE,),
    parameters=(Parameter("level", doc="growth in a second: N m/s, or N/s"), WIDTH),
    outputs=(Output("force", f"-level*t*{SIGN}", doc="acts on the body"),),
    effect=Effect(
        "level", {"rate": "v"}, shapes={"width": WIDTHS}, alias=("coulomb", "viscous_drift")
    ),
)

load_friction = Block(
    name="load_friction",
    doc="Dry friction whose level grows with a load, as of a seal under pressure or a loaded gear.",
    inputs=(
        Input(
            "load", doc="what presses the surfaces together, of either sign: a drive, a pressure"
        ),
        RATE,
    ),
    parameters=(Parameter("share", doc="of the load: its level over the load", low=0.0), WIDTH),
    outputs=(Output("force", f"-share*abs(load)*{SIGN}", doc="acts on the body"),),
    effect=Effect(
        "share",
        {"load": "u", "rate": "v"},
        sign=1,
        shapes={"width": WIDTHS},
        alias=("coulomb", "drive_gain"),
    ),
    source="Amontons: friction is in proportion to the load; a seal has a level of its own, too.",
)
