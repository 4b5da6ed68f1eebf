"""Slip: friction of many elements side by side, each a spring that slips at a level of its own."""

from tracewire.library import Block, Input, Output, Parameter, State

maxwell_slip = Block(
    name="maxwell_slip",
    doc="Springs side by side, each of which slips at its own level: hysteresis with memory.",
    inputs=(Input("rate", doc="of the body: rad/s, or m/s"),),
    parameters=(
        Parameter("k", doc="stiffnesses: N m/rad, or N/m; a list, or one for all", above=0.0),
        Parameter("level", doc="at which each slips: N m, or N; a list", low=0.0),
        Parameter("start", doc="the forces at the start, a list within the levels", default=0.0),
    ),
    states=(
        State(
            "f",
            "0 if (f >= level and rate > 0) or (f <= -level and rate < 0) else k*rate",
            "start + zeros_like(level)",
        ),
    ),
    outputs=(Output("force", "-dot(f, 1)", doc="acts on the body"),),
    source="W. D. Iwan, A distributed-element model for hysteresis, J. Appl. Mech. 33 (1966) 893:"
    " n equal springs of k/n with levels F/n*(2*j - 1)/n, j = 1 ... n, are his uniform distribution"
    " up to 2*F/n, of which the sum of the levels is F.",
)
