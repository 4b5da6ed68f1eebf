"""Discrete: blocks with a sample time, whose equations hold from tick to tick of their clock.

Sample k is taken at offset + k*period. A signal of another block with the same clock passes at
once, so that blocks in a row add no delay; give all of them their period by one parameter of the
diagram. What is new at tick k was made of the samples before it, of which the first tick has none.
"""

from tracewire.library import Block, Event, Input, Output, Parameter, State

OF = Input("of", sampled="tick")
CLOCK = (
    Parameter("period", "s", "between two samples", above=0.0),
    Parameter("offset", "s", "the time of a sample", default=0.0),
)
START = Parameter("start", doc="the state at the first sample", default=0.0)
BEGUN = State("begun", rate="0", start="0", unit="1", hidden=True)


def tick(**new: str) -> tuple[Event]:
    """The event that gives states their new values; the first tick only takes a sample."""
    values = {name: f"begun*({formula}) + (1 - begun)*{name}" for name, formula in new.items()}
    return (Event("tick", every="period", offset="offset", set={**values, "begun": "1"}),)


unit_delay = Block(
    name="unit_delay",
    doc="The sample before, y[k] = u[k-1], or z^-1.",
    inputs=(OF,),
    parameters=(*CLOCK, Parameter("start", doc="the output until the second sample", default=0.0)),
    states=(State("y", "zeros_like(of)", "start"), BEGUN),
    events=tick(y="of"),
    outputs=(Output("y", "y", doc="jumps", unit_of="of"),),
    source="The shift operator of sampled signals: K. J. Astrom, B. Wittenmark,"
    " Computer-Controlled Systems, 1997.",
)

discrete_integrator = Block(
    name="discrete_integrator",
    doc="The sum x[k+1] = x[k] + gain*period*u[k] of samples, with y = x + weight*gain*period*u.",
    inputs=(OF,),
    parameters=(
        *CLOCK,
        Parameter("gain", default=1.0),
        Parameter(
            "weight",
            doc="0: forward Euler, 1/2: trapezoidal, 1: backward Euler",
            default=0.0,
            low=0.0,
            high=1.0,
        ),
        START,
    ),
    states=(State("x", "zeros_like(of)", "start"), BEGUN),
    events=tick(x="x + gain*period*of"),
    outputs=(Output("y", "x + weight*gain*period*of", doc="jumps"),),
    source="Euler's rule at a weight of 0, the trapezoidal rule at 1/2, the backward one at 1:"
    " K. J. Astrom, B. Wittenmark, Computer-Controlled Systems, 1997.",
)

discrete_transfer_function = Block(
    name="discrete_transfer_function",
    doc="A linear system b(z)/a(z) of one sampled signal, at rest at the start.",
    inputs=(OF,),
    parameters=(
        Parameter("numerator", doc="b: coefficients, the highest power of z first", default=1.0),
        Parameter("denominator", doc="a: of as high a degree or higher, such as [1, -0.9]"),
        *CLOCK,
    ),
    states=(State("x", "0", "0*monic_coefficients(denominator, denominator, 1)"), BEGUN),
    events=tick(
        x="shift_in(x, 0) + monic_coefficients(numerator, denominator, 1)*one_number(of)"
        " - monic_coefficients(denominator, denominator, 1)"
        "*(x[0] + direct_gain(numerator, denominator)*one_number(of))"
    ),
    outputs=(Output("y", "x[0] + direct_gain(numerator, denominator)*one_number(of)"),),
    source="Direct form II transposed: A. V. Oppenheim, R. W. Schafer, Discrete-Time Signal"
    " Processing, section 6.3.",
)

discrete_state_space = Block(
    name="discrete_state_space",
    doc="A linear system x[k+1] = A x[k] + B u[k], y[k] = C x[k] + D u[k] of sampled vectors.",
    inputs=(OF,),
    parameters=(
        Parameter("A", doc="formulas by rows, such as [[0, 1], [-0.5, 1]]", kind="formula"),
        Parameter("B", doc="formulas by rows, such as [[0], [1]]", kind="formula"),
        Parameter("C", doc="by rows; a single row, such as [1, 0], gives a number", kind="formula"),
        Parameter("D", doc="by rows, as C", kind="formula", default=0.0),
        *CLOCK,
        START,
    ),
    states=(State("x", "zeros_like(matrix_times(A, x))", "start"), BEGUN),
    events=tick(x="matrix_times(A, x) + matrix_times(B, of)"),
    outputs=(Output("y", "matrix_times(C, x) + matrix_times(D, of)"),),
    source="K. J. Astrom, B. Wittenmark, Computer-Controlled Systems, 1997.",
)

FAR = 1e30  # a limit that nothing reaches: the formulas of a run know no infinity
SLOPE = "kd*n/(1 + n*period)"
RAW = f"(kp*of + integral + smooth + {SLOPE}*of)"
LIMITED = f"(high if {RAW} >= high else (low if {RAW} <= low else {RAW}))"

discrete_pid = Block(
    name="discrete_pid",
    doc="A sampled PID controller with limits, whose integral does not wind up.",
    require=("low <= high",),
    inputs=(Input("of", doc="the error: reference minus measurement", sampled="tick"),),
    parameters=(
        Parameter("kp", doc="the proportional gain"),
        *CLOCK,
        Parameter("ki", doc="the integral gain, kp over the integral time", default=0.0),
        Parameter("kd", doc="the derivative gain, kp times the derivative time", default=0.0),
        Parameter("n", "rad/s", "the bandwidth of the derivative", default=100.0, above=0.0),
        Parameter("low", doc="the lower limit; far unless given", default=-FAR),
        Parameter("high", doc="the upper limit; far unless given", default=FAR),
        Parameter(
            "kb",
            "1/s",
            "how fast the integral follows the limited output",
            default="ki/kp if ki*kp > 0 else (n/(1 + n*period) if abs(ki) > 0 else 0)",
        ),
        Parameter("start", doc="the integral at the first sample", default=0.0),
    ),
    states=(
        State("integral", "zeros_like(of)", "start"),
        State("smooth", "zeros_like(of)", "0"),
        BEGUN,
    ),
    # forward Euler for the integral, backward Euler for the derivative, stable for every n
    events=tick(
        integral=f"integral + period*(ki*of + kb*({LIMITED} - {RAW}))",
        smooth=f"(smooth + {SLOPE}*of)/(1 + n*period) - {SLOPE}*of",
    ),
    outputs=(Output("y", LIMITED, doc="jumps"),),
    source="K. J. Astrom, B. Wittenmark, Computer-Controlled Systems, 1997, section 8.5.",
)
