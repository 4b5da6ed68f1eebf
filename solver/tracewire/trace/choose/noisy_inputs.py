"""Whether the noise of a measured input alone explains a residual, and how large it would be."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tracewire.errors import SimulationError
from tracewire.residual import Measured, likely_input_noise, response_in_windows
from tracewire.trace.search.search import Search
from tracewire.trace.trials.trial import Trial


def describe_noisy_inputs(search: Search, trial: Trial) -> list[str]:
    """In words, the noise of each measured input with no declared `sigma` that would explain the
    residual of a model on its windows; nothing of an input that cannot."""
    options, windows = search.options, trial.windows
    series: dict[str, list[int]] = {}
    for number, segment in enumerate(windows.criterion.segments):
        series.setdefault(segment.measured.name, []).append(number)
    found: dict[str, list[tuple[float, float]]] = {}
    for numbers in series.values():
        measured = windows.criterion.segments[numbers[0]].measured
        if measured.input_sigma:
            continue
        chosen = numbers[: options.input_windows]
        for name, noise in _noises(search, trial, measured, chosen).items():
            found.setdefault(name, []).append(noise)
    units = trial.model.flat.units
    return [
        f"noise of the input '{name}' of {np.median([size for size, _ in noises]):.2g} "
        f"{units.get(name, '')} would explain this residual: say `sigma:` of that input if it is "
        "as noisy"
        for name, noises in found.items()
        if len(noises) == len(series) and max(left for _, left in noises) < options.input_left
    ]


def _noises(
    search: Search, trial: Trial, measured: Measured, numbers: list[int]
) -> Mapping[str, tuple[float, float]]:
    """The likely noise of each input of a series, and the reduced chi-square that it leaves."""
    windows, values = trial.windows, search.bench.all_values(trial)
    count, segments = len(windows.values), windows.segments
    parts = [
        (segments[n], windows.near[n].residual, windows.near[n].slopes[:, count:]) for n in numbers
    ]
    found = {}
    for name in measured.inputs:
        try:
            response = response_in_windows(trial.model, measured, values, trial.length)
            noise = likely_input_noise(response, name, search.bench.sigma, parts)
        except SimulationError:
            continue
        if noise.sigma > 0:
            found[name] = noise.sigma, noise.after
    return found
