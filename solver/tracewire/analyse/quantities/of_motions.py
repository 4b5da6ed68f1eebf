"""Functions of quantities that analyses find: multipliers, exponents, sections, bands, fits."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from tracewire.analyse.limits import QUANTITY
from tracewire.analyse.quantities.evaluate import At, Value, full_name
from tracewire.array_types import Complexes, Vector
from tracewire.errors import AnalysisError, Problem
from tracewire.formula import Call, Name, to_text

SEED = 0


def _multiplier(read: Callable[[At, int], float]) -> Callable[[At, Call], float]:
    def find(at: At, node: Call) -> float:
        found = at.subject.floquet.multipliers
        return read(at, at.whole(node.arguments[0], len(found), "multiplier"))

    return find


def _edge(at: At, node: Call) -> float:
    name, low, high = node.arguments
    over = to_text(name)

    def margin(value: float) -> float:
        return at.subject.floquet_with({over: value}, "an edge of stability").margin

    first, last = at.number(low), at.number(high)
    if first == last or margin(first) * margin(last) > 0:
        what = f"'{over}' has the same stability at {first:g} and at {last:g}"
        raise AnalysisError([Problem(what, hint="Give two values with the edge between them.")])
    return float(brentq(margin, first, last, xtol=QUANTITY.xtol * abs(last - first)))


def _orbit_multiplier(at: At, node: Call) -> float:
    found = at.subject.orbit.floquet.multipliers
    return float(np.abs(found[at.whole(node.arguments[0], len(found), "multiplier")]))


def _lyapunov(at: At, node: Call) -> float:
    found = at.subject.lyapunov.exponents
    return float(found[at.whole(node.arguments[0], len(found), "exponent")])


def _divergence(at: At, node: Call) -> float:
    found = at.subject.lyapunov.divergence
    if found is None:
        raise AnalysisError([Problem("the field jumps: the divergence has no mean along it")])
    return found


def _of_states(at: At, node: Call, points: Vector, names: tuple[str, ...]) -> Value:
    """A formula of states at points (K, n)."""
    state = {name: points[:, n] for n, name in enumerate(names)}
    return replace(at, times=np.zeros(len(points)), state=state).value(node.arguments[0])


def _steady(at: At, node: Call) -> float:
    found = at.subject.steady
    return float(np.ravel(_of_states(at, node, found.x[None, :], found.states))[0])


def _points(at: At, node: Call) -> Vector:
    found = at.subject.section
    values = _of_states(at, node, found.points, found.states)
    return np.broadcast_to(values, (len(found.points),))


def _section(at: At, node: Call) -> float:
    found = _points(at, node)
    return float(found[at.whole(node.arguments[1], len(found), "point")])


def main_band(bands: Iterable[tuple[float, float]], gap: float) -> tuple[float, float]:
    """The widest band; those nearer than `gap` count as one. Raises AnalysisError: none."""
    joined: list[tuple[float, float]] = []
    for low, high in bands:
        if joined and low - joined[-1][1] < gap:
            joined[-1] = (joined[-1][0], high)
        else:
            joined.append((low, high))
    if not joined:
        raise AnalysisError([Problem("the motion is irregular nowhere")])
    return max(joined, key=lambda band: band[1] - band[0])


def _band(end: int) -> Callable[[At, Call], float]:
    def find(at: At, node: Call) -> float:
        branch = at.subject.bifurcation[to_text(node.arguments[0])]
        return main_band(branch.bands, at.number(node.arguments[1]))[end]

    return find


def _beside(at: At, node: Call) -> float:
    branch = at.subject.bifurcation[to_text(node.arguments[0])]
    low, high = main_band(branch.bands, at.number(node.arguments[1]))
    beside = branch.irregular & ((branch.values < low) | (branch.values > high))
    return float(np.mean(beside))


def _motions(at: At, node: Call) -> float:
    """Starts at rest at random, and how many points of the section they end at."""
    count, size, *names = node.arguments
    model, modulo = at.subject.model, at.subject.conditions.modulo
    states = [full_name(model, to_text(name)) for name in names]
    wide, many = at.number(size), at.whole(count, QUANTITY.most_starts, "number of starts") + 1
    if not 0 < wide < QUANTITY.largest_start:
        raise AnalysisError([Problem(f"starts within {wide:g} of zero have no use")])
    columns = [model.states.index(name) for name in states]
    turn = np.array([modulo.get(name, np.inf) for name in states])
    ends: list[Complexes] = []
    for start in np.random.default_rng(SEED).uniform(-wide, wide, (many, len(states))):
        point = at.subject.section_from(dict(zip(states, start, strict=True)), 2).points[-1]
        end = _on_circle(point[columns], turn)
        if not any(float(np.max(np.abs(end - other))) < QUANTITY.apart for other in ends):
            ends.append(end)
    return float(len(ends))


def _on_circle(x: Vector, turn: Vector) -> Complexes:
    """States that turn as points of a circle, so that they are near where they differ by a turn."""
    around = np.isfinite(turn)
    angle = np.where(around, 2 * np.pi * x / np.where(around, turn, 1.0), 0.0)
    scale = np.where(around, turn / (2 * np.pi), 1.0)
    return np.where(around, scale * np.exp(1j * angle), x)


def _fitted(at: At, node: Call) -> float:
    (name,) = node.arguments
    found = at.subject.fit.values
    assert isinstance(name, Name)
    if name.name not in found:
        what = f"the fit does not free '{name.name}'"
        raise AnalysisError([Problem(what, exists=tuple(found), hint="Give it 'fit' bounds.")])
    return float(found[name.name])


def _further(at: At, node: Call) -> float:
    if node.function not in at.further:
        what = f"{node.function} is measured by `tracewire paper` only"
        raise AnalysisError([Problem(what)])
    return at.further[node.function](*(to_text(argument) for argument in node.arguments))


OF_MOTIONS: dict[str, Callable[[At, Call], Value]] = {
    "multiplier": _multiplier(lambda at, k: float(np.abs(at.subject.floquet.multipliers[k]))),
    "multiplier_real": _multiplier(lambda at, k: float(at.subject.floquet.multipliers[k].real)),
    "floquet_exponent": _multiplier(lambda at, k: float(at.subject.floquet.exponents[k].real)),
    "floquet_frequency": _multiplier(
        lambda at, k: abs(float(at.subject.floquet.exponents[k].imag))
    ),
    "monodromy_trace": lambda at, node: float(np.trace(at.subject.floquet.monodromy)),
    "monodromy_determinant": lambda at, node: float(np.linalg.det(at.subject.floquet.monodromy)),
    "stability": lambda at, node: at.subject.floquet.verdict,
    "stability_edge": _edge,
    "orbit_multiplier": _orbit_multiplier,
    "lyapunov": _lyapunov,
    "lyapunov_positive": lambda at, node: float(at.subject.lyapunov.positive),
    "lyapunov_sum": lambda at, node: at.subject.lyapunov.total,
    "divergence": _divergence,
    "steady": _steady,
    "steady_stability": lambda at, node: at.subject.steady.verdict,
    "section": _section,
    "section_range": lambda at, node: float(np.ptp(_points(at, node))),
    "section_clusters": lambda at, node: float(at.subject.section.clusters),
    "section_count": lambda at, node: float(len(at.subject.section.points)),
    "band_low": _band(0),
    "band_high": _band(1),
    "irregular_beside": _beside,
    "motions": _motions,
    "fitted": _fitted,
    "criterion": lambda at, node: at.subject.fit.criterion,
    "identification": _further,
}
