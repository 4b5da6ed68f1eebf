"""Sensitivities of a run: what is asked for, what the core is given, what the user gets."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Matrix
from tracewire.compile import Model
from tracewire.errors import OptionError, unknown
from tracewire.formula import Expression, Name, evaluate, names_of
from tracewire.solve.core.arrays import Progress, Sensitivity, Trial
from tracewire.solve.core.codes import FLAGS, GRAZES, LOST, SIMULTANEOUS, TOUCHES, ZENO
from tracewire.solve.core.flow import FREE
from tracewire.solve.core.variation import DERIVATIVES, OF_RHS
from tracewire.solve.limits import MEMORY, STEP
from tracewire.solve.once_per_model import once_per_model
from tracewire.solve.options import START
from tracewire.solve.run import Sensitivities

WEIGHTS = ((1.0, 3 / 4), (2.0, -3 / 20), (3.0, 1 / 60))
SAID = {
    ZENO: "takes the impacts of {guard} up to its rest for all there are: they are without end",
    GRAZES: "leaves out that {guard} moves: it only grazes zero",
    SIMULTANEOUS: "takes {guard} for as fast as what happens at the same instant",
    TOUCHES: "holds {guard} at zero from its contact on, though a change may open it",
    LOST: "is not finite at {guard} and is taken as zero there",
}


def check_sensitivities(model: Model, names: Sequence[str]) -> tuple[str, ...]:
    """The names of what is asked for, each once. Raises OptionError for what does not exist."""
    asked = tuple(dict.fromkeys([names] if isinstance(names, str) else names))
    if not asked:
        return ()
    known = model.parameters, {START + state for state in model.states}
    strange = [name for name in asked if not any(name in names for names in known)]
    if strange:
        there = [*model.parameters, *(START + state for state in model.states)]
        raise OptionError([unknown("sensitivity", name, there) for name in strange])
    return asked


@dataclass(frozen=True, eq=False)
class Moving:
    """The parameters that move with what is asked for, and their derivatives in it: (a, q)."""

    names: tuple[str, ...] = ()
    rates: Matrix = field(default_factory=lambda: np.zeros((0, 0)))


UNMOVED = Moving()


@dataclass(frozen=True, eq=False)
class Following:
    """How parameters follow what is asked for: what moves, as it is for all values, and, where the
    values matter, the parameters that follow, with what moves of those that their formulas read.
    Each stands behind what it reads."""

    moving: Moving
    order: tuple[tuple[str, tuple[str, ...]], ...] = ()


@once_per_model
def _known_following(model: Model) -> dict[tuple[str, tuple[str, ...], frozenset[str]], Following]:
    """How parameters follow, by preset, what is asked for and what is given."""
    return {}


def moving_with(
    model: Model,
    asked: tuple[str, ...],
    values: Mapping[str, float],
    given: Mapping[str, float],
    preset: str = "",
) -> Moving:
    """What moves with what is asked for, of the parameters that the model reads.

    `values` of all parameters; those that are `given` follow no other.
    """
    if not asked:
        return UNMOVED
    kept, key = _known_following(model), (preset, asked, frozenset(given))
    known = kept.get(key)
    if known is None:
        known = _following(model, asked, given, preset)
        if len(kept) < MEMORY.sensitivities:
            kept[key] = known
    if not known.order:
        return known.moving
    rates = _rates(model.parameter_formulas(preset), asked, known.order, values)
    return _moving(known.moving.names, asked, rates)


def _following(
    model: Model, asked: tuple[str, ...], given: Mapping[str, float], preset: str
) -> Following:
    """How parameters follow what is asked for, where some are given and follow no other."""
    formulas = model.parameter_formulas(preset)
    reads: dict[str, list[str]] = {}  # of those that follow others
    for name, formula in formulas.items():
        read = names_of(formula)
        if name not in given and (others := [other for other in formulas if other in read]):
            reads[name] = others
    led = {name for leader in asked for name in _led(leader, formulas, reads)}
    names = tuple(name for name in formulas if name in led and name in model.read_parameters)
    order: dict[str, tuple[str, ...]] = {}

    def put(name: str) -> None:
        if name in reads and name not in order:
            mine = tuple(read for read in reads[name] if read in led)
            for read in mine:
                put(read)
            order[name] = mine

    for name in formulas:
        if name in led:
            put(name)
    if not all(isinstance(formulas[name], Name) for name in order):
        return Following(_moving(names, asked, {}), tuple(order.items()))
    return Following(_moving(names, asked, _rates(formulas, asked, tuple(order.items()), {})))


def _led(
    leader: str, formulas: Mapping[str, Expression], reads: Mapping[str, Sequence[str]]
) -> set[str]:
    """A parameter and all that follow it."""
    found = {leader} & formulas.keys()
    for _ in reads if found else ():
        more = {name for name, read in reads.items() if not found.isdisjoint(read)}
        if more <= found:
            break
        found |= more
    return found


def _moving(
    names: tuple[str, ...], asked: tuple[str, ...], rates: Mapping[str, Sequence[float]]
) -> Moving:
    nothing = [0.0] * len(asked)
    rows = np.array([rates.get(name, nothing) for name in names])
    return Moving(names, rows.reshape(-1, len(asked)))


def _rates(
    formulas: Mapping[str, Expression],
    asked: tuple[str, ...],
    order: Sequence[tuple[str, tuple[str, ...]]],
    values: Mapping[str, float],
) -> dict[str, list[float]]:
    """d parameter / d leader of what is asked for and of all that follow it, by each leader."""
    found = {name: [float(name == leader) for leader in asked] for name in asked}
    for name, read in order:
        row = [0.0] * len(asked)
        for other in read:
            partial = _partial(formulas[name], values, other)
            inner = zip(row, found[other], strict=True)
            row = [r + partial * i if i != 0.0 else r for r, i in inner]
        if name in asked:
            row[asked.index(name)] = 1.0
        found[name] = row
    return found


def _partial(formula: Expression, values: Mapping[str, float], name: str) -> float:
    """d formula / d name, by differences of order 6."""
    if formula == Name(name):
        return 1.0
    step = STEP.difference * (abs(values[name]) or 1.0)
    total = 0.0
    for times, weight in WEIGHTS:
        up = evaluate(formula, {**values, name: values[name] + times * step})
        down = evaluate(formula, {**values, name: values[name] - times * step})
        total += weight * (up - down) / step
    return total


def new_sensitivity(
    model: Model,
    progress: Progress,
    trial: Trial,
    asked: tuple[str, ...],
    moved: tuple[str, ...],
    columns: int,
) -> Sensitivity:
    """The sensitivities of a run that has not begun, with `columns` numbers of each of its samples.

    `moved` are the names of the parameters that move with what is asked for.
    """
    n, modes, q = len(progress.x), len(model.modes), len(asked)
    a = len(moved) + 2 * len(model.lowered.delays)
    w = n + 1 + a if q else 0
    names = [*model.states, "t", *moved]
    functions = [model.derivative(of, names) for of in DERIVATIVES] if q else []
    address = model.routines.compiled_addresses(functions)
    return Sensitivity(
        address=np.array(address, dtype=np.int64),
        chain=np.zeros((a, q)),
        filled=np.zeros((a, 2), dtype=np.int64),
        reads=_read_by(model, functions[OF_RHS], n, a) if q else np.zeros((n, 2), dtype=np.int64),
        s=np.zeros((n, q)),
        moved=np.zeros(q),
        peak=np.zeros((n, q)),
        nodes=np.zeros((4 * n, w)),
        samples=np.zeros((len(progress.times), columns * q)),
        times=np.zeros((len(progress.log), q)),
        push=np.zeros((modes, n * a)),
        flags=np.zeros((FLAGS, 2), dtype=np.int64),
        flag_times=np.zeros(FLAGS),
        now=np.zeros(11),
        instants=np.zeros((modes, q)),
        bound=np.full(modes, FREE, dtype=np.int64),
        change=np.zeros((n, q)),
        slopes=np.zeros((4 * n, q)),
        between=np.zeros((n, q)),
        right=np.zeros((3 * n, q)),
        parts=np.zeros((max(3 * n, 3), q)),
        system=np.zeros((3 * n, 3 * n) if q else (0, 0)),
        pivots=np.zeros(3 * n, dtype=np.int64),
        order=np.zeros(n + 2, dtype=np.int64),
        weights=np.zeros(n),
        picks=np.zeros(n, dtype=np.int64),
        at=np.zeros(n),
        steps=np.zeros((MEMORY.steps if q else 0, len(trial.ends) + n * (2 + len(trial.inner)))),
        methods=np.zeros(MEMORY.steps, dtype=np.int64),
        kept=np.zeros(3, dtype=np.int64),
    )


def _read_by(model: Model, function: str, n: int, a: int) -> NDArray[np.int64]:
    """Where among a parameters those begin and end that each of n rates reads."""
    places, w = np.array([*model.routines.routine(function).roots], dtype=np.int64), n + 1 + a
    found = np.zeros((n, 2), dtype=np.int64)
    for state in range(n):
        mine = places[places // w == state] % w - (n + 1)
        if len(mine := mine[mine >= 0]):
            found[state] = mine.min(), mine.max() + 1
    return found


def recorded(model: Model, samples: Matrix, asked: tuple[str, ...]) -> Sensitivities:
    """d signal/d name at samples, as the core has them: (N, signals*names)."""
    if not asked:
        return Sensitivities((), model.recorded, np.zeros((0, len(model.recorded), len(samples))))
    shape = len(asked), len(model.recorded), len(samples)
    return Sensitivities(asked, model.recorded, samples.T.copy().reshape(shape))


def undefined(model: Model, sensitivity: Sensitivity) -> Iterator[str]:
    """What to say of instants where a sensitivity is not defined."""
    for kind, said in SAID.items() if sensitivity.flags.any() else ():
        count, mode = sensitivity.flags[kind].tolist()
        if count:
            guard = f"'{model.modes[mode].text}'" if model.modes else "a state"
            more = f", {count} times in all" if count > 1 else ""
            t = sensitivity.flag_times[kind]
            yield f"from t = {t:g} s a sensitivity {said.format(guard=guard)}{more}"
