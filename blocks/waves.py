"""Waves: periodic signals, whose jumps and corners are known times, and sweeps of frequency."""

from tracewire.library import Block, Output, Parameter

AMPLITUDE = Parameter("amplitude")
PERIOD = Parameter("period", "s", above=0.0)
OFFSET = Parameter("offset", doc="added to the wave", default=0.0)

pulse = Block(
    name="pulse",
    doc="A train of pulses, offset + amplitude during the first part of each period, else offset.",
    parameters=(
        AMPLITUDE,
        PERIOD,
        Parameter("duty", doc="the part of a period that it is on", default=0.5, low=0.0, high=1.0),
        Parameter("at", "s", "the time of the first pulse", default=0.0),
        Parameter("offset", doc="the value between pulses and before the first", default=0.0),
    ),
    outputs=(
        Output(
            "y",
            "offset + (amplitude*(floor((t - at)/period) - floor((t - at)/period - duty))"
            " if t >= at else 0)",
            doc="jumps",
        ),
    ),
    source="Modelica.Blocks.Sources.Pulse, with a duty from 0 to 1.",
)

sawtooth = Block(
    name="sawtooth",
    doc="A wave that rises evenly from offset to offset + amplitude in each period and falls back.",
    parameters=(
        AMPLITUDE,
        PERIOD,
        Parameter("at", "s", "a time at which it is at its offset", default=0.0),
        OFFSET,
    ),
    outputs=(
        Output(
            "y",
            "offset + amplitude*((t - at)/period - floor((t - at)/period))",
            doc="jumps",
        ),
    ),
    source="Modelica.Blocks.Sources.SawTooth.",
)

# 2*(t - at)/period + 1/2 is a whole number at each peak; between them the wave is a straight line
HALVES = "(2*(t - at)/period + 1/2)"

triangle = Block(
    name="triangle",
    doc="A wave of straight lines between offset - amplitude and offset + amplitude, as a sine.",
    parameters=(
        AMPLITUDE,
        PERIOD,
        Parameter("at", "s", "a time at which it rises through its offset", default=0.0),
        OFFSET,
    ),
    outputs=(
        Output(
            "y",
            f"offset + amplitude*(1 - 2*mod(floor({HALVES}), 2))"
            f"*(2*({HALVES} - floor({HALVES})) - 1)",
        ),
    ),
    source="It has its zeros and its peaks where the sine of this period has them.",
)

chirp = Block(
    name="chirp",
    doc="A sine whose frequency changes evenly from one value at t = 0 to another, and goes on so.",
    parameters=(
        AMPLITUDE,
        Parameter("first", "Hz", "the frequency at t = 0"),
        Parameter("last", "Hz", "the frequency at t = duration"),
        Parameter("duration", "s", "the time from the first to the last frequency", above=0.0),
        Parameter("phase", "rad", "the phase at t = 0", default=0.0),
        OFFSET,
    ),
    outputs=(
        Output(
            "y",
            "offset + amplitude*sin(2*pi*(first + (last - first)*t/(2*duration))*t + phase)",
        ),
    ),
    source="The phase is the integral of the frequency.",
)

multisine = Block(
    name="multisine",
    doc="A sum of sines, each with its frequency, amplitude and phase.",
    parameters=(
        Parameter("frequencies", "Hz", "a list"),
        Parameter("amplitudes", doc="a list, or one for all", default=1.0),
        Parameter("phases", "rad", "a list, or one for all", default=0.0),
        OFFSET,
    ),
    outputs=(Output("y", "offset + dot(amplitudes*sin(2*pi*frequencies*t + phases), 1)"),),
    source="Phases of a low crest, -pi*k*(k - 1)/n for sine k of n: M. R. Schroeder, IEEE Trans."
    " Inf. Theory 16, 1970.",
)
