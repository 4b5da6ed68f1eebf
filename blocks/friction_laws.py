"""Laws of friction that are whole: each stands alone, and holds the body at rest exactly.

A rate is in rad/s and the output a torque in N m, or m/s and a force in N. It acts ON the body.
"""

from tracewire.library import Block, Input, Output, Parameter

RATE = Input("rate", doc="of the body, against what it rubs on")

# the small term keeps the derivative by the exponent finite at rest
CURVE = "exp(-((rate/speed)**2 + 1e-24)**(exponent/2))"

stribeck_friction = Block(
    name="stribeck_friction",
    doc="Dry and viscous friction whose level falls from that of sticking as it begins to slip.",
    require=("slip <= stick",),
    inputs=(RATE,),
    parameters=(
        Parameter("slip", doc="level of dry friction while slipping fast: N m, or N", low=0.0),
        Parameter("stick", doc="level at which it breaks away", low=0.0),
        Parameter("speed", doc="at which the rise has fallen to 1/e: rad/s, or m/s", above=0.0),
        Parameter("exponent", doc="2: a bell, 1: a cusp", default=2.0, low=1.0),
        Parameter("c", doc="viscous part: N m s/rad, or N s/m", default=0.0, low=0.0),
    ),
    outputs=(
        Output(
            "force",
            f"-dry(rate, slip + (stick - slip)*{CURVE}, stick) - c*rate",
            doc="acts on the body",
        ),
    ),
    source="R. Stribeck, Z. VDI 46 (1902) 1341; B. Armstrong-Helouvry, P. Dupont, C. Canudas de"
    " Wit, Automatica 30 (1994) 1083: exponents from 1/2 to 2; below 1 the fall has no slope here.",
)

friction_table = Block(
    name="friction_table",
    doc="Dry friction whose level is read from a table of measured levels against the speed.",
    inputs=(RATE,),
    parameters=(
        Parameter(
            "points",
            doc="pairs [speed, level] of one direction, which hold for the other, too; the level"
            " at the first speed is that of sticking",
            kind="points",
            low=0.0,
        ),
    ),
    outputs=(
        Output(
            "force",
            "-dry(rate, interp(abs(rate), points), interp(0, points))",
            doc="acts on the body; the last level is held beyond the last speed",
        ),
    ),
    source="A measured curve as those of R. Stribeck, Z. VDI 46 (1902) 1341.",
)

rolling_resistance = Block(
    name="rolling_resistance",
    doc="The resistance of a rolling wheel under a load, which holds it at rest on a slight slope.",
    inputs=(
        RATE,
        Input("load", doc="the force on the ground: N; below 0: the wheel is in the air"),
    ),
    parameters=(
        Parameter("c0", doc="the coefficient of resistance at rest", low=0.0),
        Parameter("c1", doc="its growth with the speed: s/m", default=0.0, low=0.0),
        Parameter(
            "c2", doc="its growth with the square of the speed: s^2/m^2", default=0.0, low=0.0
        ),
    ),
    outputs=(
        Output(
            "force",
            "-(load if load >= 0 else 0)*(c0*sign(rate) + c1*rate + c2*rate*abs(rate))",
            doc="acts on the body",
        ),
    ),
    source="T. D. Gillespie, Fundamentals of Vehicle Dynamics, 1992, chapter 4: a coefficient that"
    " grows with the speed.",
)
