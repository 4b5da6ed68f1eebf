"""Paper A's appendix with noise again and again: how often 95 % intervals hold the truth."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator

import numpy as np
import tracewire as tw
from tracewire.fit import fit
from tracewire.residual import Measured

from benchmarks.cases.paper_a import DIAGRAM
from benchmarks.cases.sensitivities import NINE
from benchmarks.options import Options
from benchmarks.table import Promise, Result, seconds

FIXED = ("alpha", "beta")
FACTORS = {
    "alpha": 1.36, "beta": 0.69, "T_s2_l": 0.62, "T_02_l": 1.33, "T_s2_r": 1.35,
    "T_02_r": 0.60, "k2": 0.68, "c2_l": 1.37, "c2_r": 0.66,
}  # fmt: skip
"""The parameters behind the shipped record, over those of the preset `appendix`."""
NOISE = math.radians(0.02)
PRESET = "appendix"
TIMES = np.arange(401) / 100.0
COLUMNS = ("parameter", "truth", "mean error", "spread", "intervals that hold it", "of")


def measure(options: Options) -> Iterator[Result]:
    """White noise of 0.02 deg on phi2, alpha and beta known, starts 10 to 20 % off."""
    model = tw.compile(tw.read(DIAGRAM))
    plain = tw.simulate(model, preset=PRESET).parameters
    truth = {name: plain[name] * FACTORS[name] for name in NINE}
    exact = _run(model, truth)
    repeats = 20 if options.quick else 100
    rng = np.random.default_rng(2026)
    free = [name for name in NINE if name not in FIXED]
    hits, values, errors = (np.zeros((repeats, len(free))) for _ in range(3))
    began, ended, words = time.perf_counter(), 0, 0
    for n in range(repeats):
        noisy = exact + NOISE * rng.standard_normal(len(exact))
        off = rng.uniform(0.1, 0.2, len(free)) * rng.choice([-1.0, 1.0], len(free))
        start = {name: truth[name] * (1 + o) for name, o in zip(free, off, strict=True)}
        found = fit(
            model,
            [Measured("noisy", "train", TIMES, {"phi2": noisy}, preset=PRESET)],
            method="least_squares",
            free=free,
            parameters={**truth, **start},
            rtol=options.rtol,
        )
        ended += found.exitflag == 1
        words += bool(found.uncertainty.words)
        for j, name in enumerate(free):
            low, high = found.intervals[name]
            hits[n, j] = low <= truth[name] <= high
            values[n, j], errors[n, j] = found.values[name], found.errors[name]
    spent = time.perf_counter() - began
    rows = [
        (
            name,
            f"{truth[name]:.5g}",
            f"{np.nanmean(errors[:, j]):.3g}",
            f"{np.std(values[:, j]):.3g}",
            f"{hits[:, j].sum():.0f}",
            f"{repeats}",
        )
        for j, name in enumerate(free)
    ]
    share = 100 * hits.mean(axis=0)
    promises = [
        Promise("least coverage of a 95 % interval", float(share.min()), 88.0, "%"),
        Promise("mean coverage, at least", float(share.mean()), 92.0, "%"),
        Promise("mean coverage, at most", float(share.mean()), 98.0, "%", most=True),
    ]
    remarks = [
        f"{ended} of {repeats} fits converged, {words} found something undetermined; "
        f"{seconds(spent / repeats)} for each"
    ]
    yield Result("Paper A, coverage of 95 % intervals", COLUMNS, rows, promises, remarks)


def _run(model: tw.Model, parameters: dict[str, float]) -> np.ndarray:
    span = (0.0, float(TIMES[-1]))
    run = tw.simulate(
        model, parameters=parameters, preset=PRESET, times=TIMES, span=span, rtol=1e-9
    )
    return np.asarray(run["phi2"])
