"""Springs: every block outputs what acts ON the body, back to zero deflection.

A deflection is in rad and the output a torque in N m, or m and a force in N. Letters l and r mark
the two sides: l where the signal that decides is zero or positive, r where it is negative.
"""

from tracewire.library import Block, Effect, Input, Output, Parameter

PAPER = (
    "Semiempirical identification of nonlinear dynamics of a two-degree-of-freedom real torsion"
    " pendulum with a nonuniform planar stick-slip friction and elastic barriers"
)

OF = Input("of", doc="the deflection")

linear_stiffness = Block(
    name="linear_stiffness",
    doc="A spring in proportion to the deflection.",
    inputs=(OF,),
    parameters=(Parameter("k", doc="N m/rad, or N/m"),),
    outputs=(Output("force", "-k*of", doc="acts on the body"),),
)

cubic_stiffness = Block(
    name="cubic_stiffness",
    doc="A spring in proportion to the third power of the deflection, hardening where k > 0.",
    inputs=(OF,),
    parameters=(Parameter("k", doc="N m/rad^3, or N/m^3; negative: softening"),),
    outputs=(Output("force", "-k*of**3", doc="acts on the body"),),
    effect=Effect("k", {"of": "q"}),
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
