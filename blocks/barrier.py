"""Elastic barriers: every block outputs what acts ON the body while it is beyond a limit."""

from tracewire.library import Block, Effect, Input, Output, Parameter, Shape

PAPER = (
    "Semiempirical identification of nonlinear dynamics of a two-degree-of-freedom real torsion"
    " pendulum with a nonuniform planar stick-slip friction and elastic barriers"
)

voigt_barrier = Block(
    name="voigt_barrier",
    doc="A spring and a damper side by side beyond each of two limits, and nothing between.",
    inputs=(
        Input("of", doc="the coordinate of the body: rad, or m"),
        Input("rate", doc="its rate: rad/s, or m/s"),
    ),
    parameters=(
        Parameter("high", doc="the upper limit: rad, or m", unit_of="of"),
        Parameter("low", doc="the lower limit", default="-high", unit_of="of"),
        # below 0 it drives the body away: the sign of Eq 19 as it is printed
        Parameter("k", doc="stiffness: N m/rad, or N/m"),
        Parameter("c_l", doc="damping above the upper limit: N m s/rad, or N s/m", low=0.0),
        Parameter("c_r", doc="damping below the lower limit", default="c_l", low=0.0),
        Parameter(
            "adhesive",
            doc="1: the damper may pull the body back while it leaves; 0: it never pulls",
            default=1.0,
            low=0.0,
            high=1.0,
        ),
    ),
    # One relation for each limit. The one that asks whether the damper pulls compares a constant
    # while the barrier is adhesive, so that it is no event then.
    outputs=(
        Output(
            "force",
            "(-k*(of - high) - c_l*rate"
            " if (k*(of - high) + c_l*rate if adhesive < 0.5 else 1) >= 0 else 0)"
            " if of >= high else ((-k*(of - low) - c_r*rate"
            " if (k*(low - of) - c_r*rate if adhesive < 0.5 else 1) >= 0 else 0)"
            " if of <= low else 0)",
            doc="acts on the body; jumps at the limits",
        ),
    ),
    source=f"{PAPER}, Eq 4 and Eq 15.",
)

OF = Input("of", doc="the coordinate of the body: rad, or m")
STIFFNESS = Parameter("k", doc="N m/rad, or N/m", low=0.0)
GAP = Parameter("gap", doc="where it begins: rad, or m", low=0.0, unit_of="of")
GAPS = Shape((0.3, 0.45, 0.6, 0.75, 0.85), of="Q", least=0.05, most=1.0)

barrier = Block(
    name="barrier",
    doc="A spring beyond a gap on either side.",
    inputs=(OF,),
    parameters=(STIFFNESS, GAP),
    outputs=(
        Output(
            "force",
            "-k*(of - gap if of >= gap else (of + gap if of <= -gap else 0))",
            doc="acts on the body",
        ),
    ),
    effect=Effect("k", {"of": "q"}, sign=1, shapes={"gap": GAPS}),
)

overflow = Block(
    name="overflow",
    doc="An outflow above a level, in proportion to the excess.",
    inputs=(Input("of", doc="the level: m, or what is stored"),),
    parameters=(
        Parameter("k", doc="of what runs over to the excess: 1/s, or A/V", low=0.0),
        Parameter("edge", doc="the level from which on it runs over", low=0.0, unit_of="of"),
    ),
    outputs=(Output("flow", "-k*(of - edge if of >= edge else 0)", doc="leaves what is stored"),),
    effect=Effect(
        "k",
        {"of": "v"},
        sign=1,
        shapes={"edge": Shape((0.5, 0.7, 0.8, 0.9), of="top", least=0.2, most=1.0)},
        lacking=("q",),
    ),
)

barrier_hi = Block(
    name="barrier_hi",
    doc="A spring above a gap, on the side of positive coordinates.",
    inputs=(OF,),
    parameters=(STIFFNESS, GAP),
    outputs=(Output("force", "-k*(of - gap if of >= gap else 0)", doc="acts on the body"),),
    effect=Effect("k", {"of": "q"}, sign=1, shapes={"gap": GAPS}),
)

barrier_lo = Block(
    name="barrier_lo",
    doc="A spring below a gap, on the side of negative coordinates.",
    inputs=(OF,),
    parameters=(STIFFNESS, GAP),
    outputs=(Output("force", "-k*(of + gap if of <= -gap else 0)", doc="acts on the body"),),
    effect=Effect("k", {"of": "q"}, sign=1, shapes={"gap": GAPS}),
)

hunt_crossley = Block(
    name="hunt_crossley",
    doc="Contact of a round body with a wall, harder the deeper it goes in, with loss on the way.",
    inputs=(OF, Input("rate", doc="its rate: rad/s, or m/s")),
    parameters=(
        Parameter("k", doc="N m/rad^n, or N/m^n, with the exponent n", low=0.0),
        Parameter("wall", doc="rad, or m; above it where it is positive, else below", unit_of="of"),
        Parameter(
            "speed", doc="of the body that doubles the force: rad/s, or m/s; high: no loss", low=0.0
        ),
        Parameter("exponent", doc="1.5 for spheres (Hertz)", default=1.5, low=1.0),
    ),
    # max(): the wall never pulls
    outputs=(
        Output(
            "force",
            "(-k*(of - wall)**exponent*max(0, 1 + rate/speed) if of >= wall else 0) if wall >= 0"
            " else (k*(wall - of)**exponent*max(0, 1 - rate/speed) if of <= wall else 0)",
            doc="acts on the body",
        ),
    ),
    effect=Effect(
        "k",
        {"of": "q", "rate": "v"},
        sign=1,
        shapes={
            "wall": Shape((0.3, 0.6, 0.85, -0.3, -0.6, -0.85), of="Q", low=-1e9),
            "speed": Shape((1.0, 10.0), of="V", low=1e-12),
        },
    ),
    source="K. H. Hunt, F. R. E. Crossley, Coefficient of restitution interpreted as damping in"
    " vibroimpact, J. Appl. Mech. 42 (1975) 440.",
)
