"""How signals of different units are weighed against each other where no noise is declared."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tracewire.compile import Model
from tracewire.formula import dimension_of
from tracewire.residual import Measured, channel_noise


def noise_instead_of_units(model: Model, train: Sequence[Measured]) -> dict[str, float] | None:
    """The noise of each signal that its samples show, where residuals in SI cannot be added: the
    signals have different dimensions, and neither `sigma` nor `weight` is given. None elsewhere.

    A sum of Pa^2 and m^2 is that of the pressure alone.
    """
    if any(m.weights or any(s is not None for s in m.sigma.values()) for m in train):
        return None
    units = {model.flat.units.get(name, "") for m in train for name in m.values}
    dimensions = [dimension for unit in units if (dimension := dimension_of(unit)) is not None]
    if all(dimension == dimensions[0] for dimension in dimensions):
        return None
    return channel_noise(train)


def weighing_words(model: Model, sigma: Mapping[str, float] | None) -> list[str]:
    """What a reader must know of it."""
    if sigma is None:
        return []
    units = model.flat.units
    shown = ", ".join(f"{name} {s:.2g} {units.get(name, '')}".rstrip() for name, s in sigma.items())
    return [
        "the signals have different units and no `sigma:`, so each counts in the noise that its "
        f"samples show: {shown}; write a `sigma:` for each to weigh them otherwise"
    ]
