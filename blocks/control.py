"""Control: linear systems by their transfer function or their matrices, and the PID controller."""

from tracewire.library import Block, Input, Output, Parameter, State

transfer_function = Block(
    name="transfer_function",
    doc="A linear system b(s)/a(s) of one signal.",
    inputs=(Input("of", doc="one number"),),
    parameters=(
        Parameter("numerator", doc="b: coefficients, the highest power first", default=1.0),
        Parameter("denominator", doc="a: of as high a degree or higher, such as [m, c, k]"),
        Parameter("start", doc="the output before the start, to which it has settled", default=0.0),
    ),
    # the observable canonical form: x[0] is the output, and all states are of its size
    states=(
        State(
            "x",
            "root_scale(denominator)*(shift_in(x, 0)"
            " + monic_coefficients(numerator, denominator, root_scale(denominator))*one_number(of)"
            " - monic_coefficients(denominator, denominator, root_scale(denominator))"
            "*(x[0] + direct_gain(numerator, denominator)*one_number(of)))",
            "start*settled_states(numerator, denominator, root_scale(denominator))",
        ),
    ),
    outputs=(Output("y", "x[0] + direct_gain(numerator, denominator)*one_number(of)"),),
    source="The observable canonical form: T. Kailath, Linear Systems, 1980, section 2.1.",
)

state_space = Block(
    name="state_space",
    doc="A linear system x' = A x + B u, y = C x + D u of vector signals.",
    inputs=(Input("of", doc="u: a vector, or a number where B has one column"),),
    parameters=(
        Parameter("A", doc="formulas by rows, such as [[0, 1], [-k, -c]]", kind="formula"),
        Parameter("B", doc="formulas by rows, such as [[0], [1]]", kind="formula"),
        Parameter("C", doc="by rows; a single row, such as [1, 0], gives a number", kind="formula"),
        Parameter("D", doc="by rows, as C", kind="formula", default=0.0),
        Parameter("start", doc="x at the start of the run", default=0.0),
    ),
    states=(State("x", "matrix_times(A, x) + matrix_times(B, of)", "start"),),
    outputs=(Output("y", "matrix_times(C, x) + matrix_times(D, of)"),),
    source="R. E. Kalman, Mathematical description of linear dynamical systems, J. SIAM Control"
    " 1 (1963) 152.",
)

FAR = 1e30  # a limit that nothing reaches: the formulas of a run know no infinity
RAW = "kp*of + integral + kd*n*(of - smooth)"

pid = Block(
    name="pid",
    doc="A PID controller kp + ki/s + kd*s/(1 + s/n) with limits, whose integral does not wind up.",
    require=("low <= high",),
    inputs=(Input("of", doc="the error: reference minus measurement"),),
    parameters=(
        Parameter("kp", doc="the proportional gain"),
        Parameter("ki", doc="the integral gain, kp over the integral time", default=0.0),
        Parameter("kd", doc="the derivative gain, kp times the derivative time", default=0.0),
        Parameter("n", "rad/s", "the bandwidth of the derivative", default=100.0, above=0.0),
        Parameter("low", doc="the lower limit; far unless given", default=-FAR),
        Parameter("high", doc="the upper limit; far unless given", default=FAR),
        Parameter(
            "kb",
            "1/s",
            "how fast the integral follows the limited output",
            default="ki/kp if ki*kp > 0 else (n if abs(ki) > 0 else 0)",
        ),
        Parameter("start", doc="the integral at the start of the run", default=0.0),
    ),
    states=(
        State(
            "integral",
            f"ki*of + (kb*(high - ({RAW})) if {RAW} >= high"
            f" else (kb*(low - ({RAW})) if {RAW} <= low else 0))",
            "start",
        ),
        State("smooth", "n*(of - smooth)", "0"),
    ),
    outputs=(Output("y", f"high if {RAW} >= high else (low if {RAW} <= low else {RAW})"),),
    source="Back-calculation: K. J. Astrom, T. Hagglund, Advanced PID Control, 2006, section 3.5.",
)
