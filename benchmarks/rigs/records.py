"""The ten rigs by name, and a folder with their records and diagrams."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from pathlib import Path

from benchmarks.rigs import labs, machines
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
}


def generate(name: str, folder: Path) -> Path:
    """Write the record of a rig and its two diagrams; the file of the one that hides something."""
    folder.mkdir(parents=True, exist_ok=True)
    RECORDS[name]().write(folder / f"{name}.csv")
    for diagram in (f"{name}.yaml", f"{name}_true.yaml"):
        shutil.copyfile(DIAGRAMS / diagram, folder / diagram)
    return folder / f"{name}.yaml"
