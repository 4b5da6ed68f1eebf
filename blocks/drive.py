"""Drive: what an actuator does other than its record says. The output is added to the drive."""

from tracewire.library import Block, Effect, Input, Output, Parameter, Shape, State, Tone

QUARTER = 1.5707963267948966  # rad, of a wave: pi/2

OF = Input("of", doc="the drive as it is recorded or declared")
SHARE = Parameter("share", doc="amplitude of the harmonic, in units of that of the drive")
PHASE = Parameter("phase", "rad", "of the harmonic where the drive rises", default=0.0)
TONE = (
    Parameter("size", doc="the amplitude of the drive", default=1.0, low=0.0),
    Parameter("period", "s", "of the drive", default=1.0, low=1e-9),
    Parameter("start", "rad", "the phase of the drive at t = 0", default=0.0),
)
# One share and one phase hold for series of any amplitude and frequency, because each series has
# the sine of its own drive. Nothing is remembered, so that a run may begin anywhere in the wave.
OF_EACH: dict[str, Tone] = {"size": "amplitude", "period": "period", "start": "phase"}
SHAPES = {"phase": Shape((0.0, QUARTER), low=-4 * QUARTER)}  # sine and cosine
CATCHES = (
    "share*size*sin(n*(2*pi*t/period + start) + phase) of a drive size*sin(2*pi*t/period + start)"
    " around any mean: what an actuator adds that distorts a sine."
)

drive_gain = Block(
    name="drive_gain",
    doc="What the drive is larger than recorded, in proportion to it.",
    inputs=(OF,),
    parameters=(Parameter("gain", doc="the share that is missing; negative: too much"),),
    outputs=(Output("y", "gain*of", doc="is added to the drive"),),
    effect=Effect("gain", {"of": "u"}, place="drive"),
)

drive_lag = Block(
    name="drive_lag",
    doc="What a drive that follows its record late lacks: a lag of first order, less the record.",
    inputs=(OF,),
    parameters=(Parameter("tau", "s", "the time constant", low=0.0),),
    states=(State("w", "(of - w)/(tau if tau > 0 else 1)", "0"),),
    outputs=(Output("y", "w - of if tau > 0 else 0", doc="is added to the drive"),),
    effect=Effect("tau", {"of": "u"}, sign=1, place="drive", at=Shape((2.0, 6.0), of="dt")),
)

drive_2nd_harm = Block(
    name="drive_2nd_harm",
    doc="A drive that has a share of twice its frequency.",
    parameters=(SHARE, PHASE, *TONE),
    outputs=(
        Output("y", "share*size*sin(2*(2*pi*t/period + start) + phase)", doc="added to the drive"),
    ),
    effect=Effect("share", shapes=SHAPES, place="drive", tone=OF_EACH),
    source=CATCHES,
)

drive_3rd_harm = Block(
    name="drive_3rd_harm",
    doc="A drive that has a share of three times its frequency.",
    parameters=(SHARE, PHASE, *TONE),
    outputs=(
        Output("y", "share*size*sin(3*(2*pi*t/period + start) + phase)", doc="added to the drive"),
    ),
    effect=Effect("share", shapes=SHAPES, place="drive", tone=OF_EACH),
    source=CATCHES,
)
