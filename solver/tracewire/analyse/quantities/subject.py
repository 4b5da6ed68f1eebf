"""A model under conditions: its run, and what analyses find, each made once."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from tracewire.analyse.bifurcation_diagram import Bifurcation, bifurcation
from tracewire.analyse.floquet_multipliers import Floquet, floquet
from tracewire.analyse.limits import QUANTITY
from tracewire.analyse.lyapunov_exponents import Lyapunov, lyapunov
from tracewire.analyse.orbit import PeriodicOrbit, periodic_orbit
from tracewire.analyse.plane import Plane, span_of
from tracewire.analyse.poincare_section import PoincareSection, section
from tracewire.analyse.quantities.conditions import Conditions
from tracewire.analyse.steady_states import SteadyState, steady_state
from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.errors import AnalysisError, OptionError, Problem
from tracewire.fit import Fit, fit
from tracewire.solve import Run, parameter_values, sample_times, simulate


class Recorder:
    """A model that records what its subjects ask for: one for all, as each set of signals needs
    machine code of its own."""

    def __init__(self, model: Model) -> None:
        self._model = self._bare = model

    def fresh(self) -> Recorder:
        """The same before anything was asked for."""
        return Recorder(self._bare)

    @property
    def model(self) -> Model:
        """The model with all signals that were asked for."""
        return self._model

    def ask(self, name: str) -> None:
        """Record a signal or state, by its full name."""
        if name not in self._model.recorded:
            self._model = replace(self._model, recorded=(*self._model.recorded, name))


class Subject:
    """A model under conditions. What is asked for is computed once; a run is made again only where
    it lacks a signal or a time.

    `ask` tells beforehand what will be asked for, so that one run has it all.
    """

    def __init__(
        self,
        recorder: Recorder,
        conditions: Conditions,
        *,
        workers: int | None = None,
        tell: Callable[[str], None] | None = None,
    ) -> None:
        self.recorder, self.conditions = recorder, conditions
        self.workers, self.tell = workers, tell if tell is not None else silent
        self.times: list[Vector] = []
        self.failed = False  # whether its last run did
        self._run: Run | None = None

    @property
    def model(self) -> Model:
        """The model, with all signals that were asked for."""
        return self.recorder.model

    @cached_property
    def parameters(self) -> Mapping[str, float]:
        """The values of all parameters in SI."""
        options = self.conditions.options
        return parameter_values(
            self.model, options.get("parameters") or {}, options.get("preset", "")
        )

    @cached_property
    def span(self) -> tuple[float, float]:
        """From when to when in s the run goes, as far as no signal is read later."""
        begin, end = self.conditions.options.get("span") or span_of(self.model, self.parameters)
        return begin, end

    @cached_property
    def t(self) -> Vector:
        """The sample times (N,) in s that count, and the end of a span that is given.

        Raises OptionError where they are too few.
        """
        c = self.conditions
        times = c.options.get("times")
        begin, end = self.span
        first = begin if c.since is None else max(begin, c.since)
        if c.samples is not None and first < end:
            return np.linspace(first, end, c.samples)
        if times is None:
            every = c.options.get("every")
            times = sample_times(self.model, self.parameters, (begin, end), every)
            if "span" in c.options and times[-1] < end - QUANTITY.same_time * abs(end - begin):
                times = np.append(times, end)
        found = np.asarray(times, dtype=float).ravel()
        if c.since is not None:
            found = found[found >= c.since - QUANTITY.same_time * abs(end - begin)]
        if len(found) < 2:
            since = "the begin" if c.since is None else f"{c.since:g} s"
            what = f"there are fewer than two samples from {since} on"
            raise OptionError([Problem(what, hint="Give an earlier `since`, or a longer span.")])
        return found

    @cached_property
    def early(self) -> Vector:
        """As many times in s from the begin of the run to the samples that count."""
        if self.conditions.since is None or not self.span[0] < self.t[0]:
            return np.empty(0)
        begin, _ = self.span
        return np.linspace(begin, self.t[0], len(self.t) + 1)[:-1]

    def ask(self, name: str, times: Vector | None = None) -> None:
        """Tell that a signal will be asked for, at times (M,) in s beside those of its samples.

        Raises OptionError where a time is before the run begins.
        """
        if times is not None:
            begin, first = self.span[0], float(np.min(times, initial=math.inf))
            if first < begin:
                what = (
                    f"a quantity reads a signal at {first:g} s, and the run begins at {begin:g} s"
                )
                raise OptionError([Problem(what, hint="Write run: {from: ...} in the statement.")])
            self.times.append(times)
        self.recorder.ask(name)

    def signal(self, name: str, times: Vector | None = None) -> Vector:
        """A signal or state in SI at the samples, or at `times` (M,) in s within the span."""
        wanted = self.t if times is None else np.atleast_1d(times)
        run = self._run
        if run is None or name not in run.signals or not _has(run.t, wanted):
            self.ask(name, times)
            run = self._run = self._simulated()
        return np.asarray(run.signals[name][np.searchsorted(run.t, wanted)])

    @property
    def run(self) -> Run:
        """The run. Raises SimulationError."""
        if self._run is None:
            self._run = self._simulated()
        return self._run

    def _simulated(self) -> Run:
        """The run with all signals and times that were asked for."""
        self.failed = True
        run = self._simulated_once()
        self.failed = False
        return run

    def _simulated_once(self) -> Run:
        model, c = self.model, self.conditions
        spaced = c.since is not None or c.samples is not None or "span" in c.options
        if not self.times and not spaced:
            return simulate(model, **c.options)
        times = np.unique(np.concatenate([self.t, *(t.ravel() for t in self.times)]))
        begin, end = self.span
        end = max(end, float(times[-1]))  # a signal may be read later than samples count
        own = ("span", "times", "every")
        options = {key: value for key, value in c.options.items() if key not in own}
        return simulate(model, **options, span=(begin, end), times=times)  # type: ignore[arg-type]

    # what analyses find

    def need(self, key: str, why: str) -> float | str:
        """A number or word that an analysis needs. Raises OptionError where it is not given."""
        found = self.conditions.study.get(key)
        if found is None:
            what = f"{why} needs '{key}'"
            raise OptionError([Problem(what, hint=f"Write run: {{{key}: ...}} in the statement.")])
        return found

    def count(self, key: str, usual: int) -> int:
        """A whole number that an analysis may be given."""
        return int(float(self.conditions.study.get(key, usual)))

    @property
    def _given(self) -> dict[str, Any]:
        """What all analyses are given."""
        options = self.conditions.options
        given: dict[str, Any] = {
            "parameters": options.get("parameters"),
            "preset": options.get("preset", ""),
        }
        if "rtol" in self.conditions.study:
            given["rtol"] = self.conditions.study["rtol"]
        return given

    @cached_property
    def floquet(self) -> Floquet:
        """The multipliers of the motion through the start states. Raises AnalysisError."""
        return self.floquet_with({}, "a multiplier")

    def floquet_with(self, more: Mapping[str, float], why: str) -> Floquet:
        """The same with other values of some parameters, in SI; `why` needs its period."""
        return floquet(
            self.model,
            float(self.need("period", why)),
            begin=float(self.conditions.study.get("phase", 0.0)),
            start=self.conditions.options.get("start"),
            **{**self._given, "parameters": {**(self._given["parameters"] or {}), **more}},
        )

    @cached_property
    def orbit(self) -> PeriodicOrbit:
        """The periodic orbit next to the start states. Raises AnalysisError."""
        return periodic_orbit(
            self.model,
            float(self.need("period", "a periodic orbit")),
            begin=float(self.conditions.study.get("phase", 0.0)),
            skip=self.count("skip", 0),
            guess=self.conditions.options.get("start"),
            modulo=self.conditions.modulo,
            **self._given,
        )

    @cached_property
    def steady(self) -> SteadyState:
        """The steady state next to the start states. Raises AnalysisError."""
        given = {key: value for key, value in self._given.items() if key != "rtol"}
        return steady_state(self.model, guess=self.conditions.options.get("start"), **given)

    @cached_property
    def plane(self) -> Plane:
        """When points of a section are taken. Raises OptionError."""
        study = self.conditions.study
        edge, guard = str(study.get("edge", "")), str(study.get("guard", ""))
        period = None if edge or guard else float(self.need("period", "a section"))
        return Plane(period=period, edge=edge, guard=guard, phase=study.get("phase", 0.0))

    @cached_property
    def section(self) -> PoincareSection:
        """The points of a section. Raises AnalysisError."""
        return self.section_from(self.conditions.options.get("start"), self.count("keep", 100))

    def section_from(self, start: Mapping[str, float] | None, keep: int) -> PoincareSection:
        """`keep` points of a section from other start states."""
        return section(
            self.model,
            self.plane,
            skip=self.count("skip", 0),
            keep=keep,
            modulo=self.conditions.modulo,
            start=start,
            **self._given,
        )

    @cached_property
    def bifurcation(self) -> Bifurcation:
        """The bifurcation diagram over a parameter. Raises OptionError."""
        over = self.conditions.over
        if len(over) != 1:
            hint = "Write run: {over: {f: 0.3:0.9:100}}."
            raise OptionError([Problem("a band needs one parameter in 'over'", hint=hint)])
        ((name, values),) = over.items()
        way = str(self.conditions.study.get("direction", "up"))
        self.tell(f"bifurcation diagram: {len(values)} values, {way.replace('_', ' and ')}")
        return bifurcation(
            self.model,
            name,
            values,
            self.plane,
            direction=way,  # type: ignore[arg-type]  # the reader knows the words
            skip=self.count("skip", 200),
            keep=self.count("keep", 100),
            modulo=self.conditions.modulo,
            start=self.conditions.options.get("start"),
            workers=self.workers,
            **self._given,
        )

    @cached_property
    def lyapunov(self) -> Lyapunov:
        """The Lyapunov exponents. Raises AnalysisError."""
        length = float(self.need("length", "a Lyapunov exponent"))
        interval = self.conditions.study.get("interval")
        self.tell(f"Lyapunov exponents over {length:g} s")
        return lyapunov(
            self.model,
            length,
            interval=None if interval is None else float(interval),
            transient=float(self.conditions.study.get("transient", 0.0)),
            start=self.conditions.options.get("start"),
            **self._given,
        )

    @cached_property
    def fit(self) -> Fit:
        """The fit of the diagram to its measured series. Raises DataError, FitError.

        A preset of the setting holds in all series, in place of theirs.
        """
        model, given = self.model, self._given
        series = model.diagram.measured
        if not series:
            raise AnalysisError([Problem("there is no measured series to fit")])
        self.tell("fit")
        preset = given.pop("preset")
        if preset:  # free parameters, and those that follow them, begin with it
            series = {name: replace(one, preset=preset) for name, one in series.items()}
            model = replace(model, diagram=replace(model.diagram, measured=series))
        if "method" in self.conditions.study:
            given["method"] = str(self.conditions.study["method"])
        return fit(model, **given)


def _has(t: Vector, times: Vector) -> bool:
    """Whether a run has samples at these times."""
    at = np.minimum(np.searchsorted(t, times), len(t) - 1)
    return bool(np.array_equal(t[at], times))


def silent(_: str) -> None:
    """Tell nobody how far it is."""
