"""What is hidden in the rigs from r69 on, and why other answers count, or do not.

- r69_buoy: the eddies are drag with the square of the rate. The third power is another law: it is
  worse on the third release. The hull leans out, and is a spring with a square of 12 % in 1 m; the
  trace may say so.
- r70_door: the valves brake the two directions unlike. Springs that are harder on one side push
  while the door rests aside, and a constant torque does so always: both are worse on all runs. The
  drag of the air on the leaf is in the record.
- r71_pumped: the pivot goes up and down and gravity with it. The torque is in proportion to the
  sine of the angle, which at 19 degrees is the angle within 2 %. Another period is another crank.
- r72_piezo: `stop_q` is the voltage less `play_q`, and the factor of the voltage is free, so that
  both are one equation. The piezo has three such parts, of 7, 2.5 and 15 V: a second one with
  another gap is in the record.
- r73_glider: its supply gives no more current. It is the command that is limited, not the way of
  the glider, and there are many tones: neither a spring nor a harmonic is the same.
- r74_trough: the camera shows the ball late, and the encoder the tilt in time. A command that acts
  late would move the tilt, too. The trough is harder by 0.1 % at the largest way.
- r75_strung: the thread is a spring between both. What it does in proportion to the own angle is in
  the free gravity of each, so that the other angle is what is missing, at both. The air and the
  camera, which looks at them askew, are in the record.
- r76_ring_springs: the cones rub in proportion to the force of the rings, and so to the way. Near
  resonance that force is not the one of the shaker: `load_friction` is worse, as is hysteresis.
  The rings harden by 0.3 %.
- r77_plate: rubber that is harder the deeper the ball goes in, and takes energy away. A linear
  spring beyond a gap is at the right place and gives all energy back: on the third release its
  error is three times that of the law.
- r78_bicycle: the weight of a valve is a torque with the sine of the angle, one wave a turn. As
  friction that goes once a turn it would change its sign with the rate: the wheel turns both ways.
- r79_telescope: friction that goes three times a turn, and a drive behind a lag. A delay of the
  drive or of the encoder is a lag to first order alone, and is worse on both runs. The ripple of
  the motor, 22 on a turn, and a second wave of the board are in the record.
- r80_tower: nothing. The floor is the noise of the accelerometer, which the resonances colour.
"""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.rigs.hidden import Truth

FURTHER: Mapping[str, Truth] = {
    "r69_buoy": Truth(
        "Buoy in still water",
        hidden=("quad_drag @ acceleration",),
        sizes={"quad_drag.c": 0.75},
        words="per mass; the hull leans out and the waves that it made act on it late besides",
        besides=("quad_stiffness @ acceleration",),
    ),
    "r70_door": Truth(
        "Swing door",
        hidden=("asym_viscous @ acceleration",),
        sizes={"asym_viscous.c": 0.045},
        words="half the difference, per inertia, beside 0.62 declared; air brakes it besides",
        besides=("quad_drag @ acceleration",),
    ),
    "r71_pumped": Truth(
        "Pendulum below a crank",
        hidden=("parametric @ acceleration",),
        sizes={"parametric.amplitude": 0.55, "parametric.period": 1 / 1.58},
        words="1.9 % of gravity; a rod that makes 4 % of a second wave besides",
        bounds={("parametric @ acceleration", "period"): (0.622, 0.644)},
    ),
    "r72_piezo": Truth(
        "Piezo below a mirror",
        hidden=("play_q @ goal",),
        sizes={"play_q.k": -1.0e-8, "play_q.gap": 7.0},
        words="8 % of the stretch; two smaller parts with other gaps and a creep of 0.5 % besides",
        equal={"play_q @ goal": ("stop_q @ goal",)},
        besides=("play_q @ goal", "stop_q @ goal"),
    ),
    "r73_glider": Truth(
        "Glider with a propeller",
        hidden=("drive_saturation @ drive.u",),
        sizes={"drive_saturation.limit": 80.0},
        words="in percent of the command; its edge is soft over 2 % besides",
    ),
    "r74_trough": Truth(
        "Ball in a trough",
        hidden=("sensor_delay @ sensor.x",),
        sizes={"sensor_delay.delay": 0.022},
        words="of the camera; the trough gets steeper besides",
        besides=("cubic_stiffness @ acceleration",),
    ),
    "r75_strung": Truth(
        "Two pendulums",
        hidden=("coupling_q @ first", "coupling_q @ second"),
        sizes={"coupling_q.k": -0.17},
        words="per inertia, and -0.23 on the other one; air and a camera askew besides",
        besides=(
            "quad_drag @ first",
            "quad_drag @ second",
            "sensor_quad @ sensor.q",
            "sensor_quad @ sensor.p",
        ),
    ),
    "r76_ring_springs": Truth(
        "Machine on ring springs",
        hidden=("disp_friction @ forces",),
        sizes={"disp_friction.slope": 1.5e4},
        words="3.7 % of the force of the springs, beside 22 N declared; the rings harden besides",
        besides=("cubic_stiffness @ forces",),
    ),
    "r77_plate": Truth(
        "Pendulum at a plate",
        hidden=("hunt_crossley @ acceleration",),
        sizes={"hunt_crossley.wall": -0.19, "hunt_crossley.speed": 4.5},
        words="1.2e4/s^2 on the depth to 1.5, per inertia; its skin is softer besides",
    ),
    "r78_bicycle": Truth(
        "Wheel of a bicycle",
        hidden=("cogging @ acceleration",),
        sizes={"cogging.amplitude": 0.045, "cogging.pitch": 6.2832},
        words="per inertia, beside dry friction of 0.13; grease that is uneven by 0.1 % besides",
        bounds={("cogging @ acceleration", "pitch"): (6.0, 6.6)},
    ),
    "r79_telescope": Truth(
        "Axis of a telescope",
        hidden=("position_friction @ torques", "drive_lag @ drive.i"),
        sizes={
            "position_friction.level": 0.15,
            "position_friction.pitch": 2.0944,
            "drive_lag.tau": 0.028,
        },
        words="beside 0.95 N m declared; a second wave of 1 % and a ripple of the motor besides",
        bounds={("position_friction @ torques", "pitch"): (1.9, 2.3)},
        besides=("position_friction @ torques", "cogging @ torques"),
    ),
    "r80_tower": Truth(
        "Tower with a damper",
        words="nothing is hidden; columns that harden and a damper that wears below the noise "
        "besides",
        clean=True,
    ),
}
