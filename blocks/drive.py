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
    doc="A drive that is larger than its record by a share: adds that share.",
    inputs=(OF,),
    parameters=(Parameter("gain", doc="the share that is missing; negative: too much"),),
    outputs=(Output("y", "gain*of", doc="is added to the drive"),),
    effect=Effect("gain", {"of": "u"}, place="drive"),
)

drive_lag = Block(
    name="drive_lag",
    doc="A drive with a lag of first order: adds the lagged record less the record.",
    inputs=(OF,),
    parameters=(Parameter("tau", "s", "the time constant", low=0.0),),
    states=(State("w", "(of - w)/(tau if tau > 0 else 1)", "0"),),
    outputs=(Output("y", "w - of if tau > 0 else 0", doc="is added to the drive"),),
    effect=Effect(
        "tau",
        {"of": "u"},
        sign=1,
        place="drive",
        at=Shape((2.0, 6.0, 20.0, 60.0, 200.0), of="dt"),
        alias=("sensor_delay", "drive_delay", "viscous"),
        lasting=("w",),
    ),
)

drive_delay = Block(
    name="drive_delay",
    doc="A drive with a dead time: adds the record of that time ago less the record.",
    inputs=(OF,),
    parameters=(Parameter("tau", "s", "the dead time", low=0.0),),
    outputs=(Output("y", "shifted(of, tau) - of", doc="is added to the drive"),),
    effect=Effect(
        "tau",
        {"of": "u"},
        sign=1,
        place="drive",
        at=Shape((2.0, 6.0, 20.0, 60.0, 200.0), of="dt"),
        alias=("sensor_delay",),
    ),
)

drive_saturation = Block(
    name="drive_saturation",
    doc="A drive with a limit on either side: takes away what the record has beyond it.",
    inputs=(OF,),
    parameters=(
        Parameter(
            "share", doc="of what is beyond the limit that is lost; 1: all", low=0.0, high=1.0
        ),
        Parameter("limit", doc="of either sign", low=0.0, unit_of="of"),
    ),
    outputs=(
        Output(
            "y",
            "-share*(of - limit if of >= limit else (of + limit if of <= -limit else 0))",
            doc="is added to the drive",
        ),
    ),
    effect=Effect(
        "share",
        {"of": "u"},
        sign=1,
        shapes={"limit": Shape((0.5, 0.7, 0.85, 0.95), of="U", least=0.1, most=1.0)},
        place="drive",
        alias=("drive_3rd_harm",),
    ),
)

drive_dead_zone = Block(
    name="drive_dead_zone",
    doc="A drive with a dead zone: takes the record away inside it, and the zone beyond it.",
    inputs=(OF,),
    parameters=(
        Parameter("share", doc="of the zone that is lost; 1: all", low=0.0, high=1.0),
        Parameter("zone", doc="of either sign", low=0.0, unit_of="of"),
    ),
    outputs=(
        Output(
            "y",
            "-share*(zone if of >= zone else (-zone if of <= -zone else of))",
            doc="is added to the drive",
        ),
    ),
    effect=Effect(
        "share",
        {"of": "u"},
        sign=1,
        shapes={"zone": Shape((0.3, 0.55, 0.7, 0.85), of="drives")},
        place="drive",
        alias=("drive_3rd_harm", "drive_gain"),
    ),
)

drive_quantiser = Block(
    name="drive_quantiser",
    doc="A drive that goes in steps: adds the nearest step less the record.",
    inputs=(OF,),
    parameters=(
        Parameter("share", doc="1: it goes in steps", low=0.0, high=1.0),
        Parameter("step", doc="from one to the next", low=0.0, unit_of="of"),
    ),
    outputs=(Output("y", "share*(step*floor(of/step + 0.5) - of)", doc="is added to the drive"),),
    effect=Effect(
        "share",
        {"of": "u"},
        sign=1,
        # a fit sees how high the steps are, and not where they are
        shapes={"step": Shape((0.5, 0.25), of="U", least=0.02, most=1.0, wave=True, fixed=True)},
        place="drive",
    ),
)

drive_2nd_harm = Block(
    name="drive_2nd_harm",
    doc="A sine drive with a share of twice its frequency: adds that share.",
    parameters=(SHARE, PHASE, *TONE),
    outputs=(
        Output("y", "share*size*sin(2*(2*pi*t/period + start) + phase)", doc="added to the drive"),
    ),
    effect=Effect("share", shapes=SHAPES, place="drive", tone=OF_EACH),
    source=CATCHES,
)

drive_3rd_harm = Block(
    name="drive_3rd_harm",
    doc="A sine drive with a share of three times its frequency: adds that share.",
    parameters=(SHARE, PHASE, *TONE),
    outputs=(
        Output("y", "share*size*sin(3*(2*pi*t/period + start) + phase)", doc="added to the drive"),
    ),
    effect=Effect("share", shapes=SHAPES, place="drive", tone=OF_EACH),
    source=CATCHES,
)
