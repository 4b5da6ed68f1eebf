"""Losses: how much a residual counts. A robust one keeps outliers from leading a fit."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tracewire.array_types import Array
from tracewire.residual.limits import CRITERION


class Lossy(NamedTuple):
    """Residuals as the loss sees them, f with f^2 = rho(r^2), and df/dr; shaped as r."""

    residual: Array
    slope: Array


def linear(r: Array) -> Lossy:
    """rho = r^2: least squares."""
    return Lossy(r, np.ones(r.shape))


def huber(r: Array) -> Lossy:
    """rho = r^2 up to c = 1.345 sigma, 2 c |r| - c^2 beyond."""
    size = np.abs(r)
    c = CRITERION.huber
    inside = size <= c
    far = np.sqrt(2 * c * np.maximum(size, c) - c**2)
    slope = np.where(inside, 1.0, c / far)
    return Lossy(np.where(inside, r, np.sign(r) * far), slope)


def cauchy(r: Array) -> Lossy:
    """rho = c^2 log(1 + (r/c)^2) with c = 2.385 sigma."""
    ratio = r / CRITERION.cauchy
    square = np.log1p(ratio**2)
    f = np.sign(r) * CRITERION.cauchy * np.sqrt(square)
    steep = np.divide(np.abs(ratio), np.sqrt(square), out=np.ones_like(r), where=square > 1e-16)
    return Lossy(f, steep / (1 + ratio**2))


LOSSES: dict[str, Callable[[Array], Lossy]] = {"linear": linear, "huber": huber, "cauchy": cauchy}
