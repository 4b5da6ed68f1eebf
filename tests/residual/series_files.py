"""Diagrams of one body with a measured file beside them, and what is said of the file."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.errors import DataError
from tracewire.residual import Measured, load_measured

TOP = """\
span: [0, 6]
inputs: {drive: {unit: N m, default: 0}}
parameters: {start: 0.5}
blocks:
  theta: {type: integrator, of: omega, unit: rad}
  omega: {type: integrator, of: drive, unit: rad/s}
presets: {high: {start: 0.75}}
measured:
"""
CSV = "t,angle,u\n0.0,0,1\n0.5,90,2\n1.0,180,3\n1.5,-90,4\n"
FREE = "time: t, start: {theta: free, omega: free}"
PLAIN = "  run: {file: run.csv, time: t, signals: {theta: {column: angle, unit: deg}}}\n"


def model_of(file: Path, *series: str) -> Model:
    file.write_text(TOP + "".join(series), encoding="utf-8")
    return compile(read(file))


def message(model: Model, *uses: str) -> str:
    with pytest.raises(DataError) as caught:
        load_measured(model, uses)
    return str(caught.value)


def written(file: Path, content: str) -> None:
    (file.parent / "run.csv").write_text(content, encoding="utf-8")


def wave(file: Path, header: str = "t,angle,u", count: int = 400, step: float = 0.01) -> np.ndarray:
    """A file with a swing of 30 degrees at 1 Hz, in degrees, and a ramp."""
    t = np.arange(count) * step
    rows = (f"{x:.6g},{30 * math.cos(2 * math.pi * x):.6f},{x:.6g}" for x in t)
    written(file, "\n".join([header, *rows]))
    return t


def one(file: Path, more: str = "", theta: str = "{column: angle, unit: deg}") -> Measured:
    comma = ", " if more else ""
    text = f"  run: {{file: run.csv, signals: {{theta: {theta}}}{comma}{more}}}\n"
    (loaded,) = load_measured(model_of(file, text))
    return loaded


def said(file: Path, more: str, theta: str = "{column: angle, unit: deg}") -> str:
    comma = ", " if more else ""
    text = f"  run: {{file: run.csv, signals: {{theta: {theta}}}{comma}{more}}}\n"
    return message(model_of(file, text))
