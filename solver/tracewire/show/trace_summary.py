"""What a trace found, told in plain words that need no statistics."""

from __future__ import annotations

import math

from tracewire.show.limits import WORD
from tracewire.show.trace_experiments import experiment_words
from tracewire.show.trace_untried import common_powers
from tracewire.show.trace_words import (
    SENSORS,
    both_of,
    doubt_words,
    error_words,
    excess_words,
    few_of,
    in_sigma,
    interval_words,
    missing_dependence,
    missing_place_words,
    missing_words,
    moved_words,
    percent,
    place_words,
    remainder_numbers,
    runs_words,
    stood_in,
    unseen_errors,
    value_words,
    variables_words,
)
from tracewire.trace import (
    Found,
    FoundEffect,
    Tie,
    TraceOptions,
    coefficient_of,
    is_first_order,
    signal_of,
    users_unit,
    users_unit_of_power,
)

PERHAPS = (
    "a random disturbance of the motion (process noise)",
    "something that is not measured",
    "a law that depends on the time or on a drive",
)
REPEAT = "Do the same run twice: what comes back is a law, and what does not is random."


def paragraph_of(found: Found) -> str:
    """What a trace says, as one paragraph; `sentences_of` has its sentences."""
    return " ".join(sentences_of(found))


def sentences_of(found: Found) -> tuple[str, ...]:
    """The headline, then what was fitted, what the effects are, what is left, what cannot be told
    apart, and what declared parameters had absorbed. σ is the noise of a sensor.
    """
    cut = "The trace was interrupted: this is the best result by then." if found.interrupted else ""
    return tuple(part for part in (cut, headline_of(found), *details_of(found)) if part)


def details_of(found: Found) -> tuple[str, ...]:
    """What stands behind the headline, in sentences."""
    details = {"null": _null, "effect": _effect, "unexplained": _unexplained}[found.verdict]
    parts = [_declared(found), *details(found), _dropped(found), limits_words(found.options)]
    return tuple(part for part in parts if part)


def headline_of(found: Found) -> str:
    """One sentence: what is missing where, how much of the excess error it explains, and the error
    on unseen data before and after, in the unit of the signal."""
    heads = {"null": _nothing, "effect": _lacks, "unexplained": _open}
    return heads[found.verdict](found)


def limits_words(options: TraceOptions) -> str:
    """To what a search was limited, in a sentence; '' where it was not."""
    parts = []
    if options.only:
        places = both_of([f"'{place}'" for place in options.only])
        parts.append(f"effects were tried only at {places}")
    if options.without:
        names = both_of([f"'{name}'" for name in options.without])
        parts.append(f"{names} {_was(options.without)} not tried")
    if options.effects != TraceOptions.effects:
        parts.append(
            f"at most {options.effects} {_plural('effect', options.effects)} could be added"
        )
    if options.horizon is not None:
        parts.append(f"models were compared over {options.horizon:g} s")
    if math.isfinite(options.budget):
        parts.append(f"the search had a budget of {options.budget:g} s")
    return f"Limits of this search: {both_of(parts)}." if parts else ""


def tie_words(effect: FoundEffect, tie: Tie) -> str:
    """A tie: its name, its place, and how many numbers more or fewer it needs."""
    more = len(tie.params) - len(effect.params)
    count = abs(more)
    kind = "more" if more > 0 else "fewer"
    text = f"'{tie.name}' {place_words(tie.place)}"
    if tie.params and more:
        text += f" ({count} fitted {_plural('number', count)} {kind})"
    return text


def ties_words(effect: FoundEffect) -> list[str]:
    """The ties of an effect, each once."""
    return list(dict.fromkeys(tie_words(effect, tie) for tie in effect.ties))


# --- the headline -------------------------------------------------------------------------------


