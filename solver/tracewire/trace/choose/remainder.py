"""What the named effects explain on held-out data, and what they leave."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from tracewire.array_types import Array
from tracewire.trace.choose.prediction import Prediction
from tracewire.trace.found import Explained, HeldOut, Remainder


def explained_share(prediction: Prediction, floors: Sequence[float]) -> tuple[Explained, float]:
    """The share of the excess squared error that the chosen model explains, and its standard error.

    share = 1 - sum(E_named - E_floor)/sum(E_declared - E_floor), sums over blocks, and over
    horizons in units of the declared model's error there. `floors` is the part of the chosen
    model's error that a smooth map still leaves, by horizon. The standard error is that of a
    jackknife over blocks of time (Efron and Stein 1981).
    """
    declared, named = (_by_block(prediction, n) for n in (0, prediction.choice.chosen))
    part = np.asarray(floors)
    count = declared.shape[1]
    whole = _share(declared, named, part, np.arange(count))
    left_out = [_share(declared, named, part, np.delete(np.arange(count), n)) for n in range(count)]
    error = float(
        np.sqrt((count - 1) / count * np.sum((np.array(left_out) - np.mean(left_out)) ** 2))
    )
    errors = float(ndtri(0.5 + prediction.options.confidence / 2))
    low, high = whole - errors * error, whole + errors * error
    return Explained(whole, low, min(high, 1.0)), error


def _share(declared: Array, named: Array, part: Array, blocks: NDArray[np.intp]) -> float:
    """The share over some blocks; declared and named (horizons, blocks)."""
    whole = declared[:, blocks].sum(axis=1)
    left = named[:, blocks].sum(axis=1) / whole
    excess = float(np.sum(1 - part * left))
    return 1 - float(np.sum(left - part * left)) / excess if excess > 0 else 0.0


def _by_block(prediction: Prediction, model: int) -> Array:
    """The squared error in sigma^2 with scattered blocks left out, the mean over signals, shape
    (horizons, blocks): what extrapolates badly may still be what is missing."""
    return np.asarray(prediction.errors[model][:, 0].mean(axis=2))


def error_left(prediction: Prediction) -> float:
    """The part of the error on held-out blocks that the named effects leave, the geometric mean
    over horizons and blocks: a block that is far off counts as much as one that is near. Blocks
    where the declared model is at the noise, as late in a decay, say nothing."""
    declared, named = (_by_block(prediction, n) for n in (0, prediction.choice.chosen))
    informative = declared > prediction.options.informative
    if not informative.any():
        informative = np.ones_like(informative)
    return float(np.exp(0.5 * np.mean(np.log(np.maximum(named, 1e-300) / declared)[informative])))


def held_out_errors(prediction: Prediction, floors: Sequence[float]) -> tuple[HeldOut, ...]:
    """The errors on held-out blocks at each horizon."""
    horizons = prediction.horizons
    declared, named = (_by_block(prediction, n) for n in (0, prediction.choice.chosen))
    return tuple(
        HeldOut(
            horizon.length * horizons.interval,
            horizons.series,
            horizons.begin,
            np.sqrt(before),
            np.sqrt(after),
            np.sqrt(after * floor),
        )
        for horizon, before, after, floor in zip(
            horizons.each, declared, named, floors, strict=True
        )
    )


def remainders(
    prediction: Prediction,
    floors: Sequence[float],
    sigma: Mapping[str, float],
    units: Mapping[str, str],
) -> tuple[Remainder, ...]:
    """What is left of each signal on held-out blocks at the longer horizon."""
    before, after = (
        np.sqrt(prediction.errors[n][-1, 0].mean(axis=0)) for n in (0, prediction.choice.chosen)
    )
    signals = prediction.horizons.each[-1].segments[0].signals
    return tuple(
        Remainder(
            signal,
            units.get(signal, ""),
            float(left) * sigma[signal],
            float(left),
            float(left / whole) if whole > 0 else 0.0,
            float(left) * sigma[signal] * float(np.sqrt(floors[-1])),
        )
        for signal, whole, left in zip(signals, before, after, strict=True)
    )
