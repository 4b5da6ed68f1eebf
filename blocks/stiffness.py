"""Springs: every block outputs what acts ON the body, back to zero deflection.

A deflection is in rad and the output a torque in N m, or m and a force in N. Letters l and r mark
the two sides: l where the signal that decides is zero or positive, r where it is negative.
"""

from tracewire.library import Block, Effect, Input, Output, Parameter, Shape, State

QUARTER = 1.5707963267948966  # rad, of a wave: pi/2

PAPER = (
    "Semiempirical identification of nonlinear dynamics of a two-degree-of-freedom real torsion"
    " pendulum with a nonuniform planar stick-slip friction and elastic barriers"
)

OF = Input("of", doc="the deflection")
# whole numbers of waves in the record, or on the way that is gone: what lies between two of them
# is at most half a wave off at either end, so that no frequency is missed
PERIODS = Shape(
    tuple(1 / n for n in range(3, 61)), of="T", low=1e-9, most=0.4, line=True, modulates="of"
)  # what comes less than 2.5 times is no wave that a record shows
PITCHES = Shape((1.0, 0.5, 0.25), of="stroke", most=1.0, wave=True)
# sine and cosine; the sign of the amplitude does the other half of the circle
PHASES = Shape((0.0, QUARTER), low=-4 * QUARTER)

stiffness = Block(
    name="stiffness",
    doc="A spring in proportion to the deflection.",
    inputs=(OF,),
    parameters=(Parameter("k", doc="N m/rad, or N/m"),),
    outputs=(Output("force", "-k*of", doc="acts on the body"),),
    effect=Effect("k", {"of": "q"}),
)

quad_stiffness = Block(
    name="quad_stiffness",
    doc="A spring in proportion to the square of the deflection, harder on one side.",
    inputs=(OF,),
    parameters=(Parameter("k", doc="N m/rad^2, or N/m^2"),),
    outputs=(Output("force", "-k*of**2", doc="acts on the body"),),
    effect=Effect("k", {"of": "q"}),
)

cubic_stiffness = Block(
    name="cubic_stiffness",
    doc="A spring in proportion to the third power of the deflection, hardening where k > 0.",
    inputs=(OF,),
    parameters=(Parameter("k", doc="N m/rad^3, or N/m^3; negative: softening"),),
    outputs=(Output("force", "-k*of**3", doc="acts on the body"),),
    effect=Effect("k", {"of": "q"}, alias=("barrier", "stiffness_drift")),
)

asym_stiffness = Block(
    name="asym_stiffness",
    doc="A spring that differs between the sides: half the difference.",
    inputs=(OF,),
    parameters=(Parameter("k", doc="half the difference of the stiffnesses: N m/rad, or N/m"),),
    outputs=(Output("force", "-k*abs(of)", doc="acts on the body"),),
    effect=Effect(
        "k", {"of": "q"}, alias=("barrier_hi", "barrier_lo", "quad_stiffness"), both_signs=("q",)
    ),
)

backlash = Block(
    name="backlash",
    doc="A gap in a spring of the same stiffness: takes the spring away inside it.",
    inputs=(OF,),
    parameters=(
        Parameter("k", doc="that of the spring: N m/rad, or N/m", low=0.0),
        Parameter("gap", doc="half of the way that is free: rad, or m", low=0.0, unit_of="of"),
    ),
    outputs=(
        Output(
            "force", "k*(gap if of >= gap else (-gap if of <= -gap else of))", doc="on the body"
        ),
    ),
    effect=Effect(
        "k",
        {"of": "q"},
        sign=1,
        shapes={"gap": Shape((0.1, 0.25, 0.5), of="Q", least=0.01, most=1.0)},
        alias=("stiffness", "barrier", "play"),
    ),
)

