"""Linear blocks: integrator, gain and sum, and the product and quotient of signals."""

from tracewire.library import Block, Input, Output, Parameter, State

integrator = Block(
    name="integrator",
    doc="The integral of a signal over the time.",
    inputs=(Input("of", doc="the rate of the state"),),
    parameters=(Parameter("start", doc="the value at the start of the run", default=0.0),),
    states=(State("x", rate="of", start="start"),),
    outputs=(Output("y", "x"),),
)

gain = Block(
    name="gain",
    doc="A signal times a factor.",
    inputs=(Input("of"),),
    parameters=(Parameter("k", doc="the factor"),),
    outputs=(Output("y", "k*of"),),
)

sum_ = Block(
    name="sum",
    doc="The sum of signals, each with the sign that its wire carries.",
    inputs=(Input("of", many=True),),
    outputs=(Output("y", "sum(of)"),),
)

product = Block(
    name="product",
    doc="The product of signals.",
    inputs=(Input("of", many=True),),
    outputs=(Output("y", "product(of)"),),
)

divide = Block(
    name="divide",
    doc="One signal divided by another.",
    inputs=(Input("of"), Input("by", doc="must not be zero")),
    outputs=(Output("y", "of/by"),),
)
