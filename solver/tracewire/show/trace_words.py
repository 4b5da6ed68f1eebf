"""Numbers, units, places and series in words, for all that tells of a trace."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence

from tracewire.formula import two_digits
from tracewire.library import SENSOR_TERMS
from tracewire.show.limits import WORD
from tracewire.trace import (
    ChannelError,
    Dependence,
    Explained,
    Found,
    FoundEffect,
    ParameterChange,
    Remainder,
    is_first_order,
    signal_of,
    users_unit,
    users_unit_of,
)

SENSORS = {f"sensor_{name}": term.words for name, term in SENSOR_TERMS.items()}
VARIABLES = {
    "q": "the coordinate",
    "v": "the rate",
    "a": "the acceleration",
    "t": "the time",
    "u": "the drive",
    "y": "the signal",
}


# --- numbers ------------------------------------------------------------------------------------


def percent(part: float) -> str:
    """A part of a whole: `62 %`, `> 99.5 %` where that is not all; '' where it is not known."""
    if not math.isfinite(part):
        return ""
    if WORD.nearly_all <= part < 1:
        return f"> {100 * WORD.nearly_all:g} %"
    if 0 < part < 1 - WORD.nearly_all:
        return f"< {100 * (1 - WORD.nearly_all):.1g} %"
    return f"{100 * part:.0f} %"


def chance_words(chance: float) -> str:
    """A probability: `p = 0.4`, `p < 1e-12`."""
    return f"p < {WORD.tiny:g}" if chance < WORD.tiny else f"p = {chance:.2g}"


def to_its_interval(value: float, low: float, high: float) -> tuple[str, str, str]:
    """A value and the ends of its interval, with so many digits that the three differ.

    Half of the interval is written with two digits.
    """
    half = (high - low) / 2
    if not (math.isfinite(half) and half > 0):
        return f"{value:.5g}", f"{low:.5g}", f"{high:.5g}"
    last = math.floor(math.log10(half)) - 1
    return _rounded(value, last), _rounded(low, last), _rounded(high, last)


def _rounded(value: float, last: int) -> str:
    """A number up to the digit 10^last."""
    rounded = round(value / 10.0**last) * 10.0**last
    if not rounded:
        return "0"
    if WORD.plain[0] <= abs(rounded) < WORD.plain[1]:
        return f"{rounded:.{min(max(-last, 0), WORD.most_digits)}f}"
    digits = math.floor(math.log10(abs(rounded))) - last
    return f"{rounded:.{min(max(digits, 0), WORD.most_digits)}e}"


def value_words(found: Found, effect: FoundEffect, name: str) -> str:
    """A parameter of an effect with its unit and 95 % interval: `level = 0.800 N m (...)`."""
    unit, factor = users_unit_of(found, effect, name)
    unit, value = f" {unit}" if unit else "", effect.params[name] / factor
    low, high = (end / factor for end in effect.intervals.get(name, (math.nan, math.nan)))
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        return f"{name} = {value:.4g}{unit}"
    shown_value, low_text, high_text = to_its_interval(value, low, high)
    return f"{name} = {shown_value}{unit} (95 %: {low_text} to {high_text})"


def share_words(explained: Explained) -> str:
    """The explained share with its interval: `98 % (95 % interval: 96 to 99 %)`. What raises the
    error explains nothing of it: 0 %."""
    part, *ends = (max(one, 0.0) for one in (explained.share, explained.low, explained.high))
    share = percent(part)
    low, high = (f"{100 * end:.0f}" for end in ends)
    if low == high:
        share = f"{100 * part:.2f} %"
        low, high = (f"{100 * end:.2f}" for end in ends)
    if low == high:
        return "> 99.99 %" if low == "100.00" else f"{low} %"
    return f"{share} (95 % interval: {low} to {high} %)"


def excess_words(found: Found) -> str:
    """How much the effects explain, and of what: `98 % (...) of the excess error`; '' where that is
    not known. Where a large part of the error is out of reach of any smooth force, how much of the
    error the excess is.
    """
    if found.explained is None:
        return ""
    share, reach = share_words(found.explained), within_reach(found)
    if not reach <= 1 - WORD.out_of_reach:
        return f"{share} of the excess error"
    part = f"{percent(reach)} of the rms error" if reach > 0 else "none of the error"
    return f"{share} of the error that a smooth force could take away ({part} on held-out blocks)"


def within_reach(found: Found) -> float:
    """The part of the declared model's rms error on held-out blocks, at the longest horizon, that
    the best smooth force takes away; nan where none was fitted."""
    if not found.held_out or not len(found.held_out[-1].floor):
        return math.nan
    held = found.held_out[-1]
    floor, whole = (math.sqrt(float((x**2).sum())) for x in (held.floor, held.declared))
    return max(1 - floor / whole, 0.0) if whole > 0 else math.nan


# --- errors -------------------------------------------------------------------------------------


def unseen_errors(found: Found) -> tuple[ChannelError, ...]:
    """The errors on data that played no part; () where there were no such data. They are those of
    free runs, or of windows where free runs tell little."""
    kind = "windowed" if astray_words(found) else "free run"
    return tuple(e for e in found.errors if e.kind == kind and e.use == "validate")


def interval_words(found: Found) -> str:
    """What the intervals of an effect's values do not count; '' where runs are at the noise."""
    kind = "windowed" if astray_words(found) else "free run"
    known = [e for e in found.errors if e.kind == kind and e.sigma > 0]
    left = [e.after / e.sigma for e in known if math.isfinite(e.after)]
    if not found.effects or max(left, default=0.0) < WORD.left:
        return ""
    runs, _ = runs_words(found)
    return (
        f"something small is missing still, up to {max(left):.3g} σ in {runs}: it may move a value"
        " farther than its interval says"
    )


