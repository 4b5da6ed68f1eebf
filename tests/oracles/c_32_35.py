"""Independent solutions of the swinging Atwood machines (paper C, Eqs 61 to 80), plain scipy.

C32  l'' = (l phi'^2 - g (mu - cos phi))/(mu + 1),  phi'' = -(2 l' phi' + g sin phi)/l
C33  Mt = M + m + 2 Ip/R^2,  phi'' = (-2 l' phi' + R phi'^2 - g sin phi)/l,
     l'' = R phi'' + (m l phi'^2 - g (M - m cos phi))/Mt
C34  S = k l2 + c l2', r = l20 + l2, d = phi2 - phi1, N = M (g + l1''),
     l1'' = (m1 l1 phi1'^2 + m1 g cos phi1 - M g + S cos d)/(M + m1),
     l2'' = r phi2'^2 - S (1/m1 + 1/m2) + N cos d/m1,
     phi1'' = (-2 l1' phi1' - g sin phi1 + S sin d/m1)/l1,
     phi2'' = (-2 l2' phi2' - N sin d/m1)/r
C35  as C34 with N = M g and (M + m1) in l1'' replaced by m1
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from oracles.c_common import Array, Exit, Mode, Path, integrate, smooth
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, root

G = 9.81  # m/s^2


def atwood_rates(x: Array, mu: float) -> Array:
    """Rates of l, l', phi, phi'."""
    length, v, phi, w = x
    a = (length * w * w - G * (mu - math.cos(phi))) / (mu + 1)
    return np.array([v, a, w, -(2 * v * w + G * math.sin(phi)) / length])


def atwood(mu: float, times: ArrayLike, l_0: float = 1.0, phi_0: float = math.pi / 2) -> Array:
    """l [m], l', phi [rad], phi' (4, N) of C32 from rest."""
    return smooth(lambda t, x: atwood_rates(x, mu), [l_0, 0.0, phi_0, 0.0], times, rtol=1e-13)


def atwood_stopped(mu: float, start: ArrayLike, times: ArrayLike, l_min: float) -> Path:
    """C32 with the inelastic stop of the mass at the pulley: held while the rope would pull."""

    def held(t: float, x: Array) -> Array:
        a = atwood_rates(x, mu)
        return np.array([0.0, 0.0, a[2], a[3]])

    def fall(t: float, x: Array) -> tuple[str, Array]:
        after = np.array([l_min, 0.0, x[2], x[3]])
        return ("held" if atwood_rates(after, mu)[1] < 0 else "free"), after

    modes = {
        "free": Mode(lambda t, x: atwood_rates(x, mu), [Exit(lambda t, x: x[0] - l_min, fall)]),
        "held": Mode(held, [Exit(lambda t, x: -atwood_rates(x, mu)[1], lambda t, x: ("free", x))]),
    }
    return integrate(modes, "free", start, times, max_step=0.05)


class Brake(NamedTuple):
    """A closed brake orbit: the mass ratio, and the time in s at which the machine rests again."""

    mu: float
    time: float


def brake_orbit(mu: float) -> Brake:
    """The closed orbit from rest at l = 1, phi = pi/2 whose mass ratio is nearest to `mu`.

    An orbit that comes to rest elsewhere goes back the way it came, and is closed. Shooting: from
    each of the first deep minima of the kinetic energy Newton's search in (mass ratio, time) for
    l' = phi' = 0; of the orbits found, the nearest, and its first rest.
    """

    def rates_at_rest(p: Array) -> Array:
        run = smooth(lambda t, x: atwood_rates(x, p[0]), START, [p[1]], rtol=1e-13)
        return np.asarray(run[[1, 3], -1])

    def kinetic(x: Array) -> Array:
        return np.asarray((mu + 1) * x[1] ** 2 / 2 + (x[0] * x[3]) ** 2 / 2)

    times = np.linspace(0.0, 5.0, 5001)
    energy = kinetic(smooth(lambda t, x: atwood_rates(x, mu), START, times))
    low = (energy[1:-1] < energy[:-2]) & (energy[1:-1] < energy[2:]) & (energy[1:-1] < 1.0)
    found = [root(rates_at_rest, [mu, time], tol=1e-12) for time in times[1:-1][low][:3]]
    rests = [Brake(float(f.x[0]), float(f.x[1])) for f in found if f.success and f.x[1] > 0.1]
    return min(rests, key=lambda rest: (round(abs(rest.mu - mu), 8), rest.time))


START = (1.0, 0.0, math.pi / 2, 0.0)


def smile(low: float, high: float) -> float:
    """The mass ratio at which phi first passes zero with l' = 0: another way to the first orbit."""

    def miss(mu: float) -> float:
        def bottom(t: float, x: Array) -> float:
            return float(x[2])

        bottom.terminal = True  # type: ignore[attr-defined]
        run = solve_ivp(
            lambda t, x: atwood_rates(x, mu),
            (0.0, 2.0),
            START,
            method="DOP853",
            events=[bottom],
            rtol=1e-12,
            atol=1e-13,
        )
        return float(run.y_events[0][0][1])

    return float(brentq(miss, low, high, xtol=1e-13))


