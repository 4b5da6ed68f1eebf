"""Hysteresis: forces that remember the way that the body came, and hold it like a spring at first.

The state z is the share of the full force, from -1 to 1. It grows with the way and not with the
time, so that it stands still where the body does. A coordinate is in rad and the output a torque in
N m, or m and a force in N; every block outputs what acts ON the body.
"""

from tracewire.library import Block, Effect, Input, Output, Parameter, Shape, State

RATE = Input("rate", doc="of the body")
LEVEL = Parameter("level", doc="the full force: N m, or N", low=0.0)
DEFLECTION = Parameter(
    "deflection", doc="over which it grows to the full force: rad, or m", low=0.0
)
START = Parameter("start", doc="the share of the full force at the start", default=0.0)
DEFLECTIONS = Shape((0.025, 0.075, 0.2), of="stroke", least=0.01, most=1.0)

hysteresis = Block(
    name="hysteresis",
    doc="Dry friction that gives way like a spring before it slips: Dahl's law with exponent 1.",
    inputs=(RATE,),
    parameters=(LEVEL, DEFLECTION, START),
    states=(State("z", "(rate - abs(rate)*z)/deflection", "start"),),
    outputs=(Output("force", "-level*z", doc="acts on the body"),),
    effect=Effect(
        "level",
        {"rate": "v"},
        sign=1,
        shapes={"deflection": DEFLECTIONS},
        alias=("coulomb", "dahl", "lugre", "bouc_wen"),
    ),
    source="P. Dahl, A solid friction model, The Aerospace Corporation, TOR-158(3107-18), 1968.",
)

dahl = Block(
    name="dahl",
    doc="Dry friction that gives way before it slips, softly or abruptly by an exponent.",
    inputs=(RATE,),
    parameters=(
        LEVEL,
        DEFLECTION,
        Parameter("exponent", doc="below 1: abrupt, above 1: soft", default=1.0, low=0.0),
        START,
    ),
    # (1 - z)^n, written such that beyond 1, where only rounding leads, it turns back
    states=(
        State(
            "z",
            "rate/deflection*(1 - z)*((1 - z)**2 + 1e-8)**((exponent - 1)/2) if rate >= 0"
            " else rate/deflection*(1 + z)*((1 + z)**2 + 1e-8)**((exponent - 1)/2)",
            "start",
        ),
    ),
    outputs=(Output("force", "-level*z", doc="acts on the body"),),
    effect=Effect(
        "level",
        {"rate": "v"},
        sign=1,
        shapes={"deflection": DEFLECTIONS, "exponent": Shape((0.5, 2.0), low=0.25)},
    ),
    source="P. Dahl, A solid friction model, The Aerospace Corporation, TOR-158(3107-18), 1968.",
)

lugre = Block(
    name="lugre",
    doc="Friction of bristles that bend before they slip, and slip at less where the rate is high.",
    inputs=(RATE,),
    parameters=(
        Parameter("level", doc="while it slips fast: N m, or N", low=0.0),
        DEFLECTION,
        Parameter("peak", doc="share by which slow slip needs more than fast slip", low=0.0),
        Parameter("speed", doc="at which the peak has fallen to 1/e: rad/s, or m/s", low=0.0),
        Parameter("damping", "s", "force of the bending's rate over that of bending", default=0.0),
        START,
    ),
    states=(
        State("z", "(rate - abs(rate)*z/(1 + peak*exp(-(rate/speed)**2)))/deflection", "start"),
    ),
    outputs=(
        Output(
            "force",
            "-level*(z + damping*(rate - abs(rate)*z/(1 + peak*exp(-(rate/speed)**2)))/deflection)",
            doc="acts on the body",
        ),
    ),
    effect=Effect(
        "level",
        {"rate": "v"},
        sign=1,
        shapes={
            "deflection": Shape((0.01, 0.05), of="stroke", least=0.01, most=1.0),
            "peak": Shape((0.5,)),
            "speed": Shape((0.3, 0.7), of="rates"),
        },
    ),
    source="C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, A new model for control of"
    " systems with friction, IEEE Trans. Autom. Control 40 (1995) 419; z here is sigma_0 z/F_C.",
)

