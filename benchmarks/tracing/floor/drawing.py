"""From a case to numbers: parameters, series, hidden effects and a floor of the right size.

The floor is scaled until the refitted truth leaves its share of what the refitted declared model
leaves (windows of one period). A draw is refused, and drawn again, where the hidden effects do not
explain most of it at long windows too, or where another law of the library passes for one of them,
or for the floor.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.tracing.cases import Case
from benchmarks.tracing.floor.cases import size_of_null
from benchmarks.tracing.floor.choosing import Unfit, choose_floor
from benchmarks.tracing.floor.fields import MASSES
from benchmarks.tracing.floor.refits import refit
from benchmarks.tracing.floor.rig import Rig, trajectory
from benchmarks.tracing.floor.rivals import laws_beside, left_by, shares
from benchmarks.tracing.floor.scenario import draw_scenario, stream
from benchmarks.tracing.floor.sizes import draw_series, force_of_rig, sized
from benchmarks.tracing.floor.unmodelled import NONE, draw_parts
from benchmarks.tracing.floor.windows import System, Trajectory
from benchmarks.tracing.plants import PLANTS
from benchmarks.tracing.refit import free_parameters

MOST, PATIENCE = 60, 8
"""Draws of one case before it is given up, and before its rig is drawn anew."""
FAR = 4.0
"""Of the largest start: a body that goes farther has run away."""
LEAST = 0.85
"""Of the excess that the truth explains, in windows of one period and of LONG periods."""
LONG = 4.0
APART = 1.5
"""What the best other law leaves in the place of a hidden effect, over what the truth leaves."""
KNOWN = 0.4
"""Of the floor: the most that any one law of the library may explain."""
EXACT = 0.1
"""Of what the floor shall leave: what a refit of the truth may leave without a floor."""
BESIDE, BALANCE = 3.0, 3.0
"""The excess counts at most as this many times what the lesser of two effects is missed; the most
that sizes of two effects are changed so that both are missed alike."""
SPRING = {"driven": 0.05, "cart": 20.0, "cart_smooth": 20.0, "pendulum": 0.35, "duffing": 12.0}
FORCE, ROUNDS = 0.05, 4
"""The force of a floor's part at first, of the whole force; tries of its size."""


@dataclass(frozen=True)
class Shares:
    """How a case came out: shares of the excess, at one period and at LONG periods."""

    floor: float  # of the excess of what is hidden
    truth: float
    truth_long: float
    apart: float  # the least over hidden effects: what the best other law leaves over the truth's
    rival: str  # that law
    known: float  # share of the floor that one law of the library explains
    excess: float  # rms of what the declared model leaves, in units of the signal
    left: float  # rms of what the truth leaves, in units of the signal
    attempt: int = 0


def draw_rig(case: Case) -> tuple[Rig, Shares]:
    """The first draw of a case that is one."""
    why = Counter[str]()
    for attempt in range(MOST):
        try:
            rig, shares = _attempt(case, attempt)
        except (Unfit, RuntimeError, OverflowError, np.linalg.LinAlgError) as error:
            why[str(error)] += 1
        else:
            return rig, replace(shares, attempt=attempt)
    told = "; ".join(f"{count} of them: {what}" for what, count in why.most_common(3))
    raise RuntimeError(f"{case.name}: no draw of {MOST} is a case: {told}")


