"""The models of a search compared: errors before and after, curves, and what declared parameters
did."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracewire.array_types import Vector
from tracewire.residual import Section, Segment
from tracewire.solve import parameter_values
from tracewire.trace.choose.unseen import join_names
from tracewire.trace.found import ChannelError, Curve, ParameterChange, RunKind
from tracewire.trace.results.intervals import reported_errors
from tracewire.trace.search.search import Search
from tracewire.trace.trials.bounds import at_bounds
from tracewire.trace.trials.free_run import first_part, free_run
from tracewire.trace.trials.trial import TraceProblem, Trial


@dataclass(frozen=True, eq=False)
class ModelComparison:
    """A section with the residuals of both models in SI, in windows and in one free run, by the
    rows of `segment`, shape (N, signals); `edges` are times where windows begin."""

    use: str
    segment: Segment
    windowed: tuple[Vector, Vector]
    free: tuple[Vector, Vector]
    edges: Vector

    def errors(self, sigma: dict[str, float], units: dict[str, str]) -> Iterator[ChannelError]:
        """The root mean square errors of each signal."""
        kinds: dict[RunKind, tuple[Vector, Vector]]
        kinds = {"windowed": self.windowed, "free run": self.free}
        for n, signal in enumerate(self.segment.signals):
            for kind, pair in kinds.items():
                before, after = (float(np.sqrt(np.mean(r[:, n] ** 2))) for r in pair)
                at = self.segment.measured.name, self.use, signal, units.get(signal, "")
                yield ChannelError(*at, kind, before, after, sigma[signal])

    def curves(self, sigma: dict[str, float], units: dict[str, str]) -> Iterator[Curve]:
        """Each measured signal with both free runs."""
        samples = self.segment.samples()
        for n, signal in enumerate(self.segment.signals):
            yield Curve(
                series=self.segment.measured.name,
                use=self.use,
                signal=signal,
                unit=units.get(signal, ""),
                t=self.segment.t,
                measured=samples[:, n],
                before=samples[:, n] + self.free[0][:, n],
                after=samples[:, n] + self.free[1][:, n],
                edges=self.edges,
                windowed_before=self.windowed[0][:, n] / sigma[signal],
                windowed_after=self.windowed[1][:, n] / sigma[signal],
            )


def compare_models(search: Search, declared: Trial, best: Trial) -> list[ModelComparison]:
    """Both models on every section: what was fitted, the gate, and what played no part."""
    data_split = search.data_split
    uses = (
        ("train", data_split.whole()),
        ("gate", [s for s in data_split.gate if s.measured.use == "gate"]),
        ("validate", data_split.validate),
    )
    return [
        _compare(search, use, section, declared, best)
        for use, sections in uses
        for section in sections
    ]


def _compare(
    search: Search, use: str, section: Section, declared: Trial, best: Trial
) -> ModelComparison:
    problem = replace(search.problem, inputs=None)  # residuals as they are, and not as they count
    windows = search.windows([section], search.short_length)
    (whole,) = search.whole_windows([section])
    sigma = np.array([problem.sigma[name] for name in whole.signals])
    trials = (declared, best) if best is not declared else (declared,)
    inside = [np.concatenate(problem.residuals_on(trial, windows)) * sigma for trial in trials]
    free = [free_run(problem, trial, whole, search.shortest) * sigma for trial in trials]
    return ModelComparison(
        use,
        whole,
        (inside[0], inside[-1]),
        (free[0], free[-1]),
        np.array([window.begin for window in windows]),
    )


def on_equal_windows(problem: TraceProblem, declared: Trial, best: Trial) -> Trial:
    """The declared model on the windows of the best one, refitted where its own have another
    length: what a model leaves on long windows is no measure of what another leaves on short ones.
    Where it does not run there, it is as it was."""
    if declared.length == best.length:
        return declared
    return problem.try_refit(declared, best.windows.segments, best.length) or declared


def with_unseen_phases(search: Search, trial: Trial) -> Trial:
    """The trial whose effects have what series of their own need that no fit saw: the phase of a
    wave, from the first part of each such series alone."""
    if not any(effect.own_series for effect in trial.effects):
        return trial
    firsts = [
        first_part(whole, search.shortest, search.options.split.first_part)
        for whole in search.whole_windows(search.data_split.unseen)
    ]
    effects = search.problem.fit_unseen_phases(trial, firsts)
    for before, effect in zip(trial.effects, effects, strict=True):
        series = [f"'{name}'" for name in sorted(effect.own_series - before.own_series)]
        if series:
            part = f"{100 * search.options.split.first_part:.0f} %"
            search.words.append(
                f"in {join_names(series)}, which no fit saw, the phase of {effect} is fitted to the"
                f" first {part} alone"
            )
    return replace(trial, effects=effects)


def rmse(parts: Sequence[ModelComparison], which: int) -> float:
    """The root mean square of free-run residuals over all signals, in SI."""
    return float(np.sqrt(np.mean(np.concatenate([p.free[which].ravel() for p in parts]) ** 2)))


def parameter_changes(
    problem: TraceProblem, declared: Trial, best: Trial, values: dict[str, float]
) -> list[ParameterChange]:
    """The declared parameters without and with the effects."""
    errors, flat = reported_errors(best, problem.options), problem.declared.flat
    known, given = flat.parameters, parameter_values(problem.declared, {})
    held = {one.name for one in at_bounds(declared)}
    return [
        ParameterChange(
            name,
            known[name].unit if name in known else "",
            value,
            values.get(name, 0.0),
            errors.get(name, 0.0),
            *(known[name].users_unit if name in known else ("", 1.0)),
            at_bound=name in held,
            declared=given.get(name),
        )
        for name, value in declared.values.items()
    ]
