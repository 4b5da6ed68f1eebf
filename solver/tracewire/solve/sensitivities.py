"""Sensitivities of a run: what is asked for, what the core is given, what the user gets."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.errors import OptionError, unknown
from tracewire.formula import Expression, Name, evaluate, names_of
from tracewire.solve.core.arrays import Flow, Progress, Sensitivity
from tracewire.solve.core.codes import FLAGS, GRAZES, LOST, SIMULTANEOUS, TOUCHES, ZENO
from tracewire.solve.core.jit import invoke_at
from tracewire.solve.core.variation import DERIVATIVES, OF_STARTS

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
START = "start."
STEP = 1e-3  # of a parameter that others follow; what is left of the error is of order 6
WEIGHTS = ((1.0, 3 / 4), (2.0, -3 / 20), (3.0, 1 / 60))
SAID = {
    ZENO: "takes the impacts of {guard} up to its rest for all there are: they are without end",
    GRAZES: "leaves out that {guard} moves: it only grazes zero",
    SIMULTANEOUS: "takes {guard} for as fast as what happens at the same instant",
    TOUCHES: "holds {guard} at zero from its contact on, though a change may open it",
    LOST: "is not finite at {guard} and is taken as zero there",
}


def checked(model: Model, names: Sequence[str]) -> tuple[str, ...]:
    """The names of what is asked for, each once. Raises OptionError for what does not exist."""
    there = [*model.parameters, *(START + state for state in model.states)]
    known = set(there)
    asked = tuple(dict.fromkeys([names] if isinstance(names, str) else names))
    problems = [unknown("sensitivity", name, there) for name in asked if name not in known]
    if problems:
        raise OptionError(problems)
    return asked


def follow(
    formulas: Mapping[str, Expression],
    values: Mapping[str, float],
    asked: tuple[str, ...],
    given: Mapping[str, float],
) -> dict[str, Vector]:
    """By parameter, its derivatives (q,) in what is asked for; those that are all zero left out.

    `formulas` of the parameters over each other, `values` of all of them; those that are `given`
    follow no other.
    """
    if not asked:
        return {}
    reads = {name: formulas.keys() & names_of(formula) for name, formula in formulas.items()}
    reads = {name: read for name, read in reads.items() if read and name not in given}
    columns = [_followers(formulas, reads, values, name) for name in asked]
    moving = [name for name in formulas if any(column.get(name) for column in columns)]
    return {name: np.array([column.get(name, 0.0) for column in columns]) for name in moving}


def _followers(
    formulas: Mapping[str, Expression],
    reads: Mapping[str, Set[str]],
    values: Mapping[str, float],
    leader: str,
) -> dict[str, float]:
    """d parameter / d leader of all parameters that follow it; `reads` has those that follow any,
    and what they read."""
    found = {leader: 1.0} if leader in formulas else {}

    def rate(name: str) -> float:
        if name not in found:
            inner = {read: rate(read) for read in reads.get(name, ())}
            found[name] = sum(
                _partial(formulas[name], values, read) * inner[read]
                for read in inner
                if inner[read] != 0.0
            )
        return found[name]

    for name in reads if found else ():
        rate(name)
    return found


def _partial(formula: Expression, values: Mapping[str, float], name: str) -> float:
    """d formula / d name, by differences of order 6."""
    if formula == Name(name):
        return 1.0
    step = STEP * (abs(values[name]) or 1.0)
    total = 0.0
    for times, weight in WEIGHTS:
        up = evaluate(formula, {**values, name: values[name] + times * step})
        down = evaluate(formula, {**values, name: values[name] - times * step})
        total += weight * (up - down) / step
    return total


def new_sensitivity(
    model: Model,
    flow: Flow,
    progress: Progress,
    asked: tuple[str, ...],
    rates: Mapping[str, Vector],
    start: Mapping[str, float],
    values: Mapping[str, float],
) -> Sensitivity:
    """The sensitivities of a run that has not begun.

    `rates` are those of the parameters in what is asked for, `start` the start values that are set
    and so follow no parameter, `values` those of the parameters.
    """
    n, modes, q = len(progress.x), len(flow.bound), len(asked)
    moving = [name for name in rates if name in model.read_parameters]
    a = len(moving)
    w = n + 1 + a if q else 0
    names = [*model.states, "t", *moving]
    functions = [model.derivative(of, names) for of in DERIVATIVES] if q else []
    address = [model.compiled_address(name) for name in functions]
    sensitivity = Sensitivity(
        address=np.array(address, dtype=np.int64),
        chain=np.zeros((a, q)),
        s=np.zeros((n, q)),
        moved=np.zeros(q),
        peak=np.zeros((n, q)),
        nodes=np.zeros((4 * n, w)),
        samples=np.zeros((len(progress.times), len(model.recorded) * q)),
        times=np.zeros((len(progress.log), q)),
        push=np.zeros((modes, n * a)),
        flags=np.zeros((FLAGS, 2), dtype=np.int64),
        flag_times=np.zeros(FLAGS),
        now=np.zeros(5),
        instants=np.zeros((modes, q)),
        bound=flow.bound.copy(),
        change=np.zeros((3 * n, q)),
        slopes=np.zeros((3 * n, q)),
        real=np.zeros((n, n)),
        real_pivots=np.zeros(n, dtype=np.int64),
        order=np.zeros(n + 1, dtype=np.int64),
    )
    set_sensitivity(model, flow, progress, sensitivity, asked, rates, start, values)
    return sensitivity


def set_sensitivity(
    model: Model,
    flow: Flow,
    progress: Progress,
    sensitivity: Sensitivity,
    asked: tuple[str, ...],
    rates: Mapping[str, Vector],
    start: Mapping[str, float],
    values: Mapping[str, float],
) -> None:
    """Let the sensitivities of a run that has not begun be those of this one."""
    n, s = len(progress.x), sensitivity.s
    moving = [name for name in rates if name in model.read_parameters]
    if moving:
        sensitivity.chain[:] = [rates[name] for name in moving]
        rows, nothing = np.zeros((n, n + 1 + len(moving))), np.zeros(1)
        address = sensitivity.address[OF_STARTS]
        invoke_at(address, 0.0, nothing, flow.m, flow.c, flow.k, rows.reshape(-1))
        s[:] = rows[:, n + 1 :] @ sensitivity.chain
        s[[state in start for state in model.states]] = 0.0
    for j, name in enumerate(asked):
        if name not in model.flat.parameters:
            s[:, j] = 0.0
            s[model.states.index(name.removeprefix(START)), j] = 1.0
    # a change that all of a parameter's value moves a state less than its tolerance need not be
    # followed closely: exp(-(rate/speed)^2) has such derivatives far from rest
    sizes = np.array([abs(values.get(name, 0.0)) or 1.0 for name in asked])
    sensitivity.peak[:] = np.maximum(np.abs(s), progress.atol[:, None] / sizes)
    sensitivity.now[0] = progress.now[0]


def by_name(
    model: Model, sensitivity: Sensitivity, asked: tuple[str, ...], samples: int
) -> dict[str, dict[str, Vector]]:
    """d signal/d name at the first samples, by name and by recorded signal."""
    count = len(model.recorded)
    return {
        name: {
            signal: sensitivity.samples[:samples, j * count + column].copy()
            for column, signal in enumerate(model.recorded)
        }
        for j, name in enumerate(asked)
    }


def undefined(model: Model, sensitivity: Sensitivity) -> Iterator[str]:
    """What to say of instants where a sensitivity is not defined."""
    for kind, said in SAID.items():
        count, mode = sensitivity.flags[kind].tolist()
        if count:
            guard = f"'{model.modes[mode].text}'" if model.modes else "a state"
            more = f", {count} times in all" if count > 1 else ""
            t = sensitivity.flag_times[kind]
            yield f"from t = {t:g} s a sensitivity {said.format(guard=guard)}{more}"
