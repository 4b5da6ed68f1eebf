"""Slip: friction of many elements side by side, each a spring that slips at a level of its own."""

from tracewire.library import Block, Input, Mode, Output, Parameter, State, Transition

RATE = Input("rate", doc="of the body: rad/s, or m/s")

maxwell_slip = Block(
    name="maxwell_slip",
    doc="Springs side by side, each of which slips at its own level: hysteresis with memory.",
    inputs=(RATE,),
    parameters=(
        Parameter("k", doc="stiffnesses: N m/rad, or N/m; a list, or one for all", above=0.0),
        Parameter("level", doc="at which each slips: N m, or N; a list", low=0.0),
        Parameter("start", doc="the forces at the start, held within the levels", default=0.0),
    ),
    states=(
        State(
            "f",
            "0 if (f >= level and rate > 0) or (f <= -level and rate < 0) else k*rate",
            "level if start > level else (-level if start < -level else start)",
        ),
    ),
    outputs=(Output("force", "-dot(f, 1)", doc="acts on the body"),),
    source="W. D. Iwan, A distributed-element model for hysteresis, J. Appl. Mech. 33 (1966) 893:"
    " n equal springs of k/n with levels F/n*(2*j - 1)/n, j = 1 ... n, are his uniform distribution"
    " up to 2*F/n, of which the sum of the levels is F.",
)

STRENGTH = "level*(1 + peak*exp(-(rate/speed)**2))"

maxwell_element = Block(
    name="maxwell_element",
    doc="A spring that slips at a level which falls with the rate, until the rate turns round.",
    inputs=(RATE,),
    parameters=(
        Parameter("k", doc="stiffness: N m/rad, or N/m", above=0.0),
        Parameter("level", doc="at which it slips fast: N m, or N", above=0.0),
        Parameter("peak", doc="share by which slow slip needs more", default=0.0, low=0.0),
        Parameter(
            "speed",
            doc="at which the peak has fallen to 1/e: rad/s, or m/s",
            default=1.0,
            above=0.0,
        ),
        Parameter("c", doc="how fast slip comes to its level: N m/s, or N/s", above=0.0),
    ),
    states=(
        State(
            "f",
            {
                "stick": "k*rate",
                "forwards": f"c*(1 - f/({STRENGTH}))",
                "backwards": f"-c*(1 + f/({STRENGTH}))",
            },
            "0",
        ),
    ),
    modes=(
        Mode("stick", doc="it holds the body as a spring"),
        Mode("forwards", doc="it slips at a positive rate"),
        Mode("backwards", doc="it slips at a negative rate"),
    ),
    transitions=(
        Transition("stick", "forwards", when=f"f >= {STRENGTH} and rate > 0"),
        Transition("stick", "backwards", when=f"-f >= {STRENGTH} and rate < 0"),
        Transition("forwards", "stick", when="rate < 0"),
        Transition("backwards", "stick", when="rate > 0"),
    ),
    outputs=(Output("force", "-f", doc="acts on the body; several stand side by side in a sum"),),
    source="The generalised Maxwell slip model, of which this is one element: F. Al-Bender,"
    " V. Lampaert, J. Swevers, IEEE Trans. Autom. Control 50 (2005) 1883; its alpha*s(v) is"
    " level*(1 + peak*exp(-(rate/speed)^2)), and its alpha*C is c.",
)