def astray_words(found: Found) -> str:
    """That free runs tell little, as those of a model that is unstable or chaotic; '' where they
    stay near the windows."""
    windowed = {(e.use, e.series, e.signal): e.after for e in found.errors if e.kind == "windowed"}
    free = [e for e in found.errors if e.kind == "free run" and math.isfinite(e.after)]
    far = [
        e
        for e in free
        if e.after > WORD.astray * windowed.get((e.use, e.series, e.signal), e.after)
    ]
    if not far:
        return ""
    unit, factor = users_unit(found, far[0].signal)
    near = windowed[far[0].use, far[0].series, far[0].signal]
    free_run, window = (f"{size / factor:.3g} {unit}".rstrip() for size in (far[0].after, near))
    return (
        f"free runs tell little: over '{far[0].series}' one is off by {free_run} in "
        f"{far[0].signal}, where windows are off by {window}; the model is unstable or chaotic "
        "there"
    )


def runs_words(found: Found) -> tuple[str, str]:
    """How a text calls the runs whose errors it tells: `free runs` and `a free run is`."""
    return ("windows", "windows are") if astray_words(found) else ("free runs", "a free run is")


def in_sigma(errors: Iterable[ChannelError], when: str) -> float:
    """The root mean square of errors in units of each sensor's noise; nan where there is none.

    `when` is before or after.
    """
    squares = [(getattr(e, when) / e.sigma) ** 2 for e in errors if e.sigma > 0]
    mean = math.sqrt(sum(squares) / len(squares)) if squares else math.nan
    return 0.0 if mean < WORD.nothing else mean


def error_words(found: Found, errors: Sequence[ChannelError], both: bool = True) -> list[str]:
    """The error of each signal over all series in its unit: `for theta from 0.32 to 0.06 deg`.

    Without `both` the error after alone: `0.06 deg in theta`.
    """
    parts = []
    for signal in list(dict.fromkeys(e.signal for e in errors))[: WORD.most_told]:
        own = [e for e in errors if e.signal == signal]
        unit, factor = users_unit(found, signal)
        before, after = (
            math.sqrt(sum(getattr(e, when) ** 2 for e in own) / len(own)) / factor
            for when in ("before", "after")
        )
        if not math.isfinite(after):
            continue
        if after < WORD.nothing * sum(e.sigma for e in own) / len(own) / factor:
            after = 0.0
        unit = f" {unit}" if unit else ""
        old = f"{before:.3g}" if math.isfinite(before) else "no run at all"
        new = f"{after:.3g}{unit}"
        parts.append(f"for {signal} from {old} to {new}" if both else f"{new} in {signal}")
    return parts


def remainder_numbers(found: Found, left: Remainder) -> tuple[str, str, str]:
    """What is left of a signal, and its floor ('' where none is known), in the user's unit."""
    unit, factor = users_unit(found, left.signal)
    if factor == 1.0:
        unit = left.unit or unit
    floor = f"{left.floor / factor:.3g}" if math.isfinite(left.floor) else ""
    return f"{left.rms / factor:.3g}", floor, unit


def stood_in(moved: ParameterChange) -> bool:
    """Whether a declared parameter had absorbed the missing effect: it moved by more than its
    uncertainty, and by more than a hundredth of itself."""
    change = abs(moved.after - moved.before)
    size = max(abs(moved.before), abs(moved.after))
    return moved.significant and change > WORD.worth_telling * size


def doubt_words(found: Found) -> str:
    """What to ask of declared parameters that grow far with the effects; '' where none does. One
    that sits on its bound without them has no value there that another one could be held against,
    and one that comes back to what the diagram declares has not grown.
    """
    grown = [
        f"'{m.name}' is {two_digits(m.after / m.before)} times as large"
        for m in found.moved
        if stood_in(m)
        and m.before
        and not m.at_bound
        and abs(m.after) > WORD.grown * max(abs(m.before), abs(m.declared or 0.0))
    ]
    if not grown or not found.effects:
        return ""
    return (
        f"{both_of(grown)} with what was found: is that possible? Fix what you know better, and "
        "trace again"
    )


