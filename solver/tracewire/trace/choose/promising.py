"""Which effects of a screen are worth a refit: those that promise the most by two measures.

One is BIC of the squares. The other is what the choice asks for later: with E/n the mean squared
residual of a block of time after the effect's linear answer is taken away,

    S = mean over blocks of 1/2 ln(E/n + phi^2) + k ln(B)/(2 B),

phi^2 the median over blocks of the least E/n, k the numbers that the effects take, B the number of
blocks. Squares see the block in which the misfit is largest, the logarithm sees all of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, zip_longest

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.trace.screen.screening import Proposal, Screen, ScreenRow
from tracewire.trace.screen.shortlist import distinct

Ints = NDArray[np.intp]


def select_promising(screen: Screen, blocks: Ints, singles: int, pairs: int) -> list[Proposal]:
    """The most promising single effects of a screen, and then pairs, so many of each measure.

    blocks: the block of each residual, (M,); negative where it belongs to none.
    """
    alone = [Proposal((row,), row.gain) for row in screen.best() if row.rss_reduction > 0]
    found = _alternately(_by_blocks(screen, blocks, alone)[:singles], alone[:singles])
    if pairs:
        together = [p for same in screen.by_count(pairs).values() for p in same if len(p.rows) == 2]
        together.sort(key=lambda pair: -pair.gain)
        by_blocks = _by_blocks(screen, blocks, screen.pairs())
        found += _alternately(by_blocks[:pairs], together[:pairs])
    return found


def no_longer_absorbed(screen: Screen, before: Screen, least: float) -> set[str]:
    """The effects that the unknowns imitate less than in another screen, by so much of the square:
    those that imitate what is not there any more."""
    known = before.observable()

    def fell(name: str, row: ScreenRow) -> bool:
        return name not in known or known[name].absorbed_fraction - row.absorbed_fraction >= least

    return {name for name, row in screen.observable().items() if fell(name, row)}


def _alternately(*rankings: Sequence[Proposal]) -> list[Proposal]:
    """The proposals of some rankings in turn, each set of effects once."""
    in_turn = chain.from_iterable(zip_longest(*rankings))
    return distinct(proposal for proposal in in_turn if proposal is not None)


def _by_blocks(screen: Screen, blocks: Ints, proposals: Sequence[Proposal]) -> list[Proposal]:
    """Proposals by the logarithm of what they leave in each block, the best first."""
    blocks = blocks[screen.kept]
    columns, counted = screen.columns, blocks >= 0
    _, place, sizes = np.unique(blocks[counted], return_inverse=True, return_counts=True)

    def left(indices: Sequence[int]) -> Vector:
        residual = columns.left(indices)
        return np.bincount(place, weights=residual[counted] ** 2) / sizes

    if not proposals:
        return []
    errors = np.stack([left([c for row in p.rows for c in row.columns]) for p in proposals])
    floor = float(np.median(errors.min(axis=0)))
    scores = np.mean(0.5 * np.log(np.maximum(errors + floor, 1e-300)), axis=1)
    price = float(np.log(len(sizes))) / (2 * len(sizes))
    scores = scores + price * np.array([proposal.count for proposal in proposals])
    return [proposals[n] for n in np.argsort(scores, kind="stable").tolist()]
