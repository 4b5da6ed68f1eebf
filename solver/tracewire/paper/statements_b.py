"""What paper B states of its triple pendulum: responses, irregular region, attractor, exponents."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from tracewire.analyse import (
    Bifurcation,
    Lyapunov,
    Plane,
    PoincareSection,
    bifurcation,
    lyapunov,
    periodic_orbit,
    section,
)
from tracewire.paper.runs import Systems, Vector, largest
from tracewire.paper.statement import Measure, Statement, about, above, below
from tracewire.solve import simulate

ANGLES = ("psi1", "psi2", "psi3")
TURN = dict.fromkeys(ANGLES, 2 * math.pi)
PERIODIC = {0.3: "Fig 5", 0.45: "Fig 5", 0.6: "Fig 5", 0.5: "Fig 7", 0.69: "Fig 7", 0.81: "Fig 7"}
EDGE = Plane(edge="torque")
WHOLE = 800
INFERRED = "B₁ and M₁ are lost in the print; ours are inferred from this region."


def frequencies(full: bool) -> Vector:
    """Those of the diagram in Hz: the paper's 800, or as dense near the edges only."""
    if full:
        return np.linspace(0.3, 0.9, WHOLE)
    near = [np.arange(low, high, 0.00075) for low, high in ((0.694, 0.706), (0.761, 0.777))]
    coarse = np.arange(0.3, 0.9001, 0.006)
    inside = [coarse[(coarse < grid[0]) | (coarse > grid[-1])] for grid in near]
    return np.unique(np.concatenate([*near, np.intersect1d(*inside)]))


def diagram_of(s: Systems) -> Bifurcation:
    """The bifurcation diagram down from 0.9 Hz and up again, made once."""

    def sweep() -> Bifurcation:
        values = frequencies(s.full)
        s.tell(f"bifurcation diagram: {values.size} frequencies, down and up")
        return bifurcation(
            s.model("pendulum"),
            "f",
            values,
            EDGE,
            direction="down_up",
            skip=200,
            keep=100,
            modulo=TURN,
            workers=s.workers,
        )

    return s.kept("diagram", sweep)


def main_band(bands: Iterable[tuple[float, float]]) -> tuple[float, float]:
    """The widest band of irregular motion in Hz; bands a step of 0.003 Hz apart count as one."""
    joined: list[tuple[float, float]] = []
    for low, high in bands:
        if joined and low - joined[-1][1] < 0.003:
            joined[-1] = (joined[-1][0], high)
        else:
            joined.append((low, high))
    return max(joined, key=lambda band: band[1] - band[0], default=(math.nan, math.nan))


def _edge(direction: str, end: int) -> Measure:
    return lambda s: main_band(diagram_of(s)[direction].bands)[end]


def _beside(direction: str) -> Measure:
    """The irregular frequencies beside the main region, parts of all."""

    def find(s: Systems) -> float:
        branch = diagram_of(s)[direction]
        low, high = main_band(diagram_of(s)[direction].bands)
        beside = branch.irregular & ((branch.values < low) | (branch.values > high))
        return float(np.mean(beside))

    return find


def _returns(frequency: float, periods: int = 0) -> Measure:
    """How far the angles are from themselves a period later, in parts of their range.

    In 88.2 to 98 s, the window of the identification, or in the period after so many of them.
    """

    def find(s: Systems) -> float:
        period = 1 / frequency
        begin, end = (periods * period, (periods + 2) * period) if periods else (88.2, 98.0)
        now = np.linspace(begin, end - period, 400)
        t = np.unique(np.concatenate([[0.0], now, now + period]))
        run = simulate(
            s.model("pendulum"), parameters={"f": frequency}, span=(0.0, t[-1]), times=t, rtol=1e-8
        )
        one, other = np.searchsorted(t, now), np.searchsorted(t, now + period)
        off = [largest(run[name][other] - run[name][one]) / np.ptp(run[name]) for name in ANGLES]
        return float(max(off))

    return find


def _multiplier(frequency: float) -> Measure:
    """The largest modulus of a multiplier of the orbit with the period of the torque."""

    def find(s: Systems) -> float:
        found = periodic_orbit(
            s.model("pendulum"),
            "1/f",
            begin="0.5/f",
            skip=200,
            modulo=TURN,
            parameters={"f": frequency},
        )
        return found.floquet.radius

    return find


def _orbits(frequency: float) -> Measure:
    """How many motions 24 starts at rest lead to: points of a section that differ by 0.01 rad."""

    def find(s: Systems) -> float:
        rng = np.random.default_rng(0)
        ends: list[Vector] = []
        for start in rng.uniform(-2.0, 2.0, (24, 3)):
            found = section(
                s.model("pendulum"),
                EDGE,
                skip=200,
                keep=2,
                start=dict(zip(ANGLES, start, strict=True)),
                parameters={"f": frequency},
            )
            end = np.exp(1j * found.points[-1, :3])
            if not any(float(np.max(np.abs(end - other))) < 1e-2 for other in ends):
                ends.append(end)
        return float(len(ends))

    return find


