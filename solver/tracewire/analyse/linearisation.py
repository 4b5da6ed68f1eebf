"""`linearise`: the matrices A, B, C, D of a model at a state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import import_module
from typing import Any

import numpy as np

from tracewire.analyse import verdict
from tracewire.analyse.characteristic import characteristic_roots
from tracewire.analyse.equilibrium import describe_rates, is_steady, state_sizes
from tracewire.analyse.internal_delays import InternalDelays
from tracewire.analyse.limits import EQUILIBRIUM
from tracewire.arguments import checked
from tracewire.array_types import Complexes, Matrix, Vector
from tracewire.compile import Model, at_rest
from tracewire.errors import AnalysisError, OptionError, Problem, unknown
from tracewire.formula import to_text
from tracewire.result import Result
from tracewire.solve import Passage

NOT_STEADY = "not a steady state"


@dataclass(frozen=True, eq=False, repr=False)
class Linear(Result):
    """A linear model dx' = A dx + B du, dy = C dx + D du around the states `x` (n,) at the time t.

    A (n, n), B (n, p), C (q, n), D (q, p) in SI; `states`, `inputs` (p) and `outputs` (q) name the
    rows and columns. `rates` (n,) are those at x: zero at a steady state; `told` says in words
    those that are not. `delays` has the further matrices of a model with delays, None without.
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    t: float
    x: Vector
    rates: Vector
    A: Matrix
    B: Matrix
    C: Matrix
    D: Matrix
    told: str = ""
    delays: InternalDelays | None = None

    @cached_property
    def eigenvalues(self) -> Complexes:
        """The eigenvalues (n,) of A in 1/s, those of the largest real part first.

        With delays the characteristic roots of which there is no end: the rightmost ones. Raises
        AnalysisError where a delay feeds itself without a state.
        """
        terms = {} if self.delays is None else self.delays.terms()
        if terms:
            return characteristic_roots(self.A, terms)
        found = np.linalg.eigvals(self.A).astype(np.complex128)
        return found[np.lexsort((-found.imag, -found.real))]

    @property
    def verdict(self) -> str:
        """Whether the steady state is stable; "not a steady state" where rates are not zero."""
        return NOT_STEADY if self.told else verdict.of_eigenvalues(self.eigenvalues)

    def transfer(self, s: complex) -> Complexes:
        """The transfer function (q, p) at a complex s in 1/s, with exp(-s T) of the delays."""
        one = np.eye(len(self.x))
        d = self.delays
        if d is None:
            inner = np.linalg.solve(s * one - self.A, self.B.astype(np.complex128))
            return np.asarray(self.C @ inner + self.D)
        late = np.diag(np.exp(-s * d.times))
        late = np.linalg.solve(np.eye(len(d.times)) - late @ d.D22, late)  # w of what x and u give
        x = np.linalg.solve(s * one - self.A - d.B2 @ late @ d.C2, self.B + d.B2 @ late @ d.D21)
        w = late @ (d.C2 @ x + d.D21)
        return np.asarray(self.C @ x + self.D + d.D12 @ w)

    def to_control(self) -> Any:
        """The same as a StateSpace of python-control; stop.v is called `stop_v` there.

        Raises AnalysisError where it is not installed, or there are delays, which it does not know.
        """
        if self.delays is not None:
            what = "python-control has no delays"
            hint = "Put pade_delay in their place, or take the matrices of `delays`."
            raise AnalysisError([Problem(what, hint=hint)])
        try:
            control = import_module("control")
        except ImportError:
            what = "python-control is not installed"
            raise AnalysisError([Problem(what, hint="Install it: pip install control.")]) from None
        return control.ss(
            self.A,
            self.B,
            self.C,
            self.D,
            states=[name.replace(".", "_") for name in self.states],
            inputs=[name.replace(".", "_") for name in self.inputs],
            outputs=[name.replace(".", "_") for name in self.outputs],
        )


