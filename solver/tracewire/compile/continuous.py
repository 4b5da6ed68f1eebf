"""Ports that must not get a signal that jumps: what is certain to jump is refused.

Certain to jump are, of signals that are wired directly or through sums, gains and delays:

    a if b >= c else d    where a and d are different numbers (step, relay, compare, switch)
    a if b >= c else d    where b and c read t alone, and a or d jumps (pulse)
    floor(u)              (square, sawtooth, quantizer)
    mod(u, a)             where u jumps, or reads t alone
    what draws a number   (noise, random_steps)
    a state               that stands still and that events set (zero_order_hold, counter, toggle)

Of anything else nothing is said: whether it jumps depends on where the run goes.
"""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from tracewire.compile.flat import FlatEvent, FlatMemory, FlatParameter, FlatState
from tracewire.errors import FormulaError, Location, Problem
from tracewire.formula import Expression, Name, Number, calls_in, evaluate, names_of

PASSED = ("+", "-", "neg", "stack", "[]", "sum", "join")
FIRST = ("delayed", "shifted", "/")
"""Functions of which the first argument alone counts."""


@dataclass(frozen=True)
class ContinuousPort:
    """A port that must not get a jump, what is wired to it, and the place of its block."""

    port: str
    type: str
    wire: Expression
    place: Location


def jump_problems(
    ports: Sequence[ContinuousPort],
    signals: Mapping[str, Expression],
    states: Mapping[str, FlatState],
    events: Sequence[FlatEvent],
    memories: Sequence[FlatMemory],
    parameters: Mapping[str, FlatParameter],
) -> list[Problem]:
    """The ports that are wired to what is certain to jump, before vectors are expanded."""
    if not ports:
        return []
    reset = {name for event in events for name in event.set}
    reset |= {name for memory in memories for move in memory.transitions for name in move.set}
    still = {name for name, state in states.items() if state.rate == Number(0.0)}
    search = _Search(signals, parameters, reset & still)
    found = []
    for port in ports:
        name = search.jumping(port.wire)
        if name:
            what = f"input '{port.port}' of a {port.type} gets '{name}', which jumps"
            hint = "What moves this block has no jumps: put a rate_limiter or a first_order before."
            found.append(Problem(what, port.place, (), hint))
    return found


class _Search:
    """The search for a jump, back from a formula through the signals that it reads."""

    def __init__(
        self,
        signals: Mapping[str, Expression],
        parameters: Mapping[str, FlatParameter],
        held: Collection[str],
    ) -> None:
        self.signals, self.parameters = signals, parameters
        self.jumps = {name: name for name in held}
        """Of each signal that was looked at the one by which it jumps, or ''."""
        self.values: dict[str, float | None] = {}
        formulas = {name: parameter.formula for name, parameter in parameters.items()}
        for name in _in_order(parameters, formulas, self.values):
            self.values[name] = self.number(formulas[name])

    def jumping(self, wire: Expression) -> str:
        """The signal by which a formula is certain to jump; '' where that is not certain."""
        for name in _in_order(names_of(wire), self.signals, self.jumps):
            self.jumps[name] = self._jumping(self.signals[name], name)
        return self._jumping(wire, "this")

    def _jumping(self, node: Expression, own: str) -> str:
        """The same of a formula whose signals are known; `own` is the one that it is a part of."""
        if isinstance(node, Number):
            return ""
        if isinstance(node, Name):
            return self.jumps.get(node.name, "")
        function, arguments = node.function, node.arguments
        if function in PASSED:
            return next(filter(None, (self._jumping(part, own) for part in arguments)), "")
        if function in FIRST:
            return self._jumping(arguments[0], own)
        if function == "*":
            for part, other in (arguments, arguments[::-1]):
                if self.number(other):
                    return self._jumping(part, own)
        if _draws(node) or (function == "floor" and self.number(node) is None):
            return own
        if function == "mod":
            return own if self.is_timed(node) else self._jumping(arguments[0], own)
        if function == "if" and self.number(arguments[0]) is None:
            values = [self.number(value) for value in arguments[1:]]
            if None not in values and values[0] != values[1]:
                return own
            if self.is_timed(arguments[0]):
                return next(filter(None, (self._jumping(part, own) for part in arguments[1:])), "")
        return ""

    def is_timed(self, node: Expression) -> bool:
        """Whether a formula reads the time, and nothing else but parameters."""
        return {*names_of(node)} - self.parameters.keys() == {"t"}

    def number(self, node: Expression) -> float | None:
        """The value of a formula of numbers and parameters; None of any other."""
        values = {name: self.values.get(name) for name in names_of(node)}
        known = {name: value for name, value in values.items() if value is not None}
        if len(known) < len(values):
            return None
        try:
            return evaluate(node, known)
        except FormulaError:
            return None


def _in_order(
    names: Iterable[str], formulas: Mapping[str, Expression], known: Container[str]
) -> Iterator[str]:
    """The names that formulas are needed of and that are not known, each after those that it reads;
    without a recursion, which a long chain would break."""
    due, begun = list(names), set[str]()
    while due:
        name = due[-1]
        if name in known or name not in formulas or name in begun:
            due.pop()
            if name in begun and name not in known:
                yield name
            continue
        begun.add(name)
        due += [other for other in names_of(formulas[name]) if other not in begun]


def _draws(node: Expression) -> bool:
    """Whether a random number is a part of a formula."""
    return any(call.function == "random_number" for call in calls_in(node))
