"""Mathematics: a formula of the user's own, and the functions of the formula language as blocks."""

from tracewire.library import Block, Input, Output, Parameter

expression = Block(
    name="expression",
    doc="A formula over the signals and parameters of its diagram, and the time t.",
    parameters=(Parameter("formula", doc="such as k*theta**3 + omega", kind="formula"),),
    outputs=(Output("y", "formula"),),
)

sin = Block(
    name="sin",
    doc="The sine of an angle.",
    inputs=(Input("of", "rad"),),
    outputs=(Output("y", "sin(of)"),),
)

cos = Block(
    name="cos",
    doc="The cosine of an angle.",
    inputs=(Input("of", "rad"),),
    outputs=(Output("y", "cos(of)"),),
)

tan = Block(
    name="tan",
    doc="The tangent of an angle.",
    inputs=(Input("of", "rad"),),
    outputs=(Output("y", "tan(of)"),),
)

asin = Block(
    name="asin",
    doc="The angle whose sine is the signal.",
    inputs=(Input("of", doc="from -1 to 1"),),
    outputs=(Output("angle", "asin(of)", "rad"),),
)

acos = Block(
    name="acos",
    doc="The angle whose cosine is the signal.",
    inputs=(Input("of", doc="from -1 to 1"),),
    outputs=(Output("angle", "acos(of)", "rad"),),
)

atan = Block(
    name="atan",
    doc="The angle whose tangent is the signal, between -pi/2 and pi/2.",
    inputs=(Input("of"),),
    outputs=(Output("angle", "atan(of)", "rad"),),
)

atan2 = Block(
    name="atan2",
    doc="The angle of a point (x, y) from the x-axis, between -pi and pi.",
    inputs=(Input("y"), Input("x")),
    outputs=(Output("angle", "atan2(y, x)", "rad"),),
)

sinh = Block(
    name="sinh",
    doc="The hyperbolic sine.",
    inputs=(Input("of"),),
    outputs=(Output("y", "sinh(of)"),),
)

cosh = Block(
    name="cosh",
    doc="The hyperbolic cosine.",
    inputs=(Input("of"),),
    outputs=(Output("y", "cosh(of)"),),
)

tanh = Block(
    name="tanh",
    doc="The hyperbolic tangent.",
    inputs=(Input("of"),),
    outputs=(Output("y", "tanh(of)"),),
)

exp = Block(
    name="exp",
    doc="The exponential.",
    inputs=(Input("of"),),
    outputs=(Output("y", "exp(of)"),),
)

log = Block(
    name="log",
    doc="The natural logarithm.",
    inputs=(Input("of", doc="must be positive"),),
    outputs=(Output("y", "log(of)"),),
)

sqrt = Block(
    name="sqrt",
    doc="The square root.",
    inputs=(Input("of", doc="must not be negative"),),
    outputs=(Output("y", "sqrt(of)"),),
)

power = Block(
    name="power",
    doc="A signal raised to a fixed power.",
    inputs=(Input("of", doc="must not be negative where the exponent is not whole"),),
    parameters=(Parameter("exponent"),),
    outputs=(Output("y", "of**exponent"),),
)

floor = Block(
    name="floor",
    doc="The largest whole number that is not above the signal.",
    inputs=(Input("of"),),
    outputs=(Output("y", "floor(of)", doc="jumps"),),
)

mod = Block(
    name="mod",
    doc="The remainder of a signal after whole multiples of another, with the sign of the other.",
    inputs=(Input("of"), Input("by", doc="must not be zero")),
    outputs=(Output("y", "mod(of, by)", doc="jumps"),),
)
