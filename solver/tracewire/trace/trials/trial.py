"""A trial: a diagram with some effects added, fitted to windows; how trials are made."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from typing import Unpack

import numpy as np
from scipy.special import stdtrit

from tracewire.array_types import Vector
from tracewire.compile import Model, compile
from tracewire.diagram import Diagram, apply, patch
from tracewire.errors import DiagramError, FitError, OptionError, TracewireError
from tracewire.residual import (
    DESCENT,
    WINDOW,
    Criterion,
    InputCovariance,
    Measured,
    Segment,
    Unknown,
    Windows,
    evaluate_windows,
    fit_initial_states,
    fit_windows,
    follow_growing_parts,
    free_unknowns,
    project_out_initial_states,
    sensor_unknowns,
    with_lead_in,
    with_memory,
)
from tracewire.solve import Limits, parameter_values, release
from tracewire.trace.candidates.candidate import unknowns_of
from tracewire.trace.candidates.changes import changes_of
from tracewire.trace.candidates.drive_sines import Sine, drive_sines_of
from tracewire.trace.options import TraceOptions
from tracewire.trace.thresholds import TrialOptions
from tracewire.trace.trials.fit_options import FitOptions
from tracewire.trace.trials.phase_fit import fit_phase
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.statistics import (
    bic,
    effective_fraction,
    flat_values,
    inverse_information,
)


@dataclass(frozen=True, eq=False)
class Trial:
    """A diagram with effects, fitted to windows of about `length` samples."""

    diagram: Diagram
    model: Model
    effects: tuple[PlacedEffect, ...]
    windows: Windows
    length: int
    converged: bool
    options: TrialOptions = field(default_factory=TrialOptions)

    @property
    def values(self) -> dict[str, float]:
        """The fitted parameters and sensor values by name."""
        return dict(self.windows.values)

    @property
    def rss(self) -> float:
        """The sum of squared residuals in sigma."""
        return self.windows.rss

    @property
    def count(self) -> int:
        """The number of residuals."""
        return sum(r.size for r in self.windows.residuals)

    @property
    def unknowns(self) -> int:
        """How many numbers were fitted or scanned, start values included."""
        scanned = sum(len(effect.candidate.scanned) for effect in self.effects)
        return len(self.windows.values) + scanned + sum(len(s) for s in self.windows.starts)

    @property
    def degrees_of_freedom(self) -> int:
        """Degrees of freedom of the residual."""
        return max(self.count - self.unknowns, 1)

    @property
    def reduced_chi2(self) -> float:
        """RSS per degree of freedom; 1 is at the noise."""
        return self.rss / self.degrees_of_freedom

    @property
    def inlier_limit(self) -> float:
        """The mean squared residual of a window up to which its start is not taken for astray:
        twice that of the middle one, and what the noise alone may give."""
        return max(2 * float(np.median(self.window_mean_squares)), self.options.not_astray)

    @property
    def window_mean_squares(self) -> Vector:
        """The mean squared residual of each window."""
        windows = self.windows
        return np.asarray(windows.squares / [max(r.size, 1) for r in windows.residuals])

    @property
    def steps_per_run(self) -> float:
        """The steps that a run takes on average."""
        criterion = self.windows.criterion
        return criterion.steps / max(criterion.runs, 1)

    @property
    def effective_fraction(self) -> float:
        """N_eff/N of the residuals."""
        return effective_fraction(self.windows.residuals)

    def depends_on(self, name: str) -> bool:
        """Whether a residual depends on an unknown."""
        column = list(self.windows.values).index(name)
        return any(near.slopes[:, column].any() for near in self.windows.linearisations)

    @cached_property
    def standard_errors(self) -> dict[str, float]:
        """The standard error of each fitted value, with the residual's autocorrelation counted."""
        inverse, sizes = inverse_information(project_out_initial_states(self.windows)[0])
        covariance = inverse * max(self.reduced_chi2, 1e-300)
        spread = np.sqrt(np.maximum(np.diag(covariance) / self.effective_fraction, 0.0))
        spread = np.divide(spread, sizes, out=np.full(len(sizes), np.inf), where=sizes > 0)
        return dict(zip(self.windows.values, spread.tolist(), strict=True))

    @cached_property
    def undetermined(self) -> set[str]:
        """The values that take part in a change of several which the data do not show."""
        slopes, _ = project_out_initial_states(self.windows)
        flat = flat_values(slopes, self.options.in_flat)
        return {name for name, is_flat in zip(self.windows.values, flat, strict=True) if is_flat}

    def intervals(self, confidence: float) -> dict[str, tuple[float, float]]:
        """The interval of each fitted value, which holds the truth with this confidence."""
        freedom = max(self.degrees_of_freedom * self.effective_fraction, 1.0)
        quantile, errors = float(stdtrit(freedom, 0.5 + confidence / 2)), self.standard_errors
        return {
            name: (value - quantile * errors[name], value + quantile * errors[name])
            for name, value in self.values.items()
        }

    def bic(self, effective_fraction: float) -> float:
        """BIC, of residuals of which this part is independent."""
        return bic(self.rss, self.count, effective_fraction, self.unknowns)


