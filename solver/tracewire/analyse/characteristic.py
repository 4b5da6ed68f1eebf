"""The characteristic roots of a linear system with delays, x' = A x + sum_k A_k x(t - T_k).

The generator of the motion over the longest delay is collocated at Chebyshev points, and each of
its eigenvalues is then led to a root of det(s I - A - sum_k A_k exp(-s T_k)) by Newton's method.
Source: D. Breda, S. Maset, R. Vermiglio, SIAM J. Sci. Comput. 27 (2005) 482-495.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tracewire.analyse.limits import ROOT
from tracewire.array_types import Complexes, Matrix


def characteristic_roots(a: Matrix, terms: Mapping[float, Matrix]) -> Complexes:
    """The rightmost roots in 1/s, those of the largest real part first.

    a: A (n, n); terms: A_k (n, n) by T_k in s. As many as there are states, and at least eight.
    """
    n, longest = len(a), max(terms)
    size = sum((np.abs(m).sum(axis=1).max() for m in terms.values()), np.abs(a).sum(axis=1).max())
    most = min(ROOT.most_points, max(ROOT.largest // n, ROOT.fewest_points))
    points = int(np.clip(2.0 * size * longest, ROOT.fewest_points, most))
    found = np.linalg.eigvals(_collocated(a, terms, points))
    found = found[found.real * longest > -ROOT.far]
    found = found[np.lexsort((-found.imag, -found.real))]
    roots = [_root(a, terms, complex(guess)) for guess in found[: 4 * max(n, ROOT.fewest_roots)]]
    known = np.array([root for root in roots if root is not None], dtype=np.complex128)
    known = known[np.lexsort((-known.imag, -known.real))]
    many = max(n, ROOT.fewest_roots)
    beyond = known[many : many + 1]  # the other one of a pair
    is_pair = np.abs(beyond - known[:many][-1:].conj()) <= ROOT.near * np.abs(beyond)
    return known[: many + int(np.any(is_pair))]


def _collocated(a: Matrix, terms: Mapping[float, Matrix], points: int) -> Matrix:
    """The generator at Chebyshev points of [-longest, 0], the first of which is 0."""
    n, longest = len(a), max(terms)
    angle = np.pi * np.arange(points + 1) / points
    x = np.cos(angle)
    weights = (-1.0) ** np.arange(points + 1)
    weights[[0, -1]] /= 2.0
    apart = x[:, None] - x + np.eye(points + 1)
    slopes = weights / weights[:, None] / apart
    np.fill_diagonal(slopes, 0.0)
    np.fill_diagonal(slopes, -slopes.sum(axis=1))
    whole = np.kron(slopes * (2.0 / longest), np.eye(n))
    whole[:n] = 0.0
    whole[:n, :n] = a
    for time, matrix in terms.items():
        off = 1.0 - 2.0 * time / longest - x
        at = np.flatnonzero(np.abs(off) < 1e-14)
        shares = np.zeros(points + 1)
        if len(at):
            shares[at[0]] = 1.0
        else:
            shares = weights / off
            shares /= shares.sum()
        whole[:n] += np.kron(shares, matrix)
    return np.asarray(whole)


def _root(a: Matrix, terms: Mapping[float, Matrix], guess: complex) -> complex | None:
    """The root next to a guess, by Newton's method for the root and its vector; None: there is
    none."""
    n, s = len(a), guess
    vector: Complexes | None = None
    for _ in range(ROOT.most_steps):
        matrix = s * np.eye(n) - a.astype(np.complex128)
        slope = np.eye(n, dtype=np.complex128)
        for time, term in terms.items():
            delayed = term * np.exp(-s * time)
            matrix -= delayed
            slope += time * delayed
        if vector is None:
            vector = np.linalg.svd(matrix)[2][-1].conj()
        bordered = np.zeros((n + 1, n + 1), dtype=np.complex128)
        bordered[:n, :n], bordered[:n, n] = matrix, slope @ vector
        bordered[n, :n] = vector.conj()
        right = np.concatenate([-matrix @ vector, [0.0]])
        step = np.linalg.lstsq(bordered, right, rcond=None)[0]
        vector = vector + step[:n]
        vector /= np.linalg.norm(vector)
        s += complex(step[n])
        if not np.isfinite(s) or abs(s - guess) > ROOT.near * (abs(guess) + 1.0 / max(terms)):
            return None
        if abs(step[n]) <= ROOT.closed * (abs(s) + 1.0 / max(terms)):
            return complex(s.real, 0.0) if abs(s.imag) <= ROOT.closed * abs(s) else s
    return None