def moved_words(moved: ParameterChange) -> str:
    """How a declared parameter moved: `'c' moves from 0.3 to 0.051 N m s/rad`, and by
    how many standard errors where these are few."""
    unit = f" {moved.users_unit}" if moved.users_unit else ""
    before, after = (value / moved.factor for value in (moved.before, moved.after))
    text = f"'{moved.name}' moves from {before:.4g} to {after:.4g}{unit}"
    if moved.error > 0:
        errors = abs(moved.after - moved.before) / moved.error
        text += f" ({two_digits(errors)} standard errors)" if errors < 100 else ""
    return text


# --- names --------------------------------------------------------------------------------------


def place_words(place: str) -> str:
    """A place as a person would call it."""
    kind, _, signal = place.partition(".")
    words = {"sensor": f"in the sensor of '{signal}'", "drive": f"in the drive '{signal}'"}
    return words.get(kind, "") if signal and kind in words else f"at the sum '{place}'"


def missing_places(found: Found) -> list[str]:
    """The places at which a smooth function explains about as much of the excess as where something
    is missing, the best first; but sums before drives and sensors, which can imitate them."""
    missing = found.missing
    if missing is None:
        return []
    least = max(missing.share - WORD.alike_places, 1 - WORD.left_elsewhere * (1 - missing.share))
    best = sorted(found.dependences, key=lambda d: -d.share)
    near = [missing.place, *(d.place for d in best if d.share >= least)]
    return sorted(
        dict.fromkeys(near), key=lambda place: place.partition(".")[0] in ("sensor", "drive")
    )


def missing_dependence(found: Found) -> Dependence | None:
    """On what the missing force depends at the first of its places, and the share of the excess."""
    places, missing = missing_places(found), found.missing
    if missing is None:
        return None
    if places[0] == missing.place:
        return Dependence(missing.place, missing.variables, missing.share)
    return max((d for d in found.dependences if d.place == places[0]), key=lambda d: d.share)


def missing_place_words(found: Found, depends: str) -> str:
    """Where something is missing, and `depends`, which leads over to the variables; where it may be
    at several places, these, and of which of them the variables are told."""
    places = [place_words(place) for place in missing_places(found)]
    if len(places) == 1:
        return f"{places[0]}{depends}"
    return (
        f"{both_of(places, 'or')}, which this record cannot tell apart; {places[0]} it depends on"
    )


def variables_words(found: Found, place: str, variables: Sequence[str]) -> str:
    """Variables at a place as a person would call them: `the rate omega`."""
    return both_of([_variable_words(found, place, name) for name in variables])


def _variable_words(found: Found, place: str, variable: str) -> str:
    kinds = {**VARIABLES, "v": "", "a": "the rate"} if is_first_order(found, place) else VARIABLES
    return f"{kinds.get(variable, '')} {signal_of(found, place, variable)}".strip()


def missing_words(found: Found) -> str:
    """On what the missing force depends; with all variables of which each alone explains as much,
    as they do where the record goes one way."""
    missing = missing_dependence(found)
    if missing is None:
        return ""
    alike = [
        d.variables
        for d in sorted(found.dependences, key=lambda d: -d.share)
        if d.place == missing.place
        and d.variables != missing.variables
        and len(d.variables) == 1
        and d.variables[0] in VARIABLES
        and d.share >= missing.share - WORD.alike
    ]
    if len(missing.variables) > 1 or not alike:
        return variables_words(found, missing.place, missing.variables)
    names = [missing.variables, *alike]
    texts = [variables_words(found, missing.place, variables) for variables in names]
    return f"{both_of(texts, 'or')}, which this record cannot tell apart"


def few_of(texts: Sequence[str], word: str = "and", most: int = WORD.most_told) -> str:
    """The first of some texts, and how many more there are."""
    more = len(texts) - most
    return both_of([*texts[:most], f"{more} more"] if more > 0 else texts, word)


def both_of(texts: Sequence[str], word: str = "and") -> str:
    """Texts as a list in a sentence: `a, b and c`."""
    return f" {word} ".join(part for part in (", ".join(texts[:-1]), *texts[-1:]) if part)


def told_once(texts: Sequence[str], series: Sequence[str]) -> tuple[str, ...]:
    """Remarks, each of which is told once with the list of series that it is true of.

    A remark names a series in quotes, or at its begin before a colon.
    """
    names = sorted(series, key=len, reverse=True)
    ways = [re.compile(rf"'{re.escape(name)}'|^{re.escape(name)}(?=: )") for name in names]
    groups: dict[str, list[str]] = {}
    for text in texts:
        hit = next(((n, w) for n, w in zip(names, ways, strict=True) if w.search(text)), None)
        key = hit[1].sub("\0", text) if hit else text
        quoted = bool(hit) and f"'{hit[0]}'" in text if hit else False
        groups.setdefault(key, [])
        if hit:
            groups[key].append(f"'{hit[0]}'" if quoted else hit[0])
    return tuple(
        key.replace("\0", both_of(list(dict.fromkeys(found)))) for key, found in groups.items()
    )