@dataclass(frozen=True, eq=False)
class TraceProblem:
    """What the trials of a trace share: the declared model, series, their noise, tolerance, and
    what the noise of their inputs does; and what the user asks."""

    declared: Model
    measured: tuple[Measured, ...]
    sigma: Mapping[str, float]
    rtol: float
    inputs: InputCovariance | None = None
    options: TraceOptions = field(default_factory=TraceOptions)
    unwritable: dict[str, TracewireError | None] = field(default_factory=dict)
    """Why no effect can be written at a place, by its name; None where one can."""

    @cached_property
    def drive_sines(self) -> dict[str, dict[str, Sine]]:
        """The sine that each measured drive is, by drive and series."""
        return drive_sines_of(self.measured, self.options.candidate)

    @property
    def signals(self) -> tuple[str, ...]:
        """What is measured."""
        return tuple(dict.fromkeys(name for m in self.measured for name in m.values))

    @property
    def states(self) -> tuple[str, ...]:
        """The states that are free where a window begins: those of the declared diagram."""
        return self.declared.states

    def compile_diagram(self, diagram: Diagram) -> Model:
        """A diagram as a model that records what is measured."""
        return compile(diagram, record=self.signals, backend="quick")

    def fit(
        self,
        effects: Sequence[PlacedEffect],
        segments: Sequence[Segment],
        length: int,
        values: Mapping[str, float],
        **options: Unpack[FitOptions],
    ) -> Trial:
        """The declared diagram with effects fitted to windows, from the values given.

        Raises FitError where the model cannot be simulated, DiagramError or OptionError where an
        effect cannot be wired, or the text at its place cannot be edited by program.
        """
        own, fixed = self.options.trial, options.get("fixed", {})
        diagram, model = self.declared.diagram, self.declared
        if effects:
            added = [(effect.candidate, effect.values) for effect in effects]
            diagram = apply(diagram, changes_of(diagram, added))
            self._refuse_unwritable(effects)
            model = self.compile_diagram(diagram)
        unknowns = [u for u in self._unknowns(effects, values) if u.name not in fixed]
        segments = [_drop_foreign_starts(segment, model) for segment in segments]
        criterion = self._criterion(
            model, self.with_series_values(segments, effects), unknowns, fixed, effects
        )
        budget = options.get("budget", np.inf)
        criterion.budget = budget * _time_of(criterion.segments) / _time_of(segments)
        windows = evaluate_windows(criterion, options.get("inlier_limit", own.not_astray))
        _refuse_failed(criterion, windows)
        windows, converged = fit_windows(
            windows,
            options.get("steps", own.steps),
            options.get("target", np.inf),
            options.get("ftol", DESCENT.ftol),
            options.get("initial_state_steps", WINDOW.initial_state_steps),
        )
        _refuse_failed(criterion, windows)
        if effects:
            release(model)  # a search keeps hundreds of models
        now = tuple(effect.with_values(windows.values) for effect in effects)
        return Trial(diagram, model, now, windows, length, converged, self.options.trial)

    def _refuse_unwritable(self, effects: Sequence[PlacedEffect]) -> None:
        """Refuse effects at places where the text has no room for one: what a search finds is
        written at its end. The text is tried once for each place."""
        diagram = self.declared.diagram
        for effect in effects:
            place = effect.candidate.place.name
            if place not in self.unwritable:
                self.unwritable[place] = None
                try:
                    patch(diagram, changes_of(diagram, [(effect.candidate, effect.values)]))
                except (DiagramError, OptionError) as error:
                    self.unwritable[place] = error
            if (known := self.unwritable[place]) is not None:
                raise known

    def try_refit(
        self,
        trial: Trial,
        segments: Sequence[Segment] | None = None,
        length: int | None = None,
        target: float = np.inf,
    ) -> Trial | None:
        """A trial refitted as by `refit`; None where the model does not run."""
        try:
            return self.refit(trial, segments, length, target)
        except FitError:
            return None

    def refit(
        self,
        trial: Trial,
        segments: Sequence[Segment] | None = None,
        length: int | None = None,
        target: float = np.inf,
    ) -> Trial:
        """A trial fitted to other windows, of about `length` samples, from where it stands; to its
        own ones unless others are given. `target` is that of FitOptions. Raises as `fit` does."""
        segments = trial.windows.segments if segments is None else segments
        length = trial.length if length is None else length
        fixed = trial.windows.criterion.parameters
        effects = self.fit_unseen_phases(trial, segments)
        found = self.fit(
            effects,
            with_fitted_starts(segments, trial),
            length,
            trial.values,
            fixed=fixed,
            target=target,
            inlier_limit=trial.inlier_limit,
        )
        return self._refit_ruled(found)

    def _refit_ruled(self, trial: Trial) -> Trial:
        """A trial that a few windows rule, fitted without them first and then to all, where that
        does better: values and a start may hold each other where neither is right. Neither fit may
        take more steps than the one that gave the trial."""
        options, segments = self.options.trial, trial.windows.segments
        means = trial.window_mean_squares
        others = np.flatnonzero(means <= options.ruling * np.median(means)).tolist()
        few = len(others) >= (1 - options.few_ruling) * len(segments)
        if trial.reduced_chi2 < options.not_astray or len(others) == len(segments) or not few:
            return trial
        fixed, inlier_limit = trial.windows.criterion.parameters, trial.inlier_limit
        budget = trial.windows.criterion.steps
        try:
            there = self.fit(
                trial.effects, [segments[n] for n in others], trial.length, trial.values,
                fixed=fixed, budget=budget, inlier_limit=inlier_limit,
            )  # fmt: skip
            whole = self.fit(
                there.effects, with_starts_of(segments, there, others), trial.length, there.values,
                fixed=fixed, budget=budget, target=trial.rss, inlier_limit=inlier_limit,
            )  # fmt: skip
        except FitError:
            return trial
        return whole if whole.rss < trial.rss else trial

    def on_some_windows(self, trial: Trial, numbers: Sequence[int]) -> Trial:
        """A trial on some of its windows, by number, as they are."""
        segments = trial.windows.segments
        if len(numbers) == len(segments):
            return trial
        criterion = self.free_criterion(trial, [segments[n] for n in numbers], trial.values)
        return replace(trial, windows=evaluate_windows(criterion, trial.windows.inlier_limit))

    def residuals_on(self, trial: Trial, segments: Sequence[Segment]) -> list[Vector]:
        """The residuals in sigma of a trial on other windows, where only starts are fitted."""
        return self.windows_on(trial, segments).residuals

    def windows_on(
        self, trial: Trial, segments: Sequence[Segment], inlier_limit: float = 2.0
    ) -> Windows:
        """A trial on other windows, where only starts are fitted; `inlier_limit` as in Windows.
        One that leaves many times what the trial leaves where it was fitted begins anew."""
        windows = evaluate_windows(self.criterion_on(trial, segments), inlier_limit)
        far = self.options.trial.gate_astray * max(trial.reduced_chi2, 1.0)
        return follow_growing_parts(fit_initial_states(windows), self.options.out_of_step, far)

    def criterion_on(self, trial: Trial, segments: Sequence[Segment]) -> Criterion:
        """The criterion of a trial on other windows, with its values fixed."""
        segments = self.with_series_values(segments, self.fit_unseen_phases(trial, segments))
        return self._criterion(trial.model, segments, [], self.all_values(trial), trial.effects)

    def free_criterion(
        self, trial: Trial, segments: Sequence[Segment], values: Mapping[str, float]
    ) -> Criterion:
        """The criterion of a trial on other windows, with its unknowns free from `values`, and what
        else is there fixed."""
        unknowns = [replace(u, value=values[u.name]) for u in trial.windows.criterion.unknowns]
        others = {name: v for name, v in values.items() if name not in trial.windows.values}
        fixed = {**trial.windows.criterion.parameters, **others}
        return self._criterion(trial.model, segments, unknowns, fixed, trial.effects)

    def fixed_criterion(
        self, trial: Trial, segments: Sequence[Segment], values: Mapping[str, float]
    ) -> Criterion:
        """The criterion of a trial on other windows, with its unknowns fixed at `values`."""
        fixed = {**trial.windows.criterion.parameters, **values}
        return self._criterion(trial.model, segments, [], fixed, trial.effects)

    def fit_unseen_phases(
        self, trial: Trial, segments: Sequence[Segment]
    ) -> tuple[PlacedEffect, ...]:
        """The effects of a trial with what each series of other windows has of its own: a series
        that the trial did not see gets the phase that fits it best."""
        effects = list(trial.effects)
        fixed = self.all_values(trial)
        for number, effect in enumerate(effects):
            seen = effect.own_series
            new: dict[str, list[Segment]] = {}
            for segment in segments if seen else ():
                name = segment.measured.series or segment.measured.name
                if name not in seen:
                    new.setdefault(name, []).append(segment)
            for (name, mine), shape in product(new.items(), effect.candidate.each):
                key = f"{shape}@{name}"

                def criterion_at(phase: float, number: int = number, key: str = key,
                                 mine: list[Segment] = mine) -> Criterion:  # fmt: skip
                    changed = effects[number].with_value(key, phase)
                    unknown = Unknown(changed.unknown(key), phase)
                    those = self.with_series_values(
                        mine, [*effects[:number], changed, *effects[number + 1 :]]
                    )
                    return self._criterion(trial.model, those, [unknown], fixed, trial.effects)

                effects[number] = effects[number].with_value(
                    key, fit_phase(criterion_at, self.options.trial)
                )
        return tuple(effects)

    def with_series_values(
        self, segments: Sequence[Segment], effects: Sequence[PlacedEffect]
    ) -> list[Segment]:
        """Windows whose series have what effects need of each series, and nothing of others: the
        sine of its drive, a phase of its own."""
        declared = {measured.name: measured.parameters for measured in self.measured}
        known: dict[str, Measured] = {}
        for segment in segments:
            measured = segment.measured
            own = dict(declared.get(measured.name, {}))
            for effect in effects:
                own |= effect.series_values(measured.series or measured.name)
            if own != measured.parameters:
                known.setdefault(measured.name, replace(measured, parameters=own))
        return [replace(s, measured=known.get(s.measured.name, s.measured)) for s in segments]

    def all_values(self, trial: Trial) -> dict[str, float]:
        """The values of all that was fitted or fixed in a trial."""
        return {**trial.windows.criterion.parameters, **trial.values}

    def _criterion(
        self,
        model: Model,
        segments: Sequence[Segment],
        unknowns: Sequence[Unknown],
        fixed: Mapping[str, float],
        effects: Sequence[PlacedEffect],
    ) -> Criterion:
        """The sum of squares in sigma, which is what a likelihood needs."""
        values = {**fixed, **{u.name: u.value for u in unknowns}}
        lasting = tuple(state for effect in effects for state in effect.candidate.lasting)
        ahead = [with_lead_in(model, segment, values) for segment in segments]
        segments = with_memory(model, ahead, lasting, values)
        longest = max(segment.time_in_samples for segment in segments)
        options = self.options.trial
        return Criterion(
            model,
            segments,
            unknowns,
            fixed,
            self.rtol,
            self.sigma,
            weighting="sum",
            chained=True,
            whitening=self.inputs.whitening if self.inputs and self.inputs.series else None,
            limits=Limits(
                options.least_steps + options.steps_a_sample * longest,
                options.seconds,
                options.events_a_sample * (longest + 10),
            ),
        )

    def _unknowns(
        self, effects: Sequence[PlacedEffect], values: Mapping[str, float]
    ) -> list[Unknown]:
        given = parameter_values(self.declared, {})
        names = [n for n, p in self.declared.flat.parameters.items() if p.fit is not None]
        free = free_unknowns(self.declared, names, given) if names else []
        free += sensor_unknowns([m for m in self.measured if m.use == "train"])
        free = [replace(u, value=values.get(u.name, u.value)) for u in free]
        known = {u.name for u in free}
        for effect in effects:
            own = unknowns_of(effect.candidate, effect.values)
            free += [u for u in own if u.name not in known]
        return [replace(u, value=min(max(u.value, u.low), u.high)) for u in free]


