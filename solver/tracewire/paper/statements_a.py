"""What paper A states of its double torsion pendulum: its motion, its print, its identification."""

from __future__ import annotations

from math import degrees, pi

import numpy as np

from tracewire.paper.identification import FLOOR, step_of
from tracewire.paper.runs import Systems, Vector, drift, largest
from tracewire.paper.statement import Measure, Statement, about, above, below, between
from tracewire.solve import simulate

PERIOD = 2 * pi / 3.9
STAGES = {"S1": "s1", "S2": "s2", "S3": "s3", "S4": "pendulum", "S5": "s5"}
SLIPS = 0.1  # of the largest rate: below that the disk creeps
OFF = dict.fromkeys(("kappa1_l", "kappa1_r", "kappa2_l", "kappa2_r"), 0.0)
OFF |= dict.fromkeys(("T_v1_l", "T_v1_r", "mu", "k1", "c1"), 0.0)
GENERATED = (
    "On a record that the final model generates, with noise of 0.05 deg: the authors' is not "
    "available. Up to M6 only the disk is compared; the step waveform that the authors drove it "
    "with first is left out, as the column's own motion is one."
)


def _contact(n: int) -> Measure:
    """The time of the n-th crossing of the pin's limit at phi1 > 0, s."""

    def find(s: Systems) -> float:
        events = s.run("pendulum").events
        return [e.time for e in events if e.guard == "phi1 - pin.limit"][n]

    return find


def _reach(signal: str) -> Measure:
    return lambda s: degrees(largest(s.run("pendulum")[signal]))


def _dwell(s: Systems) -> float:
    angle = np.degrees(np.abs(s.run("pendulum")["phi1"]))
    return float(np.mean(np.abs(angle - 13.6) < 0.2))


def _cycle(s: Systems, stage: str, signal: str) -> Vector:
    """A period of the steady motion, 2001 samples of both its ends."""
    times = np.concatenate([[0.0], 8 * PERIOD + np.linspace(0.0, PERIOD, 2001)])

    def make() -> Vector:
        run = simulate(s.model(STAGES[stage]), times=times, rtol=1e-9)
        return np.array([run["phi2"][1:], run["phi2_dot"][1:]])

    found = s.kept(("cycle", stage), make)
    return np.asarray(found[0 if signal == "phi2" else 1])


def _slips(stage: str) -> Measure:
    """How many times a period the disk slips."""

    def find(s: Systems) -> float:
        rate = np.abs(_cycle(s, stage, "phi2_dot"))
        fast = (rate > SLIPS * rate.max()).astype(int)
        return float(np.count_nonzero(np.diff(fast) == 1))

    return find


def _mirror(stage: str) -> Measure:
    """How far half a period later is from the mirror image, in parts of the largest angle."""

    def find(s: Systems) -> float:
        angle = _cycle(s, stage, "phi2")
        return largest(angle[:1000] + angle[1000:2000]) / largest(angle)

    return find


def _momentum(nT: float) -> Measure:
    """The drift of (B1 + B2) v1 + B2 v2 without torque on the column, parts."""

    def find(s: Systems) -> float:
        run = simulate(
            s.model("pendulum"),
            parameters=OFF | {"nT": nT},
            start={"phi1": 0.0, "phi1_dot": 0.5, "phi2_dot": -2.0},
            times=np.linspace(0.0, 0.3, 301),
            rtol=1e-10,
        )
        return drift((0.00135 + 0.0003) * run["phi1_dot"] + 0.0003 * run["phi2_dot"])

    return find


def _same_branch(s: Systems) -> float:
    """The change of phi1 where kappa2_r stands in both branches of Eq 23b, rad."""
    printed = s.run("pendulum", kappa2_l=0.0365)
    return largest(printed["phi1"] - s.run("pendulum")["phi1"])


def _runaway(s: Systems) -> float:
    """The largest |phi2| in 0.6 s where the beam springs push, as Eq 19 prints them, rad."""
    run = simulate(s.model("pendulum"), parameters={"k2": -0.7}, span=(0.0, 0.6))
    return largest(run["phi2"])


def _impact(preset: str) -> Measure:
    """The largest jump of the disk's absolute rate at an impact of the column, rad/s."""

    def find(s: Systems) -> float:
        events = [e for e in s.run("s5", preset).events if e.kind == "reset"]
        rates = ("phi1_dot", "phi2_dot")
        return max(abs(sum(e.after[n] - e.before[n] for n in rates)) for e in events)

    return find


def _pull(preset: str) -> Measure:
    """The largest torque with which the pin pulls the column back, N m."""

    def find(s: Systems) -> float:
        model = s.model("pendulum", ("phi1", "pin.torque"))
        run = simulate(model, preset=preset, rtol=1e-9)
        return max(0.0, -float(np.min(run["pin.torque"] * np.sign(run["phi1"]))))

    return find


def _criterion(name: str) -> Measure:
    return lambda s: step_of(s, name).disk


def _fall(name: str) -> Measure:
    """The disk's criterion after a step in parts of that before it."""
    return lambda s: step_of(s, name).disk / step_of(s, name).before


def _column(s: Systems) -> float:
    return step_of(s, "M7").column / step_of(s, "M6").column


FALL = "criterion after, parts of that before"

