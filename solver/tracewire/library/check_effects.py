"""What is wrong with an effect: it must be possible to wire it, to switch it off and to try it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from tracewire.errors import Location, Problem, unknown
from tracewire.library.effect import SCALES, SYMBOLS, Effect, Shape

WIRING = f"Say which local signal each reads: {', '.join(SYMBOLS)}."
WIDE = (-math.inf, math.inf)


@dataclass(frozen=True)
class Face:
    """What an effect needs to know of its block or subsystem.

    ports: each input, and whether it works unconnected. parameters: each parameter, and whether it
    has a default. bounds: those of each parameter that is a number. outputs: how many there are.
    """

    ports: Mapping[str, bool]
    parameters: Mapping[str, bool]
    bounds: Mapping[str, tuple[float, float]]
    outputs: int


def check_effect(effect: Effect, face: Face, place: Location) -> list[Problem]:
    """Every problem of an effect with the block or subsystem that it belongs to."""
    problems = []
    if effect.coefficient not in face.bounds:
        problems.append(unknown("parameter", effect.coefficient, face.bounds, place))
    problems += _check_wiring(effect, face, place)
    if effect.sign not in (0, 1):
        what = f"the sign of an effect is {effect.sign!r}"
        hint = "1: only positive coefficients make sense; 0: either sign does."
        problems.append(Problem(what, place, ("0", "1"), hint))
    for name, shape in effect.shapes.items():
        if name == effect.coefficient:
            what = f"'{name}' is the coefficient of the effect, and not one of its shapes"
            hint = "For a coefficient in which the output is not linear, give 'at'."
            problems.append(Problem(what, place, (), hint))
        elif name not in face.bounds:
            problems.append(unknown("parameter", name, face.bounds, place, "It is a shape."))
        else:
            problems += _check_shape(name, shape, face.bounds[name], place)
    if effect.at is not None:
        what = effect.coefficient
        problems += _check_shape(what, effect.at, face.bounds.get(what, WIDE), place)
        if 0.0 in effect.at.at:
            hint = "The effect vanishes there: give other values."
            problems.append(Problem(f"'{what}' is tried at 0", place, (), hint))
    for name in effect.tone:
        if name not in face.bounds:
            hint = "It is of the drive's tone."
            problems.append(unknown("parameter", name, face.bounds, place, hint))
    trial = {effect.coefficient, *effect.shapes, *effect.tone}
    unset = [name for name, given in face.parameters.items() if not given and name not in trial]
    if unset:
        what = f"the effect leaves the parameters {', '.join(unset)} without a value"
        problems.append(Problem(what, place, (), "Give each a default, or a shape."))
    if face.outputs > 1:
        what = f"an effect has one output, and this block has {face.outputs}"
        problems.append(Problem(what, place, (), "Declare the others in a block of their own."))
    return problems


def _check_wiring(effect: Effect, face: Face, place: Location) -> list[Problem]:
    strange = [name for name in effect.inputs if name not in face.ports]
    problems = [unknown("input", name, face.ports, place) for name in strange]
    missing = [name for name, free in face.ports.items() if not free and name not in effect.inputs]
    if missing:
        what = f"the effect leaves the inputs {', '.join(missing)} unconnected"
        problems.append(Problem(what, place, (), WIRING))
    if effect.place not in ("sum", "drive"):
        problems.append(unknown("place of an effect", effect.place, ("sum", "drive"), place))
    for name, symbol in effect.inputs.items():
        if symbol not in SYMBOLS:
            what = f"the effect wires '{name}' to '{symbol}'"
            problems.append(Problem(what, place, tuple(SYMBOLS), WIRING))
        elif effect.place == "drive" and symbol != "u":
            what = f"the effect acts on the drive and wires '{name}' to '{symbol}'"
            hint = "An effect at the drive may read u and the time."
            problems.append(Problem(what, place, ("u",), hint))
    return problems


def _check_shape(
    name: str, shape: Shape, bounds: tuple[float, float], place: Location
) -> list[Problem]:
    low, high = bounds
    if shape.of not in SCALES:
        known = [scale for scale in SCALES if scale]
        return [unknown("scale", shape.of, known, place, f"It is of the shape '{name}'.")]
    if not shape.at or not all(map(math.isfinite, shape.at)):
        hint = "Say where it is tried first, such as 0.1 and 0.3."
        return [Problem(f"the shape '{name}' needs numbers to try", place, (), hint)]
    if math.isnan(shape.low) or not low <= shape.low <= high:
        what = f"the shape '{name}' may fall to {shape.low:g}, and the parameter only to {low:g}"
        return [Problem(what, place, (), "Give a 'low' that the parameter may have.")]
    # a multiple of a size is known when there are data; at 0, or of nothing, it is known now
    tried = [value for value in shape.at if shape.of == "" or value == 0.0]
    outside = [value for value in tried if not max(low, shape.low) <= value <= high]
    if outside:
        what = f"the shape '{name}' is tried at {outside[0]:g}, which its bounds exclude"
        return [Problem(what, place, (), "Change the values or the bounds.")]
    return []
