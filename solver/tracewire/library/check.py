"""What is wrong with a block declaration: names, formulas, units, bounds, modes, effect."""

from __future__ import annotations

import keyword
import math
from collections.abc import Sequence

from tracewire.errors import FormulaError, Location, Problem, unknown
from tracewire.formula import is_name, read_unit
from tracewire.library.check_effects import Face, check_effect
from tracewire.library.check_formula import Use, check_formula
from tracewire.library.check_memory import check_by_mode, check_memory
from tracewire.library.parts import Input, Output, Parameter, Parts, State


def check_block(block: Parts, place: Location) -> list[Problem]:
    """Every problem of a declaration that stands at `place`, in the order of its parts."""
    place = Location(place.file, place.line, 0, block.name)
    wires: Use = "wires"
    value: Use = "value"
    ports = {port.name: wires if port.many else value for port in block.inputs}
    parameters = {p.name: _use(p) for p in block.parameters}
    numbers = {p.name: value for p in block.parameters if p.kind == "number"}
    time = {"t": value}
    everything = ports | parameters | {state.name: value for state in block.states} | time
    everything |= {"mode": value} if block.modes else {}
    problems = _check_names(block, place)
    for output in block.outputs:
        what = f"output '{output.name}'"
        problems += check_by_mode(block, output.formula, what, everything, place)
        problems += _check_unit_of(block, output, what, place)
    for state in block.states:
        what = f"the rate of '{state.name}'"
        problems += check_by_mode(block, state.rate, what, everything, place)
        problems += check_formula(state.start, numbers, place)
    problems += _check_parameters(block.parameters, place)
    for parameter in block.parameters:
        problems += _check_unit_of(block, parameter, f"parameter '{parameter.name}'", place)
    for port in block.inputs:
        if port.default is not None:
            problems += check_formula(port.default, numbers | time, place)
    parts: list[Input | Output | Parameter | State]
    parts = [*block.inputs, *block.parameters, *block.states, *block.outputs]
    for item in parts:
        try:
            read_unit(item.unit, place)
        except FormulaError as error:
            problems += error.problems
    for condition in block.require:
        problems += check_formula(condition, numbers, place, condition=True)
    problems += check_memory(block, everything, numbers, place)
    if block.effect is not None:
        problems += check_effect(block.effect, _face(block), place)
    return problems


def _check_unit_of(
    block: Parts, part: Output | Parameter, what: str, place: Location
) -> list[Problem]:
    """What is wrong with the input of which a part of a block has the unit."""
    known = [port.name for port in block.inputs]
    if not part.unit_of or part.unit_of in known:
        return []
    return [unknown("input", part.unit_of, known, place, f"The {what} has its unit.")]


def _use(parameter: Parameter) -> Use:
    return "points" if parameter.kind == "points" else "value"


def _check_names(block: Parts, place: Location) -> list[Problem]:
    problems = []
    if not block.outputs:
        problems.append(Problem("a block needs at least one output", place))
    if not block.doc.strip():
        problems.append(Problem("a block needs a sentence that says what it is", place))
    visible = [port.name for port in block.inputs]
    visible += [parameter.name for parameter in block.parameters]
    visible += [state.name for state in block.states]
    visible += ["mode"] if block.modes else []
    outputs = [output.name for output in block.outputs]
    # a block may be called like a word of the language: its name stands in no formula
    reserved = keyword.iskeyword(block.name) and block.name not in ("and", "or", "not")
    good = block.name.isascii() and block.name.isidentifier() and not reserved
    bad = [] if good else [block.name]
    for name in bad + [name for name in (*visible, *outputs) if not is_name(name)]:
        hint = "Use letters, digits and _, and no word of the formula language."
        problems.append(Problem(f"'{name}' cannot be used as a name", place, (), hint))
    for names in (visible, outputs):
        for name in sorted({name for name in names if names.count(name) > 1}):
            problems.append(Problem(f"'{name}' is declared twice", place))
    return problems + _check_shared(block, place)


def _check_shared(block: Parts, place: Location) -> list[Problem]:
    """An output of several has the full name of a state of its name: both must be the same."""
    states = {state.name for state in block.states} | ({"mode"} if block.modes else set())
    hint = "Rename one: a diagram knows both by the same name."
    return [
        Problem(f"'{output.name}' is a state, and an output that is not it", place, (), hint)
        for output in block.outputs
        if len(block.outputs) > 1 and output.name in states and output.formula != output.name
    ]


def _check_parameters(parameters: Sequence[Parameter], place: Location) -> list[Problem]:
    problems = []
    before: dict[str, Use] = {}  # a default reads what stands before it: no default is a circle
    for p in parameters:
        low = float("-inf") if p.low is None else p.low
        high = float("inf") if p.high is None else p.high
        if low > high:
            what = f"the bounds of '{p.name}' are {low:g} to {high:g}"
            problems.append(Problem(what, place, (), "Give the lower one first."))
        if isinstance(p.default, str):
            problems += check_formula(p.default, before, place)
        elif p.default is not None and p.above is not None and p.default <= p.above:
            what = f"the default {p.default:g} of '{p.name}' is not above {p.above:g}"
            problems.append(Problem(what, place))
        elif p.default is not None and not low <= p.default <= high:
            what = f"the default {p.default:g} of '{p.name}' is outside {low:g} to {high:g}"
            problems.append(Problem(what, place))
        if p.kind == "number":
            before[p.name] = "value"
    return problems


def _face(block: Parts) -> Face:
    return Face(
        ports={port.name: port.default is not None for port in block.inputs},
        parameters={p.name: p.default is not None for p in block.parameters},
        bounds={
            p.name: (-math.inf if p.low is None else p.low, math.inf if p.high is None else p.high)
            for p in block.parameters
            if p.kind == "number"
        },
        outputs=len(block.outputs),
    )
