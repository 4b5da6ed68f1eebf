"""Whether the units of a model go together: one equation for each formula and each wire.

A signal or a state without a unit takes the one that its equations give it. A number, the time
`t`, or a parameter without a unit may have any: only what units contradict is told.
"""

from __future__ import annotations

from dataclasses import replace

from tracewire.compile.flat import Flat, FlatAsked, FlatState
from tracewire.errors import Location, Problem
from tracewire.formula import (
    CONSTANTS,
    Call,
    Expression,
    Name,
    Number,
    Term,
    dimension_of,
    dimension_text,
    read_unit,
    times,
    to_text,
    unit_term,
)

OPEN = "\0"
"""Begins the name of a signal whose unit is not known yet: no base unit does."""
SECOND: Term = {"s": 1.0}
HINT = "Correct a unit, or give the number between them a unit. What has no unit may have any."


def unit_problems(flat: Flat) -> list[Problem]:
    """Where the units of a model contradict each other, each with its place and both units.

    None where a diagram has no unit at all, as `x' = -x` of a textbook, which is in plain numbers.
    """
    return _Units(flat).problems() if has_units(flat) else []


def has_units(flat: Flat) -> bool:
    """Whether a parameter of the diagram, a signal, a value in its text, or a table has a unit."""
    own = (parameter.unit for name, parameter in flat.parameters.items() if "." not in name)
    written = (asked.given for asked in flat.asked)
    axes = (unit for points in flat.tables.values() for unit in points.units)
    return any((*own, *written, *axes, *flat.units.values()))


def complete_units(flat: Flat) -> dict[str, str]:
    """The units of a model with those that its equations give to signals and states without one.

    None is added where units contradict each other, and none that is a power of s alone: a rate in
    1/s may be one in rad/s, as rad is a number.
    """
    known = dict(flat.units)
    if not has_units(flat):
        return known
    units = _Units(flat)
    if units.problems():
        return known
    for name in (*flat.signals, *units.states):
        if not known.get(name):
            term = units.resolved({OPEN + name: 1.0})
            if term.keys() - {"s"} and not any(base.startswith(OPEN) for base in term):
                known[name] = dimension_text(term)
    return known


def unit_of(flat: Flat, formula: Expression) -> tuple[Term | None, list[Problem]]:
    """The unit of a formula over the names of a model, None where it may be any, and what
    contradicts inside of it."""
    units = _Units(flat)
    units.problems()
    units.found.clear()
    units.where = Location()
    term = units.term(formula)
    known = None if term is None else units.resolved(term)
    closed = known is not None and not any(name.startswith(OPEN) for name in known)
    return (known if closed else None), units.found


