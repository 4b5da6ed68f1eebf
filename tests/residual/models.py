"""Models whose solutions are known exactly, and measured series made of these."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ellipj
from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.residual import Criterion, Measured
from tracewire.residual.starts import whole_segment
from tracewire.residual.unknowns import free_unknowns, sensor_unknowns
from tracewire.solve import parameter_values

Vector = NDArray[np.float64]
T = np.linspace(0.0, 6.0, 121)

OSCILLATOR = """\
title: Linear oscillator
span: [0, 6]
parameters:
  k: {value: 3, unit: 1/s^2, fit: [0.5, 20]}
  c: {value: 0.1, unit: 1/s, fit: [0, 2]}
  x0: {value: 0.9, unit: m}
blocks:
  x: {type: integrator, of: v, start: x0, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  a: {type: expression, formula: -k*x - c*v}
presets:
  pulled: {x0: 1.5}
"""

PENDULUM = """\
span: [0, 6]
parameters:
  w0_squared: {value: 9, unit: 1/s^2, fit: [2, 40]}
  amplitude: {value: 60, unit: deg, fit: [10, 170]}
blocks:
  theta: {type: integrator, of: omega, start: amplitude, unit: rad}
  omega: {type: integrator, of: a, unit: rad/s}
  a: {type: expression, formula: -w0_squared*sin(theta)}
"""

LINE = """\
span: [0, 6]
parameters: {a: {value: 1, fit: free}, b: {value: 0, fit: free}}
blocks:
  x: {type: integrator, of: slope, start: b}
  slope: {type: constant, value: a}
"""

K, C = 4.0, 0.3


def made(text: str, record: tuple[str, ...] = ("x",)) -> Model:
    return compile(read_text(text), record=record)


def oscillation(t: ArrayLike, x0: float = 1.0, v0: float = 0.0, k: float = K, c: float = C) -> Any:
    """x of x'' = -k x - c x', below critical damping."""
    t = np.asarray(t, dtype=float)
    w = np.sqrt(k - c * c / 4)
    return np.exp(-c * t / 2) * (x0 * np.cos(w * t) + (v0 + c * x0 / 2) / w * np.sin(w * t))


def swing(t: Vector, w0_squared: float, amplitude: float) -> Vector:
    """theta of theta'' = -w0^2 sin(theta) from rest: sin(theta/2) = k cd(w0 t, k^2)."""
    k = np.sin(amplitude / 2)
    _, cn, dn, _ = ellipj(np.sqrt(w0_squared) * t, k * k)
    return np.asarray(2 * np.arcsin(k * cn / dn))


def series(values: ArrayLike, name: str = "run", t: Vector = T, **more: Any) -> Measured:
    """A series of the signal x."""
    use = more.pop("use", "train")
    return Measured(name, use, t, {"x": np.asarray(values, dtype=float)}, **more)


def criterion_of(model: Model, *measured: Measured, rtol: float = 1e-9) -> Criterion:
    """The criterion of whole series and the diagram's free parameters."""
    unknowns = free_unknowns(model, None, parameter_values(model, {}))
    unknowns += sensor_unknowns(measured)
    return Criterion(model, [whole_segment(model, m) for m in measured], unknowns, {}, rtol)


def write_csv(path: Path, t: Vector, **columns: ArrayLike) -> Path:
    head = ",".join(["t", *columns])
    np.savetxt(
        path, np.column_stack([t, *columns.values()]), delimiter=",", header=head, comments=""
    )
    return path
