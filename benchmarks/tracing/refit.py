"""The declared model of a case refitted by scipy alone, in windows with free start states."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.tracing.cases import Case
from benchmarks.tracing.integrate import Motion
from benchmarks.tracing.make import SYSTEMS, Series, Setup, record, set_up

Array = NDArray[np.float64]
WINDOW = 1.0  # s
ROUNDS = 2


@dataclass(frozen=True, eq=False)
class _Window:
    series: Series
    times: Array
    start: Array
    shown: Array  # (N, channels), in sigma


def residual(case: Case) -> float:
    """s2 of the declared model after the refit of its free parameters, with noisy records."""
    setup = set_up(case)
    free = free_parameters(case.system)
    windows = _windows(setup)
    values = dict(setup.values)
    starts = [w.start.copy() for w in windows]
    best = np.inf
    for round_ in range(ROUNDS + 1):
        residuals = [
            _show(setup, values, w, s) - w.shown for w, s in zip(windows, starts, strict=True)
        ]
        count = sum(r.size for r in residuals) - len(free) - sum(map(len, starts))
        best = min(best, sum(float(np.sum(r**2)) for r in residuals) / count)
        if round_ == ROUNDS:
            break
        left, right, parts = np.zeros((len(free), len(free))), np.zeros(len(free)), []
        for w, s, r in zip(windows, starts, residuals, strict=True):
            own = _columns(setup, values, w, s, r, [])
            shared = _columns(setup, values, w, s, r, free)
            q, _ = np.linalg.qr(own)
            inside = shared - q @ (q.T @ shared)
            left += inside.T @ inside
            right -= inside.T @ r.ravel()
            parts.append((own, shared, r.ravel()))
        step = np.linalg.lstsq(left, right, rcond=1e-12)[0]
        for name, value in zip(free, step, strict=True):
            values[name] *= float(np.exp(np.clip(value, -0.7, 0.7)))
        for number, (own, shared, r) in enumerate(parts):
            starts[number] = starts[number] + np.linalg.lstsq(own, -r - shared @ step)[0]
    return best


def free_parameters(system: str) -> list[str]:
    """Names of the parameters that the declared diagram leaves free."""
    text = (SYSTEMS / f"{system}.yaml").read_text()
    return re.findall(r"^  (\w+): \{.*fit:", text, re.MULTILINE)


def _windows(setup: Setup) -> list[_Window]:
    found = []
    rng = np.random.default_rng([setup.case.seed, 2])
    every = setup.times[1] - setup.times[0]
    length = round(WINDOW / every)
    n = len(setup.plant.coordinates)
    for number, series in enumerate(setup.series[:3]):
        made = record(setup, series)
        sigma = np.array([setup.sigma[c] for c in setup.channels])
        shown = np.column_stack([made.shown[c] for c in setup.channels]) / sigma
        shown = shown + rng.standard_normal(shown.shape)
        for begin in range(0, len(setup.times) - length, length * (2 if number == 0 else 3)):
            rows = slice(begin, begin + length)
            start = made.states[begin, : 2 * n]
            found.append(_Window(series, setup.times[rows], start, shown[rows]))
    return found


def _show(setup: Setup, values: dict[str, float], window: _Window, start: Array) -> Array:
    motion = Motion(setup.plant, values, (), window.series.drive)
    t = window.times
    states = motion.run([float(x) for x in start], t, float(t[0]), 1e-7)
    names = (*setup.plant.coordinates, *setup.plant.rates)
    return np.column_stack([states[:, names.index(c)] / setup.sigma[c] for c in setup.channels])


def _columns(
    setup: Setup,
    values: dict[str, float],
    window: _Window,
    start: Array,
    r: Array,
    free: list[str],
) -> Array:
    """Derivatives by the logarithms of `free`, or without any by the start state."""
    base = r + window.shown
    columns = []
    for name in free:
        moved = values | {name: values[name] * (1 + 1e-5)}
        columns.append((_show(setup, moved, window, start) - base).ravel() / 1e-5)
    if not free:
        for k in range(len(start)):
            h = 1e-6 * max(float(np.max(np.abs(start))), 1e-3)
            other = start.copy()
            other[k] += h
            columns.append((_show(setup, values, window, other) - base).ravel() / h)
    return np.column_stack(columns)