STATEMENTS = (
    Statement(
        "A first contact",
        "The column hits its pin at +13.6 deg.",
        "Fig 10, section 5",
        "time",
        _contact(0),
        about(0.3900807, 1e-6),
        "s",
        note="The time is of an independent solution.",
    ),
    Statement(
        "A leaves",
        "It leaves the pin again.",
        "Fig 10, section 5",
        "time",
        _contact(1),
        about(0.4624607, 1e-6),
        "s",
        note="The time is of an independent solution.",
    ),
    Statement(
        "A pin",
        "The pin holds the column at ±13.6 deg.",
        "Figs 9, 11a",
        "largest |φ1|",
        _reach("phi1"),
        between(13.6, 14.3),
        "deg",
    ),
    Statement(
        "A dwell",
        "It dwells there, so that the disk sees a step waveform.",
        "Section 5.3, Fig 9",
        "part of the time within 0.2 deg of the pin",
        _dwell,
        between(0.3, 0.8),
    ),
    Statement(
        "A springs",
        "The disk reaches its springs at ±1.1 deg and goes beyond.",
        "Figs 7 to 10",
        "largest |φ2|",
        _reach("phi2"),
        between(1.1, 5.0),
        "deg",
    ),
    *(
        Statement(
            f"{stage} slips",
            "The disk sticks, and slips twice a period.",
            f"Section 5.3, {figure}",
            "slips a period",
            _slips(stage),
            about(2.0, 0.0),
            note="It slips where its rate exceeds a tenth of the largest.",
        )
        for stage, figure in (("S1", "Fig 7"), ("S2", "Fig 8"), ("S3", "Fig 9"), ("S4", "Fig 10"))
    ),
    Statement(
        "S1 symmetric",
        "The first model slips alike to both sides, the disk does not.",
        "Section 5.3, M5",
        "difference from the mirror image, parts",
        _mirror("S1"),
        below(0.01),
    ),
    *(
        Statement(
            f"{stage} asymmetric",
            "Its two slips differ, as the measured ones do.",
            f"Section 5.3, {what}",
            "difference from the mirror image, parts",
            _mirror(stage),
            above(0.05),
        )
        for stage, what in (("S2", "M6, Eq 21"), ("S3", "M7, Eqs 22, 23"), ("S4", "M8, Eq 24"))
    ),
    Statement(
        "A momentum",
        "Friction and springs between the bodies keep their momentum.",
        "Eqs 5, 18, corrected",
        "drift without torque on the column, parts",
        _momentum(1.0),
        below(1e-9),
    ),
    Statement(
        "A momentum as printed",
        "Friction acts on the column with the factor 2.",
        "Eqs 5, 18, 19",
        "drift without torque on the column, parts",
        _momentum(2.0),
        below(1e-9),
        erratum="φ2 is relative to the column, so that the factor is 1: 2 breaks the momentum.",
    ),
    Statement(
        "A springs as printed",
        "Eq 19 adds + k₂φ2.",
        "Eq 19",
        "largest |φ2| within 0.6 s",
        _runaway,
        below(0.1),
        "rad",
        erratum="With that sign the springs drive the disk away.",
    ),
    Statement(
        "A spring as printed",
        "Eq 23b has κ₂r in both branches.",
        "Eq 23b, Table 1",
        "change of φ1 against Table 1",
        _same_branch,
        below(1e-3),
        "rad",
        erratum="Table 1 has κ₂l = 0.0243 and κ₂r = 0.0365: read κ₂l for φ1 ≥ 0.",
    ),
    Statement(
        "A barrier pulls",
        "A Voigt element pulls while it is left.",
        "Eqs 4, 15",
        "largest pull of the pin",
        _pull("consistent"),
        above(1e-4),
        "N m",
        note="The paper does not mention it; the preset not_adhesive has barriers that push only.",
    ),
    Statement(
        "A barrier",
        "With the preset not_adhesive it does not.",
        "Eqs 4, 15, control",
        "largest pull of the pin",
        _pull("not_adhesive"),
        below(0.0),
        "N m",
    ),
    Statement(
        "S5 impact",
        "An inelastic impact of the column leaves the disk alone.",
        "Eq 20, corrected",
        "largest jump of the disk's absolute rate",
        _impact("consistent"),
        below(1e-9),
        "rad/s",
    ),
    Statement(
        "S5 impact as printed",
        "So does Eq 20, which resets φ1' only.",
        "Eq 20",
        "largest jump of the disk's absolute rate",
        _impact("printed_reset"),
        below(1e-9),
        "rad/s",
        erratum="φ2' is relative: it must jump against φ1', by (1+c_r)φ1'.",
    ),
    Statement(
        "A step M2",
        "A fit of the first model without ε, μ, B comes closer.",
        "M2, Fig 6",
        FALL,
        _fall("M2"),
        below(0.95),
        note=GENERATED,
    ),
    Statement(
        "A step M3",
        "With ε₁, ε₂, μ it comes closer.",
        "M3",
        FALL,
        _fall("M3"),
        below(0.95),
    ),
    Statement(
        "A step M4, M5",
        "With B₁, B₂ and 50 iterations it comes closer.",
        "M4, M5, Fig 7",
        FALL,
        _fall("M4, M5"),
        below(1.0),
    ),
    Statement(
        "A step M6",
        "Friction with two sides comes closer.",
        "M6, Eq 21, Fig 8",
        FALL,
        _fall("M6"),
        below(1.0),
    ),
    Statement(
        "A step M7",
        "The column, fitted to its own record, follows it well.",
        "M7, Eqs 22, 23, Fig 9",
        "the column's criterion, parts of that after M6",
        _column,
        below(0.1),
    ),
    Statement(
        "A step M8",
        "The final friction law is better than that of M7.",
        "M8, Eq 24, Fig 10",
        "the disk's criterion, parts of that after M7",
        lambda s: step_of(s, "M8").disk / step_of(s, "M7").disk,
        below(0.5),
    ),
    Statement(
        "A final",
        "The final model is sufficiently close to reality.",
        "Section 7",
        "the disk's criterion after M8, parts of the noise's",
        lambda s: step_of(s, "M8").disk / FLOOR,
        below(1.5),
    ),
)