def with_starts_of(segments: Sequence[Segment], trial: Trial, rows: Sequence[int]) -> list[Segment]:
    """Windows of which some, by number, begin where a trial on those begins."""
    found = list(segments)
    for n, segment in zip(rows, trial.windows.segments, strict=True):
        found[n] = segment
    return found


def with_fitted_starts(segments: Sequence[Segment], trial: Trial) -> list[Segment]:
    """Windows with the free starts that a trial has where it has a window that begins so: that of
    the samples alone may lead to another minimum."""

    def begin_of(segment: Segment) -> tuple[str, float, int]:
        return segment.measured.name, segment.begin, int(segment.rows[0])

    known = {begin_of(segment): segment.start for segment in trial.windows.segments}
    found = []
    for segment in segments:
        fitted = known.get(begin_of(segment), {})
        own = {name: fitted[name] for name in segment.free if name in fitted}
        found.append(replace(segment, start={**segment.start, **own}) if own else segment)
    return found


def _time_of(segments: Sequence[Segment]) -> float:
    """The time in s that the runs of windows take together."""
    return sum(float(segment.t[-1]) - segment.begin for segment in segments)


def _refuse_failed(criterion: Criterion, windows: Windows) -> None:
    """Raises FitError where a window does not run."""
    failed = any(not near.ran for near in windows.linearisations)
    if failed and criterion.failure is not None:
        raise FitError(criterion.failure.problems)


def _drop_foreign_starts(segment: Segment, model: Model) -> Segment:
    """The segment without starts of states that the model has not: another effect's memory."""
    start = {name: value for name, value in segment.start.items() if name in model.states}
    memory = {name: value for name, value in segment.memory.items() if name in model.states}
    free = tuple(name for name in segment.free if name in model.states)
    same = len(start) == len(segment.start) and len(free) == len(segment.free)
    same = same and len(memory) == len(segment.memory)
    return segment if same else replace(segment, start=start, free=free, memory=memory)
