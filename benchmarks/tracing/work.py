"""One case: make its files, trace the diagram, simulate what was found, put it all in one row."""

from __future__ import annotations

import json
import math
import time
import traceback
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from tracewire.residual import series_parameters

from benchmarks.tracing.cases import Case
from benchmarks.tracing.floor.make import make_floor
from benchmarks.tracing.floor.score import judge_floor
from benchmarks.tracing.make import make
from benchmarks.tracing.plants import PLANTS, Plant
from benchmarks.tracing.score import judge

Row = dict[str, Any]


def generate(case: Case, folder: Path, other_units: bool = False) -> Path:
    """The files of a case; the path of its diagram."""
    if case.group in ("floor", "floor-null"):
        return make_floor(case, folder, other_units)
    return make(case, folder)


def work(case: Case, folder: Path, other_units: bool = False) -> Row:
    """The row of a case: truth, answer, judgement, seconds (CPU and wall) of the trace."""
    import tracewire as tw

    row: Row = {"case": case.name, "group": case.group, "system": case.system, "draw": case.draw}
    floor = case.group in ("floor", "floor-null")
    if floor:
        row["units"] = "other" if other_units else "si"
    path = generate(case, folder, other_units)
    truth = json.loads((path.parent / "truth.json").read_text())
    row["truth"] = truth["hidden"]
    if floor:
        row |= {key: truth[key] for key in ("scenario", "shares")}
    wall, cpu = time.perf_counter(), time.process_time()
    found: Any = None
    try:
        model = tw.compile(tw.read(path))
        found = tw.trace(model)
        row["answer"] = found.json()
    except tw.TracewireError as error:
        row["answer"] = {"verdict": "message", "error": str(error)}
    except Exception as error:
        lines = "".join(traceback.format_tb(error.__traceback__, -6))
        text = f"{type(error).__name__}: {str(error)[:300]}"
        row["answer"] = {"verdict": "crash", "error": f"{lines}{text}"}
    row["wall"], row["cpu"] = time.perf_counter() - wall, time.process_time() - cpu
    if found is not None and not case.bad:
        try:
            row["free"] = _free_runs(found, truth, PLANTS[case.system])
            if floor:
                row["short"] = _free_runs(found, truth, PLANTS[case.system], truth["period"])
        except tw.TracewireError as error:
            row["free"] = {"error": str(error)}
    row["judged"] = (judge_floor if floor else judge)(case, row, _coefficients())
    return row


def _coefficients() -> dict[str, str]:
    """The coefficient of every effect of the library, by its name."""
    from tracewire.library import load_library

    effects = load_library().effects().items()
    return {name: block.effect.coefficient for name, block in effects if block.effect}


def _free_runs(
    found: Any, truth: Mapping[str, Any], plant: Plant, window: float = math.inf
) -> dict[str, float]:
    """Errors of the declared and of the found diagram on the validation record, in sigma.

    Simulated here from the true start state, so that they depend on no number of the report; the
    noise of a measurement counts (1 is the best there is). With `window` in s the record is run in
    windows, each from the true state at its begin.
    """
    import tracewire as tw

    given = truth["validate"]
    names = (*plant.coordinates, *plant.rates)
    t = np.array(given["t"])
    if "fine" in given:
        fine, u = np.array(given["fine"]), np.array(given["u"])
    else:  # straight lines between samples would be an error
        fine = np.linspace(t[0], t[-1], 20 * len(t))
        u = CubicSpline(t, given["u"])(fine)
    inputs = {plant.drive: (fine, u)} if plant.drive else None
    count = len(t) - 1 if math.isinf(window) else max(8, round(window / (t[1] - t[0])))
    errors = {}
    found_none = found.diagram.text == found.original.text
    for which, diagram in (("before", found.original), ("after", found.diagram)):
        model = tw.compile(diagram)
        own = found.declared if which == "before" or found_none else found.values
        values = {n: v for n, v in own.items() if n in model.flat.parameters}
        if "validate" in diagram.measured:  # what the series has of its own
            values |= series_parameters(model, diagram.measured["validate"])
        squares = []
        for first in range(0, len(t) - count, count):
            rows = slice(first, first + count + 1)
            start = given["states"][first] if first else given["start"]
            run = tw.simulate(
                model,
                parameters=values,
                start=dict(zip(names, start, strict=True)),
                span=(t[rows][0], t[rows][-1]),
                times=t[rows],
                inputs=inputs,
                rtol=1e-8,
            )
            for name, shown in given["shown"].items():
                y = np.asarray(run[name])
                if which == "after" and not found_none:
                    y = _shown(found.json()["effects"], name, t[rows], y)
                squares.append(((y - np.array(shown[rows])) / truth["sigma"][name]) ** 2)
        errors[which] = math.sqrt(float(np.mean(squares)) + 1.0)
    return errors


def _shown(effects: list[Row], name: str, t: Any, y: Any) -> Any:
    """What a sensor with the effects of the answer shows: gain*y(t - delay) + offset + ..."""
    mine = {
        e["name"]: next(iter(e["params"].values()))
        for e in effects
        if e["place"] == f"sensor.{name}" and e["params"]
    }
    z = np.interp(t - mine.get("sensor_delay", 0.0), t, y)
    gain = mine.get("sensor_gain", 1.0)
    return (
        gain * z
        + mine.get("sensor_offset", 0.0)
        + mine.get("sensor_quad", 0.0) * y**2
        + mine.get("sensor_drift", 0.0) * t  # from the record's begin, at 0
    )
