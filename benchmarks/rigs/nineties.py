"""What is hidden in the rigs from r89 on, and why other answers count, or do not.

- r89_rollers: rollers are pressed into their tracks and bend before they roll: Dahl's law with the
  exponent 1, which `hysteresis` is. The corner of Bouc and Wen has another shape and is worse by
  half. Dry friction that slips at once has 25 times the error. The leaves harden by 1.3 % at the
  largest deflection.
- r90_block: the block sticks and slips in turn at all four speeds, for as long as the belt runs:
  with friction of one level it would come to rest on the slipping belt. Bristles that bend by less
  than the laser sees rub in the same way. The belt has a seam.
- r91_heaters: heat goes through the board from each heater to the other. What each loses by it is
  in its free loss, so that the rise of the other one is missing, at both. One way alone has five
  times the error, losses that grow with the rise four times. Hot parts glow a little.
- r92_ball: water moves along with the ball, and eddies brake it. The spring is known: a softer one
  would move the place where the ball follows the hook slowly. A mass on a spring that is too stiff
  to be seen is the same as the water. Drag with the third power is worse on both runs. The water
  remembers where the ball came from.
- r93_slalom: another steering gear was built in. The tyres are free and take up what they can, at
  one speed nearly all; three speeds leave 12 % of the angle. A gyroscope that shows too little has
  half more error, as its accelerometer tells the same turn. The front tyres give way by 0.2 %.
- r94_crab: the inverter acts 57 ms after it is told. A lag leaves five times the error within 2 s.
  A crab that is seen late has seven times the error, as its load is seen in time; both would have
  to be late by the same. The rail is not level.
- r95_sand: the bed gets blocked, and passes less water in proportion to the level and to the time.
  A loss that grows with the time alone is worse by five times, laws of the level alone by more. The
  bed chokes a little where water is fast, and gets blocked faster at first.
- r96_bottle: the octave is in the sound of the loudspeaker. Air that is harder when it is pressed
  makes an octave with the square of its own pressure, which at the resonance would be far larger
  than below it. It is there, with 1 % of the octave.
- r97_keyway: a keyway makes the shaft softer in one direction: its stiffness goes up and down twice
  a turn, in proportion to the deflection. What is not balanced pulls once a turn. Either
  alone leaves half of the error or more. A coupling that is askew pulls twice a turn, by 3 %.
- r98_slide: bristles that bend by 24 um and slip easier where it is fast. Dry friction, also with
  more of it near rest, does not bend; Dahl's law bends, but slips at one level. All of the dry
  friction is hidden: none is declared. The screw has a ripple.
- r99_double: the joint between both rods is dry. At the shoulder, or as drag, dry friction is worse
  by three times and more on the first two runs. The air brakes the lower rod.
- r100_boat: below 9 % of the stick the screw does not turn, and eddies brake the hull. Dry friction
  would stop a boat that glides with the stick in its middle. Drag with the third power is worse on
  all runs. The water of the pool drifts.
- r101_crack: a crack that is open makes the beam softer on one side, by a share that is the same at
  all levels. A spring with a square grows with the level and is worse on all three runs. A linear
  spring on one side without a gap is the same law, as the spring of the beam is free. The crack
  closes softly and the beam hardens.
- r102_converter: it has 25 steps of 0.25 V. A dead zone, a zero that is off and a bend of the
  converter are smooth or small, and change nothing; another step is another converter. Its
  resistors are unequal.
- r103_arm: nothing. A cable pulls at the arm and the brushes brake one way more, below the noise.
- r104_four: nothing. One pump bends and a hose drips, below the noise.
- r105_plate: a slab of steel on the plate takes heat and gives it back, with 217 s. A drift of the
  loss follows it in one run, and not in the other. A hot plate loses more.
- r106_grindstone: a heavy side pulls once a turn. Speeds of a decay go up and down with it, which
  no friction does. The rock to and fro at the end shows where it hangs. A strap rubs over half a
  turn: a friction of the same kind of place, and a small one.
- r107_sledge: dry friction has more of it near rest. It sticks and slips: what falls with the rate
  makes the slips long. The boards under it rub unevenly, by 3 %.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from benchmarks.rigs.hidden import Truth

NINETIES: Mapping[str, Truth] = {
    "r89_rollers": Truth(
        "Stage on crossed rollers",
        hidden=("dahl @ forces",),
        sizes={"dahl.level": 0.11, "dahl.deflection": 1.4e-5, "dahl.exponent": 1.0},
        words="the leaves harden by 1.3 % besides",
        equal={"dahl @ forces": ("hysteresis @ forces",)},  # the same law with the exponent 1
        besides=("cubic_stiffness @ forces",),
    ),
    "r90_block": Truth(
        "Block on a belt",
        hidden=("stribeck @ forces",),
        sizes={"stribeck.level": 0.95, "stribeck.speed": 0.042},
        words="beside 2.3 N declared; a belt that rubs unevenly by 0.015 N on its way besides",
        equal={"stribeck @ forces": ("lugre @ forces",)},
        # the laser reads steps of 0.05 mm
        bounds={("lugre @ forces", "deflection"): (0.0, 5e-5)},
    ),
    "r91_heaters": Truth(
        "Two heaters on a board",
        hidden=("coupling_v @ first", "coupling_v @ second"),
        sizes={"coupling_v.c": -0.0062},
        words="of the losses of 0.037 and 0.032 W/K; hot parts that glow besides",
        besides=("quad_drag @ first", "quad_drag @ second"),
    ),
    "r92_ball": Truth(
        "Ball on a spring in water",
        hidden=("inertia @ forces", "quad_drag @ forces"),
        sizes={"inertia.m": 0.094, "quad_drag.c": 0.92},
        words="beside 362 g; water that remembers the way of the ball besides",
        equal={"inertia @ forces": ("elastic_load @ forces",)},
        # a mass on a spring that the frames of the camera do not see move
        bounds={("elastic_load @ forces", "period"): (0.0, 0.06)},
    ),
    "r93_slalom": Truth(
        "Car in a slalom",
        hidden=("drive_gain @ drive.wheel",),
        sizes={"drive_gain.gain": 15.6 / 17.8 - 1},
        words="of the angle, as the ratio is 17.8 and not 15.6; tyres that give way besides",
    ),
    "r94_crab": Truth(
        "Crab of a crane",
        hidden=("drive_delay @ drive.u",),
        sizes={"drive_delay.tau": 0.057},
        words="between the controller and the motor; a rail that is not level besides",
    ),
    "r95_sand": Truth(
        "Water through a bed of sand",
        hidden=("viscous_drift @ balance",),
        sizes={"viscous_drift.c": -1.5e-8},
        words="19 % of the outflow in 48 min; a bed that chokes by 0.8 % at 0.6 m besides",
        besides=("quad_drag @ balance",),
    ),
    "r96_bottle": Truth(
        "Bottle before a loudspeaker",
        hidden=("drive_2nd_harm @ drive.u",),
        sizes={"drive_2nd_harm.share": 0.042, "drive_2nd_harm.phase": 0.6},
        words="of the tone; air that is harder when it is pressed besides",
        besides=("quad_stiffness @ acceleration",),
    ),
    "r97_keyway": Truth(
        "Shaft with a keyway",
        hidden=("parametric @ forces", "harmonic @ forces"),
        sizes={
            "parametric.amplitude": 4300.0,
            "parametric.period": 1 / 27.4,
            "harmonic.amplitude": 0.36,
            "harmonic.period": 1 / 13.7,
        },
        words="2.3 % of the stiffness; a coupling that pulls twice a turn with 0.012 N besides",
        # a wave of another period is another law
        bounds={
            ("parametric @ forces", "period"): (0.0358, 0.0372),
            ("harmonic @ forces", "period"): (0.0705, 0.0755),
        },
        besides=("harmonic @ forces",),
    ),
    "r98_slide": Truth(
        "Cross slide of a lathe",
        hidden=("lugre @ forces",),
        sizes={
            "lugre.level": 38.0,
            "lugre.deflection": 2.4e-5,
            "lugre.peak": 0.2,
            "lugre.speed": 0.010,
        },
        words="a ripple of the screw of 0.3 % besides",
        besides=("cogging @ forces",),
    ),
    "r99_double": Truth(
        "Double pendulum",
        hidden=("coulomb @ elbow",),
        sizes={"coulomb.level": 1.5e-3},
        words="0.7 % of the gravity of the lower rod; air on it besides",
        besides=("quad_drag @ shoulder", "quad_drag @ elbow"),
    ),
    "r100_boat": Truth(
        "Model boat in a pool",
        hidden=("drive_dead_zone @ drive.u", "quad_drag @ forces"),
        sizes={"drive_dead_zone.zone": 9.0, "quad_drag.c": 5.2},
        words="in percent of the stick; a soft edge over 0.3 % and water that drifts besides",
    ),
    "r101_crack": Truth(
        "Beam with a crack",
        hidden=("asym_stiffness @ forces",),
        sizes={"asym_stiffness.k": 120.0},
        words="half the difference, 2.3 % of the spring; it closes softly over 8 um and the beam "
        "hardens besides",
        equal={"asym_stiffness @ forces": ("barrier_hi @ forces",)},
        # of the way of 1.8 mm
        bounds={("barrier_hi @ forces", "gap"): (0.0, 5e-5)},
        besides=("cubic_stiffness @ forces",),
    ),
    "r102_converter": Truth(
        "Filter behind a converter",
        hidden=("drive_quantiser @ drive.u",),
        sizes={"drive_quantiser.step": 0.25},
        words="a converter of 25 steps; unequal resistors that bend it by 3 mV besides",
        bounds={("drive_quantiser @ drive.u", "step"): (0.24, 0.26)},
    ),
    "r103_arm": Truth(
        "Arm with a pendulum",
        words="nothing is hidden; a cable and unequal brushes below the noise besides",
        clean=True,
    ),
    "r104_four": Truth(
        "Four tanks",
        words="nothing is hidden; a pump that bends and a hose that drips below the noise besides",
        clean=True,
    ),
    "r105_plate": Truth(
        "Hot plate under a slab",
        hidden=("viscous_load @ flows",),
        sizes={"viscous_load.c": 2.4, "viscous_load.lag": 520 / 2.4},
        words="behind a thin gap; a hot plate that loses 1.6 % more at 45 K besides",
        besides=("quad_drag @ flows", "cubic_damping @ flows"),
    ),
    "r106_grindstone": Truth(
        "Grindstone that runs out",
        hidden=("cogging @ acceleration",),
        sizes={"cogging.amplitude": 0.42, "cogging.pitch": 2 * math.pi},
        words="a heavy side; a strap that rubs over half a turn with 4 % of that besides",
        bounds={("cogging @ acceleration", "pitch"): (6.2, 6.36)},
        besides=("position_friction @ acceleration", "cogging @ acceleration"),
    ),
    "r107_sledge": Truth(
        "Sledge behind a spring",
        hidden=("stribeck @ forces",),
        sizes={"stribeck.level": 1.4, "stribeck.speed": 0.016},
        words="boards that rub unevenly by 3 % besides",
        besides=("position_friction @ forces", "cogging @ forces"),
    ),
}
