"""The value of a quantity: of its formula, by the functions of runs and of motions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from tracewire.analyse.quantities.subject import Subject
from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.diagram import element_name, find_recorded, is_quantity
from tracewire.errors import AnalysisError, OptionError, Problem, unknown
from tracewire.formula import (
    ALONG,
    CONSTANTS,
    QUANTITIES,
    Call,
    Expression,
    Name,
    Number,
    calls_in,
    is_condition,
    names_of,
    rename,
    to_text,
)

Value = Any
"""A number, a word, or values (N,) at samples or events."""
Further = Mapping[str, Callable[..., float]]
"""Quantities that the caller knows, by name; they are given the texts of their arguments."""
NOTHING_FURTHER: Further = MappingProxyType({})
SMOOTH = frozenset(("+", "-", "*", "/", "**", "neg", "sin", "cos", "tan", "exp", "sqrt"))
"""Functions that have no guard."""
OF_WAVES = frozenset(("period", "frequency", "growth_rate"))
"""Quantities that read what was before the samples that count, to tell a wave from noise."""


@dataclass(frozen=True)
class At:
    """Where signals are taken: of which subject, and at which times (M,) in s.

    times None: at the samples that count. `state`: at events, states by name as (K,) before or
    after each. `reference` is what `reference(...)` reads. `functions` are those of QUANTITIES,
    `further` what the caller knows.
    """

    subject: Subject
    reference: Subject | None = None
    times: Vector | None = None
    state: Mapping[str, Vector] | None = None
    functions: Mapping[str, Callable[[At, Call], Value]] = field(default_factory=dict)
    further: Further = field(default_factory=dict)

    @property
    def t(self) -> Vector:
        """The times (M,) in s at which signals are taken."""
        return self.subject.t if self.times is None else self.times

    @property
    def along(self) -> At:
        """The same at the samples of the run, as what is reduced to a number needs them."""
        return replace(self, times=None, state=None)

    def value(self, node: Expression) -> Value:
        """The value of a part of a quantity."""
        if isinstance(node, Number):
            return node.value
        if isinstance(node, Name):
            return self.name(node.name)
        if is_quantity(node):
            return self.functions[node.function](self, node)
        if node.function == "[]":
            return self.name(_element(node))
        function = ALONG.get(node.function)
        if function is None:
            what = f"a quantity cannot work out {node.function}"
            hint = "Make it an expression block of the diagram, and name that here."
            raise OptionError([Problem(what, hint=hint)])
        return function(*(self.value(argument) for argument in node.arguments))

    def number(self, node: Expression) -> float:
        """A part that must be one number. Raises OptionError."""
        found = self.value(node)
        if isinstance(found, str) or np.ndim(found):
            what = f"'{to_text(node)}' is no single number"
            raise OptionError([Problem(what, hint="Write end(x), max(x) or at(x, 2).")])
        return float(found)

    def whole(self, node: Expression, most: int, what: str) -> int:
        """A number k of 1 to `most`, as an index from 0. Raises AnalysisError."""
        k = self.number(node)
        if not (1 <= k <= most and k == round(k)):
            raise AnalysisError([Problem(f"there is no {what} {k:g}: there are {most}")])
        return int(k) - 1

    def name(self, name: str) -> Value:
        """A constant, a parameter, the time, or a signal."""
        if name in CONSTANTS:
            return CONSTANTS[name]
        if name in self.subject.parameters:
            return self.subject.parameters[name]
        if name == "t":
            return self.t
        full = full_name(self.subject.model, name)
        if self.state is not None:
            if full in self.state:
                return self.state[full]
            formula = of_states(self.subject.model, full)
            if formula is not None:
                return self.value(formula)
        return self.subject.signal(full, self.times)

    def ask(self, node: Expression) -> None:
        """Tell the subjects beforehand which signals will be needed, at which times."""
        if isinstance(node, Name) or (isinstance(node, Call) and node.function == "[]"):
            name = node.name if isinstance(node, Name) else _element(node)
            if name in CONSTANTS or name == "t" or name in self.subject.parameters:
                return
            self.subject.ask(full_name(self.subject.model, name), self.times)
        elif isinstance(node, Call) and node.function == "at":
            signal, time = node.arguments
            self.ask(time)
            if _reads_no_run(time, self.subject):
                replace(self, times=np.atleast_1d(self.value(time))).ask(signal)
            else:
                self.along.ask(signal)
        elif isinstance(node, Call) and node.function == "reference":
            other_of(self).ask(node.arguments[0])
        elif isinstance(node, Call) and is_quantity(node):
            if QUANTITIES[node.function].study:
                return
            for argument in formulas_in(node):
                self.along.ask(argument)
                if node.function in OF_WAVES and len(self.subject.early):
                    replace(self.along, times=self.subject.early).ask(argument)
        elif isinstance(node, Call):
            for argument in node.arguments:
                self.ask(argument)


def other_of(at: At) -> At:
    """Where signals of the reference are taken: at the times of the run. Raises OptionError."""
    if at.reference is None:
        what = "the quantity has reference(...), and there is no reference"
        raise OptionError([Problem(what, hint="Write reference: {preset: ...} in the statement.")])
    return replace(at, subject=at.reference, reference=None, times=at.t, state=None)


def full_name(model: Model, name: str) -> str:
    """The full name of a signal or a state. Raises OptionError: there is none."""
    known = {*model.states, *model.flat.signals, *model.flat.inputs}
    found = name if name in known else find_recorded(model.diagram, name)
    if found is None or found not in known:
        raise OptionError([unknown("signal", name, known)])
    return found


def resolve(model: Model, quantity: Expression) -> None:
    """Raises OptionError where a quantity reads a signal or parameter that is not there."""
    problems: list[Problem] = []
    known = {*model.states, *model.flat.signals, *model.flat.inputs}
    for name in _signals(quantity):
        if name not in {*CONSTANTS, "t", *model.flat.parameters} and name not in known:
            found = find_recorded(model.diagram, name)
            if found not in known:
                problems.append(unknown("signal", name, known))
    if problems:
        raise OptionError(problems)


def _signals(node: Expression) -> list[str]:
    """The names in a quantity that may be signals, and not events or words."""
    if isinstance(node, Name):
        return [node.name]
    if not isinstance(node, Call):
        return []
    if node.function == "[]":
        return [_element(node)]
    if is_quantity(node):
        return [name for argument in formulas_in(node) for name in _signals(argument)]
    return [name for argument in node.arguments for name in _signals(argument)]


def _reads_no_run(node: Expression, subject: Subject) -> bool:
    """Whether a time is made of `t`, numbers and parameters."""
    if isinstance(node, Call) and (is_quantity(node) or node.function == "[]"):
        return False
    if isinstance(node, Call):
        return all(_reads_no_run(argument, subject) for argument in node.arguments)
    return all(n in CONSTANTS or n == "t" or n in subject.parameters for n in names_of(node))


def _element(node: Call) -> str:
    vector, *indices = node.arguments
    number = tuple(int(i.value) for i in indices if isinstance(i, Number))
    return element_name(to_text(vector), number)


def of_states(model: Model, name: str) -> Expression | None:
    """A signal as a formula of states, parameters and `t`; None where it has a guard, whose side at
    an event no state tells."""
    formula = model.flat.signals.get(name)
    if formula is None or not _is_smooth(formula):
        return None
    made: dict[str, Expression] = {}
    for read in names_of(formula):
        if read in (*CONSTANTS, "t", *model.flat.parameters, *model.states):
            continue
        inner = of_states(model, read)
        if inner is None:
            return None
        made[read] = inner
    return rename(formula, lambda read: made.get(read, Name(read)))


def _is_smooth(node: Expression) -> bool:
    return all(call.function in SMOOTH for call in calls_in(node))


def is_of_run(node: Expression) -> bool:
    """Whether a quantity is made of numbers of one run."""
    quantities = (call.function for call in calls_in(node) if is_quantity(call))
    return not any(QUANTITIES[name].study or name == "reference" for name in quantities)


def formulas_in(node: Call) -> list[Expression]:
    """The arguments of a quantity that are formulas, and not events, parameters or words."""
    known = QUANTITIES[node.function]
    return [
        argument
        for n, argument in enumerate(node.arguments)
        if known.kind(n) in ("signal", "condition", "number")
        or (known.kind(n) == "happening" and is_condition(argument))
    ]
