"""What is hidden in each rig, how large it is, and which other answers are right, too."""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.rigs.eighties import EIGHTIES
from benchmarks.rigs.further import FURTHER
from benchmarks.rigs.hidden import Truth
from benchmarks.rigs.later import LATER
from benchmarks.rigs.nineties import NINETIES

EARLIER: Mapping[str, Truth] = {
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
    "r11_car": Truth(
        "Car that coasts",
        hidden=("coulomb @ forces",),
        sizes={"coulomb.level": 151.0},
        words="the tyres; a tie, because no run goes the other way or ends at rest; wind in gusts "
        "of 0.25 m/s besides",
        equal={"coulomb @ forces": ("bias @ forces", "asym_coulomb @ forces")},
    ),
    "r12_resonator": Truth(
        "Resonator of 25 kHz",
        hidden=("cubic_stiffness @ forces",),
        sizes={"cubic_stiffness.k": 4.0e11},
        words="3.2 % of the linear spring at the largest deflection; it warms up besides, and is "
        "softer by up to 0.3 %",
    ),
    "r13_cylinder": Truth(
        "Pneumatic cylinder",
        hidden=("load_friction @ forces",),
        sizes={"load_friction.share": 0.12},
        words="of the force of the pressure, beside 9 N declared; a part of 0.05 comes 0.4 s late",
    ),
    "r14_cart": Truth(
        "Cart on a rail with a cable",
        hidden=("stiffness @ forces", "coulomb @ forces"),
        sizes={"stiffness.k": 1.8, "coulomb.level": 0.42},
        words="the cable is a spring; the rail brakes by 10 % more at one end besides",
    ),
    "r15_gimbal": Truth(
        "Gimbal motor with magnets",
        hidden=("cogging @ shaft",),
        sizes={"cogging.amplitude": 0.0026, "cogging.pitch": 0.5236},
        words="12 on a turn, larger by up to 10 % on one side of it",
    ),
    "r16_beam": Truth(
        "Beam with a stop on one side",
        hidden=("barrier_hi @ forces",),
        sizes={"barrier_hi.k": 9000.0, "barrier_hi.gap": 0.0006},
        words="its tip draws in by a very little besides",
    ),
    "r17_plate": Truth(
        "Hot plate with a cartridge",
        hidden=("drive_lag @ drive.power",),
        sizes={"drive_lag.tau": 34.0},
        words="the air of the room goes up and down by 0.4 K besides",
    ),
    "r18_brake": Truth(
        "Eddy-current brake, from its release to rest",
        words="nothing is hidden; a brake that is weaker by 0.3 % at the highest rate besides",
        clean=True,
    ),
    "r19_filter": Truth(
        "Filter on an oscilloscope of 8 bits",
        words="nothing is hidden; a skin effect below the noise besides",
        clean=True,
    ),
    "r20_basin": Truth(
        "Retention basin far below a sewer",
        hidden=("drive_delay @ drive.inflow", "overflow @ balance"),
        sizes={"drive_delay.tau": 720.0, "overflow.k": 6.24, "overflow.edge": 1.7},
        words="the banks lean by 7 % of the area in 2 m besides",
    ),
    "r21_video": Truth(
        "Filmed pendulum",
        hidden=("coulomb @ acceleration",),
        sizes={"coulomb.level": 0.5},
        words="per inertia, in the mean, as the level follows the load of the bushing; the phone "
        "looks at it 9 degrees askew besides",
    ),
    "r22_speaker": Truth(
        "Loudspeaker",
        hidden=("quad_stiffness @ forces", "cubic_stiffness @ forces"),
        sizes={"quad_stiffness.k": 6.0e4, "cubic_stiffness.k": 2.6e7},
        words="the surround creeps by 1.6 % and the coil leaves its magnet by 1 % at 3.3 mm "
        "besides",
    ),
    "r23_wheel": Truth(
        "Quarter of a car on a post",
        hidden=("asym_viscous @ strut",),
        sizes={"asym_viscous.c": 560.0},
        words="half the difference; 2010 N s/m in rebound and 890 in bump; the force of the damper "
        "comes 2.5 ms late besides",
    ),
    "r24_belt": Truth(
        "Servo with a belt",
        hidden=("elastic_load @ shaft",),
        sizes={"elastic_load.m": 5.2e-4, "elastic_load.period": 0.0444},
        words="the belt gets stiffer with its square besides",
    ),
    "r25_creeper": Truth(
        "Slow geared motor",
        hidden=("stribeck @ shaft",),
        sizes={"stribeck.level": 4.4e-3, "stribeck.speed": 0.9},
        words="beside 6.2 mN m declared; seven magnets of 0.04 mN m besides",
        equal={"stribeck @ shaft": ("lugre @ shaft",)},  # bristles bend less than the encoder sees
    ),
    "r26_isolator": Truth(
        "Isolators of wire rope",
        hidden=("bouc_wen @ forces",),
        sizes={"bouc_wen.level": 42.0, "bouc_wen.deflection": 7.0e-4},
        words="a corner of exponent 2; the ropes get stiffer by 4 % at the largest deflection "
        "besides",
    ),
    "r27_valve": Truth(
        "Cylinder behind a valve",
        hidden=("drive_dead_zone @ drive.u",),
        sizes={"drive_dead_zone.zone": 0.42},
        words="all of it is lost; the edges are soft over 0.045 V besides",
    ),
    "r28_flywheel": Truth(
        "Flywheel that runs out",
        hidden=("quad_drag @ acceleration", "coulomb @ acceleration"),
        sizes={"quad_drag.c": 3.2e-5, "coulomb.level": 1.15},
        words="per inertia; the grease gets thinner by 9 % as it warms up besides",
        equal={"coulomb @ acceleration": ("asym_coulomb @ acceleration",)},  # all turn one way
    ),
    "r29_arm": Truth(
        "Arm of a robot",
        hidden=("drive_saturation @ drive.i", "stiffness @ joint"),
        sizes={"drive_saturation.limit": 2.3, "stiffness.k": 0.85},
        words="the hose is a spring, which gravity that is free tells from a cubic one by a fifth "
        "power alone; the gear ripples besides",
        equal={"stiffness @ joint": ("cubic_stiffness @ joint",)},
    ),
    "r30_magnets": Truth(
        "Pendulum above a table",
        words="a magnet in the table, 13/s^2 at the lowest point and next to nothing beyond 20 "
        "degrees; currents brake it there besides",
        law=("acceleration", "q"),
    ),
    "r31_roll": Truth(
        "Ship that rolls",
        words="nothing is hidden; a righting lever with a fifth power and waves that come back "
        "below the noise besides",
        clean=True,
    ),
    "r32_chamber": Truth(
        "Thermal chamber",
        words="nothing is hidden; a loss that grows by 0.08 % per K below the noise besides",
        clean=True,
    ),
    "r33_geophone": Truth(
        "Geophone on a shaker",
        hidden=("barrier @ forces",),
        sizes={"barrier.k": 45.0, "barrier.gap": 5.05e-4},
        words="one stop 0.01 mm farther than the other, the springs harden by 0.1 % besides",
    ),
    "r34_hoist": Truth(
        "Hoist of a mine",
        hidden=("stiffness @ forces", "position_friction @ forces"),
        sizes={"stiffness.k": -47.0, "position_friction.level": 260.0},
        words="the ropes are a spring that pushes, the guides are worn every 9 m, beside 310 N "
        "declared; the torque comes 5 ms late besides",
    ),
    "r35_levitator": Truth(
        "Levitated globe, which falls without its controller",
        hidden=("drive_gain @ drive.i",),
        sizes={"drive_gain.gain": 0.07},
        words="of the current; the iron saturates by 0.3 % and the coil is 0.2 ms late besides",
    ),
    "r36_drum": Truth(
        "Washing machine that spins up",
        hidden=("hysteresis @ forces",),
        sizes={"hysteresis.level": 15.0, "hysteresis.deflection": 2.5e-3},
        words="beside oil; the springs harden and the laundry settles by 0.4 % besides",
        equal={"hysteresis @ forces": ("dahl @ forces",)},  # the same law with the exponent 1
    ),
    "r37_rheometer": Truth(
        "Torsional rheometer",
        hidden=("inertia @ tool",),
        sizes={"inertia.m": 4.5e-6},
        words="11 % of that declared; the wire is known, so that a gain of the torque is another "
        "law; the liquid thins by 1 % besides",
    ),
    "r38_tanks": Truth(
        "Two tanks in a row",
        hidden=("drive_quantiser @ drive.duty",),
        sizes={"drive_quantiser.step": 0.05},
        words="a pump of twenty speeds; 3 % of the duties lie on the edge between two of them, and "
        "it gives 0.4 % less when it is warm besides",
    ),
    "r39_ball": Truth(
        "Tennis ball that bounces",
        hidden=("quad_drag @ forces",),
        sizes={"quad_drag.c": 1.15e-3},
        words="6 % of the weight at the highest rate; it is harder deep in besides",
    ),
    "r40_fork": Truth(
        "Tuning fork with a magnet",
        words="nothing is hidden; a magnet that brakes less by 2 % at the largest deflection and "
        "a hum of 50 Hz below the noise besides",
        clean=True,
    ),
    "r41_cure": Truth(
        "Resin that cures",
        hidden=("stiffness_drift @ forces",),
        sizes={"stiffness_drift.k": 7.2},
        words="12 % of the spring in 50 s; it gets slower by 5 % besides",
    ),
    "r42_rotors": Truth(
        "Seesaw with two rotors",
        hidden=("drive_lag @ drive.u", "bias @ torques"),
        sizes={"drive_lag.tau": 0.070, "bias.level": 0.011},
        words="the thrust bends by 1 % and the air trembles besides",
    ),
    "r43_carts": Truth(
        "Two carts on springs, moved by hand",
        hidden=("barrier_lo @ first", "coulomb @ second"),
        sizes={"barrier_lo.k": 48.0, "barrier_lo.gap": 0.021, "coulomb.level": 0.085},
        words="the springs harden by 0.3 % besides",
    ),
    "r44_ripple": Truth(
        "Linear motor with force ripple",
        words="nothing is hidden; a second wave of 0.4 % in the ripple and a seal that rubs more "
        "by 0.15 % near rest besides",
        answers=(("cogging @ forces",),),
        clean=True,
        bounds={("cogging @ forces", "pitch"): (0.0145, 0.0155)},
    ),
    "r45_joint": Truth(
        "Joint of a robot that warms up",
        hidden=("viscous_drift @ torques",),
        sizes={"viscous_drift.c": -0.606},
        words="26 % of the viscous friction in 40 s; it slows down, and the gear ripples",
    ),
    "r46_oscillator": Truth(
        "Electronic oscillator",
        hidden=("cubic_stiffness @ acceleration",),
        sizes={"cubic_stiffness.k": 5.2e5},
        words="22 % of the linear spring at the largest voltage; a fifth power of 0.5 % and a bent "
        "scale besides",
    ),
    "r47_store": Truth(
        "Store below a wing",
        hidden=("barrier @ mount", "coulomb @ mount"),
        sizes={"barrier.k": 7.5e4, "barrier.gap": 1.0e-3, "coulomb.level": 8.5},
        words="accelerometers on both sides, each value the mean of 1.25 ms; the bolts harden "
        "besides",
    ),
    "r48_bolted": Truth(
        "Bolted beam",
        hidden=("dahl @ forces",),
        sizes={"dahl.level": 3.6, "dahl.deflection": 1.4e-4, "dahl.exponent": 2.0},
        words="3 % of the force at the largest deflection; the second mode rings in besides",
    ),
    "r49_table": Truth(
        "Positioning table",
        hidden=("friction_drift @ forces", "bias @ forces"),
        sizes={"friction_drift.level": -0.75, "bias.level": -8.5},
        words="seals that lose a third of 46 N in 20 s, a floor that is not level; the screw has a "
        "pitch error besides",
        equal={"bias @ forces": ("asym_coulomb @ forces",)},  # it hardly ever rests
    ),
    "r50_belts": Truth(
        "Coupled electric drives",
        hidden=("sensor_quad @ sensor.p",),
        sizes={"sensor_quad.quad": 6.68e-4},
        words="4 % at the highest rate; the belt creeps and the tachogenerator is 4 ms late "
        "besides",
    ),
    "r51_flight": Truth(
        "Table tennis ball with backspin",
        hidden=("coupling_v @ along", "coupling_v @ up"),
        sizes={"coupling_v.c": 8.5e-4},
        words="the lift is across the way: of one sign along, of the other up; the spin gets "
        "slower by 2.6 % and the lens bends besides",
    ),
    "r52_rolling": Truth(
        "Wheel with a weight that rolls",
        words="nothing is hidden; a rail that leans by 0.02 mm in 1 m below the noise besides",
        clean=True,
    ),
    "r53_damper": Truth(
        "Damper with a magnetic fluid",
        hidden=("bouc_wen @ force",),
        sizes={"bouc_wen.level": 62.0, "bouc_wen.deflection": 1.3e-3},
        words="9 % of the force; its motion is given and its force is measured; a corner of "
        "exponent 2; the fluid thins by 0.9 % besides",
    ),
    "r54_telephone": Truth(
        "Telephone as a pendulum",
        hidden=("sensor_gain @ sensor.w",),
        sizes={"sensor_gain.gain": 1.065},
        words="the period at large angles tells it; uneven times; the rod stretches besides",
    ),
    "r55_plate": Truth(
        "Plate on a shaker, tone by tone",
        hidden=("drive_3rd_harm @ drive.u",),
        sizes={"drive_3rd_harm.share": 0.055, "drive_3rd_harm.phase": 0.7},
        words="the spring hardens by 0.1 % and a second harmonic of 0.04 % is there besides",
    ),
    "r56_cell": Truth(
        "Cell of a battery under pulses",
        words="nothing is hidden; a voltage at rest that bends and a slow diffusion below the "
        "noise besides",
        clean=True,
    ),
}

TRUTHS: Mapping[str, Truth] = {**EARLIER, **LATER, **FURTHER, **EIGHTIES, **NINETIES}
"""By rig, in the order of their records."""
