"""A trace in lines for a terminal: the short answer, and the way to it."""

from __future__ import annotations

import math

from tracewire.trace import Found, FoundEffect
from tracewire.trace.found import StepTold
from tracewire.trace.telling import (
    chance_words,
    common_powers,
    in_sigma,
    percent,
    place_words,
    stood_in,
    unseen_errors,
    value_words,
    variables_words,
)

MOST_CHANNELS = 4
NONE = "no effect of the library explains it"


def answer_lines(found: Found) -> tuple[str, ...]:
    """The short answer: verdict, effects with coefficients, ties, error on unseen data."""
    cut = " (interrupted: what was known by then)" if found.interrupted else ""
    lines = [f"VERDICT {found.verdict}{cut}: {_verdict(found)}"]
    partial = "best approximation, not enough: " if found.verdict == "unexplained" else ""
    for effect in found.effects:
        values = ", ".join(value_words(found, effect, name) for name in effect.params)
        lines.append(f"  {partial}{effect}: {values}")
        lines += _tie_lines(effect)
    lines += [f"  {name} went to zero" for name in found.dropped]
    lines += _error_lines(found)
    moved = [m for m in found.moved if stood_in(m)]
    if moved:
        shifts = ", ".join(
            f"{m.name} {m.before:.4g} -> {m.after:.4g} {m.unit}".rstrip() for m in moved
        )
        lines.append(f"  had stood in for what was missing: {shifts}")
    lines += [f"  {experiment.words}" for experiment in found.experiments]
    if found.verdict == "null" and found.power:
        least = ", ".join(
            f"{p.name} {p.smallest:.2g}" for p in common_powers(found)[:MOST_CHANNELS]
        )
        lines.append(f"  smallest coefficients that would have been seen: {least} (SI)")
    return tuple(lines)


def step_lines(found: Found) -> tuple[str, ...]:
    """The way to the answer: noise, declared model, step by step."""
    noise = ", ".join(f"{name} {sigma:.3g} {found.units.get(name, '')}".rstrip()
                      for name, sigma in found.sigma.items())  # fmt: skip
    lines = [f"noise (σ)       {noise}"]
    lines.append(
        f"declared model  s2 = {found.s2_before:.4g}: rms {math.sqrt(found.s2_before):.3g} σ "
        "on short windows; 1 is the noise"
    )
    for number, step in enumerate(found.steps, start=1):
        lines += _step(number, step)
    return tuple(lines)


def _verdict(found: Found) -> str:
    if found.verdict == "null":
        so_far = ", but not all effects were tried" if found.interrupted else ""
        return f"nothing is missing beyond the noise{so_far}"
    if found.verdict == "effect":
        return f"{' and '.join(map(str, found.effects))} {_is(len(found.effects))} missing"
    none = "no effect was accepted by then" if found.interrupted else NONE
    if found.missing is None:
        return f"something is missing, and {none}"
    others = sorted(
        (d for d in found.dependences if (d.place, d.variables) != _key(found)),
        key=lambda d: -d.share,
    )
    beside = [
        f"{', '.join(d.variables)} @ {d.place} {percent(d.share)}"
        for d in others[:2]
        if d.share > 0
    ]
    text = (
        f"something is missing {place_words(found.missing.place)}; it depends on "
        f"{variables_words(found.missing.variables)} ({percent(found.missing.share)} of the excess"
    )
    return text + (f"; {'; '.join(beside)})" if beside else ")") + f", and {none}"


def _key(found: Found) -> tuple[str, tuple[str, ...]] | None:
    return None if found.missing is None else (found.missing.place, found.missing.variables)


def _is(count: int) -> str:
    return "is" if count == 1 else "are"


def _tie_lines(effect: FoundEffect) -> list[str]:
    if not effect.ties:
        return []
    ties = ", ".join(f"{tie} ({tie.likeness:.3f})" for tie in effect.ties)
    return [f"    cannot be told apart on these data: {ties}"]


def _error_lines(found: Found) -> list[str]:
    errors = unseen_errors(found)
    if not errors:
        lines = ["  no data played no part: these errors are of data that chose the effects"]
        errors = tuple(e for e in found.errors if e.kind == "free run")
    else:
        lines = []
    before, after = in_sigma(errors, "before"), in_sigma(errors, "after")
    if not math.isfinite(after):
        return []
    channels = dict.fromkeys((e.signal, e.unit) for e in errors)
    parts = []
    for signal, unit in list(channels)[:MOST_CHANNELS]:
        own = [e for e in errors if e.signal == signal]
        old, new = (
            math.sqrt(sum(getattr(e, when) ** 2 for e in own) / len(own))
            for when in ("before", "after")
        )
        parts.append(f"{signal} {old:.4g} -> {new:.4g} {unit}".rstrip())
    where = "on unseen data" if not lines else "on the series"
    if found.effects:
        text = f"  free runs {where}: {before:.3g} σ -> {after:.3g} σ ({'; '.join(parts)})"
    else:
        text = f"  free runs {where}: {after:.3g} σ"
    return [*lines, text]


def _step(number: int, step: StepTold) -> list[str]:
    head = f"step {number}"
    chance = "" if "p = " in step.words else f", {chance_words(step.chance)}"
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
