"""What can be set in a new experiment on the rig of a diagram, and how far: as far as the records
went, as nobody knows what lies beyond a track, a stop, or the range of a drive."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.formula import Name
from tracewire.residual import Measured
from tracewire.solve import parameter_values, values_at
from tracewire.trace.experiment.drives import Drive, drive_of, rates_of
from tracewire.trace.screen.trajectories import simulate_signals
from tracewire.trace.thresholds import ExperimentOptions
from tracewire.trace.trials.trial import TraceProblem, Trial


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
    """What can be set: sample times, where each state begins, how far and to which side each
    coordinate went from there, the drives, `rates` that a drive has as a drive of its own, and the
    parameters (amplitude, frequency, factor) of drives that are blocks.

    `ranges` is what each measured signal spans in the records. `begins` is the series as which an
    experiment begins where no body can rest; '': at rest. `returns`: a body comes back to where it
    was, so that it can be released.
    """

    t: Vector
    rest: Mapping[str, float]
    width: Mapping[str, float]
    drives: Mapping[str, Drive]
    rates: Mapping[str, str]
    drive_parameters: Mapping[str, tuple[str, str, float]]
    frequency: float
    template: Measured
    ranges: Mapping[str, tuple[float, float]]
    begins: str = ""
    returns: bool = True
    options: ExperimentOptions = field(default_factory=ExperimentOptions)

    def designs(self) -> list[Design]:
        """The coarse grid: releases, and every drive at several amplitudes and frequencies."""
        highest = self.options.highest / float(self.t[1] - self.t[0])
        found = [Design(release=size) for size in self.options.sizes]
        for name, drive in self.drives.items():
            for size in self.options.sizes:
                for pitch in self.options.pitches:
                    frequency = min(pitch * self.frequency, highest)
                    found.append(Design(0.0, name, size * drive.largest, frequency))
        return [one for one in dict.fromkeys(found) if self.is_allowed(one)]

    def is_allowed(self, design: Design) -> bool:
        """Whether a design can be set: in the range of what the records have."""
        least = self.options.sizes[0]
        if not design.drive:
            can_release = self.returns and bool(self.width)
            return can_release and least <= design.release <= self.options.beyond
        drive = self.drives.get(design.drive)
        if drive is None or not drive.largest > 0:
            return False
        rate = self.rates.get(design.drive)
        fastest = 2 * math.pi * design.frequency * design.amplitude
        if rate is not None and fastest > self.drives[rate].largest:
            return False
        return design.drive not in self.rates.values() and (
            least <= design.amplitude / drive.largest <= 1.0
        )

    def stays(self, values: Matrix) -> bool:
        """Whether what the sensors show (N, signals) stays within what the rig is known to bear."""
        for x, (low, high) in zip(values.T, self.ranges.values(), strict=True):
            far = float(np.max(np.abs(x - (low + high) / 2)))
            if high > low and not far <= self.options.reach * (high - low) / 2:
                return False
        return True

    def held(self, design: Design) -> dict[str, float]:
        """The named inputs that keep a value other than zero: those that the records never switch
        off."""
        moved = (design.drive, self.rates.get(design.drive))
        names = [name for name in self.template.inputs if name not in moved]
        return {name: self.drives[name].off for name in names if self.drives[name].off}

    def as_parameters(self, design: Design) -> dict[str, float]:
        """A design by the names that a user knows, in SI and Hz."""
        if not design.drive:
            found = {
                f"start.{state}": self.rest[state] + design.release * width
                for state, width in self.width.items()
            }
        else:
            centre = self.drives[design.drive].centre
            found = {f"{design.drive} mean": centre} if centre else {}
            found[f"{design.drive} amplitude"] = design.amplitude
            found[f"{design.drive} frequency"] = design.frequency
        found |= {f"{name} held": value for name, value in self.held(design).items()}
        return {name: float(f"{value:.4g}") for name, value in found.items()}

    def start(self, design: Design) -> dict[str, float]:
        """The states where the experiment begins: at rest, released or not."""
        return {
            state: value + design.release * self.width.get(state, 0.0)
            for state, value in self.rest.items()
        }

    def inputs(self, design: Design) -> dict[str, tuple[Vector, Vector]]:
        """The named inputs in the experiment."""
        pitch = 2 * math.pi * design.frequency
        found = {}
        for name in self.template.inputs:
            if name == design.drive:
                u = self.drives[name].centre + design.amplitude * np.sin(pitch * self.t)
            elif name == self.rates.get(design.drive):
                u = design.amplitude * pitch * np.cos(pitch * self.t)
            else:
                u = np.full(len(self.t), self.drives[name].off)
            found[name] = (self.t, u)
        return found

    def parameters(self, design: Design) -> dict[str, float]:
        """The parameters of drives that are blocks."""
        found = {}
        for drive, (amplitude, frequency, factor) in self.drive_parameters.items():
            on = drive == design.drive
            found[amplitude] = design.amplitude if on else 0.0
            if on:
                found[frequency] = design.frequency * factor
        return found


def rig_of(problem: TraceProblem, one: Trial, states: Model, returns: bool = True) -> Rig:
    """The rig of a fitted trial, whose diagram `states` records its states; `returns` as there."""
    train = [m for m in problem.measured if m.use == "train"]
    longest = max(train, key=lambda m: float(m.t[-1] - m.t[0]))
    interval = longest.interval
    frequency = main_frequency(longest)
    options = problem.options.experiment
    fine = 1 / (options.samples_a_period * frequency)
    step = max(interval, min(fine, options.coarser * interval))
    duration = min(float(longest.t[-1] - longest.t[0]), (options.samples - 1) * step)
    t = step * np.arange(int(duration / step) + 1, dtype=np.float64)
    rest, width = _reach(problem, one, states, longest)
    drives = {
        name: drive_of([m.inputs[name][1] for m in problem.measured if name in m.inputs], options)
        for name in longest.inputs
    }
    drive_parameters = _drive_parameters(problem, one)
    for drive, (amplitude, _, _) in drive_parameters.items():
        size = abs(problem.all_values(one).get(amplitude, _default(problem, amplitude)))
        drives[drive] = Drive(0.0, size, 0.0)
    sampled = {name: values_at(u, longest.t) for name, u in longest.inputs.items()}
    return Rig(
        t,
        rest,
        width,
        drives,
        rates_of(longest.t, sampled, problem.options.check.sure_rate),
        drive_parameters,
        frequency,
        longest,
        {name: _range_of(problem.measured, name) for name in problem.signals},
        "" if width else longest.series or longest.name,
        returns,
        options,
    )


def main_frequency(measured: Measured) -> float:
    """The frequency in Hz at which the first measured signal moves most; at least one wave."""
    t = measured.t
    values = next(iter(measured.values.values()))
    even = np.interp(np.linspace(t[0], t[-1], len(t)), t, values)
    spectrum = np.abs(np.fft.rfft(even - np.mean(even)))
    return max(int(np.argmax(spectrum)), 1) / float(t[-1] - t[0])


def _range_of(measured: Sequence[Measured], signal: str) -> tuple[float, float]:
    """The least and the largest value of a signal in the records."""
    parts = [m.values[signal] for m in measured if signal in m.values]
    return min(float(np.min(x)) for x in parts), max(float(np.max(x)) for x in parts)


def _reach(
    problem: TraceProblem, one: Trial, states: Model, longest: Measured
) -> tuple[dict[str, float], dict[str, float]]:
    """Where each state begins, and how far each coordinate went from there, to its farther side.

    A rate begins at zero, a coordinate in the middle of its motion, and what has no rate, as the
    level of a tank, where the longest record begins. What is not measured is known along the
    windows.
    """
    known = {state.name: state for state in problem.declared.flat.states}
    rates = {s.rate.name for s in known.values() if isinstance(s.rate, Name)} & set(known)
    runs = simulate_signals(states, one.windows, problem.rtol)
    mine = [s for s in one.windows.segments if s.measured.name == longest.name]
    first = min(mine, key=lambda s: s.begin).start if mine else {}
    rest, width = {}, {}
    for name in problem.states:
        if name in rates:
            rest[name] = 0.0
            continue
        measured = [m.values[name] for m in problem.measured if name in m.values]
        values = np.concatenate(measured or [run[name] for run in runs])
        rest[name] = float(np.mean(values))
        rate = known[name].rate
        if isinstance(rate, Name) and rate.name in known:
            away = values - rest[name]
            width[name] = float(away[np.argmax(np.abs(away))])
        elif name in longest.values:
            rest[name] = float(longest.values[name][0])
        else:
            rest[name] = first.get(name, rest[name])
    return rest, {name: size for name, size in width.items() if size != 0}


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
