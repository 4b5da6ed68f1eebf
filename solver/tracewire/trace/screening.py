"""The screen: one linearisation that promises what each effect, and each pair, would bring."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from tracewire.compile import compile
from tracewire.fit.criterion import Criterion
from tracewire.fit.segment import of_diagram
from tracewire.solve import simulate
from tracewire.trace.candidates import Candidate, coefficient_scale, extend
from tracewire.trace.places import Place
from tracewire.trace.statistics import Screen
from tracewire.trace.trial import Bench, Trial

SINGLES = 4
PAIRS = 4
PROMISING = 0.2
MORE_THAN_PARTS = 5.0


@dataclass(frozen=True)
class Proposal:
    """Effects to try together, and the coefficients that the screen expects of them."""

    effects: tuple[Candidate, ...]
    expected: tuple[float, ...]
    gain: float


def screen_candidates(
    bench: Bench, now: Trial, places: Sequence[Place], candidates: Sequence[Candidate]
) -> tuple[Screen, dict[str, float]]:
    """The score test of all candidates, and the size of each coefficient that would matter.

    The columns come from one model that has them all, with coefficient zero.
    """
    added = [(c, 0.0) for c in candidates if c.block is not None]
    model = bench.compiled(extend(now.model.diagram, added))
    levels = _levels(bench, now, places)
    scales = {c.unknown: coefficient_scale(c, levels) for c in candidates}
    unknowns = now.criterion.moved(now.descent.z)[0]
    extra = [replace(c.as_unknown(0.0, 0.1 * scales[c.unknown]), low=-np.inf) for c in candidates]
    fixed = now.criterion.parameters
    criterion = Criterion(model, now.segments, [*unknowns, *extra], fixed, bench.rtol, bench.sigma)
    residuals, derivatives = criterion.residuals_and_derivatives(criterion.begin())
    jacobian = np.concatenate(derivatives)
    first, last = len(unknowns), len(unknowns) + len(extra)
    columns = {
        c.unknown: jacobian[:, first + n] / criterion.scales[first + n]
        for n, c in enumerate(candidates)
    }
    kept = np.concatenate((jacobian[:, :first], jacobian[:, last:]), axis=1)
    residual = np.concatenate([r.ravel() for r in residuals])
    return Screen(residual, kept, columns, now.part), scales


def shortlist(
    screen: Screen, candidates: Sequence[Candidate], room: int, least: float
) -> list[Proposal]:
    """What is worth a refit: the best single effects, and pairs that promise more than their parts.

    Every proposal gains at least `least`, has possible signs, and either belongs to the two best
    single effects or promises a fifth of the best gain. `room` is how many effects may be added.
    """
    singles = _proposals(screen, candidates, 1, least)
    alone = {proposal.effects[0]: proposal.gain for proposal in singles}
    pairs = [
        proposal
        for proposal in (_proposals(screen, candidates, 2, least) if room > 1 else ())
        if proposal.gain > MORE_THAN_PARTS + max(alone.get(e, 0.0) for e in proposal.effects)
    ]
    enough = PROMISING * max((p.gain for p in (*singles, *pairs)), default=0.0)
    kept = [p for n, p in enumerate(singles[:SINGLES]) if n < 2 or p.gain > enough]
    return kept + [p for p in pairs[:PAIRS] if p.gain > enough]


def _proposals(
    screen: Screen, candidates: Sequence[Candidate], size: int, least: float
) -> list[Proposal]:
    """All combinations of a size whose coefficients have possible signs, the best first."""
    found = []
    for effects in combinations(candidates, size):
        score = screen.score([c.unknown for c in effects])
        signs = zip(effects, score.values, strict=True)
        if score.gain > least and all(c.sign == 0 or value > 0 for c, value in signs):
            found.append(Proposal(effects, score.values, score.gain))
    return sorted(found, key=lambda proposal: -proposal.gain)


def _levels(bench: Bench, now: Trial, places: Sequence[Place]) -> dict[str, float]:
    """Root mean squares of the signals at the places and of the sensors, on the first segment."""
    names = {name for p in places for name in (p.name, p.v, p.q) if name}
    names |= {signal for m in bench.measured for signal in m.values}
    model = compile(now.model.diagram, record=sorted(names))
    segment = now.segments[0]
    run = simulate(
        model,
        parameters={**now.criterion.parameters, **of_diagram(now.values)},
        start=segment.start,
        span=(min(segment.begin, float(segment.t[0])), float(segment.t[-1])),
        times=segment.t,
        rtol=bench.rtol,
        preset=segment.measured.preset,
        inputs=segment.measured.inputs,
    )
    return {name: max(float(np.sqrt(np.mean(run[name] ** 2))), 1e-12) for name in names}
