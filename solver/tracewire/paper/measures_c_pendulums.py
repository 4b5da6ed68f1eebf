"""How the statements of C19 to C31 are measured."""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt

import numpy as np

from tracewire.analyse import spectrum
from tracewire.paper.runs import Systems, drift, largest
from tracewire.paper.statement import Measure
from tracewire.solve import Run, simulate

CHOSEN = "The paper prints no numbers here; those of the diagram are chosen."
FIRST = sqrt(9.8)
SECOND = sqrt(9.8 + 2 * 19.7 * 0.55**2 / 0.5)


def largest_of(name: str, preset: str, signal: str, **parameters: float) -> Measure:
    """The largest absolute value of a signal."""
    return lambda s: largest(s.run(name, preset, **parameters)[signal])


def natural(name: str, **parameters: float) -> Measure:
    """The angular frequency of a small free swing, from where it next passes zero."""

    def find(s: Systems) -> float:
        run = simulate(
            s.model(name),
            parameters=parameters,
            start={"phi": 1e-4, "phi_dot": 0.0},
            times=np.linspace(0.0, 3.0, 3001),
            rtol=1e-10,
        )
        n = int(np.argmax(run["phi"] <= 0.0))
        return float(pi / 2 / (run.t[n] - run["phi"][n] / run["phi_dot"][n]))

    return find


def times(run: Run, kind: str) -> list[float]:
    """When a run has events of a kind."""
    return [event.time for event in run.events if event.kind == kind]


def energy(name: str, preset: str, scale: str = "kinetic") -> Measure:
    def find(s: Systems) -> float:
        run = s.run(name, preset)
        return drift(run["energy"], largest(run[scale]))

    return find


def length_trace(preset: str) -> Measure:
    """Of the map over a period of the step length, for small swings."""

    def find(s: Systems) -> float:
        ends = []
        for unit in ({"phi": 1e-5, "phi_dot": 0.0}, {"phi": 0.0, "phi_dot": 1e-5}):
            run = simulate(
                s.model("c22"), preset=preset, start=unit, span=(0.1, 0.1 + pi / 3), rtol=1e-11
            )
            ends.append([run.final["phi"], run.final["phi_dot"]])
        return float(np.trace(np.array(ends).T) / 1e-5)

    return find


def step_trace(factor: float) -> float:
    """The same in closed form: two swings, and jumps of the rate by `factor` and back."""
    (c1, s1, w1), (c2, s2, w2) = (
        (cos(w * pi / 6), sin(w * pi / 6), w) for w in (sqrt(9.81 / 1.1), sqrt(9.81 / 0.9))
    )
    return 2 * c1 * c2 - s1 * s2 * (factor * w1 / w2 + w2 / (factor * w1))


def momentum_jump(s: Systems) -> float:
    """The largest relative jump of l² φ' where the length jumps between 1.1 and 0.9 m."""
    jumps = []
    for n, event in enumerate(s.run("c22", "C22_l2w").events):
        old, new = ((1.1, 0.9), (0.9, 1.1))[n % 2]
        before, after = old**2 * event.before["phi_dot"], new**2 * event.after["phi_dot"]
        jumps.append(abs(after / before - 1))
    return max(jumps)


def stop(s: Systems) -> float:
    return times(s.run("c23", "C23a"), "stick")[0]


def stays(s: Systems) -> float:
    run = s.run("c23", "C23a")
    return largest(run["theta_dot"][run.t > stop(s)])


def clutch(s: Systems) -> float:
    return float(len([e for e in s.run("c23", "C23b").events if e.block == "clutch"]))


def calmed(s: Systems) -> float:
    """The mass' late amplitude with the absorber, in parts of that without."""
    with_it, alone = s.run("c24", "C24"), s.run("c24", "C24", m=1e-9, M=5.5)
    late = with_it.t > 30
    return largest(with_it["y"][late]) / largest(alone["y"][late])


def mode(preset: str, side: float, omega: float) -> Measure:
    """How far both angles are from one cosine of the mode's frequency, parts."""

    def find(s: Systems) -> float:
        run = s.run("c25", preset)
        wave = 0.1 * np.cos(omega * run.t)
        return max(largest(run["phi1"] - wave), largest(run["phi2"] - side * wave)) / 0.1

    return find


def line(n: int) -> Measure:
    """The frequency of a line of phi1's spectrum in rad/s, the lowest first."""

    def find(s: Systems) -> float:
        model = s.model("c25")
        run = s.kept(
            "c25 long",
            lambda: simulate(
                model, preset="C25mix", times=np.linspace(0.0, 100.0, 4001), rtol=1e-9
            ),
        )
        lines = sorted(line.frequency for line in spectrum(run, "phi1", lines=2).lines)
        return 2 * pi * lines[n]

    return find


def slips(name: str, preset: str, n: int) -> Measure:
    return lambda s: times(s.run(name, preset), "slip")[n]


def cycle(s: Systems) -> float:
    """How much two periods of the limit cycle differ, parts."""
    slips = times(s.run("c30", "C30"), "slip")
    return abs((slips[2] - slips[1]) / (slips[1] - slips[0]) - 1)


def belt(name: str, preset: str) -> Measure:
    """The largest deviation from the belt's speed while the tank sticks, m/s."""

    def find(s: Systems) -> float:
        run = s.run(name, preset)
        off = 0.0
        ends = [*times(run, "slip"), float(run.t[-1]) + 1]
        for begin, end in zip([0.0, *times(run, "stick")], ends, strict=False):
            held = (run.t > begin) & (run.t < end)
            off = max(off, largest(run["x_dot"][held] - 0.2)) if held.any() else off
        return off

    return find


def stick_slip_period() -> float:
    """Of C30 with mu = mud while it slips, in closed form.

    It slips about the rest point x_s = mud Mt g/k with w = sqrt(k/Mt), from x_b = mus Mt g/k, until
    its speed is that of the belt again; then the belt carries it back to x_b.
    """
    M, k, g, speed, held, slipping = 10.0, 100.0, 9.81, 0.2, 0.4, 0.2
    w, begin, rest = sqrt(k / M), held * M * g / k, slipping * M * g / k
    phase = atan2(-speed / w, begin - rest)
    # x - rest = a cos(w t + phase) has the speed of the belt again at w t = pi - 2 phase, and then
    # x = 2 rest - begin
    return (pi - 2 * phase) / w + 2 * (begin - rest) / speed
