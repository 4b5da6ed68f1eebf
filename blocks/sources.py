"""Sources: signals that depend on nothing but the time."""

from tracewire.library import Block, Effect, Input, Output, Parameter, Shape

QUARTER = 1.5707963267948966  # rad, of a wave: pi/2

constant = Block(
    name="constant",
    doc="A value that does not change.",
    parameters=(Parameter("value"),),
    outputs=(Output("y", "value"),),
)

bias = Block(
    name="bias",
    doc="A constant torque or force that nothing else explains.",
    parameters=(Parameter("level", doc="the torque or force, of either sign"),),
    outputs=(Output("force", "level", doc="acts on the body"),),
    effect=Effect("level", alias=("sensor_offset",)),
)

harmonic = Block(
    name="harmonic",
    doc="A torque or force of one frequency that nothing else explains, as of a motor nearby, with "
    "its phase at t = 0.",
    parameters=(
        Parameter("amplitude", doc="the torque or force"),
        Parameter("period", "s", "of a wave, 1/frequency", low=0.0),
        Parameter("phase", "rad", "at t = 0; one for all series that give none", default=0.0),
    ),
    outputs=(Output("force", "amplitude*sin(2*pi*t/period + phase)", doc="acts on the body"),),
    # Whole numbers of waves in the record, so that no frequency up to 60/T is missed, and above it
    # the lines of the residual's spectrum. What comes less than 2.5 times is no wave that a record
    # shows: two waves follow whatever goes up and down. The phase is that at t = 0: series that
    # begin anywhere in the wave give it under their `parameters`.
    effect=Effect(
        "amplitude",
        shapes={
            "period": Shape(
                tuple(1 / n for n in range(3, 61)), of="T", low=1e-9, most=0.4, line=True
            ),
            "phase": Shape((0.0, QUARTER), low=-4 * QUARTER),  # sine and cosine
        },
        each=("phase",),
        alias=("drive_2nd_harm", "drive_3rd_harm", "parametric"),
    ),
)

time = Block(
    name="time",
    doc="The time of the run.",
    outputs=(Output("y", "t", "s"),),
)

sine = Block(
    name="sine",
    doc="A sine wave around an offset.",
    parameters=(
        Parameter("amplitude"),
        Parameter("omega", "rad/s", "angular frequency, 2*pi over the period"),
        Parameter("phase", "rad", default=0.0),
        Parameter("offset", default=0.0),
    ),
    outputs=(Output("y", "amplitude*sin(omega*t + phase) + offset"),),
)

square = Block(
    name="square",
    doc="A square wave, amplitude times the sign of sin(2*pi*frequency*t + phase), first positive.",
    parameters=(
        Parameter("amplitude"),
        Parameter("frequency", "Hz", "periods in a second"),
        Parameter("phase", "rad", default=0.0),
    ),
    outputs=(
        Output("y", "amplitude*(1 - 2*mod(floor(2*frequency*t + phase/pi), 2))", doc="jumps"),
    ),
)

step = Block(
    name="step",
    doc="A jump from an offset by a height.",
    parameters=(
        Parameter("height"),
        Parameter("at", "s", "the time of the jump", default=0.0),
        Parameter("offset", doc="the value before the jump", default=0.0),
    ),
    outputs=(Output("y", "offset + (height if t >= at else 0)", doc="jumps"),),
)

ramp = Block(
    name="ramp",
    doc="A signal that rises evenly from a time on.",
    parameters=(
        Parameter("slope", doc="rise in a second"),
        Parameter("at", "s", "the time where it begins", default=0.0),
        Parameter("offset", doc="the value before that time", default=0.0),
    ),
    outputs=(Output("y", "offset + (slope*(t - at) if t >= at else 0)"),),
)

READ_AT = Input("of", doc="where the table is read: the time, unless wired", default="t")
POINTS = Parameter("points", doc="pairs [x, y], x ascending", kind="points")

table = Block(
    name="table",
    doc="Straight lines through points, held before the first and after the last.",
    inputs=(READ_AT,),
    parameters=(POINTS,),
    outputs=(Output("y", "interp(of, points)"),),
)

spline_table = Block(
    name="spline_table",
    doc="The natural cubic spline through points, whose ends are held.",
    inputs=(READ_AT,),
    parameters=(POINTS,),
    outputs=(Output("y", "cubic_spline(of, points)"),),
    source="C. de Boor, A Practical Guide to Splines, chapter IV; at the ends y'' = 0.",
)

monotone_table = Block(
    name="monotone_table",
    doc="A smooth curve through points that rises and falls with them, whose ends are held.",
    inputs=(READ_AT,),
    parameters=(POINTS,),
    outputs=(Output("y", "monotone_cubic(of, points)"),),
    source="PCHIP: F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5, 1984.",
)
