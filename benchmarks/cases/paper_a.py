"""Paper A: the double torsion pendulum, with the stiff barrier and with the soft one."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from benchmarks.accuracy import Reference
from benchmarks.cases.side_by_side import compare
from benchmarks.options import Options
from benchmarks.peers.peer import Problem
from benchmarks.systems.hybrid import Vector
from benchmarks.systems.torsion import Torsion
from benchmarks.table import Result

ROOT = Path(__file__).parents[2]
DIAGRAM = ROOT / "diagrams/papers/a_torsion/pendulum.yaml"
ORACLE = ROOT / "tests/oracles/double_torsion.py"
STATES = ("phi1", "phi1_dot", "phi2", "phi2_dot")
COMMON = {"C, CVODE BDF": (5.0, False), "PathSim": (1000.0, False)}


def problem(c1: float, preset: str) -> Problem:
    """The pendulum for one damping of its pin barrier [N m s/rad], from 0 to 4 s."""
    return Problem(
        title=f"Paper A, c1 = {c1:g}, 4 s",
        system=Torsion(c1),
        names=STATES,
        judged=(0, 2),
        stiff=c1 > 10,
        diagram=DIAGRAM,
        preset=preset,
        script="torsion.sce",
    )


def reference(c1: float) -> Reference:
    """The tests' own oracle: LSODA and DOP853 at 1e-11 with states counted from the barrier."""
    oracle = _oracle()

    def states(times: Vector) -> Vector:
        found: Vector = oracle.solve({"c1": c1}, times).states.T
        return found

    kept: dict[bytes, Vector] = {}

    def remembered(times: Vector) -> Vector:
        if len(times) != 401:  # of a peer that chooses its times
            return states(times)
        key = times.tobytes()
        if key not in kept:
            kept[key] = states(times)
        return kept[key]

    return remembered


def _oracle() -> ModuleType:
    name = "benchmark_oracle"
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, ORACLE)
        assert spec is not None and spec.loader is not None
        sys.modules[name] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[name])
    return sys.modules[name]


def measure(options: Options) -> Iterator[Result]:
    """Both tables. The error is that of the angles, in rad."""
    for c1, preset, lsoda in ((120.0, "consistent", 40.0), (1.2, "teaching", 75.0)):
        promised = {**COMMON, "scipy LSODA": (lsoda, False)}
        promised |= {"C, same algorithm": (1.25, True), "C, leaner": (1.8, True)}
        yield compare(problem(c1, preset), reference(c1), options, promised)
