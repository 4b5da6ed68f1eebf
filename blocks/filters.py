"""Filters of first and second order: each reads the states that all of one order share."""

from tracewire.library import Block, Input, Output, Parameter, State

OF = Input("of")
GAIN = Parameter("k", doc="the gain of a constant signal", default=1.0)

# the state follows the signal within a time constant
LAG = (State("x", "(of - x)/lag", "start"),)
LAG_TIME = Parameter("lag", "s", "the time constant", above=0.0)
LAG_START = Parameter(
    "start", doc="the input before the start, to which it has settled", default=0.0
)

first_order = Block(
    name="first_order",
    doc="A lag of first order, k/(lag*s + 1).",
    inputs=(OF,),
    parameters=(LAG_TIME, GAIN, LAG_START),
    states=LAG,
    outputs=(Output("y", "k*x", unit_of="of", factor="k"),),
    source="It comes to 1 - 1/e of a step within the time constant: K. J. Astrom, R. M. Murray,"
    " Feedback Systems, 2008.",
)

lead_lag = Block(
    name="lead_lag",
    doc="A compensator k*(lead*s + 1)/(lag*s + 1).",
    inputs=(OF,),
    parameters=(Parameter("lead", "s", "the time of the zero"), LAG_TIME, GAIN, LAG_START),
    states=LAG,
    outputs=(Output("y", "k*(x + lead/lag*(of - x))", unit_of="of", factor="k"),),
    source="Loop shaping by lead and lag compensation: K. J. Astrom, R. M. Murray, Feedback"
    " Systems, 2008.",
)

derivative = Block(
    name="derivative",
    doc="The derivative of a signal that passes a lag, k*s/(lag*s + 1).",
    inputs=(OF,),
    parameters=(LAG_TIME, GAIN, LAG_START),
    states=LAG,
    outputs=(Output("y", "k*(of - x)/lag"),),
    source="The derivative part of a PID controller: K. J. Astrom, T. Hagglund, Advanced PID"
    " Control, 2006.",
)

# low/of = 1/(p^2 + 2*damping*p + 1) and band = p*low, with p = s/(2*pi*frequency)
SECOND_ORDER = (
    State("low", "2*pi*frequency*band", "start"),
    State("band", "2*pi*frequency*(of - low - 2*damping*band)", "0"),
)
FREQUENCY = Parameter("frequency", "Hz", "where poles and zeros are, over 2*pi", above=0.0)
BUTTERWORTH = Parameter(
    "damping", doc="the ratio of damping; Butterworth's unless given", default=0.5**0.5, low=0.0
)
WIDTH = Parameter(
    "damping", doc="half the width of the band over its frequency", default=0.5**0.5, low=0.0
)
START = Parameter("start", doc="the input before the start, to which it has settled", default=0.0)

second_order = Block(
    name="second_order",
    doc="An oscillator of second order, k/(p^2 + 2*damping*p + 1) with p = s/(2*pi*frequency).",
    inputs=(OF,),
    parameters=(FREQUENCY, Parameter("damping", doc="the ratio of damping", low=0.0), GAIN, START),
    states=SECOND_ORDER,
    outputs=(Output("y", "k*low", unit_of="of", factor="k"),),
    source="The equation of a mass on a spring with a damper: K. J. Astrom, R. M. Murray,"
    " Feedback Systems, 2008.",
)

low_pass = Block(
    name="low_pass",
    doc="What is slow in a signal, 1/(p^2 + 2*damping*p + 1) with p = s/(2*pi*frequency).",
    inputs=(OF,),
    parameters=(FREQUENCY, BUTTERWORTH, START),
    states=SECOND_ORDER,
    outputs=(Output("y", "low", unit_of="of"),),
    source="With a damping of 1/sqrt(2): S. Butterworth, On the theory of filter amplifiers,"
    " Wireless Engineer 7 (1930) 536.",
)

high_pass = Block(
    name="high_pass",
    doc="What is fast in a signal, p^2/(p^2 + 2*damping*p + 1) with p = s/(2*pi*frequency).",
    inputs=(OF,),
    parameters=(FREQUENCY, BUTTERWORTH, START),
    states=SECOND_ORDER,
    outputs=(Output("y", "of - low - 2*damping*band", unit_of="of"),),
    source="The low pass with 1/p in the place of p.",
)

band_pass = Block(
    name="band_pass",
    doc="What a signal has around a frequency, 2*damping*p/(p^2 + 2*damping*p + 1).",
    inputs=(OF,),
    parameters=(FREQUENCY, WIDTH, START),
    states=SECOND_ORDER,
    outputs=(Output("y", "2*damping*band", unit_of="of"),),
    source="What the notch takes away: 1 - (p^2 + 1)/(p^2 + 2*damping*p + 1).",
)

notch = Block(
    name="notch",
    doc="A signal without what it has at a frequency, (p^2 + 1)/(p^2 + 2*damping*p + 1).",
    inputs=(OF,),
    parameters=(FREQUENCY, WIDTH, START),
    states=SECOND_ORDER,
    outputs=(Output("y", "of - 2*damping*band", unit_of="of"),),
    source="What the band pass leaves: 1 - 2*damping*p/(p^2 + 2*damping*p + 1).",
)
