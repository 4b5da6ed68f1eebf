"""Elastic barriers: every block outputs what acts ON the body while it is beyond a limit."""

from tracewire.library import Block, Input, Output, Parameter

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
        Parameter("high", doc="the upper limit: rad, or m"),
        Parameter("low", doc="the lower limit", default="-high"),
        Parameter("k", doc="stiffness: N m/rad, or N/m", low=0.0),
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