bouc_wen = Block(
    name="bouc_wen",
    doc="Hysteresis of materials and joints, whose corner an exponent makes soft or sharp.",
    inputs=(RATE,),
    parameters=(
        LEVEL,
        DEFLECTION,
        Parameter("exponent", doc="the sharpness of the corner", default=2.0, low=1.0),
        Parameter(
            "beta",
            doc="of Bouc and Wen, gamma is 1 - beta; 0.5: it unloads in a straight line",
            default=0.5,
            low=0.0,
            high=1.0,
        ),
        START,
    ),
    # abs(z)^n as a power of z^2, which has a derivative at 0 whatever the exponent
    states=(
        State(
            "z",
            "(rate - beta*abs(rate)*z*(z**2 + 1e-18)**((exponent - 1)/2)"
            " - (1 - beta)*rate*(z**2 + 1e-18)**(exponent/2))/deflection",
            "start",
        ),
    ),
    outputs=(Output("force", "-level*z", doc="acts on the body"),),
    effect=Effect(
        "level",
        {"rate": "v"},
        sign=1,
        shapes={
            # a free exponent and beta make runs with sensitivities a hundred times slower
            "deflection": DEFLECTIONS,
        },
    ),
    source="Y. K. Wen, Method for random vibration of hysteretic systems, J. Eng. Mech. Div. ASCE"
    " 102 (1976) 249, with A = 1 and beta + gamma = 1.",
)

play = Block(
    name="play",
    doc="A spring behind a gap with friction: it follows the body only after the gap is crossed.",
    inputs=(Input("of", doc="the coordinate of the body: rad, or m"), RATE),
    parameters=(
        Parameter("k", doc="N m/rad, or N/m"),
        Parameter("gap", doc="half of the way that is free: rad, or m", low=0.0, unit_of="of"),
        Parameter("start", doc="where in the gap the body is at the start", default=0.0),
    ),
    # x is where in the gap the body is, so that the spring is at of - x
    states=(
        State("x", "0 if (x >= gap and rate > 0) or (x <= -gap and rate < 0) else rate", "start"),
    ),
    outputs=(Output("force", "-k*(of - x)", doc="acts on the body"),),
    effect=Effect(
        "k",
        {"of": "q", "rate": "v"},
        shapes={"gap": Shape((0.1, 0.25, 0.5), of="Q", least=0.01, most=1.0)},
    ),
    source="The play operator: M. A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis.",
)

GAP = Parameter("gap", doc="half of the way that is free", low=0.0, unit_of="of")
LAG = Parameter("lag", "s", "with which the end of the gap follows", low=0.0)
FOLLOWS = State(
    "w", "((of - gap) - w if of - w >= gap else ((of + gap) - w if of - w <= -gap else 0))/lag", "0"
)
# w follows within a fraction of a sample, which no record tells from at once
OF_GAP = {
    "gap": Shape((0.025, 0.075, 0.2), of="stroke", least=0.01, most=1.0),
    "lag": Shape((0.3,), of="dt", fixed=True),
}

play_q = Block(
    name="play_q",
    doc="A spring behind a gap with friction, where nothing is known of the rate.",
    inputs=(Input("of", doc="the coordinate, or the drive of an actuator"),),
    parameters=(Parameter("k", doc="the output per unit of the coordinate"), GAP, LAG),
    states=(FOLLOWS,),
    outputs=(Output("force", "-k*w", doc="acts on the body"),),
    effect=Effect(
        "k",
        {"of": "q"},
        shapes=OF_GAP,
        lacking=("v",),
        alias=("stop_q", "sensor_delay", "drive_lag", "drive_delay"),
    ),
    source="The play operator: M. A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis;"
    " piezo actuators: K. Kuhnen, Modeling, identification and compensation of complex hysteretic"
    " nonlinearities, Eur. J. Control 9 (2003) 407.",
)

stop_q = Block(
    name="stop_q",
    doc="A spring that slips at its full force, where nothing is known of the rate.",
    inputs=(Input("of", doc="the coordinate, or the drive of an actuator"),),
    parameters=(LEVEL, GAP, LAG),
    states=(FOLLOWS,),
    outputs=(Output("force", "-level*(of - w)/gap", doc="acts on the body"),),
    effect=Effect(
        "level",
        {"of": "q"},
        shapes=OF_GAP,
        lacking=("v",),
        alias=("sensor_delay", "drive_lag", "drive_delay"),
    ),
    source="The stop operator, an element of Prandtl and Ishlinskii: of - play(of).",
)