def pulleys(M: float, m: float, R: float, Ip: float, start: ArrayLike, times: ArrayLike) -> Array:
    """l [m], l', phi [rad], phi' (4, N) of C33."""
    Mt = M + m + 2 * Ip / R**2

    def rates(t: float, x: Array) -> Array:
        length, v, phi, w = x
        turn = (-2 * v * w + R * w * w - G * math.sin(phi)) / length
        pull = (m * length * w * w - G * (M - m * math.cos(phi))) / Mt
        return np.array([v, R * turn + pull, w, turn])

    return smooth(rates, start, times, rtol=1e-13)


def pulley_inertia(M: float, m: float, R: float, h: float, fall: float) -> float:
    """Ip [kg m^2] by solving h = a fall^2/2 with a of the machine at phi = 0 (corrected Eq 70)."""
    a = 2 * h / fall**2
    effective = (M - m) * G / a
    return (effective - M - m) * R**2 / 2


class Modified(NamedTuple):
    """Parameters of C34; `inertia` is 0 for C35, which leaves M's inertia out."""

    M: float = 15.0
    m1: float = 3.5
    m2: float = 3.7
    l20: float = 1.0
    k: float = 400.0
    c: float = 0.0
    inertia: float = 1.0

    def outward(self, x: Array) -> float:
        """What pulls m1 outward along its rope, but for the rope itself [N]."""
        l1, _, l2, v2, phi1, w1, phi2, _ = x
        S = self.k * l2 + self.c * v2
        pull = self.m1 * l1 * w1 * w1 + self.m1 * G * math.cos(phi1)
        return float(pull + S * math.cos(phi2 - phi1))

    def tension(self, x: Array) -> float:
        """N [N] of the rope while l1 is free."""
        a = (self.outward(x) - self.M * G) / (self.inertia * self.M + self.m1)
        return float(self.M * (G + self.inertia * a))

    def rates(self, x: Array, held: bool = False) -> Array:
        """Rates of l1, l1', l2, l2', phi1, phi1', phi2, phi2'; held: l1 rests on its barrier."""
        l1, v1, l2, v2, phi1, w1, phi2, w2 = x
        S, r, d = self.k * l2 + self.c * v2, self.l20 + l2, phi2 - phi1
        N = self.outward(x) if held else self.tension(x)
        # the balance of m1 along its rope: m1 l1'' = outward - N
        a1 = 0.0 if held else (self.outward(x) - N) / self.m1
        a2 = r * w2**2 - S * (1 / self.m1 + 1 / self.m2) + N * math.cos(d) / self.m1
        b1 = (-2 * v1 * w1 - G * math.sin(phi1) + S * math.sin(d) / self.m1) / l1
        b2 = (-2 * v2 * w2 - N * math.sin(d) / self.m1) / r
        return np.array([v1, a1, v2, a2, w1, b1, w2, b2])

    def energy(self, x: Array, counterweight: bool = True) -> Array:
        """T + U [J] by Cartesian positions; without M l1'^2/2 where the counterweight is out."""
        l1, v1, l2, v2, phi1, w1, phi2, w2 = x
        r = self.l20 + l2
        u1 = v1 * np.sin(phi1) + l1 * w1 * np.cos(phi1)
        s1 = -v1 * np.cos(phi1) + l1 * w1 * np.sin(phi1)
        u2 = u1 + v2 * np.sin(phi2) + r * w2 * np.cos(phi2)
        s2 = s1 - v2 * np.cos(phi2) + r * w2 * np.sin(phi2)
        y1 = -l1 * np.cos(phi1)
        y2 = y1 - r * np.cos(phi2)
        kinetic = self.m1 * (u1**2 + s1**2) / 2 + self.m2 * (u2**2 + s2**2) / 2
        if counterweight:
            kinetic = kinetic + self.M * v1**2 / 2
        potential = self.k * l2**2 / 2 + G * (self.M * l1 + self.m1 * y1 + self.m2 * y2)
        return np.asarray(kinetic + potential, dtype=float)