def _lacks(found: Found) -> str:
    one = len(found.effects) == 1
    text = f"The diagram lacks {both_of([_named(found, effect) for effect in found.effects])}"
    parts = []
    if found.explained is not None:
        who = "it explains" if one else "together they explain"
        left = max((part.share for part in found.remainder), default=0.0)
        leaves = (
            f" and {'leaves' if one else 'leave'} {percent(left)} of the rms error on held-out "
            "blocks"
        )
        parts.append(f"{who} {excess_words(found)}{leaves if left > 0 else ''}")
    errors = error_words(found, unseen_errors(found))
    if errors:
        goes = _goes(found)
        runs, _ = runs_words(found)
        parts.append(f"on unseen data the error of {runs} {goes} {both_of(errors)}")
    return f"{text}; {', and '.join(parts)}." if parts else f"{text}."


def _goes(found: Found) -> str:
    errors = unseen_errors(found)
    before, after = in_sigma(errors, "before"), in_sigma(errors, "after")
    if not (math.isfinite(before) and math.isfinite(after)):
        return "goes"
    return "falls" if after < before else "rises"


def _named(found: Found, effect: FoundEffect) -> str:
    """An effect at its place, with its coefficient alone: the table has the others."""
    where = place_words(effect.place)
    what = SENSORS.get(effect.name, f"'{effect.name}'")
    name = (
        effect.coefficient if effect.coefficient in effect.params else next(iter(effect.params), "")
    )
    return f"{what} {where}" + (f", {value_words(found, effect, name)}" if name else "")


def _nothing(found: Found) -> str:
    if found.interrupted:
        return "No missing effect was found by then, but not all effects were tried."
    errors = unseen_errors(found)
    parts = error_words(found, errors, both=False)
    text = "Nothing is missing that these data could show"
    if not parts:
        return f"{text}."
    noise = f" ({in_sigma(errors, 'after'):.3g} σ)" if in_sigma(errors, "after") > 0 else ""
    _, runs_are = runs_words(found)
    return f"{text}; on unseen data {runs_are} wrong by {both_of(parts)}{noise}."


def _open(found: Found) -> str:
    missing = missing_dependence(found)
    none = explained_words(found)
    if noisy_words(found):
        return f"No effect of the library explains the residual; {noisy_words(found)}."
    if missing is None:
        where = "Something is missing, and its place is not known"
        return f"{where}; {none}{_wrong_by(found)}."
    where, share = missing_place_words(found, " that depends on"), percent(missing.share)
    return (
        f"Something is missing {where} {missing_words(found)} ({share} of the excess error); "
        f"{none}{_wrong_by(found)}."
    )


def explained_words(found: Found) -> str:
    """Why a trace that ends `unexplained` names nothing as the explanation."""
    if found.interrupted:
        return "no effect was accepted by then"
    if found.effects:
        return f"the best approximation is not enough: {found.reason}".removesuffix(": ")
    return f"no effect of the library explains it: {found.reason}".removesuffix(": ")


def noisy_words(found: Found) -> str:
    """The noise of inputs that would explain the residual; '' where none would."""
    if found.effects or not found.noisy_inputs:
        return ""
    parts = [
        f"noise of the input '{one.name}' of {one.sigma / factor:.2g} {unit}".rstrip()
        for one in found.noisy_inputs
        for unit, factor in [users_unit(found, one.name)]
    ]
    return f"{' or '.join(parts)} would explain the residual"


def _wrong_by(found: Found) -> str:
    """How wrong the declared diagram is on unseen data, where nothing better is known."""
    parts = [] if found.effects else error_words(found, unseen_errors(found), both=False)
    _, runs_are = runs_words(found)
    return f", and on unseen data {runs_are} wrong by {both_of(parts)}" if parts else ""


# --- the details --------------------------------------------------------------------------------


def _declared(found: Found) -> str:
    series = list(dict.fromkeys(e.series for e in found.errors if e.use == "train"))
    names = few_of([f"'{name}'" for name in series])
    to = f" to {names}" if series else ""
    title = found.original.title or found.original.file.name
    return (
        f"'{title}' was first fitted{to} as it stands: it leaves a residual of "
        f"{found.s2_before**0.5:.3g} σ (rms on the fitted windows; σ is the noise of the sensor)."
    )


