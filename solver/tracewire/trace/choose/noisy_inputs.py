"""Whether the noise of a measured input alone explains a residual, and how large it would be."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tracewire.errors import SimulationError
from tracewire.residual import Measured, likely_input_noise, response_in_windows
from tracewire.trace.found import LikelyInput
from tracewire.trace.search.search import Search
from tracewire.trace.trials.trial import Trial


def noisy_inputs(search: Search, trial: Trial) -> tuple[LikelyInput, ...]:
    """The measured inputs with no declared `sigma` whose noise would explain the residual of a
    model on its windows, each with the size of that noise."""
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
    return tuple(
        LikelyInput(
            name,
            float(np.median([size for size, _ in noises])),
            max(left for _, left in noises),
        )
        for name, noises in found.items()
        if len(noises) == len(series) and max(left for _, left in noises) < options.input_left
    )


def _noises(
    search: Search, trial: Trial, measured: Measured, numbers: list[int]
) -> Mapping[str, tuple[float, float]]:
    """The likely noise of each input of a series, and the reduced chi-square that it leaves."""
    windows, values = trial.windows, search.problem.all_values(trial)
    count, segments = len(windows.values), windows.segments
    parts = [
        (
            segments[n],
            windows.linearisations[n].residual,
            windows.linearisations[n].slopes[:, count:],
        )
        for n in numbers
    ]
    found = {}
    for name in measured.inputs:
        try:
            response = response_in_windows(trial.model, measured, values, trial.length)
            noise = likely_input_noise(response, name, search.problem.sigma, parts)
        except SimulationError:
            continue
        if 0 < noise.sigma <= search.options.input_noise * float(np.std(measured.inputs[name][1])):
            found[name] = noise.sigma, noise.after
    return found
