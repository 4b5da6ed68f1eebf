"""What a trace could not try, and what to do about it, in words."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from tracewire.show.trace_words import both_of, few_of
from tracewire.trace import Found, Power

NAME = r"\S+ @ \S+(?: \(of \S+\))?"
UNTRIED = re.compile(rf"({NAME}(?: and {NAME})*) (?:was|were) not tried: (.+)", re.DOTALL)
COSTLY = re.compile(r"the model takes more than \d+ steps in all|the run stopped at t = ")
COMMON = ("coulomb", "viscous", "quad_drag", "stiffness", "cubic_stiffness", "sensor_offset")
OF = re.compile(r" \(of \S+\)")


def untried(found: Found) -> set[str]:
    """The effects that were not tried by themselves, as their models do not run."""
    return {OF.sub("", names[0]) for _, names, _ in _refused(found) if len(names) == 1}


def common_powers(found: Found) -> list[Power]:
    """What these data would have shown, the effects first that a reader is most likely to know.

    What was not tried is left out.
    """
    order = {name: n for n, name in enumerate(COMMON)}
    left_out = untried(found)
    tried = (p for p in found.power if f"{p.name} @ {p.place}" not in left_out)
    return sorted(tried, key=lambda p: order.get(p.name, len(order)))


def told_of_untried(found: Found) -> list[str]:
    """The remarks of a trace, of which those about what was not tried are told as one each cause.

    An effect that was refitted elsewhere in the search was tried, and a pair says no more than the
    effect in it that was not tried alone.
    """
    ties = [tie for effect in found.effects for tie in effect.ties]
    named = {str(effect) for effect in (*found.effects, *ties)}
    for step in found.steps:
        for row in step.tried:
            named.update(row.effects.split(" + ") if math.isfinite(row.s2) else ())
    refused = [one for one in _refused(found) if not {OF.sub("", n) for n in one[1]} <= named]
    alone = {names[0] for _, names, _ in refused if len(names) == 1}
    said = {text for text, *_ in _refused(found)}
    kept = [one for one in refused if len(one[1]) == 1 or not alone & {*one[1]}]
    remarks = [text for text in found.words if text not in said]
    remarks += [
        f"{both_of(names)} {'was' if len(names) == 1 else 'were'} not tried: {cause}"
        for _, names, cause in kept
        if not COSTLY.match(cause)
    ]
    costly = [" with ".join(names) for _, names, cause in kept if COSTLY.match(cause)]
    return remarks + ([_costly_words(found, costly)] if costly else [])


def _costly_words(found: Found, costly: list[str]) -> str:
    """What takes too long to be tried, and how it can be."""
    many = found.options.search.slower
    were, with_it, it = ("was", "it", "it") if len(costly) == 1 else ("were", "them", "one")
    return (
        f"{few_of(costly)} {were} not tried: with {with_it} a run takes more than {many:g} times "
        "as many steps, or does not end, as the model is stiff, switches often or runs away; "
        f"to try {it}, add it to the diagram and `fit` that, or allow more in Python: "
        f'`tw.trace(model, options={{"search": {{"slower": {5 * many:g}}}}})`'
    )


def _refused(found: Found) -> Iterator[tuple[str, tuple[str, ...], str]]:
    """Each remark about what was not tried, with the names of that and the cause."""
    for text in found.words:
        if hit := UNTRIED.fullmatch(text):
            yield text, tuple(re.findall(NAME, hit[1])), hit[2]