stiffness_drift = Block(
    name="stiffness_drift",
    doc="A spring that grows stiffer with the time of the run, or softer where k is negative.",
    inputs=(OF,),
    parameters=(Parameter("k", doc="growth in a second: N m/rad/s, or N/m/s"),),
    outputs=(Output("force", "-k*t*of", doc="acts on the body"),),
    effect=Effect("k", {"of": "q"}),
)

parametric = Block(
    name="parametric",
    doc="A spring whose stiffness goes up and down with the time, as of a shaft that is not round.",
    inputs=(OF,),
    parameters=(
        Parameter("amplitude", doc="of the stiffness: N m/rad, or N/m"),
        Parameter("period", "s", "of a wave", low=0.0),
        Parameter("phase", "rad", default=0.0),
    ),
    outputs=(Output("force", "-amplitude*sin(2*pi*t/period + phase)*of", doc="acts on the body"),),
    effect=Effect(
        "amplitude",
        {"of": "q"},
        shapes={"period": PERIODS, "phase": PHASES},
        each=("phase",),
    ),
)

cogging = Block(
    name="cogging",
    doc="A force that comes back with every tooth, slot or magnet along the way.",
    inputs=(OF,),
    parameters=(
        Parameter("amplitude", doc="N m, or N"),
        Parameter("pitch", doc="from one to the next: rad, or m; 2*pi/n for n on a turn", low=0.0),
        Parameter("phase", "rad", default=0.0),
    ),
    outputs=(Output("force", "amplitude*sin(2*pi*of/pitch + phase)", doc="acts on the body"),),
    effect=Effect("amplitude", {"of": "q"}, shapes={"pitch": PITCHES, "phase": PHASES}),
)

coupling_q = Block(
    name="coupling_q",
    doc="A spring between a body and the coordinate of another one, as the body feels it.",
    inputs=(Input("other", doc="the coordinate of the other body: rad, or m"),),
    parameters=(Parameter("k", doc="N m/rad, or N/m"),),
    outputs=(Output("force", "-k*other", doc="acts on the body"),),
    effect=Effect("k", {"other": "other_q"}),
)

coupling_v = Block(
    name="coupling_v",
    doc="A damper between a body and the rate of another one, as the body feels it.",
    inputs=(Input("other", doc="the rate of the other body: rad/s, or m/s"),),
    parameters=(Parameter("c", doc="N m s/rad, or N s/m"),),
    outputs=(Output("force", "-c*other", doc="acts on the body"),),
    effect=Effect("c", {"other": "other_v"}),
)

inertia = Block(
    name="inertia",
    doc="Mass that moves with the body and that the diagram leaves out.",
    inputs=(Input("of", doc="the acceleration of the body: rad/s^2, or m/s^2"),),
    parameters=(Parameter("m", doc="kg m^2, or kg; negative where too much is declared"),),
    outputs=(Output("force", "-m*of", doc="acts on the body"),),
    effect=Effect("m", {"of": "a"}, alias=("drive_gain", "sensor_gain")),
)

elastic_load = Block(
    name="elastic_load",
    doc="A mass on a spring and a damper, such as a load behind a belt, a cable or a shaft.",
    inputs=(Input("of", doc="the acceleration of the body: rad/s^2, or m/s^2"),),
    parameters=(
        Parameter("m", doc="the mass: kg m^2, or kg", low=0.0),
        Parameter("period", "s", "of the mass where the body is held", low=0.0),
        Parameter("damping", doc="ratio of the damper to the critical one", default=0.05, low=0.0),
    ),
    # x is by how much the mass is ahead of the body, xdot its rate: the force is that of the spring
    states=(
        State("x", "xdot", "0"),
        State("xdot", "-of - (2*pi/period)**2*x - 2*damping*2*pi/period*xdot", "0"),
    ),
    outputs=(
        Output(
            "force",
            "m*((2*pi/period)**2*x + 2*damping*2*pi/period*xdot)",
            doc="acts on the body",
        ),
    ),
    effect=Effect(
        "m",
        {"of": "a"},
        sign=1,
        shapes={
            "period": Shape(
                (8.0, 11.0, 16.0, 23.0, 32.0, 45.0, 64.0, 91.0, 128.0),
                of="dt",
                least=4.0,
                line=True,
            ),
            "damping": Shape((0.05,)),
        },
        alias=("inertia", "drive_lag", "sensor_delay"),
        lasting=("x", "xdot"),
    ),
    source="The equation of a dynamic absorber; at a period of 0 it is inertia.",
)

