"""The shortlist: which of the effects that a screen promises something of are worth a refit."""

from __future__ import annotations

from collections.abc import Iterable

from tracewire.trace.limits import ROUNDING
from tracewire.trace.screen.screening import Proposal, Screen, ScreenRow


def shortlist(screen: Screen, room: int, count: int) -> list[Proposal]:
    """What is worth a refit: the best single effects, `count` of them, and pairs that promise more
    than their parts and than any single effect, where there is room for two."""
    options = screen.columns.options
    least = options.least_gain
    singles: list[ScreenRow] = []
    for row in sorted(screen.best(), key=lambda row: (-round(row.gain, 3), not row.candidate.sign)):
        # an exact copy, as of what is more in one direction where there is no other, has its name
        same = (
            screen.columns.canonical_correlation(row.columns, other.columns) for other in singles
        )
        if row.gain > least and (
            len(singles) >= options.many or all(x < ROUNDING.same for x in same)
        ):
            singles.append(row)
    found = [Proposal((row,), row.gain) for row in singles[:count]]
    if room < 2:
        return found
    alone = {str(row.candidate): row.gain for row in screen.best()}
    best = max(alone.values(), default=0.0)

    def promises_more(pair: Proposal) -> bool:
        parts = max(alone.get(str(row.candidate), 0.0) for row in pair.rows)
        return pair.gain > max(best, least, parts + least)

    pairs = [pair for pair in screen.pairs() if promises_more(pair)]
    best_of = {pair.count: pair for pair in reversed(pairs)}
    # what takes many numbers, as waves do, hides no simple pair
    simple = [best_of[count] for count in sorted(best_of)[: options.simple_pairs]]
    others = [pair for pair in pairs if pair not in simple]
    return found + simple + others[: options.pairs - len(simple)]


def distinct(proposals: Iterable[Proposal]) -> list[Proposal]:
    """The first of the proposals with each set of effects."""
    found: dict[frozenset[str], Proposal] = {}
    for proposal in proposals:
        found.setdefault(frozenset(proposal.names), proposal)
    return list(found.values())
