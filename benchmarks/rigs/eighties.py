"""What is hidden in the rigs from r81 on, and why other answers count, or do not.

- r81_paste: starch in water gets thicker as it is sheared, with the third power of the rate. Drag
  with the square is another law: it is worse on all four runs. The starch settles, and the
  paste loses 2 % of its friction within a run; the trace may say so.
- r82_slider: below a duty of 6 % the bridge does not switch at all. More dry friction is in the
  free level of the rail, and acts against the rate: the controller brakes, so that duty and rate
  often have unlike signs. The dead zone is of the drive, and is right there alone. The rail rubs
  along the way in a wave of 0.5 %.
- r83_wire: a wire that is pulled aside gets longer, and is a spring with a third power. The sail
  is drag with the square of the rate; the third power of the rate is worse on all runs. The wire
  warms in its light and loses 0.02 % of its stiffness.
- r84_bowl: the water that sways is a mass on a spring, at 1.8 Hz. The mass of all is free, so that
  inertia is declared. A second wave of the water at 3.5 Hz has 3 % of the mass of the first.
- r85_rotor: nobody stopped the rotor in the bob. A gyroscope takes the rate of one axis to the
  torque of the other, with unlike signs, at both. A spring between both is a quarter of a wave
  off. The air brakes the bob, and the rotor runs out by 3 %.
- r86_relay: the leaf lifts a contact on a second leaf, which is a linear spring beyond a gap on one
  side. A round body on a wall that begins at rest is worse by two fifths on both runs, and a spring
  that is harder on one side has more than twice the error. Stops on both sides hardly
  help.
- r87_worm: the collar takes the thrust of the worm, and rubs in proportion to the torque. More or
  less torque is in the free inertia and friction: `drive_gain` changes nothing. Friction that is
  higher near rest and drag do not lower the error on the second run. The oil thins by 2 %, and the
  worm runs out a little once in a turn.
- r88_train: nothing. The floor leans and one place of the rails is dirty: both together are a
  tenth of the noise.
"""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.rigs.hidden import Truth

EIGHTIES: Mapping[str, Truth] = {
    "r81_paste": Truth(
        "Paddle in paste",
        hidden=("cubic_damping @ acceleration",),
        sizes={"cubic_damping.c": 0.009},
        words="per inertia; the starch settles by 2 % besides",
        besides=("viscous_drift @ acceleration",),
    ),
    "r82_slider": Truth(
        "Slider for a camera",
        hidden=("drive_dead_zone @ drive.u",),
        sizes={"drive_dead_zone.zone": 6.0},
        words="in percent of the duty; edges that are soft over 0.15 % and a rail that rubs "
        "unevenly besides",
        besides=("position_friction @ forces",),
    ),
    "r83_wire": Truth(
        "Ball on a stretched wire",
        hidden=("cubic_stiffness @ acceleration", "quad_drag @ acceleration"),
        sizes={"cubic_stiffness.k": 2.6e4, "quad_drag.c": 0.55},
        words="per mass; the wire warms and gets softer by 0.02 % besides",
        besides=("stiffness_drift @ acceleration",),
    ),
    "r84_bowl": Truth(
        "Trolley with a bowl of water",
        hidden=("elastic_load @ forces",),
        sizes={"elastic_load.m": 0.045, "elastic_load.period": 0.555},
        words="0.6 % of the mass of all; a second wave with 3 % of that besides",
        bounds={("elastic_load @ forces", "period"): (0.52, 0.59)},
        besides=("elastic_load @ forces",),
    ),
    "r85_rotor": Truth(
        "Pendulum in two axes",
        hidden=("coupling_v @ east", "coupling_v @ north"),
        sizes={"coupling_v.c": 0.031},
        words="per inertia, and -0.027 on the other axis; it slows and the air brakes besides",
        besides=("quad_drag @ east", "quad_drag @ north"),
    ),
    "r86_relay": Truth(
        "Spring of a relay",
        hidden=("barrier_hi @ forces",),
        sizes={"barrier_hi.k": 9.0, "barrier_hi.gap": 3.4e-4},
        words="3.5 % of the leaf; it begins softly over 6 um and rubs besides",
    ),
    "r87_worm": Truth(
        "Table on a worm",
        hidden=("load_friction @ torques",),
        sizes={"load_friction.share": 0.03},
        words="of the torque, beside 18 mN m declared; oil that thins and a worm that runs out "
        "besides",
        besides=("viscous_drift @ torques", "cogging @ torques"),
    ),
    "r88_train": Truth(
        "Model train",
        words="nothing is hidden; a floor that is not level and a dirty spot below the noise "
        "besides",
        clean=True,
    ),
}
