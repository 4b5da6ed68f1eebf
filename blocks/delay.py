"""Delays of flowing signals: a true one, and a rational function that stands for one."""

from tracewire.library import Block, Input, Output, Parameter, State

delay = Block(
    name="delay",
    doc="The input as it was some time ago, exactly: a loop through it is no algebraic loop.",
    inputs=(
        Input("of"),
        Input("past", default="before", doc="of before the start: a smooth signal of t alone"),
    ),
    parameters=(
        Parameter("time", "s", above=0.0),
        Parameter("before", doc="the input before the start", default=0.0),
    ),
    outputs=(Output("y", "delayed(of, time, past)", unit_of="of"),),
    source="A. Bellen, M. Zennaro, Numerical Methods for Delay Differential Equations, 2003.",
)

variable_delay = Block(
    name="variable_delay",
    doc="The input as it was some time ago, where that time changes between two bounds.",
    inputs=(
        Input("of"),
        Input("time", "s", "the delay"),
        Input("past", default="before", doc="of before the start: a smooth signal of t alone"),
    ),
    parameters=(
        Parameter("shortest", "s", "what is below is this: steps are no longer", above=0.0),
        Parameter("longest", "s", "what is above is this", above=0.0),
        Parameter("before", doc="the input before the start", default=0.0),
    ),
    require=("shortest <= longest",),
    outputs=(
        Output(
            "y",
            "delayed(of, min(max(time, shortest), longest), past, shortest, longest)",
            unit_of="of",
        ),
    ),
    source="A. Bellen, M. Zennaro, Numerical Methods for Delay Differential Equations, 2003.",
)

pade_delay = Block(
    name="pade_delay",
    doc="An approximation of a delay by Pade's all-pass of third order, good up to 2/delay rad/s.",
    inputs=(Input("of", doc="without jumps: of a jump it makes a wave before the delay"),),
    parameters=(
        Parameter("delay", "s", above=0.0),
        Parameter("start", doc="the input before the start, to which it has settled", default=0.0),
    ),
    # (120 - 60p + 12p^2 - p^3)/(120 + 60p + 12p^2 + p^3) with p = delay*s: y = x - of
    states=(
        State("x", "(12*of - 12*(x - of) + x_2)/delay", "2*start"),
        State("x_2", "(x_3 - 60*of - 60*(x - of))/delay", "0"),
        State("x_3", "120*(of - (x - of))/delay", "120*start"),
    ),
    outputs=(Output("y", "x - of", unit_of="of"),),
    source="G. H. Golub, C. F. Van Loan, Matrix Computations, section 9.3: the (3, 3) Pade form of"
    " exp(-p).",
)
