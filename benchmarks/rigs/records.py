"""The rigs by name, and a folder with their records and diagrams."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from pathlib import Path

from benchmarks.rigs import (
    actuators,
    axes,
    benches,
    circuits,
    decays,
    drives,
    flights,
    households,
    joints,
    labs,
    machines,
    motions,
    mounts,
    plants,
    processes,
    servos,
    structures,
    swings,
    vibrations,
)
from benchmarks.rigs.record import Record

DIAGRAMS = Path(__file__).parent / "diagrams"
RECORDS: Mapping[str, Callable[[], Record]] = {
    "r01_pendulum": labs.pendulum,
    "r02_base": labs.shaker_table,
    "r03_drive": machines.drive,
    "r04_motor": machines.motor,
    "r05_heater": machines.heater,
    "r06_tank": machines.tank,
    "r07_crane": labs.crane,
    "r08_torsion": labs.torsion,
    "r09_coil": machines.coil,
    "r10_stage": labs.stage,
    "r11_car": drives.car,
    "r12_resonator": benches.resonator,
    "r13_cylinder": drives.cylinder,
    "r14_cart": drives.cart,
    "r15_gimbal": drives.gimbal,
    "r16_beam": benches.beam,
    "r17_plate": plants.plate,
    "r18_brake": benches.brake,
    "r19_filter": benches.ladder,
    "r20_basin": plants.basin,
    "r21_video": decays.video,
    "r22_speaker": vibrations.loudspeaker,
    "r23_wheel": vibrations.wheel,
    "r24_belt": servos.belt,
    "r25_creeper": servos.creeper,
    "r26_isolator": vibrations.isolator,
    "r27_valve": actuators.valve,
    "r28_flywheel": decays.flywheel,
    "r29_arm": servos.arm,
    "r30_magnets": decays.magnets,
    "r31_roll": decays.ship,
    "r32_chamber": actuators.chamber,
    "r33_geophone": mounts.geophone,
    "r34_hoist": axes.hoist,
    "r35_levitator": axes.levitator,
    "r36_drum": households.drum,
    "r37_rheometer": mounts.rheometer,
    "r38_tanks": households.tanks,
    "r39_ball": households.ball,
    "r40_fork": mounts.fork,
    "r41_cure": mounts.cure,
    "r42_rotors": axes.rotors,
    "r43_carts": households.carts,
    "r44_ripple": axes.ripple,
    "r45_joint": joints.joint,
    "r46_oscillator": circuits.oscillator,
    "r47_store": structures.store,
    "r48_bolted": structures.bolted,
    "r49_table": joints.table,
    "r50_belts": joints.belts,
    "r51_flight": flights.flight,
    "r52_rolling": flights.rolling,
    "r53_damper": structures.damper,
    "r54_telephone": flights.telephone,
    "r55_plate": structures.plate,
    "r56_cell": circuits.cell,
    "r57_foam": swings.foam,
    "r58_seismometer": swings.seismometer,
    "r59_needle": swings.needle,
    "r60_gearbox": motions.gearbox,
    "r61_pin": motions.pin,
    "r62_magnets": motions.magnets,
    "r63_scooter": motions.scooter,
    "r64_dryer": processes.dryer,
    "r65_accumulator": processes.accumulator,
    "r66_capacitor": swings.capacitor,
    "r67_strut": processes.strut,
    "r68_wheel": motions.wheel,
}


def generate(name: str, folder: Path) -> Path:
    """Write the record of a rig and its two diagrams; the file of the one that hides something."""
    folder.mkdir(parents=True, exist_ok=True)
    RECORDS[name]().write(folder / f"{name}.csv")
    for diagram in (f"{name}.yaml", f"{name}_true.yaml"):
        shutil.copyfile(DIAGRAMS / diagram, folder / diagram)
    return folder / f"{name}.yaml"
