"""Friction and damping: every block outputs what acts ON the body, against its rate.

A rate is in rad/s and the output a torque in N m, or m/s and a force in N. Letters l and r mark
the two directions: l while the rate is zero or positive, r while it is negative.
"""

from tracewire.library import Block, Effect, Input, Output, Parameter

PAPER = (
    "Semiempirical identification of nonlinear dynamics of a two-degree-of-freedom real torsion"
    " pendulum with a nonuniform planar stick-slip friction and elastic barriers"
)

RATE = Input("rate", doc="of the body, against what it rubs on")


viscous = Block(
    name="viscous",
    doc="Friction in proportion to the rate.",
    inputs=(RATE,),
    parameters=(Parameter("c", doc="N m s/rad, or N s/m", low=0.0),),
    outputs=(Output("force", "-c*rate", doc="acts on the body"),),
    effect=Effect("c", {"rate": "v"}, sign=1),
)

cubic_damping = Block(
    name="cubic_damping",
    doc="Friction in proportion to the third power of the rate.",
    inputs=(RATE,),
    parameters=(Parameter("c", doc="N m s^3/rad^3, or N s^3/m^3", low=0.0),),
    outputs=(Output("force", "-c*rate**3", doc="acts on the body"),),
    effect=Effect("c", {"rate": "v"}, sign=1),
)

quad_drag = Block(
    name="quad_drag",
    doc="Drag in proportion to the square of the rate, as of a body in a turbulent fluid.",
    inputs=(RATE,),
    parameters=(Parameter("c", doc="N m s^2/rad^2, or N s^2/m^2", low=0.0),),
    outputs=(Output("force", "-c*rate*abs(rate)", doc="acts on the body"),),
    effect=Effect("c", {"rate": "v"}, sign=1, alias=("cubic_damping", "viscous_drift")),
)

arctan_friction = Block(
    name="arctan_friction",
    doc="Dry friction smoothed by an arctangent: it creeps and never sticks.",
    inputs=(RATE,),
    parameters=(
        Parameter("level", doc="approached at high rates: N m, or N", low=0.0),
        Parameter("eps", doc="steepness at rest: s/rad, or s/m", low=0.0),
    ),
    outputs=(Output("force", "-level*2/pi*atan(eps*rate)", doc="acts on the body"),),
    source=f"{PAPER}, the second terms of Eq 8 and Eq 10.",
)

asymmetric_viscous = Block(
    name="asymmetric_viscous",
    doc="Viscous friction with a coefficient for each direction.",
    inputs=(RATE,),
    parameters=(
        Parameter("c_l", doc="while rate >= 0: N m s/rad, or N s/m", low=0.0),
        Parameter("c_r", doc="while rate < 0", low=0.0),
    ),
    outputs=(Output("force", "-c_l*rate if rate >= 0 else -c_r*rate", doc="acts on the body"),),
    source=f"{PAPER}, the first term of Eq 22.",
)

asymmetric_arctan = Block(
    name="asymmetric_arctan",
    doc="Viscous and arctangent friction with coefficients for each direction.",
    inputs=(RATE,),
    parameters=(
        Parameter("level_l", doc="while rate >= 0, approached at high rates: N m, or N", low=0.0),
        Parameter("level_r", doc="while rate < 0", low=0.0),
        Parameter("c_l", doc="viscous, while rate >= 0: N m s/rad, or N s/m", low=0.0),
        Parameter("c_r", doc="viscous, while rate < 0", low=0.0),
        Parameter("eps", doc="steepness at rest: s/rad, or s/m", low=0.0),
    ),
    outputs=(
        Output(
            "force",
            "-(c_l*rate + level_l*2/pi*atan(eps*rate)) if rate >= 0"
            " else -(c_r*rate + level_r*2/pi*atan(eps*rate))",
            doc="acts on the body",
        ),
    ),
    source=f"{PAPER}, Eq 21: level = T_s2, c = T_v2, eps = epsilon_2.",
)

smoothed_stribeck = Block(
    name="smoothed_stribeck",
    doc="Dry friction with a peak near rest and a decay at high rates, smooth, for each direction.",
    inputs=(RATE,),
    parameters=(
        Parameter("level_l", doc="while rate >= 0: N m, or N", low=0.0),
        Parameter("level_r", doc="while rate < 0", low=0.0),
        Parameter("decay_l", doc="how fast it falls, while rate >= 0: s/rad, or s/m", low=0.0),
        Parameter("decay_r", doc="while rate < 0", low=0.0),
        Parameter("alpha", doc="sharpness near rest: s/rad, or s/m", low=0.0),
        Parameter("beta", doc="height of the peak over the level near rest", low=0.0),
    ),
    outputs=(
        Output(
            "force",
            "-(level_l/(1 + decay_l*rate) if rate >= 0 else level_r/(1 - decay_r*rate))"
            "*(1 + beta/cosh(alpha*rate))*tanh(alpha*rate)",
            doc="acts on the body",
        ),
    ),
    source=f"{PAPER}, Eq 24: T_s2/(1 + T_02*|v|)*(1 + beta/cosh(alpha*v))*tanh(alpha*v)"
    " with level = T_s2 and decay = T_02; the print gives beta in N m, but it is a number.",
)

asym_viscous = Block(
    name="asym_viscous",
    doc="Viscous friction that differs between the directions: half the difference.",
    inputs=(RATE,),
    parameters=(
        Parameter("c", doc="half the difference of the coefficients: N m s/rad, or N s/m"),
    ),
    outputs=(Output("force", "-c*abs(rate)", doc="acts on the body"),),
    effect=Effect("c", {"rate": "v"}, both_signs=("v",)),
)

viscous_drift = Block(
    name="viscous_drift",
    doc="Viscous friction that grows with the time of the run, as in a bearing that cools down.",
    inputs=(RATE,),
    parameters=(Parameter("c", doc="growth in a second: N m/rad, or N/m"),),
    outputs=(Output("force", "-c*t*rate", doc="acts on the body"),),
    effect=Effect("c", {"rate": "v"}, alias=("cubic_damping", "friction_drift")),
)