def _null(found: Found) -> list[str]:
    parts = []
    if not found.interrupted:
        parts += ["No effect of the library reduces it on unseen data.", far_words(found)]
    if found.power:
        few = [
            f"{p.name} {place_words(p.place)} from {coefficient_of(p)} = "
            f"{p.smallest / factor:.3g} {unit}".rstrip()
            for p in common_powers(found)[: WORD.most_told]
            for unit, factor in [users_unit_of_power(found, p)]
        ]
        parts.append(f"These data would have shown, for example, {both_of(few)} on.")
    return parts


def far_words(found: Found) -> str:
    """What a residual may be that no effect reduces and that is more than the noise; '' where it is
    not."""
    if found.s2_before**0.5 <= WORD.far:
        return _slow_words(found)
    return (
        "It is more than the noise that was assumed, and follows nothing that was tried: "
        f"it may be {both_of([*PERHAPS, 'a noise that is larger than assumed'], 'or')}. {REPEAT}"
    )


def _slow_words(found: Found) -> str:
    """That whole runs are off by more than the noise where windows are not; '' where they are
    not."""
    errors, (_, runs_are) = unseen_errors(found), runs_words(found)
    left = in_sigma(errors, "after") if errors else 0.0
    if not WORD.left <= left < math.inf or not found.steps:
        return ""
    return (
        f"On unseen data {runs_are} off by {left:.3g} σ, and in windows of "
        f"{found.steps[-1].window:.3g} s the residual is the noise: what is missing is small and"
        " slow, or noise of an input adds up in a run."
    )


def _effect(found: Found) -> list[str]:
    parts = [meaning_words(found, effect) for effect in found.effects]
    parts.append(_left(found))
    if found.explained is not None and "excess" in excess_words(found):
        parts.append(
            "The excess error is what the declared model leaves above the best smooth force that "
            "the data allow."
        )
    if not unseen_errors(found):
        parts.append("No data were kept back for a final test.")
    doubts = [f"{effect.doubt}." for effect in found.effects if effect.doubt]
    sure = interval_words(found)
    sure = f"{sure[:1].upper()}{sure[1:]}." if sure else ""
    return [*parts, *_remains(found), sure, *_ties(found), *doubts, _moved(found)]


AT_A_LEVEL = {
    "bias": "a constant flow in or out",
    "viscous": "a loss in proportion to {}",
    "quad_drag": "a loss in proportion to the square of {}",
    "cubic_damping": "a loss in proportion to the third power of {}",
    "coulomb": "a loss that is the same for each {}",
    "viscous_drift": "a loss in proportion to {} that grows with the time of the run",
    "friction_drift": "a loss that grows with the time of the run, the same for each {}",
}
"""What effects mean where the state is no rate of a body, as a temperature or a pressure."""
OF_BODIES = ("m/s", "rad/s", "")
"""The units of rates; of what has no unit nothing is known."""


def meaning_words(found: Found, effect: FoundEffect) -> str:
    """What an effect is, as its block says; '' for one of a sensor, whose name says it."""
    if effect.name not in found.diagram.library or effect.name in SENSORS:
        return ""
    doc = found.diagram.library[effect.name].doc.rstrip(".")
    state = signal_of(found, effect.place, "v")
    if is_first_order(found, effect.place) and found.units.get(state, "") not in OF_BODIES:
        doc = AT_A_LEVEL.get(effect.name, doc).format(state)
    return f"'{effect.name}': {doc[:1].lower()}{doc[1:]}." if doc else ""


def _left(found: Found) -> str:
    what = "With it" if len(found.effects) == 1 else "With them"
    left = f"{found.s2_after**0.5:.3g} σ"
    return f"{what} in the diagram, and all free parameters refitted, {left} are left."


