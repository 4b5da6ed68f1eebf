"""The drive of a model: does it change with time by itself, with what period, and when it rises."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tracewire.analyse.limits import SECTION
from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.diagram import find_recorded
from tracewire.errors import OptionError, Problem, unknown
from tracewire.formula import CONSTANTS, evaluate, names_of, parse
from tracewire.solve import Passage


def number(model: Model, given: float | str, values: Mapping[str, float], what: str) -> float:
    """A number, or a formula of the parameters such as "2*pi/omega". Raises OptionError."""
    if not isinstance(given, str):
        return float(given)
    formula = parse(given)
    there = {*model.parameters, *CONSTANTS}
    wrong = [unknown("parameter", n, model.parameters) for n in names_of(formula) if n not in there]
    if wrong:
        raise OptionError(wrong)
    found = evaluate(formula, values)
    if not math.isfinite(found):
        raise OptionError([Problem(f"the {what} '{given}' is {found}")])
    return found


def period_of(model: Model, period: float | str, values: Mapping[str, float]) -> float:
    """A period in s from a number or a formula of the parameters. Raises OptionError."""
    found = number(model, period, values, "period")
    if not found > 0:
        what = f"a period of {found:g} s has no use"
        raise OptionError(
            [Problem(what, hint="Give a period above 0, in s, such as '2*pi/omega'.")]
        )
    return found


def is_driven(passage: Passage, span: float) -> bool:
    """Whether the rates at a stop change with time by themselves."""
    t, x = passage.t, passage.x
    before = passage.rates()
    driven = False
    for part in SECTION.other_times:
        passage.begin_at(t + part * span, x)
        change = np.abs(passage.rates() - before)
        driven = driven or bool(np.any(change > 1e-9 * (1.0 + np.abs(before))))
    passage.begin_at(t, x)
    return driven


def rising_edges(
    model: Model, source: str, parameters: Mapping[str, float], preset: str = ""
) -> tuple[float, float]:
    """The first rising edge at t >= 0 of a periodic source that jumps, and its period, in s.

    The source is a signal that depends on parameters and time alone, such as a square wave. Raises
    OptionError: no such signal, one that does not jump at known times, or not periodically.
    """
    signals = model.flat.signals
    full = source if source in signals else find_recorded(model.diagram, source)
    if full is None or full not in signals:
        raise OptionError([unknown("signal", source, signals)])
    entry = model.lowered.entries[full]
    tape = model.lowered.tape
    alone = tape.leaves([entry]) <= {"t", "param", "const", "mode", "table"}
    read = set(tape.needed([entry]))
    timed = [n for n, mode in enumerate(model.modes) if mode.timed is not None]
    own = [n for n in timed if model.modes[n].leaf in read]
    if not alone or not own:
        what = f"'{source}' is no source that jumps at known times"
        hint = "Name a square wave or the like, or give the period, or a guard."
        raise OptionError([Problem(what, hint=hint)])
    seen = replace(model, recorded=(full,))
    passage = Passage(seen, length=1.0, parameters=parameters, preset=preset)
    lines = passage.value("timed", 2 * len(timed), passage.x, 0.0).reshape(-1, 2)
    rows = [lines[timed.index(n)] for n in own]
    edges: list[float] = []
    x = passage.x
    instants = sorted({t for slope, offset in rows for t in _instants(model, slope, offset)})
    near = SECTION.beside * max(1.0, max(instants, default=1.0))
    for t in instants:
        sides = []
        for side in (t - near, t + near):
            passage.begin_at(side, x)
            sides.append(float(passage.value("outputs", 1, x, side)[0]))
        if sides[1] > sides[0] + 1e-9 * (abs(sides[0]) + abs(sides[1])):
            edges.append(t)
    gaps = np.diff(edges)
    if len(edges) < 3 or not np.allclose(gaps, gaps[0], rtol=1e-6):
        what = f"'{source}' does not rise periodically with these parameters"
        raise OptionError([Problem(what, hint="Give the period, or a guard.")])
    period = float(np.mean(gaps))
    return max(edges[0], 0.0), period


def _instants(model: Model, slope: float, offset: float) -> Vector:
    """The first times t >= 0 at which slope*t + offset is a whole number."""
    if slope == 0.0 or not math.isfinite(slope):
        return np.empty(0)
    first = math.ceil(offset - 1e-9) if slope > 0 else math.floor(offset + 1e-9)
    levels = first + np.arange(SECTION.most_changes) * (1 if slope > 0 else -1)
    return np.asarray((levels - offset) / slope, dtype=float)
