"""Each shipped diagram has the same answer in other units of time and of each of its states."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from solve.models import LIMITS
from tracewire.compile import Model, compile
from tracewire.compile.lower import lower
from tracewire.diagram import read
from tracewire.formula import Call, Expression, Name, Number, evaluate, rename
from tracewire.shipped import shipped
from tracewire.solve import parameter_values, simulate

FILES = [
    file
    for folder in ("demo", "papers")
    for file in sorted((shipped("diagrams") / folder).rglob("*.yaml"))
    if "\nblocks:" in file.read_text(encoding="utf-8")
]
PART = 0.1  # of the span: farther on, small differences may grow
RTOL = 1e-11


def times(formula: Expression, factor: float) -> Expression:
    return Call("*", (formula, Number(factor)))


def in_units(model: Model, units: Mapping[str, float], second: float) -> Model:
    """The model with each state counted in a unit, and the time in one of so many seconds."""
    flat = model.flat
    known = {name: times(Name(name), unit) for name, unit in units.items()}
    known["t"] = times(Name("t"), second)

    def read_so(formula: Expression) -> Expression:
        return rename(formula, lambda name: known.get(name, Name(name)))

    def put(values: Mapping[str, Expression]) -> dict[str, Expression]:
        return {name: times(read_so(value), 1 / units[name]) for name, value in values.items()}

    changed = replace(
        flat,
        states=tuple(
            replace(
                state,
                rate=times(read_so(state.rate), second / units[state.name]),
                start=times(read_so(state.start), 1 / units[state.name]),
            )
            for state in flat.states
        ),
        signals={name: read_so(formula) for name, formula in flat.signals.items()},
        guesses={name: read_so(formula) for name, formula in flat.guesses.items()},
        events=tuple(replace(e, when=read_so(e.when), set=put(e.set)) for e in flat.events),
        memories=tuple(
            replace(
                memory,
                start=read_so(memory.start),
                transitions=tuple(
                    replace(way, when=read_so(way.when), set=put(way.set))
                    for way in memory.transitions
                ),
            )
            for memory in flat.memories
        ),
    )
    return replace(model, flat=changed, lowered=lower(changed), backend="quick")


@pytest.mark.parametrize("file", FILES, ids=lambda file: f"{file.parent.name}-{file.stem}")
def test_each_shipped_diagram_has_the_same_answer_in_any_units(file: Path) -> None:
    rng = random.Random(file.stem)
    model = compile(read(file))
    begin, end = (evaluate(side, parameter_values(model, {})) for side in model.flat.span)
    t = np.array([begin, begin + PART * (end - begin)])
    plain = simulate(model, times=t, rtol=RTOL, limits=LIMITS)
    units = {name: 10 ** rng.uniform(-15, 15) for name in model.states}
    second = rng.choice([1e-6, 1.0, 1e6])
    other = simulate(in_units(model, units, second), times=t / second, rtol=RTOL, limits=LIMITS)
    assert len(other.events) == len(plain.events)
    for name, unit in units.items():
        size = max(abs(plain.final[name]), abs(plain.start[name]), 1e-9)
        assert abs(other.final[name] * unit - plain.final[name]) < 1e-8 * size, name
