"""What a person, or a program, wants to read about the effects of a sensor."""

from __future__ import annotations

import math

from tracewire.library.sensor import SENSOR_TERMS, SensorTerm

PREFIX = "sensor_"


def sensor_effect(name: str) -> str:
    """The term of a sensor that an effect of this name is; '' where it is none."""
    term = name.removeprefix(PREFIX)
    return term if name.startswith(PREFIX) and term in SENSOR_TERMS else ""


def sensor_doc(term: str) -> str:
    """The sentence that says what a term is."""
    words = SENSOR_TERMS[term].words
    return f"{words[0].upper()}{words[1:]}."


def describe_sensor(term: str) -> str:
    """One effect of a sensor in full, as plain text: formula, number, and how it is written."""
    known = SENSOR_TERMS[term]
    least = "" if math.isinf(known.low) else f", at least {known.low:g}"
    return "\n".join(
        (
            f"{PREFIX}{term}: {sensor_doc(term)} It is no block: a measured signal has it.",
            "",
            "formula",
            f"  shown = {known.shown}, {_meaning(term)}",
            "",
            "number",
            f"  {term}  [{_unit(known)}]  default {known.neutral:g}{least}",
            "",
            "in a diagram, where a fit may change it",
            f"  {_written(term)}",
            "",
            f"An effect that a trace tries at each sensor: coefficient {term}, "
            f"{'positive only' if known.sign else 'of either sign'}.",
        )
    )


def describe_sensor_json(term: str) -> dict[str, object]:
    """One effect of a sensor in full, in dictionaries that `json` can write."""
    known = SENSOR_TERMS[term]
    return {
        "name": f"{PREFIX}{term}",
        "family": "sensor",
        "doc": sensor_doc(term),
        "parameters": [
            {
                "name": term,
                "unit": _unit(known),
                "default": known.neutral,
                "low": None if math.isinf(known.low) else known.low,
            }
        ],
        "outputs": [{"name": "shown", "formula": known.shown, "doc": _meaning(term)}],
        "effect": {"coefficient": term, "sign": known.sign, "place": "sensor"},
        "written": _written(term),
    }


def _meaning(term: str) -> str:
    """What the letters of the formula are."""
    if term == "delay":
        return "where z = y(t - delay) of the signal y"
    since = " and t0 the time of the first sample" if "t0" in SENSOR_TERMS[term].shown else ""
    return f"where z is the signal{since}"


def _unit(term: SensorTerm) -> str:
    """The unit of the number, in words where it follows from that of the column."""
    return term.unit.format("unit of the column") or "1"


def _written(term: str) -> str:
    """The lines of a diagram, with a range for the number."""
    neutral = SENSOR_TERMS[term].neutral
    low, high = max(neutral - 1, SENSOR_TERMS[term].low), neutral + 1
    return f"signals: {{x: {{column: x, {term}: {{fit: [{low:g}, {high:g}]}}}}}}"
