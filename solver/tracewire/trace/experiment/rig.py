"""What can be set in a new experiment on the rig of a diagram, and how far."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from tracewire.formula import Name
from tracewire.residual import Measured
from tracewire.solve import parameter_values
from tracewire.trace.thresholds import ExperimentOptions
from tracewire.trace.trials.trial import TraceProblem, Trial

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Design:
    """An experiment: a released body (in widths of the measured motion), or a driven one (drive,
    its amplitude in SI and its frequency in Hz)."""

    release: float = 0.0
    drive: str = ""
    amplitude: float = 0.0
    frequency: float = 0.0

    def near(self, options: ExperimentOptions) -> Iterator[Design]:
        """Four designs around this one, or two."""
        if not self.drive:
            yield from (replace(self, release=self.release * x) for x in options.near_sizes)
            return
        yield from (replace(self, amplitude=self.amplitude * x) for x in options.near_amplitudes)
        yield from (replace(self, frequency=self.frequency * x) for x in options.near_sizes)


@dataclass(frozen=True, eq=False)
class Rig:
    """What can be set: sample times, where each state rests and how far it moved, drives with their
    largest amplitude, the parameters (amplitude, frequency, factor) of those that are blocks."""

    t: Vector
    rest: Mapping[str, float]
    width: Mapping[str, float]
    drives: Mapping[str, float]
    drive_parameters: Mapping[str, tuple[str, str, float]]
    frequency: float
    template: Measured
    options: ExperimentOptions = field(default_factory=ExperimentOptions)

    def designs(self) -> list[Design]:
        """The coarse grid: releases, and every drive at several amplitudes and frequencies."""
        highest = self.options.highest / float(self.t[1] - self.t[0])
        found = [Design(release=size) for size in self.options.sizes]
        for drive, largest in self.drives.items():
            for size in self.options.sizes:
                for pitch in self.options.pitches:
                    frequency = min(pitch * self.frequency, highest)
                    found.append(Design(0.0, drive, size * largest, frequency))
        return list(dict.fromkeys(found))

    def is_allowed(self, design: Design) -> bool:
        """Whether a design is within reach."""
        least, most = self.options.sizes[0], self.options.sizes[-1]
        if not design.drive:
            return least <= design.release <= most
        part = design.amplitude / self.drives[design.drive]
        return least <= part <= most

    def as_parameters(self, design: Design) -> dict[str, float]:
        """A design by the names that a user knows, in SI and Hz."""
        if not design.drive:
            return {
                f"start.{state}": float(f"{self.rest[state] + design.release * width:.4g}")
                for state, width in self.width.items()
            }
        return {
            f"{design.drive} amplitude": float(f"{design.amplitude:.4g}"),
            f"{design.drive} frequency": float(f"{design.frequency:.4g}"),
        }

    def start(self, design: Design) -> dict[str, float]:
        """The states where the experiment begins: at rest, released or not."""
        return {
            state: value + design.release * self.width.get(state, 0.0)
            for state, value in self.rest.items()
        }

    def inputs(self, design: Design) -> dict[str, tuple[Vector, Vector]]:
        """The named inputs in the experiment."""
        angle = 2 * np.pi * design.frequency * self.t
        sine, zero = design.amplitude * np.sin(angle), np.zeros(len(self.t))
        names = self.template.inputs
        return {name: (self.t, sine if name == design.drive else zero) for name in names}

    def parameters(self, design: Design) -> dict[str, float]:
        """The parameters of drives that are blocks."""
        found = {}
        for drive, (amplitude, frequency, factor) in self.drive_parameters.items():
            on = drive == design.drive
            found[amplitude] = design.amplitude if on else 0.0
            if on:
                found[frequency] = design.frequency * factor
        return found


def rig_of(problem: TraceProblem, one: Trial) -> Rig:
    train = [m for m in problem.measured if m.use == "train"]
    longest = max(train, key=lambda m: float(m.t[-1] - m.t[0]))
    interval = longest.interval
    frequency = main_frequency(longest)
    options = problem.options.experiment
    fine = 1 / (options.samples_a_period * frequency)
    step = max(interval, min(fine, options.coarser * interval))
    duration = min(float(longest.t[-1] - longest.t[0]), (options.samples - 1) * step)
    t = step * np.arange(int(duration / step) + 1, dtype=np.float64)
    rest, width = _reach(problem, one, train)
    drives: dict[str, float] = {}
    for m in train:
        for name, (_, u) in m.inputs.items():
            drives[name] = max(drives.get(name, 0.0), float(np.max(np.abs(u - np.mean(u)))))
    drive_parameters = _drive_parameters(problem, one)
    for drive, (amplitude, _, _) in drive_parameters.items():
        drives[drive] = abs(problem.all_values(one).get(amplitude, _default(problem, amplitude)))
    drives = {name: size for name, size in drives.items() if size > 0}
    return Rig(t, rest, width, drives, drive_parameters, frequency, longest, options)


def main_frequency(measured: Measured) -> float:
    """The frequency in Hz at which the first measured signal moves most; at least one wave."""
    t = measured.t
    values = next(iter(measured.values.values()))
    even = np.interp(np.linspace(t[0], t[-1], len(t)), t, values)
    spectrum = np.abs(np.fft.rfft(even - np.mean(even)))
    return max(int(np.argmax(spectrum)), 1) / float(t[-1] - t[0])


def _reach(
    problem: TraceProblem, one: Trial, train: Sequence[Measured]
) -> tuple[dict[str, float], dict[str, float]]:
    """Where each state rests (rates at zero), and how far each coordinate moved from there."""
    states = {state.name: state for state in problem.declared.flat.states}
    rates = {s.rate.name for s in states.values() if isinstance(s.rate, Name)} & set(states)
    rest, width = {}, {}
    for name in problem.states:
        parts = [m.values[name] for m in train if name in m.values]
        parts += [np.array([s.start[name]]) for s in one.windows.segments if name in s.start]
        values = np.concatenate(parts) if parts else np.zeros(1)
        if name in rates:
            rest[name] = 0.0
            continue
        rest[name] = float(np.mean(values))
        rate = states[name].rate
        if isinstance(rate, Name) and rate.name in states:
            width[name] = float(np.max(np.abs(values - rest[name])))
    return rest, {name: size for name, size in width.items() if size > 0}


def _drive_parameters(problem: TraceProblem, one: Trial) -> dict[str, tuple[str, str, float]]:
    """Drives that are blocks with a sine or square: parameters of amplitude and frequency."""
    diagram, flat = problem.declared.diagram, problem.declared.flat
    found = {}
    for name, block in diagram.blocks.items():
        if block.type not in ("sine", "square"):
            continue
        keys = ("amplitude", "omega" if block.type == "sine" else "frequency")
        names = []
        for key in keys:
            setting = block.settings.get(key)
            formula = getattr(setting, "formula", None)
            if f"{name}.{key}" in flat.parameters:
                names.append(f"{name}.{key}")
            elif isinstance(formula, Name) and formula.name in flat.parameters:
                names.append(formula.name)
        if len(names) == 2:
            found[name] = (names[0], names[1], 2 * math.pi if block.type == "sine" else 1.0)
    return found


def _default(problem: TraceProblem, parameter: str) -> float:
    return float(parameter_values(problem.declared, {})[parameter])