def _remains(found: Found) -> list[str]:
    parts = []
    for left in found.remainder[: WORD.most_told]:
        size, _, unit = remainder_numbers(found, left)
        size = f"{size} {unit}".rstrip()
        share = f"{left.in_sigma:.3g} σ, {percent(left.share)} of the rms error before"
        parts.append(f"{size} of {left.signal} ({share})")
    if not parts:
        return []
    text = (
        "On held-out blocks of time, each predicted by a model that was fitted without it, these "
        f"residuals remain: {both_of(parts)}."
    )
    rest = rest_words(found)
    return [f"{text} {rest}." if rest else text]


def rest_words(found: Found) -> str:
    """On what the rest depends that the named effects leave on held-out blocks, also at another
    place that explains about as much; '': on nothing."""
    shares = sorted(found.remainder_depends, key=lambda d: -d.share)
    if not shares or shares[0].share <= 0:
        return ""
    most = shares[0]
    least = most.share - WORD.alike_places
    alike = [d for d in shares if d.place != most.place and d.share > least]
    variables = variables_words(found, most.place, most.variables)
    text = (
        f"A smooth function of {variables} {place_words(most.place)} explains {percent(most.share)}"
        " of that"
    )
    for other in alike[:1]:
        variables = variables_words(found, other.place, other.variables)
        text += f", and one of {variables} {place_words(other.place)} {percent(other.share)}"
    return text


def _unexplained(found: Found) -> list[str]:
    parts = [open_words(found)]
    if found.effects:
        names = both_of([_named(found, effect) for effect in found.effects])
        parts.append(f"The best approximation is {names}. {_left(found)} That is not enough.")
        if found.explained is not None:
            parts.append(f"It explains {excess_words(found)}.")
        errors = error_words(found, unseen_errors(found))
        if errors:
            goes = _goes(found)
            runs, _ = runs_words(found)
            parts.append(f"On unseen data the error of {runs} {goes} {both_of(errors)}.")
        parts += _remains(found)
    return [*parts, _moved(found)]


def open_words(found: Found) -> str:
    """What an unexplained residual may be where no variable tells; '' where one does."""
    if noisy_words(found):
        names = both_of([f"'{one.name}'" for one in found.noisy_inputs])
        return f"If {names} is measured with such noise, say its `sigma:` and trace again."
    if found.missing is None:
        return f"The residual depends on nothing that was tried: {_perhaps()}"
    left = max((d.share for d in found.remainder_depends), default=0.0)
    if max(found.missing.share, left) < WORD.little:
        return f"The rest depends on no variable that was tried: {_perhaps()}"
    return ""


def _perhaps() -> str:
    """What a residual may be that depends on nothing that was tried, and how to find out."""
    return f"it may be {both_of(PERHAPS, 'or')}. {REPEAT}"


def _ties(found: Found) -> list[str]:
    parts = []
    for effect in found.effects:
        if effect.ties:
            names = few_of(ties_words(effect), "or")
            parts.append(f"These data cannot tell '{effect.name}' from {names}.")
    return parts + [experiment_words(found, experiment) for experiment in found.experiments]


def _moved(found: Found) -> str:
    large = [m for m in found.moved if stood_in(m) and m.name not in found.dropped]
    if not large or not found.effects:
        return ""
    shifts = few_of([moved_words(m) for m in large])
    who = "A fitted parameter" if len(large) == 1 else "Fitted parameters"
    doubt = doubt_words(found)
    return f"{who} had absorbed part of the missing effect: {shifts}." + (
        f" {doubt}." if doubt else ""
    )


def _dropped(found: Found) -> str:
    if not found.dropped:
        return ""
    names = both_of([f"'{name}'" for name in found.dropped])
    one = len(found.dropped) == 1
    return (
        f"{names} {'is' if one else 'are'} left out, as 0: beside the effects the data do not need"
        f" {'it' if one else 'them'}, and the intervals suppose that."
    )


def _was(texts: tuple[str, ...]) -> str:
    return "was" if len(texts) == 1 else "were"


def _plural(word: str, count: int) -> str:
    return word if count == 1 else f"{word}s"