viscous_load = Block(
    name="viscous_load",
    doc="A mass behind a damper, as a liquid in a vessel, or a second heat capacity behind a wall.",
    inputs=(Input("of", doc="the acceleration of the body: rad/s^2, or m/s^2; K/s of heat"),),
    parameters=(
        Parameter("c", doc="of the damper: N m s/rad, or N s/m; W/K of heat", low=0.0),
        Parameter("lag", "s", "the mass over c, in which it comes along", above=0.0),
    ),
    states=(State("slip", "of - slip/lag", "0"),),  # by how much the body is faster than the mass
    outputs=(Output("force", "-c*slip", doc="acts on the body"),),
    # a coordinate shows a load on a spring, too, of which this is the one without the spring
    effect=Effect(
        "c",
        {"of": "a"},
        sign=1,
        shapes={"lag": Shape((0.01, 0.03, 0.1, 0.3), of="T", low=1e-9, most=1.0)},
        alias=("inertia", "viscous", "drive_lag"),
        lacking=("q",),
        lasting=("slip",),
    ),
    source="The equation of a Lanchester damper; with a short lag it is inertia, with a long one"
    " viscous friction.",
)

relaxing_spring = Block(
    name="relaxing_spring",
    doc="A spring in series with a damper, as rubber has: its force fades where the body rests.",
    inputs=(Input("rate", doc="of the body: rad/s, or m/s"),),
    parameters=(
        Parameter("k", doc="the stiffness of a fast motion: N m/rad, or N/m", low=0.0),
        Parameter("lag", "s", "in which the force falls to 1/e where the body rests", above=0.0),
        Parameter("start", doc="the deflection of the spring at the start", default=0.0),
    ),
    states=(State("s", "rate - s/lag", "start"),),  # the deflection of the spring alone
    outputs=(Output("force", "-k*s", doc="acts on the body"),),
    source="Maxwell's element; beside a spring it is the standard linear solid: J. D. Ferry,"
    " Viscoelastic Properties of Polymers, 1980. With a short lag it is a damper, with a long one"
    " a spring.",
)

asymmetric_stiffness = Block(
    name="asymmetric_stiffness",
    doc="A linear spring with a stiffness for each side.",
    inputs=(OF,),
    parameters=(
        Parameter("k_l", doc="where of >= 0: N m/rad, or N/m"),
        Parameter("k_r", doc="where of < 0"),
    ),
    outputs=(Output("force", "-k_l*of if of >= 0 else -k_r*of", doc="acts on the body"),),
)

asymmetric_cubic_spring = Block(
    name="asymmetric_cubic_spring",
    doc="A linear and cubic spring whose coefficients change with the sign of another signal.",
    inputs=(OF, Input("side", doc="decides: l where side >= 0, r where side < 0")),
    parameters=(
        Parameter("k1_l", doc="where side >= 0: N m/rad, or N/m"),
        Parameter("k1_r", doc="where side < 0"),
        Parameter("k3_l", doc="where side >= 0: N m/rad^3, or N/m^3"),
        Parameter("k3_r", doc="where side < 0"),
    ),
    outputs=(
        Output(
            "force",
            "-(k1_l*of + k3_l*of**3) if side >= 0 else -(k1_r*of + k3_r*of**3)",
            doc="acts on the body; jumps where side changes its sign",
        ),
    ),
    source=f"{PAPER}, Eq 23: k1 = kappa_1, k3 = kappa_2, of = -phi_f, side = phi_1;"
    " the first of the two kappa_2r in print is read as kappa_2l.",
)