def _attempt(case: Case, attempt: int) -> tuple[Rig, Shares]:
    scenario = draw_scenario(case, attempt // PATIENCE)
    rng = stream(case, "numbers", attempt)
    plant = PLANTS[case.system]
    values = dict(plant.true)
    for name in plant.scatter:
        values[name] *= rng.uniform(0.9, 1.1)
    if scenario.drive == "free" and scenario.rest:
        values["c"] *= rng.uniform(3, 6)
    control = None
    if scenario.drive in ("output", "reference"):
        kp = SPRING[case.system] * float(rng.uniform(0.5, 2.0))
        stiff = kp + SPRING[case.system]
        control = (
            kp,
            2
            * float(rng.uniform(0.05, 0.25))
            * float(np.sqrt(stiff * values[MASSES[case.system]])),
        )
    series = draw_series(scenario, plant, control, rng)
    told = control if scenario.drive == "reference" else None
    system = System(case.system, values, free_parameters(case.system), told or (0.0, 0.0))
    rig = Rig(case, scenario, plant, values, (), NONE, series, control, system)
    declared = trajectory(rig, 0.0)
    specs = size_of_null(case, rng) if case.group == "floor-null" else case.hidden
    hidden = tuple(sized(rig, spec, declared, rng) for spec in specs)
    rig = replace(rig, hidden=hidden)
    return _with_floor(rig, rng)


def _with_floor(rig: Rig, rng: np.random.Generator) -> tuple[Rig, Shares]:
    """Choose and scale the floor, and see that the case is one."""
    scenario, system = rig.scenario, rig.system
    clean = trajectory(rig, 0.0)
    T = 2 * np.pi * float(np.std(clean.q)) / float(np.std(clean.v))
    if len(rig.hidden) > 1:
        rig = _balanced(rig, clean, T)
        clean = trajectory(rig, 0.0)
    excess = min(
        refit(system, (), clean, T).rss, BESIDE * min(_without(rig, clean, T), default=np.inf)
    )
    if rig.case.group == "floor-null":  # what gives the floor its size goes
        rig = replace(rig, hidden=())
        clean = trajectory(rig, 0.0)
    wanted = excess * scenario.share / (1 - scenario.share)
    if not np.max(np.abs(clean.q)) < FAR * rig.plant.begin[0] or not np.isfinite(excess):
        raise Unfit("the body runs away")
    apart, rival = _apart(rig, clean, T, wanted)
    if apart < APART - 1:  # what it leaves comes on top of the floor
        raise Unfit(f"{rival} explains the hidden effect")
    perfect = refit(system, rig.hidden, clean, T)
    if perfect.rss > EXACT * wanted:
        raise Unfit("a refit does not follow this motion")
    laws = laws_beside(system, rig.hidden, clean, perfect)
    Q, V = float(np.max(np.abs(clean.q))), float(np.max(np.abs(clean.v)))
    force = FORCE * force_of_rig(rig, clean, slice(0, clean.counts[0] * clean.every))
    parts = draw_parts(scenario.floor, Q, V, force, len(rig.series), rng)
    rig = replace(rig, floor=choose_floor(laws, clean, parts, wanted, rng))
    for _ in range(ROUNDS):
        data = trajectory(rig, 1.0)
        truth = refit(system, rig.hidden, data, T)
        alone = refit(system, (), data, T)
        share = truth.rss / (alone.rss if len(rig.hidden) == 1 else excess + truth.rss)
        if not share < 0.9:
            raise Unfit(f"share of the floor {share:.3g}")
        if abs(share / scenario.share - 1) < 0.2:
            break
        factor = float(np.sqrt(scenario.share / (1 - scenario.share) * (1 / share - 1)))
        rig = replace(rig, floor=rig.floor.scaled(float(np.clip(factor, 0.2, 5))))
    else:
        raise Unfit(f"share of the floor {share:.3g}")
    beside = laws_beside(system, rig.hidden, data, truth)
    known = max(shares(beside, left_by(beside)).values())
    if known > KNOWN:
        raise Unfit(f"a law explains {known:.2f} of the floor")
    signal = float(np.std(data.shown)) * np.sqrt(alone.residual.size)
    sizes = [float(np.sqrt(rss)) / signal for rss in (max(excess, alone.rss), truth.rss)]
    if not rig.hidden:
        return rig, Shares(share, 0.0, 0.0, np.inf, "", known, *sizes)
    apart, rival = _apart(rig, data, T, truth.rss)
    if apart < APART:
        raise Unfit(f"{rival} leaves {apart:.2f} times what the truth leaves")
    long_truth = refit(system, rig.hidden, data, LONG * T).rss
    long = 1 - long_truth / refit(system, (), data, LONG * T).rss
    if long < LEAST:
        raise Unfit(f"the truth explains {long:.2f} at long windows")
    return rig, Shares(share, 1 - truth.rss / alone.rss, long, apart, rival, known, *sizes)


def _without(rig: Rig, data: Trajectory, T: float) -> list[float]:
    """What is left where one of several hidden effects is left out."""
    if len(rig.hidden) < 2:
        return []
    others = ([*rig.hidden[:k], *rig.hidden[k + 1 :]] for k in range(len(rig.hidden)))
    return [refit(rig.system, terms, data, T).rss for terms in others]


def _balanced(rig: Rig, data: Trajectory, T: float) -> Rig:
    """Effects that are missed about as much as one another."""
    left = np.array(_without(rig, data, T))
    factors = np.clip(np.sqrt(np.exp(np.mean(np.log(left))) / left), 1 / BALANCE, BALANCE)
    hidden = (
        replace(h, coefficient=h.coefficient * float(factor))
        for h, factor in zip(rig.hidden, factors, strict=True)
    )
    return replace(rig, hidden=tuple(hidden))


def _apart(rig: Rig, data: Trajectory, T: float, truth: float) -> tuple[float, str]:
    """The least ratio of what another law leaves in the place of a hidden effect to the truth."""
    worst, which = np.inf, ""
    for k, h in enumerate(rig.hidden):
        others = [*rig.hidden[:k], *rig.hidden[k + 1 :]]
        base = refit(rig.system, others, data, T)
        laws = laws_beside(rig.system, others, data, base)
        skip = (h.name, *(a.split(" ")[0] for a in rig.case.alike))
        taken = shares(laws, left_by(laws), skip)
        best = max(taken, key=lambda name: taken[name])
        ratio = base.rss * (1 - taken[best]) / truth
        if ratio < worst:
            worst, which = ratio, best
    return float(worst), which
