"""Switching: blocks whose formula changes with the sign of a signal, located as events."""

from tracewire.library import Block, Input, Output, Parameter

LIMITS = (Parameter("low", doc="the lower limit"), Parameter("high", doc="the upper limit"))

switch = Block(
    name="switch",
    doc="One signal while the control is at or above a threshold, another below it.",
    inputs=(
        Input("control"),
        Input("above", doc="passed on while control >= threshold"),
        Input("below", doc="passed on while control < threshold"),
    ),
    parameters=(Parameter("threshold", default=0.0),),
    outputs=(Output("y", "above if control >= threshold else below"),),
)

sign = Block(
    name="sign",
    doc="One above zero, minus one below.",
    inputs=(Input("of"),),
    outputs=(
        Output("y", "sign(of)", doc="at zero 0, or any value from -1 to 1 that holds it there"),
    ),
)

abs_ = Block(
    name="abs",
    doc="The absolute value.",
    inputs=(Input("of"),),
    outputs=(Output("y", "abs(of)", unit_of="of"),),
)

min_ = Block(
    name="min",
    doc="The smallest of two signals or more.",
    inputs=(Input("of"), Input("other", many=True)),
    outputs=(Output("y", "min(of, other)"),),
)

max_ = Block(
    name="max",
    doc="The largest of two signals or more.",
    inputs=(Input("of"), Input("other", many=True)),
    outputs=(Output("y", "max(of, other)"),),
)

saturation = Block(
    name="saturation",
    doc="A signal that is held at its limits.",
    require=("low <= high",),
    inputs=(Input("of"),),
    parameters=LIMITS,
    outputs=(Output("y", "high if of >= high else (low if of <= low else of)", unit_of="of"),),
)

dead_zone = Block(
    name="dead_zone",
    doc="What a signal exceeds its limits by, and zero between them.",
    require=("low <= high",),
    inputs=(Input("of"),),
    parameters=LIMITS,
    outputs=(
        Output("y", "of - high if of >= high else (of - low if of <= low else 0)", unit_of="of"),
    ),
)

quantizer = Block(
    name="quantizer",
    doc="The nearest whole multiple of an interval, as of a converter or an encoder.",
    inputs=(Input("of"),),
    parameters=(Parameter("interval", doc="between two levels", above=0.0, unit_of="of"),),
    outputs=(
        Output("y", "interval*floor(of/interval + 1/2)", doc="jumps; halves go up", unit_of="of"),
    ),
    source="The mid-tread quantizer: B. Widrow, I. Kollar, Quantization Noise, 2008.",
)
