"""What is hidden in the rigs from r57 on."""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.rigs.hidden import Truth

LATER: Mapping[str, Truth] = {
    "r57_foam": Truth(
        "Foam ball on a rod",
        hidden=("quad_drag @ acceleration",),
        sizes={"quad_drag.c": 0.020},
        words="per inertia; the rod stretches by 0.001 % of its length per weight and the grease "
        "thins by 2.4 % besides",
    ),
    "r58_seismometer": Truth(
        "Seismometer beside a fan",
        hidden=("harmonic @ acceleration",),
        sizes={"harmonic.amplitude": 0.011, "harmonic.period": 1 / 4.13},
        words="per mass; its size goes up and down by 1 % and the spring hardens besides",
        # a wave of another period is another law
        bounds={("harmonic @ acceleration", "period"): (0.240, 0.244)},
    ),
    "r59_needle": Truth(
        "Needle on a torsion wire",
        hidden=("coulomb @ acceleration", "sensor_offset @ sensor.phi"),
        sizes={"coulomb.level": 0.25, "sensor_offset.offset": 0.02443},
        words="per inertia; the wire hardens by 0.1 % and the angle trembles besides",
        # the wire is linear: a constant torque moves its middle just as the zero of the sensor
        equal={
            "sensor_offset @ sensor.phi": ("bias @ acceleration", "asym_coulomb @ acceleration")
        },
    ),
    "r60_gearbox": Truth(
        "Gear between a servo and a disc",
        hidden=("backlash @ gear",),
        sizes={"backlash.gap": 0.008, "backlash.k": 60.0},
        words="half the gap; the twist is up to 0.1 rad; the teeth harden by 1 % and are "
        "uneven by 0.7 mdeg besides",
        # the declared spring may go to zero, and the barrier is what is left of it beyond the gap
        equal={"backlash @ gear": ("barrier @ gear",)},
    ),
    "r61_pin": Truth(
        "Pin on a disc that turns one way",
        hidden=("stribeck @ force",),
        sizes={"stribeck.level": 6.0, "stribeck.speed": 0.004},
        words="beside 12 N declared; the disc is worn by 0.4 % and the load cell drifts besides",
        # it never turns back, so that bristles which are bent within 0.01 mm stay so
        equal={"stribeck @ force": ("lugre @ force",)},
        bounds={("lugre @ force", "deflection"): (0.0, 1e-5)},
    ),
    "r62_magnets": Truth(
        "Motor on a torsion bar",
        hidden=("cogging @ shaft", "coulomb @ shaft"),
        sizes={"cogging.amplitude": 0.006, "cogging.pitch": 0.2094, "coulomb.level": 0.010},
        words="30 on a turn; a second wave of 0.6 % and an amplifier that bends besides",
        bounds={("cogging @ shaft", "pitch"): (0.204, 0.215)},
    ),
    "r63_scooter": Truth(
        "Electric scooter",
        hidden=("inertia @ forces",),
        sizes={"inertia.m": 11.0},
        words="of the motor, beside 98 kg declared; gusts of 0.03 m/s and hills of 0.25 N besides",
        # it only goes forwards, and rolling resistance and drag are free: with less of either,
        # less force on the same mass, or a speed shown too low, is the same equation
        equal={"inertia @ forces": ("drive_gain @ drive.F", "sensor_gain @ sensor.v")},
    ),
    "r64_dryer": Truth(
        "Heated air in a tube",
        hidden=("drive_delay @ drive.u",),
        sizes={"drive_delay.tau": 0.25},
        words="the room warms by 0.09 K in 60 s and a hotter tube loses more by 0.6 % besides",
        # one drive, one sensor, and no coefficient that changes with the time
        equal={"drive_delay @ drive.u": ("sensor_delay @ sensor.T",)},
    ),
    "r65_accumulator": Truth(
        "Accumulator of oil",
        words="nothing is hidden; a gas that is stiffer by 0.1 % at 80 bar and oil that "
        "thins by 0.1 % below the noise besides",
        clean=True,
    ),
    "r66_capacitor": Truth(
        "Circuit with a ceramic capacitor",
        hidden=("cubic_stiffness @ voltages",),
        sizes={"cubic_stiffness.k": 7.5e12},
        words="7.4 % of the linear voltage at the largest charge; the wire warms by 0.3 % and "
        "0.08 % of the voltage comes late besides",
    ),
    "r67_strut": Truth(
        "Strut of a motorcycle",
        hidden=("asym_viscous @ force",),
        sizes={"asym_viscous.c": 430.0},
        words="half the difference; its motion is given and its force is measured; the oil thins "
        "by 0.4 % and the valves choke by 1 % besides",
    ),
    "r68_wheel": Truth(
        "Reaction wheel",
        words="nothing is hidden; grease that thins by 0.3 % and the air's drag below the noise "
        "besides",
        clean=True,
    ),
}
