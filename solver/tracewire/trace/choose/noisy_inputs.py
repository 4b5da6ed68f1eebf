"""Whether the noise of measured inputs explains a residual, and how large it would be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tracewire.compile import Model
from tracewire.errors import SimulationError
from tracewire.formula import two_digits
from tracewire.residual import (
    InputCovariance,
    LikelyNoise,
    Measured,
    likely_input_noise,
    noise_of_signal,
    response_in_windows,
)
from tracewire.solve import Held
from tracewire.trace.found import LikelyInput
from tracewire.trace.search.search import Search
from tracewire.trace.trials.trial import Trial

InputNoise = Mapping[str, Mapping[str, float]]
"""The standard deviation of the noise of inputs in SI, by series and input."""


def shown_input_noise(search: Search) -> InputNoise:
    """The noise that the samples of inputs with no declared `sigma` show, where with it the
    declared model or the best one is at the noise; else nothing.

    The input of a run counts as exact unless its noise is declared. An input that is measured has
    some, which its spectrum shows as that of a signal does.
    """
    problem = search.problem
    if problem.declared.lowered.delays:  # what noise does is followed from states alone
        return {}
    noise = {m.name: _noise_of_samples(m, search.options.input_shown) for m in problem.measured}
    if not any(noise.values()):
        return {}
    series = tuple(
        replace(m, input_sigma={**noise[m.name], **m.input_sigma}) for m in problem.measured
    )
    inputs = InputCovariance(problem.sigma, problem.declared, series, search.shortest)
    noisy, limit = replace(problem, measured=series, inputs=inputs), search.options.at_noise
    for trial in dict.fromkeys(search.declared_and_best):
        there = noisy.try_refit(trial)
        if there is not None and 1 / limit < there.reduced_chi2 < limit < trial.reduced_chi2:
            return noise
    return {}


def describe_input_noise(noise: InputNoise, model: Model) -> str:
    """In words, which noise of inputs of a model counts in a search."""
    largest: dict[str, float] = {}
    for by_input in noise.values():
        for name, level in by_input.items():
            largest[name] = max(level, largest.get(name, 0.0))
    parts = [
        f"{two_digits(level / factor)} {unit}".rstrip() + f" in '{name}'"
        for name, level in largest.items()
        for unit, factor in [model.users_unit(name)]
    ]
    return (
        f"noise that the inputs show from sample to sample counts: {' and '.join(parts)}. With"
        " exact inputs no model reached the noise of the sensors. Say `sigma:` at an input to have"
        " it so at once"
    )


def _noise_of_samples(measured: Measured, most: float) -> dict[str, float]:
    """The white noise on the inputs of a series, up to a part of what they vary by.

    A held input is what a controller has given, and so is one in steps that are larger than what
    looks like noise: it is exact, however it jitters.
    """
    found = {}
    for name, known in measured.inputs.items():
        t, values = known
        if name in measured.input_sigma or isinstance(known, Held) or len(values) < 2:
            continue
        noise = noise_of_signal(values, t)
        if noise.is_sure and noise.step < noise.level < most * float(np.std(values)):
            found[name] = noise.level
    return found


def noisy_inputs(search: Search, trial: Trial) -> tuple[LikelyInput, ...]:
    """The measured inputs with no declared `sigma` whose noise would explain the residual of a
    model on its windows, each with the size of that noise."""
    options, windows = search.options, trial.windows
    if trial.model.lowered.delays:
        return ()
    series: dict[str, list[int]] = {}
    for number, segment in enumerate(windows.criterion.segments):
        series.setdefault(segment.measured.name, []).append(number)
    found: dict[str, list[LikelyNoise]] = {}
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
            float(np.median([noise.sigma for noise in noises])),
            max(noise.after for noise in noises),
        )
        for name, noises in found.items()
        if len(noises) == len(series)
        and all(
            noise.after < options.input_left and noise.evenness > options.input_even
            for noise in noises
        )
    )


def _noises(
    search: Search, trial: Trial, measured: Measured, numbers: list[int]
) -> Mapping[str, LikelyNoise]:
    """The likely noise of each input of a series."""
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
            found[name] = noise
    return found
