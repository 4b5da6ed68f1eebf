"""Records of a free oscillator with a further force, and what a trace is made of around them."""

from __future__ import annotations

import atexit
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.residual import Measured
from tracewire.residual.windows import Section, cut_windows
from tracewire.trace.candidates.candidates import Candidate, find_candidates
from tracewire.trace.candidates.places import find_places
from tracewire.trace.candidates.signal_scales import SignalScale, SignalScales
from tracewire.trace.options import TraceOptions
from tracewire.trace.search.search import Search
from tracewire.trace.trials.data_split import split_data
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import TraceProblem, Trial

OPTIONS = TraceOptions()

DIAGRAM = """\
span: [0, 12]
parameters:
  k: {value: 22, unit: 1/s^2, fit: [5, 80]}
  c: {value: 0.3, unit: 1/s, fit: [0, 2]}
blocks:
  x: {type: integrator, of: v, start: 1, unit: m}
  v: {type: integrator, of: force, unit: m/s}
  spring: {type: gain, of: x, k: -k}
  damper: {type: viscous, rate: v, c: c}
  force: {type: sum, of: [spring, damper]}
measured:
  swing: {file: swing.csv, time: t, signals: {x: x}, start: {x: free, v: free}}
"""
STIFFNESS, DAMPING, NOISE = 25.0, 0.2, 1e-3
STEP = 0.03
LEVELS = SignalScales(
    {"x": SignalScale(0.5, 1.0), "v": SignalScale(2.5, 5.0), "force": SignalScale(12.0, 25.0)},
    12.0,
    STEP,
)


def exact(t: np.ndarray, k: float, c: float, start: Sequence[float]) -> np.ndarray:
    """x at evenly spaced times after a start (x, v), by the matrix exponential."""
    step = expm(np.array([[0.0, 1.0], [-k, -c]]) * (t[1] - t[0]))
    states = [np.asarray(start, dtype=float)]
    for _ in t[1:]:
        states.append(step @ states[-1])
    return np.array(states)[:, 0]


def record(
    law: Callable[[float, float], float] | None = None,
    *,
    name: str = "swing",
    use: str = "train",
    end: float = 12.0,
    damping: float = DAMPING,
    noise: float = NOISE,
    seed: int = 0,
) -> Measured:
    """x'' = -25 x - damping v + law(x, v), seen with white noise."""
    t = np.arange(0.0, end, STEP)

    def rates(_: float, state: np.ndarray) -> list[float]:
        x, v = state.tolist()
        return [v, -STIFFNESS * x - damping * v + (law(x, v) if law else 0.0)]

    run = solve_ivp(rates, (0, end), [1.0, 0.0], t_eval=t, rtol=1e-9, atol=1e-10, max_step=STEP)
    x = run.y[0] + noise * np.random.default_rng(seed).standard_normal(len(t))
    return Measured(name, use, t, {"x": x}, start={"x": None, "v": None})


def model_of(text: str = DIAGRAM) -> Model:
    """The model of a diagram that records x; the file of its series is there, and says nothing."""
    return compile(read_text(text, _folder() / "oscillator.yaml"), record=["x"])


@cache
def _folder() -> Path:
    folder = Path(mkdtemp())
    atexit.register(rmtree, folder, ignore_errors=True)
    (folder / "swing.csv").write_text("t,x\n0,1\n1,0\n")
    return folder


def problem_of(*series: Measured, text: str = DIAGRAM, sigma: float = NOISE) -> TraceProblem:
    """What trials on these series share."""
    return TraceProblem(model_of(text), series, {"x": sigma}, 1e-8)


def candidates_of(bench: TraceProblem) -> dict[str, Candidate]:
    """What may be missing, by name."""
    found = find_candidates(bench.declared, find_places(bench.declared), LEVELS, OPTIONS.candidate)
    return {str(candidate): candidate for candidate in found}


def trial_of(bench: TraceProblem, effects: Sequence[PlacedEffect] = (), length: int = 60) -> Trial:
    """The diagram with effects, fitted to windows of all train series."""
    sections = [Section(m, 0, len(m.t)) for m in bench.measured if m.use == "train"]
    windows = [w for s in sections for w in cut_windows(bench.declared, s, length, bench.states)]
    return bench.fit(effects, windows, length, {})


def search_of(bench: TraceProblem, shortest: int = 20) -> Search:
    """A search that has not begun."""
    places = find_places(bench.declared)
    stretches = split_data(bench.measured, OPTIONS.split)
    return Search(bench, stretches, places, shortest, {}, lambda text: None, [])


def later(measured: Measured, rows: slice, by: float) -> Measured:
    """The series with another x in some rows."""
    x = measured.values["x"].copy()
    x[rows] += by
    return replace(measured, values={"x": x})
