"""A trace in lines for a terminal: the short answer, and the way to it."""

from __future__ import annotations

import math

from tracewire.formula import two_digits
from tracewire.show.limits import WORD
from tracewire.show.trace_experiments import experiment_words
from tracewire.show.trace_steps import decided_words
from tracewire.show.trace_summary import (
    explained_words,
    far_words,
    limits_words,
    meaning_words,
    noisy_words,
    open_words,
    rest_words,
    ties_words,
)
from tracewire.show.trace_untried import common_powers, told_of_untried
from tracewire.show.trace_words import (
    astray_words,
    both_of,
    chance_words,
    doubt_words,
    error_words,
    excess_words,
    in_sigma,
    interval_words,
    missing_dependence,
    missing_place_words,
    missing_words,
    moved_words,
    percent,
    remainder_numbers,
    runs_words,
    stood_in,
    told_once,
    unseen_errors,
    value_words,
)
from tracewire.trace import (
    Found,
    FoundEffect,
    SearchStep,
    coefficient_of,
    signal_of,
    users_unit,
    users_unit_of_power,
)


def answer_lines(found: Found) -> tuple[str, ...]:
    """The short answer: verdict, effects with coefficients, ties, error on unseen data, advice."""
    cut = " (interrupted: what was known by then)" if found.interrupted else ""
    lines = [f"VERDICT {found.verdict}{cut}: {_verdict(found)}"]
    partial = "best approximation, not enough: " if found.verdict == "unexplained" else ""
    for effect in found.effects:
        values = ", ".join(value_words(found, effect, name) for name in effect.params)
        lines.append(f"  {partial}{effect}: {values}")
        meaning = meaning_words(found, effect).partition(": ")[2].rstrip(".")
        lines += [f"    {text}" for text in (meaning, _ties(effect), effect.doubt) if text]
    lines += [
        f"  {name} is left out, as 0: beside the effects the data do not need it, and the intervals"
        " suppose that"
        for name in found.dropped
    ]
    if explained := excess_words(found):
        lines.append(f"  explained: {explained}")
    lines += _error_lines(found)
    lines += _remainder_lines(found)
    if sure := interval_words(found):
        lines.append(f"  {sure}")
    shifts = [moved_words(m) for m in found.moved if stood_in(m) and m.name not in found.dropped]
    if shifts:
        lines.append(f"  had absorbed part of the missing effect: {', '.join(shifts)}")
    if doubt := doubt_words(found):
        lines.append(f"  {doubt}")
    lines += [f"  {experiment_words(found, experiment)}" for experiment in found.experiments]
    if found.verdict == "null" and found.power:
        least = ", ".join(
            f"{p.name} @ {p.place} {coefficient_of(p)} = "
            f"{two_digits(p.smallest / factor)} {unit}".rstrip()
            for p in common_powers(found)[: WORD.most_channels]
            for unit, factor in [users_unit_of_power(found, p)]
        )
        lines.append(f"  smallest coefficients that these data would show: {least}")
    lines += [f"  {text}" for text in (_advice(found), limits_words(found.options)) if text]
    return tuple(lines)


def remarks_of(found: Found) -> tuple[str, ...]:
    """The remarks of a trace; one that is true of several series is told once with all of them."""
    named = [*(e.series for e in found.errors), *(c.series for c in found.curves)]
    return told_once(
        told_of_untried(found), list(dict.fromkeys([*named, *found.original.measured]))
    )


def step_lines(found: Found) -> tuple[str, ...]:
    """The way to the answer: noise, declared model, step by step."""
    noise = ", ".join(f"{name} {sigma / factor:.3g} {unit}".rstrip()
                      for name, sigma in found.sigma.items()
                      for unit, factor in [users_unit(found, name)])  # fmt: skip
    lines = [f"noise (σ)       {noise}"]
    lines.append(
        f"declared model  s2 = {found.s2_before:.4g}: rms {math.sqrt(found.s2_before):.3g} σ "
        "on the fitted windows; 1 is the noise"
    )
    for number, step in enumerate(found.steps, start=1):
        lines += _step(number, step)
    decided = decided_words(found)
    return (*lines, decided) if decided else tuple(lines)


