"""Paper B's long analyses: the whole bifurcation diagram, and the Lyapunov spectrum at 0.73 Hz."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator

import numpy as np
import tracewire as tw
from tracewire.shipped import shipped

from benchmarks.options import Options
from benchmarks.table import Promise, Result, seconds

DIAGRAM = shipped("diagrams") / "papers/b_triple/pendulum.yaml"
TURN = dict.fromkeys(("psi1", "psi2", "psi3"), 2 * math.pi)
WHOLE = 800


def measure(options: Options) -> Iterator[Result]:
    """Down from 0.9 Hz and up again, 300 periods at each frequency; then the exponents."""
    model = tw.compile(tw.read(DIAGRAM))
    tw.simulate(model, span=(0.0, 0.1), rtol=options.rtol)
    count = 80 if options.quick else WHOLE
    began = time.perf_counter()
    found = tw.bifurcation(
        model,
        "f",
        np.linspace(0.3, 0.9, count),
        tw.Plane(edge="torque"),
        direction="down_up",
        skip=200,
        keep=100,
        modulo=TURN,
        rtol=options.rtol,
    )
    each = (time.perf_counter() - began) / 2
    rows = [
        (b.direction, ", ".join(f"{low:.5f} to {high:.5f}" for low, high in b.bands))
        for b in found.branches
    ]
    yield Result(
        f"Irregular motion over {count} frequencies, in Hz",
        ("direction", "bands"),
        rows,
        [Promise("a direction of the diagram, 800 x 300", each * WHOLE / count, 80.0, "s", True)],
        ["the paper: 0.700 to 0.768"],
    )
    length, transient = (2e3, 5e2) if options.quick else (4e4, 1e4)
    began = time.perf_counter()
    exponents = tw.lyapunov(
        model, length, interval=0.5, transient=transient, preset="chaotic", rtol=options.rtol
    )
    spent = time.perf_counter() - began
    assert exponents.divergence is not None
    yield Result(
        f"Lyapunov exponents over {length:g} s, in {seconds(spent)}",
        ("exponent [1/s]", "standard error"),
        [
            (f"{value:.5f}", f"{error:.2g}")
            for value, error in zip(exponents.exponents, exponents.errors, strict=True)
        ],
        remarks=[f"sum {exponents.total:.6f}, mean divergence {exponents.divergence:.6f} 1/s"],
    )
