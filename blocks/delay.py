"""Delay: what stands for a delay of a flowing signal."""

from tracewire.library import Block, Input, Output, Parameter, State

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
    outputs=(Output("y", "x - of"),),
    source="G. H. Golub, C. F. Van Loan, Matrix Computations, section 9.3: the (3, 3) Pade form of"
    " exp(-p).",
)
