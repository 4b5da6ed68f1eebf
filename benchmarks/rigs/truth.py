"""What is hidden in each rig, how large it is, and which other answers are right, too."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

Labels = tuple[str, ...]
"""Effects, each as `effect @ place`."""


@dataclass(frozen=True)
class Truth:
    """What a rig hides, and what is right to answer.

    `hidden` are the effects, none where no block of the library is the law. `sizes` has their
    parameters in the units of the diagram (SI), as `effect.parameter`, and `words` says the rest.
    `equal` gives for a hidden effect others that are the same on these data. `answers` are sets of
    effects that are right instead of the hidden ones, `half` single ones that are a part of the
    truth. `law` is a place and the variable on which a missing force there depends, where the
    verdict `unexplained` that says so is right. `clean`: no effect at all is right. `bounds` are
    the least and the most of a parameter, by `effect @ place` and its name, without which an effect
    does not count as the one that is meant.
    """

    title: str
    hidden: Labels = ()
    sizes: Mapping[str, float] = field(default_factory=dict)
    words: str = ""
    equal: Mapping[str, Labels] = field(default_factory=dict)
    answers: tuple[Labels, ...] = ()
    half: Labels = ()
    law: tuple[str, str] | None = None
    clean: bool = False
    bounds: Mapping[tuple[str, str], tuple[float, float]] = field(default_factory=dict)

    def told(self) -> str:
        """What is hidden, with its sizes."""
        sizes = ", ".join(f"{name} {value:.4g}" for name, value in self.sizes.items())
        hidden = " + ".join(self.hidden) or "no block of the library"
        return f"{hidden} ({'; '.join(filter(None, (sizes, self.words)))})"


TRUTHS: Mapping[str, Truth] = {
    "r01_pendulum": Truth(
        "Physical pendulum with an encoder",
        hidden=("quad_drag @ acceleration",),
        sizes={"quad_drag.c": 0.05},
        words="per inertia, beside the declared viscous friction",
    ),
    "r02_base": Truth(
        "Mass on a shaker table",
        hidden=("cubic_stiffness @ acceleration", "coulomb @ acceleration"),
        sizes={"cubic_stiffness.k": 6.0e6, "coulomb.level": 0.25},
        words="22 % of the linear spring at the largest deflection",
    ),
    "r03_drive": Truth(
        "Two-mass drive under a speed controller",
        hidden=("backlash @ coupling",),
        sizes={"backlash.gap": 0.010, "backlash.k": 60.0},
        words="half the gap; the twist has a root mean square of 0.016 rad",
    ),
    "r04_motor": Truth(
        "Motor with a tachometer that reads 4 % too much",
        hidden=("coulomb @ shaft", "asym_coulomb @ shaft"),
        sizes={"coulomb.level": 0.0104, "asym_coulomb.level": 0.00208},
        words="in the units of the tachometer, 0.01248 forwards and 0.00832 backwards",
        equal={"asym_coulomb @ shaft": ("bias @ shaft",)},
    ),
    "r05_heater": Truth(
        "Heated block on a plate",
        words="radiation of the block, 0.010 m^2, 41 W at 259 degrees C beside 52 W declared",
        answers=(
            ("quad_stiffness @ heat1",),
            ("cubic_stiffness @ heat1",),
            ("quad_stiffness @ heat1", "cubic_stiffness @ heat1"),
        ),
        law=("heat1", "rise1"),
    ),
    "r06_tank": Truth(
        "Tank with an outlet",
        words="outflow of 3.6e-5 m^2 * sqrt(2 g level) instead of one in proportion to the level",
        half=("quad_stiffness @ balance", "bias @ balance"),
        law=("balance", "level"),
    ),
    "r07_crane": Truth(
        "Crane with an angle over a field bus",
        hidden=("sensor_delay @ sensor.theta", "viscous @ rod"),
        sizes={"sensor_delay.delay": 0.012, "viscous.c": 0.004},
    ),
    "r08_torsion": Truth(
        "Torsion pendulum with a potentiometer",
        hidden=("asym_stiffness @ acceleration", "sensor_offset @ sensor.phi"),
        sizes={"asym_stiffness.k": 0.35, "sensor_offset.offset": 0.02269},
        words="half the difference of the springs, 5.8 % of the spring",
    ),
    "r09_coil": Truth(
        "Series circuit with a coil that saturates",
        hidden=("cubic_stiffness @ current",),
        sizes={"cubic_stiffness.k": -10.0},
        words="25 % of the current of the linear coil at the largest flux",
    ),
    "r10_stage": Truth(
        "Flexure stage that warms up",
        words="a spring that goes up and down by 1 % in 47 s",
        answers=(("parametric @ forces",),),
        half=("stiffness_drift @ forces",),
        law=("forces", "x"),
        clean=True,
        bounds={("parametric @ forces", "period"): (42.0, 52.0)},
    ),
}