def modified(machine: Modified, l1_0: float, times: ArrayLike) -> Array:
    """The states (8, N) of C34 or C35 from rest at phi1 = pi/6, phi2 = -pi/6, without a barrier."""
    return smooth(lambda t, x: machine.rates(x), modified_start(l1_0), times, rtol=1e-13)


def modified_start(l1_0: float) -> Array:
    """l1, l1', l2, l2', phi1, phi1', phi2, phi2' at the start."""
    return np.array([l1_0, 0.0, 0.0, 0.0, math.pi / 6, 0.0, -math.pi / 6, 0.0])


def modified_stopped(
    machine: Modified, l1_0: float, times: ArrayLike, l_min: float, paper_law: bool = False
) -> Path:
    """C34 with the barrier l1 = l_min: impact, hold, and release where the force turns round."""

    def impact(t: float, x: Array) -> tuple[str, Array]:
        after, d = x.copy(), x[6] - x[4]
        after[0], after[1] = l_min, 0.0
        if not paper_law:
            after[3] += x[1] * math.cos(d)
            after[7] -= x[1] * math.sin(d) / (machine.l20 + x[2])
        return ("held" if machine.outward(after) < machine.M * G else "free"), after

    modes = {
        "free": Mode(lambda t, x: machine.rates(x), [Exit(lambda t, x: x[0] - l_min, impact)]),
        "held": Mode(
            lambda t, x: machine.rates(x, held=True),
            [Exit(lambda t, x: machine.M * G - machine.outward(x), lambda t, x: ("free", x))],
        ),
    }
    return integrate(modes, "free", modified_start(l1_0), times, max_step=0.02)


def slack_times(machine: Modified, l1_0: float, end: float) -> list[float]:
    """The times at which the rope's tension N falls through zero, without a barrier."""

    def tension(t: float, x: Array) -> float:
        return machine.tension(x)

    tension.direction = -1.0  # type: ignore[attr-defined]
    run = solve_ivp(
        lambda t, x: machine.rates(x),
        (0.0, end),
        modified_start(l1_0),
        method="DOP853",
        events=[tension],
        max_step=0.01,
        rtol=1e-12,
        atol=1e-13,
    )
    return [float(t) for t in run.t_events[0]]


def printed_rates(p: Modified, x: Array) -> Array:
    """The rates by Eqs 77 to 80, term by term as they are printed."""
    l1, v1, l2, v2, phi1, w1, phi2, w2 = x
    M, m1, m2, l20, k, c, _ = p
    s21, c21 = math.sin(phi2 - phi1), math.cos(phi2 - phi1)
    sin, cos = math.sin, math.cos
    a1 = (
        -G * m2 * sin(phi2) * s21 / m1
        - G * m2 * cos(phi2) * c21 / m1
        + c * v2 * c21 / m1
        + k * l2 * c21 / m1
        + l1 * w1**2
        + G * m2 * cos(phi1) / m1
        + G * cos(phi1)
        - M * G / m1
    )
    a2 = (
        G * m2 * sin(phi1) * s21 / m1
        + G * sin(phi1) * s21
        - G * m2 * cos(phi1) * c21 / m1
        - G * cos(phi1) * c21
        + M * G * c21 / m1
        + l2 * w2**2
        + l20 * w2**2
        + G * m2 * cos(phi2) / m1
        + G * cos(phi2)
        - c * v2 / m2
        - c * v2 / m1
        - k * l2 / m2
        - k * l2 / m1
    )
    b1 = (
        -G * m2 * cos(phi2) * s21 / (m1 * l1)
        + c * v2 * s21 / (m1 * l1)
        + k * l2 * s21 / (m1 * l1)
        + G * m2 * sin(phi2) * c21 / (m1 * l1)
        - 2 * v1 * w1 / l1
        - G * m2 * sin(phi1) / (m1 * l1)
        - G * sin(phi1) / l1
    )
    below = m1 * l2 + l20 * m1
    b2 = (
        G * m2 * cos(phi1) * s21 / below
        + G * m1 * cos(phi1) * s21 / below
        - M * G * s21 / below
        + G * m2 * sin(phi1) * c21 / below
        + G * m1 * sin(phi1) * c21 / below
        - 2 * m1 * v2 * w2 / below
        - G * m2 * sin(phi2) / below
        - G * m1 * sin(phi2) / below
    )
    return np.array([v1, a1, v2, a2, w1, b1, w2, b2])