@checked
def linearise(
    model: Model,
    *,
    at: Mapping[str, float] | None = None,
    t: float = 0.0,
    inputs: Sequence[str] = (),
    outputs: Sequence[str] | None = None,
    parameters: Mapping[str, float] | None = None,
    preset: str = "",
) -> Linear:
    """Linearise a model: exact derivatives of its rates and signals, from the tape.

    A delay stays one, beside the matrices: see `InternalDelays`. At the states of `at` it gives
    what goes into it, as after a rest there.

    `at` gives states by name in place of the start values, `t` in s is the time. `inputs` names
    what B and D are about: parameters, measured inputs of the diagram, or signals, which are then
    taken as given from outside. `outputs` names the rows of C and D, the recorded signals unless
    given.

    Raises AnalysisError at a nonsmooth point, with the guards that are at their level there;
    OptionError for names that do not exist.
    """
    rest = at_rest(model) if model.reads_past else None
    settled, cut = (model, model) if rest is None else (rest.settled, rest.opened)
    shown = with_outputs(cut, outputs)
    names = _inputs(cut, inputs)
    passage = Passage(settled, length=1.0, begin=t, parameters=parameters, start=at, preset=preset)
    refuse_nonsmooth(passage)
    x, n = passage.x, len(model.states)
    ports: tuple[str, ...] = ()
    given, times = dict(parameters or {}), np.zeros(0)
    if rest is not None:
        known = replace(settled, recorded=(*rest.signals, *rest.times))
        ports, m = rest.outputs, len(rest.outputs)
        there = Passage(known, length=1.0, begin=t, parameters=given, start=at, preset=preset)
        values = there.value("outputs", 2 * m, x, t)
        given |= dict(zip(ports, values[:m].tolist(), strict=True))
        times = values[m:]
        shown = replace(shown, recorded=(*shown.recorded, *rest.signals))
    seen = Passage(shown, length=1.0, begin=t, parameters=given, start=at, preset=preset)
    q = len(shown.recorded)

    def slopes(of: str, by: Sequence[str], rows: int) -> Matrix:
        if not (rows and by):
            return np.zeros((rows, len(by)))
        function = shown.derivative(of, by)
        return seen.value(function, rows * len(by), x, t).reshape(rows, len(by))

    sizes = state_sizes(passage)
    by_x, by_u, by_w = (slopes("outputs", by, q) for by in (model.states, names, ports))
    q -= len(ports)
    delays = None
    if rest is not None:
        delays = InternalDelays(
            signals=tuple(to_text(cut.flat.signals[name]) for name in rest.signals),
            times=times,
            B2=slopes("rhs", ports, n),
            C2=by_x[q:],
            D12=by_w[:q],
            D21=by_u[q:],
            D22=by_w[q:],
        )
    found = Linear(
        states=model.states,
        inputs=names,
        outputs=shown.recorded[:q],
        t=t,
        x=x,
        rates=passage.rates(),
        A=slopes("rhs", model.states, n),
        B=slopes("rhs", names, n),
        C=by_x[:q],
        D=by_u[:q],
        told="" if is_steady(passage, sizes) else describe_rates(passage, sizes),
        delays=delays,
    )
    parts: list[tuple[object, str]] = [(found, name) for name in "ABCD"]
    parts += [(delays, name) for name in ("B2", "C2", "D12", "D21", "D22") if delays is not None]
    for of, name in parts:
        if not np.isfinite(getattr(of, name)).all():
            what = f"the matrix {name} is not finite at this state"
            hint = "Look for a root or a division whose slope has no end there."
            raise AnalysisError([Problem(what, hint=hint)])
    return found


def with_outputs(model: Model, outputs: Sequence[str] | None) -> Model:
    """The model that records these signals, states or parameters. Raises OptionError."""
    if outputs is None:
        return model
    flat = model.flat
    known = {*model.states, *flat.signals, *flat.inputs}
    wrong = [unknown("signal", name, known) for name in outputs if name not in known]
    if wrong:
        raise OptionError(wrong)
    return replace(model, recorded=tuple(dict.fromkeys(outputs)))


def _inputs(model: Model, inputs: Sequence[str]) -> tuple[str, ...]:
    """The names of inputs, which may move freely. Raises OptionError."""
    flat, low = model.flat, model.lowered
    known = {*model.parameters, *flat.signals, *flat.inputs}
    problems = [unknown("input", name, known) for name in inputs if name not in known]
    for name in inputs:
        if name in known and low.tape.leaves([low.entries[name]]) <= {"const"}:
            what = f"the signal '{name}' is a constant, which the equations no longer name"
            hint = "Make it a parameter, or an input of the diagram: inputs: {u: {default: 0}}."
            problems.append(Problem(what, hint=hint))
    if problems:
        raise OptionError(problems)
    return tuple(dict.fromkeys(inputs))


def refuse_nonsmooth(passage: Passage) -> None:
    """Raises AnalysisError where a guard is at its level and what lies beyond it differs."""
    problems = [
        Problem(
            f"there are no slopes at t = {passage.t:g} s: {why}",
            hint="Give states on one side of it (at=, --start), or a smooth law instead.",
        )
        for why in nonsmooth(passage)
    ]
    if problems:
        raise AnalysisError(problems)


def nonsmooth(passage: Passage) -> list[str]:
    """In words, the guards that are at their level at a stop, where it makes a difference."""
    model = passage.model
    modes, x, t = model.modes, passage.x, passage.t
    if not modes:
        return []
    n = len(x)
    guards = passage.value("guards", len(modes), x, t)
    slopes = passage.value("guard_gradients", len(modes) * n, x, t).reshape(len(modes), n)
    size = EQUILIBRIUM.at_guard * (1.0 + np.abs(x).max(initial=0.0))
    reach = size * (1.0 + np.abs(slopes).sum(axis=1))
    held, m = passage.held, passage.modes
    found = []
    for i, mode in enumerate(modes):
        where = f"'{mode.text}' of {mode.signal or 'an event'}"
        if i in held:
            found.append(f"{where} is held at zero")
            continue
        if mode.kind == "memory":
            continue
        level = 0.0 if mode.kind == "sign" else np.round(guards[i])
        if mode.kind == "segment" or abs(guards[i] - level) > reach[i]:
            continue
        if mode.timed is None and any(r.trigger == i for r in model.lowered.resets):
            found.append(f"{where} is at zero, where an event fires")
            continue
        other = m.copy()
        if mode.kind == "sign":
            other[i] = 1.0 - m[i]
        else:
            other[i] = level - 1.0 if m[i] >= level else level
        if _differs(passage, m, other, mode.timed is None):
            found.append(f"{where} is at its level")
    return found


def _differs(passage: Passage, m: Vector, other: Vector, rates: bool) -> bool:
    """Whether slopes differ in two mode combinations, or also the rates."""
    x, t, n = passage.x, passage.t, len(passage.x)
    pairs = [(passage.jacobian(modes=m), passage.jacobian(modes=other))]
    if rates:
        pairs.append((passage.value("rhs", n, x, t, m), passage.value("rhs", n, x, t, other)))
    return any(
        bool(np.any(np.abs(a - b) > EQUILIBRIUM.alike * (1.0 + np.abs(a) + np.abs(b))))
        for a, b in pairs
    )