class _Units:
    def __init__(self, flat: Flat) -> None:
        self.flat = flat
        self.states = {state.name: state for state in flat.states}
        self.known: dict[str, Term] = {}
        self.found: list[Problem] = []
        self.where = Location()
        for name, unit in flat.units.items():
            dimension = dimension_of(unit)
            if dimension is not None:
                self.known[OPEN + name] = dimension
            elif name in flat.shown and _is_part(flat.shown[name].unit):
                self.known[OPEN + name] = {}
        self.axes = {
            f"{name}.{axis}": dimension_of(unit) or {}
            for name, points in flat.tables.items()
            for axis, unit in zip("xy", points.units, strict=True)
            if unit is not None
        }

    def problems(self) -> list[Problem]:
        for name, parameter in self.flat.parameters.items():
            self.where = parameter.place
            self.same(name, parameter.formula, "its value")
        for asked in self.flat.asked:
            self.where = asked.place
            self.as_asked(asked)
        for state in self.flat.states:
            self.where = state.place
            self.integral(state)
        for name, formula in self.flat.signals.items():
            self.where = self.place(name)
            self.same(name, formula, "its formula")
        for state in self.flat.states:
            self.where = state.place
            self.same(state.name, state.start, "its start")
        for event in self.flat.events:
            self.where = event.place
            self.term(event.when)
            for name, formula in event.set.items():
                self.same(name, formula, f"what '{event.name}' sets it to")
        for memory in self.flat.memories:
            self.where = memory.place
            self.term(memory.start)
            for transition in memory.transitions:
                self.term(transition.when)
                for name, formula in transition.set.items():
                    self.same(name, formula, "what a transition sets it to")
        for condition in self.flat.require:
            self.where = condition.place
            self.term(condition.formula)
        return _told_once(self.found)

    def term(self, formula: Expression) -> Term | None:
        """The unit of a formula; what contradicts inside of it is noted."""
        return unit_term(formula, self.named, self.together, strict=False)

    def named(self, name: str) -> Term | None:
        if name in CONSTANTS:
            return {}
        parameter = self.flat.parameters.get(name)
        if parameter is not None:
            own = {} if _is_part(parameter.written) else dimension_of(parameter.unit)
            number = isinstance(parameter.formula, Number)
            return own if own is not None or number else self.term(parameter.formula)
        if name in self.states or name in self.flat.signals or OPEN + name in self.known:
            return {OPEN + name: 1.0}
        return self.axes.get(name)

    def together(self, one: Term, other: Term, left: Expression | None, right: Expression) -> None:
        """What a formula adds or compares, or takes for a number."""
        if self.agree(one, other):
            return
        if left is None:
            self.note(f"{self.said(right, other)} where a number or an angle is needed")
        else:
            both = f"{self.said(left, one)} and {self.said(right, other)}"
            self.note(f"{both}: they cannot be added or compared")

    def same(self, name: str, formula: Expression, what: str) -> None:
        """The unit of a name is that of its formula."""
        own, made = self.named(name), self.term(formula)
        if own is None or made is None or self.agree(own, made):
            return
        made_of = self.said(formula, made) if isinstance(formula, Name) else ""
        made_of = made_of or f"{what} is in {self.text(made)}"
        self.note(f"{self.said(Name(name), own)}, and {made_of}")

    def as_asked(self, asked: FlatAsked) -> None:
        """The unit of a value is that of what takes it."""
        given, like = self.term(asked.formula), asked.like
        wanted = dimension_of(asked.unit) if like is None else self.term(like)
        if wanted is None:
            return
        if given is not None:
            written = self.text(given, asked.formula)
            self.as_wanted(asked, self.said(asked.formula, given), given, written, wanted)
        if asked.given and not isinstance(asked.formula, Name):
            given, said = _dimension(asked.given), f"'{asked.name}' is in {asked.given}"
            self.as_wanted(asked, said, given, asked.given, wanted)

    def as_wanted(
        self, asked: FlatAsked, said: str, given: Term, written: str, wanted: Term
    ) -> None:
        """Of a value in the unit `given`, which is `said` and `written` so."""
        unit = asked.unit if asked.like is None else self.text(wanted, asked.like)
        if not self.agree(given, wanted):
            self.note(f"{said}, and {asked.taker} takes it in {unit}")
        elif _turns(written) and _turns(unit) and _turns(written) != _turns(unit):
            # both are 1/s: no other equation can tell them apart
            hint = f"1 Hz is 2*pi rad/s: write the value in {unit}."
            self.found.append(
                Problem(f"{said}, and {asked.taker} takes it in {unit}", self.where, hint=hint)
            )

    def integral(self, state: FlatState) -> None:
        """The unit of a rate is that of its state over time."""
        rate, own = self.term(state.rate), self.named(state.name)
        if rate is None or own is None:
            return
        needed = times(own, SECOND, -1.0)
        if not self.agree(needed, rate):
            self.note(
                f"{self.said(Name(state.name), own)}, and is the integral of what is in "
                f"{self.text(rate, state.rate)}; it needs a rate in {self.text(needed)}"
            )

    def agree(self, one: Term, other: Term) -> bool:
        """Whether two units are the same; where they leave a signal open, its unit is known now."""
        apart = self.resolved(times(one, other, -1.0))
        signal = next((name for name in apart if name.startswith(OPEN)), None)
        if signal is None:
            return not apart
        power = apart.pop(signal)
        self.known[signal] = times({}, apart, -1.0 / power)
        return True

    def note(self, what: str) -> None:
        problem = Problem(what, self.where, hint=HINT)
        if problem not in self.found:
            self.found.append(problem)

    def resolved(self, term: Term) -> Term:
        """The same without signals whose unit is known by now."""
        while name := next((name for name in term if name in self.known), ""):
            rest = {other: power for other, power in term.items() if other != name}
            term = times(rest, self.known[name], term[name])
        return term

    def text(self, term: Term, formula: Expression | None = None) -> str:
        """The unit, as the diagram writes it where it does."""
        written = ""
        if isinstance(formula, Name):
            parameter = self.flat.parameters.get(formula.name)
            written = parameter.unit if parameter else self.flat.units.get(formula.name, "")
        if written:
            return written
        known = self.resolved(term)
        rest = {name: power for name, power in known.items() if not name.startswith(OPEN)}
        still_open = [
            f"the unit of '{name.removeprefix(OPEN)}'" + ("" if power == 1 else f"^{power:g}")
            for name, power in known.items()
            if name not in rest
        ]
        told = [dimension_text(rest)] if rest or not still_open else []
        return " times ".join(told + still_open)

    def said(self, formula: Expression, term: Term) -> str:
        """A part of a formula, its line and its unit: `'phi' (line 12) is in rad`."""
        while isinstance(formula, Call) and formula.function == "neg":
            formula = formula.arguments[0]
        if not isinstance(formula, Name):
            return f"'{to_text(formula)}' is in {self.text(term)}"
        line = self.place(formula.name).line
        beside = f" (line {line})" if line and line != self.where.line else ""
        return f"'{formula.name}'{beside} is in {self.text(term, formula)}"

    def place(self, name: str) -> Location:
        """Where the diagram has a name; nowhere for an input."""
        tables = (self.flat.parameters, self.flat.blocks, self.states)
        return next((table[name].place for table in tables if name in table), Location())


def _is_part(unit: str) -> bool:
    """Whether a user's unit says that a value is a plain number, as `%` does."""
    return bool(unit) and not read_unit(unit).text


def _dimension(unit: str) -> Term:
    """The dimension of a unit as a text writes it."""
    return dimension_of(read_unit(unit).text) or {}


def _turns(unit: str) -> str:
    """What a frequency counts: `Hz` turns, `rad` radians; empty where the unit does not say it."""
    return next((name for name in ("Hz", "rad/s") if unit == name), "")


def _told_once(problems: list[Problem]) -> list[Problem]:
    """The problems of a line that several blocks are made from, for the first of them only."""
    blocks: dict[tuple[str, int, int], list[str]] = {}
    for problem in problems:
        at = problem.place
        same = blocks.setdefault((at.file, at.line, at.column), [])
        same += [] if at.block in same else [at.block]
    found = []
    for problem in problems:
        at = problem.place
        first, *others = blocks[at.file, at.line, at.column]
        if at.block != first:
            continue
        also = f"; so it is in {len(others)} other blocks of this line" if others else ""
        found.append(replace(problem, what=problem.what + also))
    return found