def _verdict(found: Found) -> str:
    if found.verdict == "null":
        so_far = ", but not all effects were tried" if found.interrupted else ""
        return f"nothing is missing that these data could show{so_far}"
    if found.verdict == "effect":
        return f"{both_of(list(map(str, found.effects)))} {_is(len(found.effects))} missing"
    none = explained_words(found)
    if noisy_words(found):
        return f"{noisy_words(found)}, and {none}"
    missing = missing_dependence(found)
    if missing is None:
        return f"something is missing, and {none}"
    told = missing.place, missing.variables
    others = sorted(
        (d for d in found.dependences if (d.place, d.variables) != told), key=lambda d: -d.share
    )
    beside = [
        f"{', '.join(signal_of(found, d.place, name) for name in d.variables)} @ {d.place} "
        f"{percent(d.share)}"
        for d in others[:2]
        if d.share > 0
    ]
    text = (
        f"something is missing {missing_place_words(found, '; it depends on')} "
        f"{missing_words(found)} ({percent(missing.share)} of the excess"
    )
    return text + (f"; {'; '.join(beside)})" if beside else ")") + f", and {none}"


def _is(count: int) -> str:
    return "is" if count == 1 else "are"


def _ties(effect: FoundEffect) -> str:
    return f"these data cannot tell it from {', '.join(ties_words(effect))}" if effect.ties else ""


def _advice(found: Found) -> str:
    """What the residual may be where nothing that was tried explains it."""
    if found.verdict == "null" and not found.interrupted:
        return far_words(found)
    return open_words(found) if found.verdict == "unexplained" else ""


def _error_lines(found: Found) -> list[str]:
    errors = unseen_errors(found)
    where, (runs, _) = "on unseen data", runs_words(found)
    lines = []
    if not errors:
        lines = ["  no data were kept back: these errors are of data that chose the effects"]
        kind = "windowed" if astray_words(found) else "free run"
        errors = tuple(e for e in found.errors if e.kind == kind)
        where = "on the series"
    before, after = in_sigma(errors, "before"), in_sigma(errors, "after")
    if not math.isfinite(after):
        return []
    if astray := astray_words(found):
        lines.append(f"  {astray}")
    if not found.effects:
        signals = ", ".join(error_words(found, errors, both=False))
        return [*lines, f"  {runs} {where}: {after:.3g} σ ({signals})"]
    signals = "; ".join(text.removeprefix("for ") for text in error_words(found, errors))
    return [*lines, f"  {runs} {where}: {before:.3g} σ -> {after:.3g} σ ({signals})"]


def _remainder_lines(found: Found) -> list[str]:
    lines = []
    for left in found.remainder[: WORD.most_channels]:
        size, floor, unit = remainder_numbers(found, left)
        least = f"; a smooth map would leave {floor} {unit}".rstrip() if floor else ""
        lines.append(
            f"  left on held-out blocks: {size} {unit}".rstrip()
            + f" of {left.signal} ({left.in_sigma:.3g} σ, {percent(left.share)} of the rms "
            f"error before{least})"
        )
    if lines and (rest := rest_words(found)):
        lines.append(f"    {rest[:1].lower()}{rest[1:]}")
    return lines


def _step(number: int, step: SearchStep) -> list[str]:
    head = f"step {number}"
    told = "p = " in step.words or math.isnan(step.chance)  # models that are compared have none
    chance = "" if told else f", {chance_words(step.chance)}"
    lines = [f"{head:<16}windows of {step.window:.3g} s, s2 = {step.s2:.4g}{chance}: {step.words}"]
    for row in step.tried:
        if row.remark:
            numbers = [
                text
                for value, text in (
                    (row.masked, f"masked {percent(row.masked)}"),
                    (row.s2, f"s2 -> {row.s2:.4g}"),
                    (row.weight, f"weight {row.weight:.2f}"),
                )
                if math.isfinite(value)
            ]
            lines.append(f"{'':<16}{row.effects}: {', '.join([*numbers, row.remark])}")
    return lines
