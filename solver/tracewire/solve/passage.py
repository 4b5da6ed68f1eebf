"""`Passage`: a run that goes on from one stop to the next, for analyses that look at it there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.ctypeslib import as_ctypes
from numpy.typing import ArrayLike

from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, unknown
from tracewire.solve.core.arrays import Arrays
from tracewire.solve.core.codes import (
    BUDGET,
    END,
    EVENTS,
    FINISHED,
    LOG_FULL,
    LOG_HEAD,
    PAUSED,
    SAMPLED,
    STEPS,
    T,
)
from tracewire.solve.core.collocation import SLOPED
from tracewire.solve.core.flow import FREE, FUNCTIONS
from tracewire.solve.core.memory import invoke
from tracewire.solve.core.methods import NAMES, STEPPED
from tracewire.solve.core_library import library
from tracewire.solve.failures import failure
from tracewire.solve.history import refuse_delays
from tracewire.solve.integrator import Integrator
from tracewire.solve.interrupt import Interrupted, StopFlag
from tracewire.solve.limits import STEP
from tracewire.solve.options import START
from tracewire.solve.problem import initial_value_problem, start_of
from tracewire.solve.workspace import set_to


class Passage:
    """A run of a model that stops where it is told to, and goes on from there.

    Modes, slides, contacts and memories go on over a stop; parameters are those of the beginning.
    With `tangents` the columns of S (n, n), which follow S' = f_x S and jump with the states at
    events, are there to be read and set at each stop; they begin as the identity. `length` in s is
    about how far it is from one stop to the next; `inner` is the number of instants between two
    stops at which states are kept. The other arguments are those of `simulate`.

    Raises OptionError and SimulationError as `simulate` does.
    """

    def __init__(
        self,
        model: Model,
        *,
        length: float,
        begin: float = 0.0,
        parameters: Mapping[str, float] | None = None,
        start: Mapping[str, float] | None = None,
        preset: str = "",
        inputs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
        method: str = "auto",
        rtol: float = 1e-9,
        atol: float | Mapping[str, float] | None = None,
        tangents: bool = False,
        inner: int = 0,
        stop_flag: StopFlag | None = None,
    ) -> None:
        known = ["auto", *(name for name in NAMES if name not in STEPPED)]
        if method not in known:
            raise OptionError([unknown("method", method, known)])
        if not (np.isfinite(length) and length > 0 and np.isfinite(begin)):
            what = f"an interval of {length:g} s from t = {begin:g} s has no use"
            raise OptionError([Problem(what, hint="Give a finite length above 0.")])
        refuse_delays(model, "an analysis")
        self.model, self._inner = model, inner
        asked = [START + name for name in model.states] if tangents else []
        self._problem = initial_value_problem(
            model,
            asked,
            sampled=False,
            span=(begin, begin + STEP.passage * length),
            parameters=parameters,
            start=start,
            method=method,
            rtol=rtol,
            atol=atol,
            preset=preset,
            inputs=inputs,
        )
        model.routines.compiled_addresses(FUNCTIONS)  # several passages may run in threads
        problem = replace(self._problem, times=np.zeros(inner))
        self._integrator = Integrator(problem, records="states", stop_flag=stop_flag or StopFlag())
        self.arrays: Arrays = self._integrator.arrays
        self._integrator.workspace.keep()
        self._settle()

    @property
    def parameters(self) -> Mapping[str, float]:
        """The value of each parameter in SI."""
        return self._problem.parameters

    def begin_with(self, parameters: Mapping[str, float], *, begin: float, length: float) -> None:
        """Begin anew at the start values with other values of parameters, over those of the first
        beginning. Raises OptionError and SimulationError.
        """
        span = (begin, begin + STEP.passage * length)
        self._problem = self._problem.with_values(parameters, span)
        self._integrator.workspace.renew()
        set_to(self.arrays, replace(self._problem, times=np.zeros(self._inner)))
        self._integrator.workspace.keep()
        self.begin_at(begin, self._problem.start)

    def begin_at(self, t: float, x: Vector) -> None:
        """Begin anew at a time and states (n,): modes are decided anew, memories at their start."""
        self._integrator.workspace.renew()
        self._integrator.begin = t
        progress = self.arrays.progress
        progress.now[END] += t - progress.now[T]
        progress.now[T] = self.arrays.sensitivity.now[0] = t
        progress.x[:] = x
        self._settle()

    def _settle(self) -> None:
        """Decide the modes at the beginning; no step is taken."""
        self._integrator.forget()
        self.arrays.progress.ints[BUDGET] = 0
        code = library()
        status = code.advance(self._integrator.workspace.address)
        code.check()
        if status not in (FINISHED, PAUSED, LOG_FULL):
            raise failure(self.model, self.arrays, status)

    @property
    def t(self) -> float:
        """The time of the stop in s."""
        return float(self.arrays.progress.now[T])

    @property
    def x(self) -> Vector:
        """The states (n,) at the stop: the right limit."""
        return self.arrays.progress.x.copy()

    @property
    def tangents(self) -> Matrix:
        """The tangent vectors at the stop, the columns of S (n, n)."""
        return self.arrays.sensitivity.s.copy()

    @tangents.setter
    def tangents(self, columns: Matrix) -> None:
        sensitivity = self.arrays.sensitivity
        sensitivity.s[:] = columns
        sensitivity.peak[:] = np.maximum(np.abs(columns), self.arrays.progress.atol[:, None])
        sensitivity.now[SLOPED] = 0.0

    @property
    def declared_start(self) -> Vector:
        """The states (n,) with which the diagram begins."""
        problem = self._problem
        return start_of(self.model, problem.constants, problem.tables, {})

    def go_to(self, end: float, inner: ArrayLike = ()) -> None:
        """Go on to the time `end` in s; what happens there has happened then.

        `inner` holds the ascending instants in (t, end] at which states are kept: see `inside`.
        Raises SimulationError where it cannot go on, Interrupted where the user stops it.
        """
        progress = self.arrays.progress
        times = np.asarray(inner, dtype=float)
        if len(progress.times):
            progress.times[:] = times if len(times) else np.inf
            progress.ints[SAMPLED] = 0 if len(times) else len(progress.times)
        progress.ints[STEPS] = 0
        self._integrator.forget()
        if end > progress.now[T]:
            try:
                self._integrator.go_to(end)
            except Interrupted as error:
                what = f"interrupted at t = {self.t:.9g} s, on the way to {end:g} s"
                raise Interrupted([Problem(what)]) from error

    @property
    def inside(self) -> Matrix:
        """The states (K, n) at the inner instants of the last interval."""
        return self.arrays.progress.samples.copy()

    @property
    def log(self) -> Matrix:
        """What happened in the last interval, in order: time, kind, mode, direction, x⁻, x⁺."""
        rows = self._integrator.log.rows
        return rows[:, : LOG_HEAD + 2 * len(self.model.states)]

    @property
    def kinds(self) -> set[str]:
        """The kinds of what happened in the last interval."""
        return {EVENTS[int(kind)] for rows in self._integrator.log.parts for kind in rows[:, 1]}

    @property
    def modes(self) -> Vector:
        """The values of the modes (M,) at the stop."""
        return self.arrays.flow.m[: len(self.model.modes)].copy()

    @property
    def held(self) -> list[int]:
        """The modes whose guards are held at zero: slides and resting contacts."""
        return np.flatnonzero(self.arrays.flow.bound != FREE).tolist()

    def value(
        self, function: str, size: int, x: Vector, t: float, modes: Vector | None = None
    ) -> Vector:
        """A function of the model (see `Routines.address`) at a time and states, (size,).

        `modes` (M,) in place of those at the stop.
        """
        flow, out = self.arrays.flow, np.zeros(size)
        m = flow.m
        if modes is not None:
            m = m.copy()
            m[: len(modes)] = modes
        address = self.model.routines.compiled_address(function)
        invoke(address, t, np.ascontiguousarray(x), m, flow.c, flow.k, out)
        return out

    def rates(self) -> Vector:
        """The rates (n,) at the stop: on a slide those along it."""
        return self.rates_at(self.x)

    def rates_at(self, x: Vector) -> Vector:
        """The rates (n,) at other states, with the modes, slides and contacts of the stop."""
        at, out = np.ascontiguousarray(x, dtype=float), np.zeros(len(self.model.states))
        pointers = [as_ctypes(array) for array in (at, out)]
        library().rates(
            self._integrator.workspace.address, self.t, pointers[0], len(at), pointers[1], len(at)
        )
        return out

    def slopes(self) -> Matrix:
        """d rates / d x (n, n) at the stop: on slides and contacts by differences."""
        x, n = self.x, len(self.model.states)
        out = np.zeros(n * (n + 1))
        pointers = [as_ctypes(array) for array in (x, out)]
        library().jacobian(
            self._integrator.workspace.address, self.t, pointers[0], n, pointers[1], n, n + 1
        )
        return out.reshape(n, n + 1)[:, :n]

    @property
    def steps(self) -> int:
        """The steps, accepted and rejected ones, of the last interval."""
        return int(self.arrays.progress.ints[STEPS])

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user should know of the way so far."""
        return self._integrator.warnings

    def jacobian(
        self, x: Vector | None = None, t: float | None = None, modes: Vector | None = None
    ) -> Matrix:
        """d rate / d x (n, n), at the stop unless states and time are given."""
        n = len(self.model.states)
        at, when = self.x if x is None else x, self.t if t is None else t
        return self.value("jacobian", n * (n + 1), at, when, modes).reshape(n, n + 1)[:, :n]
