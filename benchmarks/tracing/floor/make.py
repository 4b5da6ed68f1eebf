"""From a case with a floor to files: a diagram, its series, and the truth."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.tracing.cases import Case
from benchmarks.tracing.floor.cases import ANGLES
from benchmarks.tracing.floor.drawing import Shares, draw_rig
from benchmarks.tracing.floor.measuring import Clean, clean, instrument, record
from benchmarks.tracing.floor.rig import Rig
from benchmarks.tracing.floor.scenario import stream
from benchmarks.tracing.floor.units import Units, diagram, draw_units
from benchmarks.tracing.make import place_name


def make_floor(case: Case, folder: Path, other_units: bool = False) -> Path:
    """Write the files of a case into a folder of its own and return the diagram's path."""
    name = case.name.replace("/", "_").replace("@", "_at_").replace("+", "_")
    home = folder / f"{name}{'_other_units' if other_units else ''}"
    path, known = home / f"{case.system}.yaml", home / "truth.json"
    said = json.dumps(asdict(case))
    if known.exists() and json.dumps(json.loads(known.read_text())["case"]) == said:
        return path
    home.mkdir(parents=True, exist_ok=True)
    units = Units()
    if other_units:
        units = draw_units(case.system in ANGLES, stream(case, "units"))
    rig, shares = draw_rig(case)
    truth = _written(rig, shares, units, home, path)
    known.write_text(json.dumps({"case": asdict(case), **truth}))
    return path


def _written(rig: Rig, shares: Shares, units: Units, home: Path, path: Path) -> dict[str, Any]:
    rng = stream(rig.case, "noise")
    motions = [clean(rig, series) for series in rig.series]
    first = motions[0]
    names = list(first.shown)
    spreads = {n: float(np.std(first.shown[n])) for n in names}
    period = 2 * np.pi * float(np.std(first.states[:, 0]) / np.std(first.states[:, 1]))
    tool = instrument(rig, shares.left, period, rng)
    scale = dict(zip(names, (units.length, units.length / units.time), strict=False))
    control = rig.control if rig.scenario.drive == "reference" else None
    drive = units.length if control else units.force
    given = {}
    if rig.scenario.drive == "free" and rig.scenario.rest:
        given = {"c": float(f"{rig.values['c'] * rng.uniform(0.8, 1.3):.2g}")}
    lines, sigma = ["measured:"], {n: tool.noise * spreads[n] * scale[n] for n in names}
    for number, (series, truth) in enumerate(zip(rig.series, motions, strict=True), 1):
        if series.use == "validate" and rig.scenario.alone:
            continue  # the truth alone has it
        made = record(rig, series, tool, truth, spreads, rng)
        name = f"{series.use}_{number}" if series.use == "train" else series.use
        columns = {"t": made.t * units.time}
        if rig.plant.drive:
            columns["u"] = made.u * drive
        columns |= {n: y * scale[n] for n, y in made.columns.items()}
        text = np.column_stack(list(columns.values()))
        np.savetxt(home / f"{name}.csv", text, "%.12g", ",", header=",".join(columns), comments="")
        lines += _measured(rig, name, series.use, sigma)
    path.write_text(diagram(rig.case.system, units, given, control) + "\n".join(lines) + "\n")
    return {
        "values": rig.values,
        "hidden": [asdict(h) | {"place": place_name(rig.plant, h)} for h in rig.hidden],
        "floor": asdict(rig.floor),
        "scenario": asdict(rig.scenario),
        "instrument": asdict(tool),
        "shares": asdict(shares),
        "units": asdict(units),
        "control": rig.control,
        "sigma": sigma,
        "period": period * units.time,
        "validate": _unseen(motions[-1], units, drive, scale),
    }


def _unseen(truth: Clean, units: Units, drive: float, scale: dict[str, float]) -> dict[str, Any]:
    """The true motion of the series for validation, in the units of the files."""
    states = truth.states * (units.length, units.length / units.time)
    return {
        "t": (truth.t * units.time).tolist(),
        "states": states.tolist(),
        "start": states[0].tolist(),
        "shown": {n: (y * scale[n]).tolist() for n, y in truth.shown.items()},
        "fine": (truth.fine * units.time).tolist(),
        "u": (truth.u * drive).tolist(),
    }


def _measured(rig: Rig, name: str, use: str, sigma: dict[str, float]) -> list[str]:
    def channel(c: str) -> str:
        stated = rig.scenario.stated
        return f"{c}: {{column: {c}, sigma: {sigma[c]:.3g}}}" if stated else f"{c}: {c}"

    lines = [f"  {name}:", f"    file: {name}.csv", f"    use: {use}", "    time: t"]
    lines += [f"    signals: {{{', '.join(map(channel, sigma))}}}"]
    if rig.plant.drive:
        lines += ["    inputs: {u: u}"]
    free = ", ".join(f"{s}: free" for s in (*rig.plant.coordinates, *rig.plant.rates))
    return [*lines, f"    start: {{{free}}}"]
