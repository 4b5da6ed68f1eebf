"""Independent solutions of the pendulums of paper C: C07, C09, C11 to C13, C17 and C18.

Written from the first-order equations; states (2, N) are the angle phi and its rate, with y and
its rate after them where the pivot moves by itself. SI units.
"""

from __future__ import annotations

from math import cos, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike
from oracles.c_common import Array, smooth
from scipy.special import jv, yv

Pair = tuple[float, float]
Four = tuple[float, float, float, float]


def constant_length(t: ArrayLike, start: ArrayLike, *, g: float, l0: float) -> Array:
    """C07, Eq 8."""
    return smooth(lambda t, y: (y[1], -g / l0 * sin(y[0])), start, t)


def periodic_length(
    t: ArrayLike, start: ArrayLike, *, alpha: float, eps: float, nonlinear: bool
) -> Array:
    """C09: Eq 10 in phi."""

    def rates(t: float, y: Array) -> Pair:
        length, rate = 1 + eps * cos(t), -eps * sin(t)
        height = sin(y[0]) if nonlinear else y[0]
        return y[1], -2 * rate / length * y[1] - alpha / length * height

    return smooth(rates, start, t)


def laboratory(t: ArrayLike, start: ArrayLike, *, g: float, l0: float, h: float, b: float) -> Array:
    """C11, Eq 12."""
    w0 = sqrt(g / l0)

    def rates(t: float, y: Array) -> Pair:
        length = l0 * (1 + h * sin(2 * w0 * t))
        rate = 2 * w0 * l0 * h * cos(2 * w0 * t)
        return y[1], -2 * rate / length * y[1] - 2 * b * y[1] - g / length * y[0]

    return smooth(rates, start, t)


def moved_pivot(
    t: ArrayLike, start: ArrayLike, *, g: float, length: float, Dy: float, b: float
) -> Array:
    """C12a, Eq 16 with the derived equation of the sway."""
    w = sqrt(g / length)

    def rates(t: float, y: Array) -> Pair:
        a = -4 * Dy * w**2 * sin(2 * w * t)
        return y[1], -(g + a) / length * sin(y[0]) - b * y[1]

    return smooth(rates, start, t)


def free_pivot(
    t: ArrayLike,
    start: ArrayLike,
    *,
    m1: float,
    m2: float,
    length: float,
    g: float,
    b: float,
    kp: float,
    kd: float,
) -> Array:
    """C12b, Eq 17: states phi, phi', y, y'; the accelerations eliminated by hand."""

    def rates(t: float, x: Array) -> Four:
        phi, w, y, v = x
        s, c = sin(phi), cos(phi)
        force = (m1 + m2) * g - kp * y - kd * v
        above = force - (m1 + m2) * g - b * v - m2 * length * w**2 * c + m2 * g * s**2
        a = above / (m1 + m2 * c**2)
        return w, -(g + a) * s / length, v, a

    return smooth(rates, start, t)


def damped_sway(
    t: ArrayLike, start: ArrayLike, *, g: float, length: float, K: float, k1: float, k2: float
) -> Array:
    """C12c: states phi, phi', y, y'."""

    def rates(t: float, x: Array) -> Four:
        phi, w, y, v = x
        a = K * w * sin(phi) - k2 * y - k1 * v
        return w, -(g + a) * sin(phi) / length, v, a

    return smooth(rates, start, t)


def ramp(
    t: ArrayLike, start: ArrayLike, *, g: float, l0: float, v: float, nonlinear: bool
) -> Array:
    """C13, Eq 18."""

    def rates(t: float, y: Array) -> Pair:
        height = sin(y[0]) if nonlinear else y[0]
        return y[1], -(2 * v * y[1] + g * height) / (l0 + v * t)

    return smooth(rates, start, t)


def ramp_exact(t: ArrayLike, phi0: float, *, g: float, l0: float, v: float) -> Array:
    """C13lin from rest: phi = (C J1(x) + D Y1(x))/x with x = 2 sqrt(g l)/v, and phi' (2, N)."""
    x0 = 2 * np.sqrt(g * l0) / v
    x = 2 * np.sqrt(g * (l0 + v * np.asarray(t))) / v
    # d/dx (Z1/x) = -Z2/x, and the Wronskian of J1/x and Y1/x is 2/(pi x^3)
    C, D = -phi0 * np.pi / 2 * x0**2 * yv(2, x0), phi0 * np.pi / 2 * x0**2 * jv(2, x0)
    rate = 2 * g / (v * x)  # dx/dt
    return np.array([(C * jv(1, x) + D * yv(1, x)) / x, -(C * jv(2, x) + D * yv(2, x)) / x * rate])


def parametric(
    t: ArrayLike, start: ArrayLike, *, eps: float, A: float, omega: float, s: float
) -> Array:
    """C17, Eq 25."""

    def rates(t: float, y: Array) -> Pair:
        return y[1], -sin(y[0]) * (1 + eps * A * cos((omega + eps * s) * t))

    return smooth(rates, start, t)


def averaged(
    t: ArrayLike, start: ArrayLike, *, eps: float, A: float, omega: float, s: float
) -> Array:
    """C17: the amplitude a and phase delta of phi' + i (omega/2) phi, averaged over a period."""
    mu = 1 / eps

    def rates(t: float, y: Array) -> Pair:
        a, delta = y
        z = 2 * a / omega
        pumped = 2 * jv(2, z) / z * sin(2 * delta)
        turned = mu * jv(1, z) - A * (jv(1, z) - jv(3, z)) / 2 * cos(2 * delta)
        return -eps * A * pumped, eps * (turned / a - s / 2 - mu * omega / 4)

    return smooth(rates, start, t)


def averaged_hamiltonian(
    a: ArrayLike, delta: ArrayLike, *, eps: float, A: float, omega: float, s: float, mu_of_J0: float
) -> Array:
    """C17, Eq 28; mu_of_J0 is mu = 1/eps in the corrected form, and 1 in the print."""
    z = 2 * np.asarray(a) / omega
    turning = -np.square(a) * (s / 2 + omega / (4 * eps)) - mu_of_J0 * omega * jv(0, z)
    return np.asarray(turning - A * omega * jv(2, z) * np.cos(2 * np.asarray(delta)))


def inverted(
    t: ArrayLike,
    start: ArrayLike,
    *,
    g: float,
    length: float,
    b: float,
    sines: tuple[tuple[float, float, float], ...],
) -> Array:
    """C18, Eqs 30 and 32: phi from above; `sines` are amplitude, frequency and phase of each."""

    def rates(t: float, y: Array) -> Pair:
        a = -sum(A * w**2 * sin(w * t + phase) for A, w, phase in sines)
        return y[1], (g + a) / length * sin(y[0]) - b * y[1]

    return smooth(rates, start, t)
