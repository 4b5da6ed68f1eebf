"""Paper C, section 7: what it states of the swinging Atwood machines C32 to C35."""

from __future__ import annotations

from collections.abc import Mapping
from math import sqrt

import numpy as np

from tracewire.paper.runs import Systems, drift, largest
from tracewire.paper.statement import Measure, Statement, about, above, below
from tracewire.solve import Event, Run, simulate

# the mass ratios of Figs 28 to 39
RATIOS = dict(zip(range(28, 40), (2, 3, 5, 6, 16, 19, 21, 24, 1.7, 2.4, 1.2, 1.6), strict=True))
# where the orbits near the labels of Figs 36 to 39 come to rest again, s
RESTS = {36: 0.9214, 37: 4.0847, 38: 4.5257, 39: 1.9447}
PRINTED = {36: "1.665", 37: "2.394", 38: "1.1727", 39: "1.555"}
C32 = "Eqs 61 to 69"


def drift_of(name: str, preset: str, signal: str) -> Measure:
    """The drift of a signal in parts of its start."""
    return lambda s: drift(s.run(name, preset)[signal])


def resets(run: Run, block: str) -> list[Event]:
    """The resets of a block, or of an event of the diagram."""
    return [event for event in run.events if event.block == block and event.kind == "reset"]


def _rest(preset: str, time: float) -> Measure:
    """The least speed near a time, in parts of the highest: zero where the orbit turns back."""

    def find(s: Systems) -> float:
        span = np.concatenate([[0.0], np.linspace(0.97 * time, 1.03 * time, 20001)])
        run = simulate(s.model("c32"), preset=preset, times=span, rtol=1e-10)
        return sqrt(float(np.min(run["kinetic"][1:])) / largest(s.run("c32", preset)["kinetic"]))

    return find


def _ratio(figure: int) -> Measure:
    return lambda s: s.run("c32", f"C32_{figure}_closed").parameters["mu"]


def _scale(s: Systems) -> float:
    large = s.run("c32", "C32_scale")
    small = simulate(s.model("c32"), preset="C32_30", times=large.t / sqrt(2.5), rtol=1e-9)
    return max(largest(large[name] / size - small[name]) for name, size in (("l", 2.5), ("phi", 1)))


def _without_radius(s: Systems) -> float:
    run = s.run("c33", "C33lim")
    other = simulate(s.model("c32"), preset="C32_29", times=run.t, rtol=1e-9)
    return max(largest(run[name] - other[name]) for name in ("l", "phi"))


def _fall(s: Systems) -> float:
    length = s.run("c33", "C33Ip")["l"]
    return float(length[0] - length[-1])


def _loss(s: Systems) -> float:
    """The energy lost against the damper's work, parts."""
    run = simulate(s.model("c34"), preset="C34c", times=np.arange(3001) / 1000, rtol=1e-9)
    work = float(np.trapezoid(5 * run["l2_dot"] ** 2, run.t))
    return abs(float(run["energy"][0] - run["energy"][-1]) / work - 1)


def _slack(s: Systems) -> float:
    return resets(s.run("c34", "C34c"), "slack")[0].time


def _tension(s: Systems) -> float:
    return abs(float(np.interp(_slack(s), *_fine_tension(s))))


def _fine_tension(s: Systems) -> tuple[np.ndarray, np.ndarray]:
    run = simulate(s.model("c34"), preset="C34c", times=np.linspace(0, 3, 30001), rtol=1e-9)
    return run.t, run["tension"] / run["tension"][0]


def _impacts(preset: str) -> Measure:
    return lambda s: float(len(resets(s.run("c34", preset), "events[0]")))


def _pushed(preset: str) -> Measure:
    """The largest jump of the velocity of the second mass at an impact, m/s."""

    def find(s: Systems) -> float:
        events = resets(s.run("c34", preset), "events[0]")
        return max(float(np.hypot(*(_velocity(e.after) - _velocity(e.before)))) for e in events)

    return find


def _velocity(state: Mapping[str, float]) -> np.ndarray:
    """Of m2, from the rates of the four coordinates."""
    r, one, two = 1.0 + state["l2"], state["phi1"], state["phi2"]
    along = np.array([np.sin(one), -np.cos(one)]) * state["l1_dot"]
    across = np.array([np.cos(one), np.sin(one)]) * state["l1"] * state["phi1_dot"]
    along2 = np.array([np.sin(two), -np.cos(two)]) * state["l2_dot"]
    across2 = np.array([np.cos(two), np.sin(two)]) * r * state["phi2_dot"]
    return np.asarray(along + across + along2 + across2)


def _least(s: Systems) -> float:
    return float(np.min(s.run("c34", "C34bar_consistent")["l1"]))