def _attractor(s: Systems) -> PoincareSection:
    skip, keep = (1000, 30000) if s.full else (100, 400)
    return s.kept(
        "attractor",
        lambda: section(
            s.model("pendulum"), EDGE, preset="chaotic", skip=skip, keep=keep, modulo=TURN
        ),
    )


def _turns(s: Systems) -> float:
    """The least number of turns that a link goes, over the points of the attractor."""
    return float(np.min(np.ptp(_attractor(s).points[:, :3], axis=0)) / (2 * math.pi))


def exponents_of(s: Systems) -> Lyapunov:
    """The Lyapunov exponents at 0.73 Hz, made once."""
    length, transient = (4e4, 1e4) if s.full else (2e3, 5e2)

    def follow() -> Lyapunov:
        s.tell(f"Lyapunov exponents over {length:g} s")
        return lyapunov(
            s.model("pendulum"), length, interval=0.5, transient=transient, preset="chaotic"
        )

    return s.kept("exponents", follow)


def _sum_rule(s: Systems) -> float:
    found = exponents_of(s)
    return math.nan if found.divergence is None else abs(found.total / found.divergence - 1)


def _reference(s: Systems) -> float:
    run = simulate(s.model("pendulum"), parameters={"f": 0.3}, times=[0.0, 1.0], rtol=1e-10)
    known = (-0.20979876, -0.01558703, 0.29480985)
    return max(abs(float(run[name][-1]) - x) for name, x in zip(ANGLES, known, strict=True))


REGION = "Irregular motion for f in (0.700, 0.768) Hz."
EDGES = (
    ("down", 0, "lower", 0.700, 0.003),
    ("down", 1, "upper", 0.768, 0.003),
    ("up", 0, "lower", 0.700, 0.003),
    ("up", 1, "upper", 0.768, 0.008),
)

STATEMENTS = (
    Statement(
        "B equations",
        "The equations of motion, against an independent solution.",
        "Section 4",
        "largest difference of an angle at t = 1 s, f = 0.3 Hz",
        _reference,
        below(1e-7),
        "rad",
    ),
    *(
        Statement(
            f"B response at {f:g} Hz",
            "From rest it swings with the period of the torque.",
            figure,
            "difference of two periods in 88.2 to 98 s, parts",
            _returns(f),
            below(0.02),
            note="A series of the identification.",
        )
        for f, figure in list(PERIODIC.items())[:3]
    ),
    *(
        Statement(
            f"B response at {f:g} Hz",
            "From rest it comes to swing with the period of the torque.",
            figure,
            "difference of two periods after 200, parts",
            _returns(f, 200),
            below(1e-3),
        )
        for f, figure in list(PERIODIC.items())[3:]
    ),
    *(
        Statement(
            f"B orbit at {f:g} Hz",
            "That motion is stable.",
            figure,
            "largest modulus of a multiplier",
            _multiplier(f),
            below(1.0),
        )
        for f, figure in PERIODIC.items()
    ),
    *(
        Statement(
            f"B coexisting at {f:g} Hz",
            "The criterion has many minima, so that shots and simplex "
            "are combined: motions coexist.",
            "Section 5, Eq 5",
            "periodic motions from 24 starts",
            _orbits(f),
            above(2.0),
            note="Where motions coexist, the criterion jumps as a parameter changes.",
        )
        for f in (0.45, 0.69)
    ),
    *(
        Statement(
            f"B {side} edge {direction}",
            REGION,
            "Fig 6",
            f"{side} edge, going {direction}",
            _edge(direction, end),
            about(value, off),
            "Hz",
            note=INFERRED,
        )
        for direction, end, side, value, off in EDGES
    ),
    *(
        Statement(
            f"B regular beside, {direction}",
            "The text names no other irregular region.",
            "Fig 6",
            "irregular frequencies beside it, parts of all",
            _beside(direction),
            below(0.0),
            note="200 skipped periods leave such bands; the bands are listed below.",
        )
        for direction in ("down", "up")
    ),
    Statement(
        "B attractor",
        "At 0.73 Hz the motion never repeats.",
        "Figs 8, 9",
        "clusters of the section's points, parts of their number",
        lambda s: _attractor(s).clusters / len(_attractor(s).points),
        above(0.25),
    ),
    Statement(
        "B turns",
        "Every link turns over at unpredictable instances.",
        "Fig 8",
        "least turns of a link",
        _turns,
        above(1.0),
    ),
    Statement(
        "B exponents",
        "Three Lyapunov exponents are positive.",
        "Fig 10",
        "positive exponents",
        lambda s: float(exponents_of(s).positive),
        about(3.0, 0.0),
        note="The paper prints no values.",
    ),
    Statement(
        "B sum rule",
        "Their sum is minus the mean of trace(M⁻¹C).",
        "theory",
        "relative difference",
        _sum_rule,
        below(5e-3),
    ),
)
