"""Independent solutions of the linear equations of paper C: C01 to C06, C08 to C10, C14 to C18.

Each is x'' = -damping(t) x' - stiffness(t) x, written from the equations; states (2, N) are x, x'.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike
from oracles.c_common import Array, Known, Leave, Mode, integrate, smooth
from scipy.linalg import eig

Coefficient = Callable[[float], float]
Pair = tuple[float, float]


def hill(
    times: ArrayLike,
    start: ArrayLike,
    stiffness: Coefficient,
    damping: Coefficient = lambda t: 0.0,
    drive: Coefficient = lambda t: 0.0,
) -> Array:
    """x'' + damping(t) x' + stiffness(t) x = drive(t)."""

    def rates(t: float, y: Array) -> Pair:
        return y[1], drive(t) - damping(t) * y[1] - stiffness(t) * y[0]

    return smooth(rates, start, times)


def damped_hill(
    t: ArrayLike, start: ArrayLike, *, b0: float, b1: float, w2: float, h: float
) -> Array:
    """C01, Eqs 1 and 21."""
    return hill(t, start, lambda t: w2 * (1 + h * np.cos(2 * t)), lambda t: b0 + b1 * np.cos(t))


def mathieu(t: ArrayLike, start: ArrayLike, *, a: float, beta: float) -> Array:
    """C02, Eq 2."""
    return hill(t, start, lambda t: a + beta * np.cos(t))


def canonical_mathieu(t: ArrayLike, start: ArrayLike, *, a: float, q: float) -> Array:
    """C03, Eq 3."""
    return hill(t, start, lambda t: a - 2 * q * np.cos(2 * t))


def driven(t: ArrayLike, start: ArrayLike, *, w0: float, b0: float, h0: float, E0: float) -> Array:
    """C04, Eqs 4 and 5."""
    return hill(
        t,
        start,
        lambda t: w0**2 * (1 + h0 * np.sin(2 * w0 * t)),
        lambda t: w0 * b0,
        lambda t: E0 * np.sin(w0 * t),
    )


def two_harmonics(t: ArrayLike, start: ArrayLike, *, c0: float, c1: float, c2: float) -> Array:
    """C05, Eq 6."""
    return hill(t, start, lambda t: c0 + c1 * np.cos(2 * t) + c2 * np.cos(4 * t))


def meissner(t: ArrayLike, start: ArrayLike, *, r: float, omega: float) -> Array:
    """C06, Eq 7: restarted at every switch."""

    def mode(side: int) -> Mode:
        return Mode(lambda t, y: (y[1], -(1 + r * side) * y[0]))

    def to(side: str) -> Leave:
        return lambda t, y: (side, y)

    half = np.pi / omega
    switches = range(1, int(np.asarray(t)[-1] / half) + 1)
    known = [Known(n * half, to("low" if n % 2 else "high")) for n in switches]
    return integrate({"high": mode(1), "low": mode(-1)}, "high", start, t, known=known).states


def meissner_trace(r: float, omega: float) -> float:
    """C06: the trace of the map over a period 2 pi/omega, in closed form; r above 1 as well."""
    half = np.pi / omega
    first, second = np.sqrt(complex(1 + r)), np.sqrt(complex(1 - r))
    a, b = first * half, second * half
    both = 2 * np.cos(a) * np.cos(b) - (first / second + second / first) * np.sin(a) * np.sin(b)
    return float(both.real)


def hill_trace(mean: float, harmonics: ArrayLike, terms: int = 24) -> float:
    """The trace over pi of y'' + (mean + sum harmonics[n] cos(2 (n + 1) t)) y = 0.

    Not by integration: y = exp(i nu t) sum c_k exp(2 i k t) makes it a quadratic eigenproblem in
    nu, of 2 terms + 1 harmonics; the trace is 2 cos(pi nu).
    """
    size = 2 * terms + 1
    k = 2.0 * np.arange(-terms, terms + 1)
    stiffness = mean * np.eye(size)
    for n, amplitude in enumerate(np.ravel(harmonics), 1):
        stiffness += amplitude / 2 * (np.eye(size, k=n) + np.eye(size, k=-n))
    # (stiffness - (nu + k)^2) c = 0 as a linear problem in (c, nu c)
    zero, one = np.zeros((size, size)), np.eye(size)
    matrix = np.block([[zero, one], [stiffness - np.diag(k**2), -2 * np.diag(k)]])
    exponents, vectors = eig(matrix)
    centred = np.argmax(np.abs(vectors[terms]))
    return float((2 * np.cos(np.pi * exponents[centred])).real)


def mathieu_pendulum(
    t: ArrayLike, start: ArrayLike, *, s: float, alpha: float, delta: float, b: float
) -> Array:
    """C08, Eq 9."""
    return hill(t, start, lambda t: s * (alpha - delta * np.cos(t)), lambda t: b)


def length_hill(t: ArrayLike, start: ArrayLike, *, alpha: float, eps: float) -> Array:
    """C09, Eq 10, of u = l phi."""
    return hill(t, start, lambda t: (alpha + eps * np.cos(t)) / (1 + eps * np.cos(t)))


def truncation(t: ArrayLike, start: ArrayLike, *, alpha: float, eps: float) -> Array:
    """C10, Eq 11."""
    return hill(t, start, lambda t: alpha + eps * (1 - alpha) * np.cos(t))


def zero_mean(t: ArrayLike, start: ArrayLike, *, w0: float, h: float) -> Array:
    """C14, Eq 20."""
    return hill(t, start, lambda t: w0**2 * (1 + h * np.sin(2 * w0 * t)))


def unstable(t: ArrayLike, start: ArrayLike, *, w0: float, nu: float) -> Array:
    """C15, Eq 22."""
    return hill(t, start, lambda t: w0**2 * (1 + np.sin(nu * t)))


def fast(
    t: ArrayLike, start: ArrayLike, *, gamma: float, w0sq: float, lam: float, beta: float
) -> Array:
    """C16, Eq 24."""
    return hill(t, start, lambda t: w0sq * (1 + lam * np.sin(beta * t)), lambda t: 2 * gamma)


def inverted_linear(t: ArrayLike, start: ArrayLike, *, A: float, w: float) -> Array:
    """C18, Eqs 33 and 34 with one sine."""
    return hill(t, start, lambda t: A * w**2 * np.sin(w * t) - 1)
