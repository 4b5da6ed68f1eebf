"""The tables of a run: those of the diagram, and the measured inputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.errors import OptionError, Problem, unknown
from tracewire.formula import evaluate, names_of
from tracewire.solve.held import Held
from tracewire.solve.once_per_model import once_per_model

Inputs = Mapping[str, tuple[ArrayLike, ArrayLike]]
Table = tuple[Vector, Vector]


def tables_of(
    model: Model,
    values: Mapping[str, float],
    inputs: Inputs,
) -> list[Table]:
    """The tables of the model: the diagram's and the inputs. Raises OptionError."""
    flat = model.flat
    problems = [unknown("input", name, flat.inputs) for name in inputs if name not in flat.inputs]
    tables = []
    times: dict[int, Vector] = {}  # many inputs have the same: they are looked at once
    for name in model.lowered.tables:
        if name in flat.tables:
            tables.append(_tables_of_diagram(model)[name])
        elif name in inputs:
            table = _table(name, *inputs[name], times)
            tables.append(Held(*table) if isinstance(inputs[name], Held) else table)
        else:
            default = flat.inputs[name]
            if default is None:
                hint = (
                    "Name a measured series that has it (`--series` of `run` and `sweep`), "
                    f"write a default, inputs: {{{name}: {{default: 0}}}}, "
                    "or in Python give it as `inputs=`."
                )
                problems.append(Problem(f"the input '{name}' has no source", hint=hint))
            else:
                tables.append(_table(name, [0.0], [evaluate(default, values)], {}))
    if problems:
        raise OptionError(problems)
    return tables


@once_per_model
def _tables_of_diagram(model: Model) -> dict[str, Table]:
    """The tables that the diagram has, by name. Raises OptionError."""
    known = model.flat.tables
    return {n: _table(n, known[n].x, known[n].y, {}) for n in model.lowered.tables if n in known}


def _table(name: str, x: ArrayLike, y: ArrayLike, known: dict[int, Vector]) -> Table:
    """A table whose x ascend and whose y are finite; `known` has the x that do, by identity."""
    xs, ys = known.get(id(x)), np.asarray(y, dtype=float).ravel()
    if xs is None:
        xs = np.asarray(x, dtype=float).ravel()
        if len(xs) and np.isfinite(xs).all() and (xs[1:] > xs[:-1]).all():
            known[id(x)] = xs
    if not (id(x) in known and len(xs) == len(ys) and np.isfinite(ys).all()):
        hint = "Give as many values as times, times that ascend, and no NaN."
        raise OptionError([Problem(f"the table of the input '{name}' is not usable", hint=hint)])
    return xs, ys


def unknown_parts(inputs: Inputs, begin: float, end: float) -> list[str]:
    """Where a run from `begin` to `end` in s goes beyond what is known of its inputs, in words.

    A value holds for one more interval between samples, as a record of 100 samples a second ends
    0.01 s before its full second.
    """
    said = []
    for name, (t, _) in inputs.items():
        times = np.asarray(t, dtype=float).ravel()
        if len(times) < 2:
            continue  # a constant
        before, after = times[0] - begin, end - times[-1]
        if max(before - (times[1] - times[0]), after - (times[-1] - times[-2])) > 0:
            known = f"{times[0]:.6g} to {times[-1]:.6g} s"
            said.append(
                f"the input '{name}' is known from {known}, and the run goes from {begin:.6g} to "
                f"{end:.6g} s: outside, the nearest value of the input is held"
            )
    return said


def tables_follow(model: Model, inputs: Inputs) -> bool:
    """Whether the tables follow parameters: an input has a formula of them, and no values."""
    return any(name not in inputs for name in _following_inputs(model))


@once_per_model
def _following_inputs(model: Model) -> tuple[str, ...]:
    """The inputs whose default is a formula of parameters."""
    return tuple(name for name, f in model.flat.inputs.items() if f is not None and names_of(f))


def pack_tables(tables: Sequence[Table]) -> Vector:
    """All tables in one array: their offsets, then of each its length, points, values, slopes.

    One that is held has slopes of 0: it jumps at its points.
    """
    out = np.zeros(len(tables) + sum(3 * len(x) for x, _ in tables) + 1)
    steps: dict[int, Vector] = {}  # many tables have the same x
    offset = len(tables)
    for number, table in enumerate(tables):
        x, y = table
        count = len(x)
        if id(x) not in steps:
            steps[id(x)] = x[1:] - x[:-1]
        out[number], out[offset] = offset, count
        out[offset + 1 : offset + 1 + count] = x
        out[offset + 1 + count : offset + 1 + 2 * count] = y
        slopes = out[offset + 1 + 2 * count : offset + 3 * count]
        if not isinstance(table, Held):
            np.divide(y[1:] - y[:-1], steps[id(x)], out=slopes)
        offset += 3 * count
    return out
