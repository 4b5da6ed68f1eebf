"""How the statements of C01 to C18 are measured."""

from __future__ import annotations

from collections.abc import Callable
from math import pi, sqrt

import numpy as np
from scipy.optimize import brentq
from scipy.special import j0, j1, mathieu_a, y0, y1

from tracewire.analyse import floquet
from tracewire.paper.runs import Systems, largest
from tracewire.paper.statement import Measure

CHOSEN = "The paper prints no numbers here; those of the diagram are chosen."
W0 = sqrt(9.81)


def radius(name: str, period: float | str, preset: str, **parameters: float) -> Measure:
    """The largest modulus of a multiplier of a linear system."""
    return lambda s: s.floquet(name, period, preset, **parameters).radius


def rate(name: str, period: float | str, preset: str = "", **parameters: float) -> Measure:
    """The growth rate of a linear system in 1/s."""
    return lambda s: s.growth(name, period, preset, **parameters)


def edge(
    name: str, period: float, over: str, low: float, high: float, preset: str = "", **more: float
) -> Measure:
    """The value of a parameter between `low` and `high` where a linear system loses stability."""

    def find(s: Systems) -> float:
        def margin(value: float) -> float:
            return s.floquet(name, period, preset, **{over: value}, **more).margin

        return float(brentq(margin, low, high, xtol=1e-9))

    return find


def meissner_trace(r: float, omega: float) -> float:
    """Of the map over a period of y'' + (1 + r sgn sin omega t) y = 0, r <= 1."""
    half, (a, b) = pi / omega, (sqrt(1 + r), sqrt(1 - r))
    turned = (a / b + b / a) * np.sin(a * half) * np.sin(b * half)
    return float(2 * np.cos(a * half) * np.cos(b * half) - turned)


def liouville(s: Systems) -> float:
    return float(np.linalg.det(s.floquet("c01", 2 * pi, "C01").monodromy))


def mathieu_trace(s: Systems) -> float:
    """Of the map over a period pi, at a = a_1(q): the even solution has the multiplier -1."""
    a = float(mathieu_a(1, 0.2))
    return float(np.trace(s.floquet("c03", pi, "C03", a=a, q=0.2).monodromy))


def balance(s: Systems) -> float:
    """The part of cos 2t in the periodic state; the pump of sin 4t adds odd harmonics to it."""
    run = s.run("c04", "C04")
    waves = [f(n * run.t) for n in (2, 6, 10, 14) for f in (np.cos, np.sin)]
    return float(np.linalg.lstsq(np.array(waves).T, run["x"], rcond=None)[0][0])


def meissner(preset: str, omega: float) -> Measure:
    return lambda s: float(np.trace(s.floquet("c06", 2 * pi / omega, preset).monodromy))


def period(preset: str) -> Measure:
    """From the time of a quarter, where phi falls through zero."""

    def find(s: Systems) -> float:
        run = s.run("c07", preset)
        n = int(np.argmax(run["phi"] <= 0.0))
        t, phi, phi_dot = run.t[n], run["phi"][n], run["phi_dot"][n]
        return float(4 * (t - phi / phi_dot))  # a zero of phi, where phi'' is zero, too

    return find


def arc(signal: str) -> Measure:
    def find(s: Systems) -> float:
        run = s.run("c09", "C09")
        compared = run["phi"] * (1 + 0.2 * np.cos(run.t)) if signal == "arc" else run["phi"]
        return largest(run["u"] - compared)

    return find


def bessel(s: Systems) -> float:
    """Eq 18 on the ramp: x = 2 sqrt(g l)/v, phi = (a J1(x) + b Y1(x))/x, from rest at phi_0."""
    run, v = s.run("c13", "C13lin"), 0.1
    x = 2 * np.sqrt(9.81 * run["l"]) / v
    start = float(x[0])
    # d/dx (J1/x) = -J2/x; J2 = 2 J1/x - J0
    rates = [-(2 * f1(start) / start - f0(start)) / start for f0, f1 in ((j0, j1), (y0, y1))]
    values = [f(start) / start for f in (j1, y1)]
    a, b = np.linalg.solve([values, rates], [0.1, 0.0])
    return largest(run["phi"] - (a * j1(x) + b * y1(x)) / x) / 0.1


def printed_ramp(signal: str) -> Measure:
    def find(s: Systems) -> float:
        run = s.run("c13", "C13lin")
        return largest(run[signal] - run["phi"]) / 0.1

    return find


def decay(preset: str, beta: float) -> Measure:
    """The mean of the two exponents of C16, 1/s."""

    def find(s: Systems) -> float:
        return float(np.mean(s.floquet("c16", 2 * pi / beta, preset).exponents.real))

    return find


def slow(preset: str) -> Measure:
    """The relative error of Eq 23's frequency against the argument of the multiplier."""

    def find(s: Systems) -> float:
        run = s.run("c16", preset)
        beta, printed = run.parameters["beta"], run.parameters["omega"]
        multiplier = s.floquet("c16", 2 * pi / beta, preset).multipliers[0]
        return abs(1 - printed / (abs(float(np.angle(multiplier))) * beta / (2 * pi)))

    return find


def curves(preset: str) -> Measure:
    def find(s: Systems) -> float:
        run = s.run("c16", preset)
        return float(np.std(run["analytic"] - run["x"]) / np.std(run["x"]))

    return find


def averaged(signal: str) -> Measure:
    """The range of a Hamiltonian along the motion, in parts of that of the printed one's."""

    def find(s: Systems) -> float:
        run = s.run("c17", "C17", eps=0.025, t_end=400.0)
        return float(np.ptp(run[signal]) / np.ptp(run["H_printed"]))

    return find


def falls(name: str, preset: str) -> Callable[[Systems], float]:
    return lambda s: largest(s.run(name, preset)["phi"])


def slower(s: Systems) -> float:
    rest = {"u": 0.0, "u_dot": 0.0, "phi": 0.0, "phi_dot": 0.0}
    whole = floquet(s.model("c09"), 2 * pi, preset="C09", start=rest).exponents[0].real
    return s.growth("c10", 2 * pi, "C10") / float(whole)


def lost(s: Systems) -> float:
    energy = s.run("c12_vertical_pivot_damping", "C12c")["sway_energy"]
    return float(energy[-1] / energy[0])


C16_GAMMA = "the mean of the two exponents, 1/s"
