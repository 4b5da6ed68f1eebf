"""Noise: random signals that keep each value for a period, the same in each run of a seed."""

from tracewire.library import Block, Event, Output, Parameter, State

PERIOD = Parameter("period", "s", "the time that a value is kept", above=0.0)
SEED = Parameter(
    "seed", doc="a whole number: another one gives other values; a list gives a vector", low=0.0
)
WHOLE = "floor(seed) >= seed"
K = "floor(t/period)"
SOURCE = "Random numbers: permutations of the number of the period, tracewire/compile/draws.py."

random_steps = Block(
    name="random_steps",
    doc="Steps to random levels, all equally likely between two limits, at each period.",
    require=("low <= high", WHOLE),
    parameters=(
        PERIOD,
        SEED,
        Parameter("low", doc="the lower limit", default=0.0),
        Parameter("high", doc="the upper limit", default=1.0),
    ),
    outputs=(Output("y", f"low + (high - low)*random_number(seed, {K})", doc="jumps"),),
    source=SOURCE,
)

noise = Block(
    name="noise",
    doc="White noise up to 1/(2*period): a normally distributed value at each period.",
    require=(WHOLE,),
    parameters=(
        PERIOD,
        SEED,
        Parameter("sigma", doc="the standard deviation; sigma^2*period is the power", low=0.0),
        Parameter("mean", default=0.0),
    ),
    outputs=(
        Output(
            "y",
            f"mean + sigma*sqrt(-2*log(random_number(seed, 2*{K})))"
            f"*cos(2*pi*random_number(seed, 2*{K} + 1))",
            doc="jumps",
        ),
    ),
    source=f"{SOURCE} Normal values: G. E. P. Box, M. E. Muller, Ann. Math. Statist. 29, 1958.",
)

prbs = Block(
    name="prbs",
    doc="A pseudo-random binary sequence, of a shift register whose feedback is an exclusive or.",
    parameters=(
        PERIOD,
        Parameter(
            "register",
            doc="a list of n bits, not all 0, such as [1, 0, 0, 0, 0, 0, 0]",
            low=0.0,
            high=1.0,
        ),
        Parameter("tap", doc="bit k + n is bit k xor bit k + tap", default=1.0, low=1.0),
        Parameter("low", doc="the level of a bit of 0", default=-1.0),
        Parameter("high", doc="the level of a bit of 1", default=1.0),
    ),
    states=(State("bits", "zeros_like(bit_register(register))", "bit_register(register)"),),
    events=(
        Event(
            "tick",
            every="period",
            offset="period",
            set={"bits": "shift_in(bits, bits[0] + bits[tap] - 2*bits[0]*bits[tap])"},
        ),
    ),
    outputs=(Output("y", "low + (high - low)*bits[0]", doc="jumps"),),
    source="It repeats after 2^n - 1 periods for n = 2, 3, 4, 6, 7, 15 with tap 1; n = 5, 11 with"
    " 2; n = 10, 17 with 3; n = 9 with 4: S. W. Golomb, Shift Register Sequences, 1967.",
)