STATEMENTS = (
    *(
        Statement(
            f"C32 energy, Fig {figure}",
            f"At μ = {ratio:g} the machine keeps its energy.",
            f"{C32}, Fig {figure}",
            "drift over 20 s, parts",
            drift_of("c32", f"C32_{figure}", "energy"),
            below(1e-7),
        )
        for figure, ratio in RATIOS.items()
    ),
    Statement(
        "C32 integrable",
        "At μ = 3 there is a second integral.",
        "Section 7, Fig 29",
        "its drift over 20 s, parts",
        drift_of("c32", "C32_29", "second_integral"),
        below(1e-7),
    ),
    Statement(
        "C32 not integrable",
        "At μ = 2 the same is no integral.",
        "Section 7, Fig 28, control",
        "its drift over 20 s, parts",
        drift_of("c32", "C32_28", "second_integral"),
        above(0.1),
    ),
    *(
        Statement(
            f"C32 label {RATIOS[figure]:g}",
            f"At μ = {RATIOS[figure]:g} the orbit from rest is closed.",
            f"Fig {figure}",
            "least speed where it should rest, parts",
            _rest(f"C32_{figure}", time),
            below(3e-5),
            erratum=f"It closes at μ = {PRINTED[figure]}, which the label rounds too far.",
        )
        for figure, time in RESTS.items()
    ),
    *(
        Statement(
            f"C32 closed near {RATIOS[figure]:g}",
            "From rest to rest and back the way it came.",
            f"Fig {figure}, ratio by shooting",
            "least speed where it should rest, parts",
            _rest(f"C32_{figure}_closed", time),
            below(3e-5),
        )
        for figure, time in RESTS.items()
    ),
    *(
        Statement(
            f"C32 ratio near {RATIOS[figure]:g}",
            f"The literature has it closed at μ = {printed}.",
            f"Fig {figure}",
            "μ of the closed orbit, by shooting",
            _ratio(figure),
            about(float(printed), 0.5 * 10.0 ** -(len(printed) - 2)),
        )
        for figure, printed in PRINTED.items()
    ),
    Statement(
        "C32 scaling",
        "A longer rope makes the same orbit larger and slower, by √l.",
        C32,
        "largest difference of l/2.5 and φ",
        _scale,
        below(1e-6),
    ),
    Statement(
        "C33 energy",
        "The Hamiltonian of the machine with pulleys is kept.",
        "Eq 72, corrected",
        "drift over 5 s, parts",
        drift_of("c33", "C33a", "H"),
        below(1e-7),
    ),
    Statement(
        "C33 as printed",
        "Eq 72 as printed is kept.",
        "Eq 72",
        "drift over 5 s, parts",
        drift_of("c33", "C33a", "H_printed"),
        below(1e-7),
        erratum="Its second term needs 1/(m l²) for 1/l².",
    ),
    Statement(
        "C33 without radius",
        "For R → 0 it is the machine without pulleys.",
        "Eqs 66 to 72",
        "largest difference of l and φ",
        _without_radius,
        below(1e-6),
    ),
    Statement(
        "C33 inertia",
        "The time of a fall by h = 1 m tells the inertia of the pulleys.",
        "Eq 70, corrected",
        "fall in Δt = 0.65 s",
        _fall,
        about(1.0, 1e-8),
        "m",
        note="The printed bracket cannot be right by its units.",
    ),
    *(
        Statement(
            f"C34 energy, Fig {figure}",
            "The Modified machine keeps its energy for c = 0.",
            f"Eqs 73 to 76, Fig {figure}",
            "drift, parts",
            drift_of("c34", preset, "energy"),
            below(1e-7),
            note="Figs 41 and 42 with the corrected equations.",
        )
        for preset, figure in (("C34a", "41"), ("C34b", "42"))
    ),
    Statement(
        "C34 damper",
        "With c > 0 it loses what the damper takes.",
        "Eq 76, corrected",
        "difference of loss and work, parts",
        _loss,
        below(1e-5),
        note="Eq 76 prints 1/c for c/2.",
    ),
    Statement(
        "C35 as printed",
        "Eqs 77 to 80 keep the energy of Eqs 73, 74.",
        "Eqs 77 to 80",
        "drift over 10 s, parts",
        drift_of("c35", "C35a", "energy"),
        below(1e-7),
        erratum="They lack the inertia of M, as if the rope pulled with M g at all times.",
    ),
    Statement(
        "C35 what is kept",
        "They keep T + U without M l₁'²/2.",
        "Eqs 77 to 80, control",
        "drift over 10 s, parts",
        drift_of("c35", "C35a", "energy_printed"),
        below(1e-7),
    ),
    Statement(
        "C34 slack",
        "The rope would have to push from some time on, which is an event.",
        "Section 7",
        "tension at the event, parts of that at the start",
        _tension,
        below(1e-4),
    ),
    Statement(
        "C34 barrier",
        "The barrier stops the first mass at l_min = 0.1 m.",
        "After Eq 76",
        "least l₁",
        _least,
        about(0.1, 1e-9),
        "m",
        note="Read l₁ ≤ l_min for the printed l₁ ≥ 0.",
    ),
    Statement(
        "C34 barrier's impacts",
        "The mass comes to the barrier, is held, and let go.",
        "After Eq 76",
        "impacts within 4 s",
        _impacts("C34bar_consistent"),
        above(1.0),
    ),
    Statement(
        "C34 impact, consistent",
        "An impact of m₁ leaves m₂ alone: only a spring acts on it.",
        "After Eq 76, corrected",
        "largest jump of m₂'s velocity",
        _pushed("C34bar_consistent"),
        below(1e-8),
        "m/s",
    ),
    Statement(
        "C34 impact as printed",
        "Setting only l₁' to zero leaves m₂ alone.",
        "After Eq 76",
        "largest jump of m₂'s velocity",
        _pushed("C34bar_paper"),
        below(1e-8),
        "m/s",
        erratum="l₂' and φ₂' must jump, too; else m₂ is kicked, though only a spring acts on it.",
    ),
)
