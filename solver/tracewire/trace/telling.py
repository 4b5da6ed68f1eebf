"""What a trace found, told in plain words that need no statistics."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from tracewire.trace.found import ChannelError, Found, FoundEffect, Moved, Power
from tracewire.trace.told import AT_NOISE

SENSORS = {
    "sensor_offset": "an offset",
    "sensor_gain": "a gain that is not 1",
    "sensor_delay": "a delay",
    "sensor_quad": "a bent scale",
    "sensor_drift": "a drift",
}
VARIABLES = {
    "q": "the coordinate q",
    "v": "the rate v",
    "a": "the acceleration a",
    "t": "the time t",
    "u": "the drive u",
    "y": "the signal itself",
}
MOST_TOLD = 3
TINY = 1e-12
WORTH_TELLING = 0.01
LITTLE = 0.5
"""The share of the excess below which the variables found explain little of it."""
RANDOM = (
    "a random disturbance of the motion (process noise), or something that is not measured, looks "
    "like that"
)
COMMON = ("coulomb", "viscous", "quad_drag", "stiffness", "cubic_stiffness", "sensor_offset")


def paragraph_of(found: Found) -> str:
    """What was fitted, what the residual showed, what was added where, how well that predicts data
    that played no part, what cannot be told apart, and which parameters had absorbed what.

    It reads every field of `found` but `paragraph`; errors are in sigma, the noise of a sensor.
    """
    told = {"null": _null, "effect": _effect, "unexplained": _unexplained}[found.verdict]
    parts = [_interrupted(found), _declared(found), *told(found), _dropped(found)]
    return " ".join(part for part in parts if part)


def unseen_errors(found: Found) -> tuple[ChannelError, ...]:
    """The errors of free runs on data that played no part; () where there were no such data."""
    return tuple(e for e in found.errors if e.kind == "free run" and e.use == "validate")


def in_sigma(errors: Iterable[ChannelError], when: str) -> float:
    """The root mean square of errors in units of each sensor's noise; nan where there is none.

    `when` is before or after.
    """
    squares = [(getattr(e, when) / e.sigma) ** 2 for e in errors if e.sigma > 0]
    return math.sqrt(sum(squares) / len(squares)) if squares else math.nan


def place_words(place: str) -> str:
    """A place as a person would call it."""
    kind, _, signal = place.partition(".")
    words = {"sensor": f"in the sensor of '{signal}'", "drive": f"in the drive '{signal}'"}
    return words.get(kind, "") if signal and kind in words else f"at the sum '{place}'"


def variables_words(variables: Sequence[str]) -> str:
    """Variables as a person would call them."""
    return _and([VARIABLES.get(name, name) for name in variables])


def value_words(found: Found, effect: FoundEffect, name: str) -> str:
    """A parameter of an effect with its unit and 95 % interval: `level = 0.8 N m (...)`."""
    unit = unit_of(found, effect, name)
    text = f"{name} = {effect.params[name]:.4g}{f' {unit}' if unit else ''}"
    low, high = effect.intervals.get(name, (math.nan, math.nan))
    if math.isfinite(low) and math.isfinite(high):
        text += f" (95 %: {low:.4g} to {high:.4g})"
    return text


def unit_of(found: Found, effect: FoundEffect, name: str) -> str:
    """The SI unit of a parameter of an effect; '' where it has none."""
    if effect.block:
        return found.units.get(f"{effect.block}.{name}", "")
    return found.units.get(f"{name}.{effect.place.partition('.')[2]}", "")


def chance_words(chance: float) -> str:
    """A probability: `p = 0.4`, `p < 1e-12`."""
    return f"p < {TINY:g}" if chance < TINY else f"p = {chance:.2g}"


def stood_in(moved: Moved) -> bool:
    """Whether a declared parameter had stood in for what was missing: it moved by more than its
    uncertainty, and by more than a hundredth of itself."""
    change = abs(moved.after - moved.before)
    return moved.significant and change > WORTH_TELLING * max(abs(moved.before), abs(moved.after))


def common_powers(found: Found) -> list[Power]:
    """What these data would have shown, the effects first that a reader is most likely to know."""
    order = {name: n for n, name in enumerate(COMMON)}
    return sorted(found.power, key=lambda p: order.get(p.name, len(order)))


def coefficient_of(power: Power) -> str:
    """The coefficient of an effect as its block, or the sensor, calls it."""
    first, _, last = power.coefficient.partition(".")
    return first if power.name in SENSORS or not last else last


def percent(part: float) -> str:
    """A part of a whole: `62 %`; '' where it is not known."""
    return f"{100 * part:.0f} %" if math.isfinite(part) else ""


def _interrupted(found: Found) -> str:
    return "The trace was interrupted: this is what was known by then." if found.interrupted else ""


def _declared(found: Found) -> str:
    series = list(dict.fromkeys(e.series for e in found.errors if e.use == "train"))
    names = _few([f"'{name}'" for name in series])
    to = f" to {names}" if series else " to its measured series"
    title = found.original.title or found.original.file.name
    left = (
        "What the fit left over is as small as the noise of the sensors"
        if found.s2_before <= AT_NOISE and found.verdict != "unexplained"
        else f"What the fit left over is {found.s2_before**0.5:.3g} times the noise of the sensors"
    )
    return f"'{title}' was fitted{to} as it stands. {left}."


def _null(found: Found) -> list[str]:
    parts = [
        "Not all effects were tried by then."
        if found.interrupted
        else "No effect of the library explains any more of it: nothing is missing that these data "
        "could show."
    ]
    after = in_sigma(unseen_errors(found), "after")
    if math.isfinite(after):
        parts.append(
            f"On data that played no part, a run of the diagram is wrong by {after:.3g} σ (σ is "
            "the noise of a sensor: 1 σ is as good as the data allow)."
        )
    if found.power:
        few = [
            f"{p.name} {place_words(p.place)} from {coefficient_of(p)} = {p.smallest:.3g}"
            for p in common_powers(found)[:MOST_TOLD]
        ]
        parts.append(f"These data would have shown, for example, {_and(few)} on.")
    return parts


def _effect(found: Found) -> list[str]:
    added = [_named(found, effect) for effect in found.effects]
    one = len(added) == 1
    parts = [f"It is no noise: it has the shape of {_and(added)}."] if added else []
    if added:
        parts.append(
            f"With {'that' if one else 'these'} in the diagram and all free parameters fitted "
            f"again, {_left(found)}."
        )
    return [*parts, _unseen(found), *_ties(found), _moved(found.moved)]


def _unexplained(found: Found) -> list[str]:
    parts = []
    missing = found.missing
    if missing is not None:
        parts.append(
            f"Something is missing {place_words(missing.place)}. It depends on "
            f"{variables_words(missing.variables)}: a smooth function of that explains "
            f"{percent(missing.share)} of what is above the noise."
        )
        if missing.share < LITTLE:
            parts.append(f"The rest depends on no variable that was tried: {RANDOM}.")
    else:
        parts.append(f"It is no noise, but where it comes from cannot be said: {RANDOM}.")
    parts.append(
        "No effect was accepted by then; not all were tried."
        if found.interrupted
        else "No effect of the library explains it."
    )
    if found.effects:
        names = _and([f"{e.name} {place_words(e.place)}" for e in found.effects])
        parts.append(f"The best approximation is {names}: {_left(found)}, which is not enough.")
    return [*parts, _unseen(found) if found.effects else "", _moved(found.moved)]


def _named(found: Found, effect: FoundEffect) -> str:
    values = ", ".join(value_words(found, effect, name) for name in effect.params)
    where = place_words(effect.place)
    if effect.name in SENSORS:
        return f"{SENSORS[effect.name]} {where}, {values}"
    known = effect.name in found.diagram.library
    doc = found.diagram.library[effect.name].doc if known else ""
    meaning = f" ({doc[0].lower()}{doc[1:].rstrip('.')})" if doc else ""
    return f"'{effect.name}' {where}{meaning}, with {values}"


def _left(found: Found) -> str:
    if found.s2_after <= AT_NOISE:
        return "what is left is as small as the noise"
    return f"{found.s2_after**0.5:.3g} times the noise is left"


def _unseen(found: Found) -> str:
    errors = unseen_errors(found)
    before, after = in_sigma(errors, "before"), in_sigma(errors, "after")
    if not math.isfinite(after):
        return "There were no data to test that on which played no part in it."
    return (
        f"On data that played no part, a run of the diagram was wrong by {before:.3g} σ and is now "
        f"wrong by {after:.3g} σ (σ is the noise of a sensor: 1 σ is as good as the data allow)."
    )


def _ties(found: Found) -> list[str]:
    parts = []
    for effect in found.effects:
        if effect.ties:
            names = _few([f"'{tie.name}' {place_words(tie.place)}" for tie in effect.ties], "or")
            parts.append(f"These data cannot tell '{effect.name}' from {names}.")
    for experiment in found.experiments:
        parts.append(experiment.words if experiment.words.endswith(".") else f"{experiment.words}.")
    return parts


def _moved(moved: Sequence[Moved]) -> str:
    large = [m for m in moved if stood_in(m)]
    if not large:
        return ""
    shifts = [
        f"'{m.name}' from {m.before:.4g} to {m.after:.4g}{f' {m.unit}' if m.unit else ''}"
        for m in large
    ]
    if len(large) == 1:
        return f"A declared parameter had stood in for what was missing: {shifts[0]}."
    return f"Declared parameters had stood in for what was missing: {_few(shifts)}."


def _dropped(found: Found) -> str:
    if not found.dropped:
        return ""
    names = _and([f"'{name}'" for name in found.dropped])
    return f"{names} went to zero: the data do not need what the diagram declares there."


def _few(texts: Sequence[str], word: str = "and") -> str:
    """The first of some texts, and how many more there are."""
    more = len(texts) - MOST_TOLD
    return _and([*texts[:MOST_TOLD], f"{more} more"] if more > 0 else texts, word)


def _and(texts: Sequence[str], word: str = "and") -> str:
    return f" {word} ".join(part for part in (", ".join(texts[:-1]), *texts[-1:]) if part)
