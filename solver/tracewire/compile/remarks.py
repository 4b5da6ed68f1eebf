"""What is odd about a model that can be run: forces that push on, functions of a held friction,
numbers in SI beside a signal that is shown in degrees."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass

from tracewire.compile.flat import Flat
from tracewire.compile.limits import REMARK
from tracewire.compile.model import Model
from tracewire.diagram import BlockUse, Diagram, InputPort, Shown, Value
from tracewire.errors import FormulaError
from tracewire.formula import Name, Number, evaluate

FORCES = ("barrier", "dry_friction", "friction", "hysteresis", "stiffness")
"""The families of blocks whose output acts on a body, most of them against its motion."""
STICKING = ("coulomb", "dry_friction", "stribeck")
"""Blocks whose output has two values at rest, and any between them while it sticks."""
OF_THE_SIGNAL = ("value", "start", "offset", "height", "amplitude", "low", "high", "before")
"""Parameters of blocks that are in the unit of the output, where the declaration names none."""
PRIME = "'"

Values = Mapping[str, float]


def remarks_of(model: Model, parameters: Values) -> list[str]:
    """What is odd about a model with these parameters in SI, each in a line.

    A block of a spring or a damper that is wired so that it pushes the body on; a nonlinear
    function of a dry friction, which has a blend of the values on both sides while that sticks; a
    number without a unit that is large or tiny in the unit, not of SI, in which its signal is
    shown; a parameter that a fit may change, and that nothing reads.
    """
    return [*_bare(model), *_unread(model.flat), *_of_forces(model, parameters)]


def _unread(flat: Flat) -> Iterator[str]:
    """Parameters that a fit may change and that stand in no formula."""
    free = [name for name, parameter in flat.parameters.items() if parameter.fit is not None]
    read = set(_names_in(flat)) if free else set()
    for name in free:
        if name not in read:
            yield f"'{name}' is free in a fit, and nothing reads it: use it, or remove it"


def _names_in(value: object) -> Iterator[str]:
    """The names in all formulas of a record."""
    if isinstance(value, Name):
        yield value.name
    elif isinstance(value, Mapping):
        value = tuple(value.values())
    elif is_dataclass(value):
        value = tuple(getattr(value, field.name) for field in fields(value))
    if isinstance(value, tuple):
        for part in value:
            yield from _names_in(part)


def _bare(model: Model) -> Iterator[str]:
    """Numbers that count in SI, and may be meant in the unit in which a signal is shown: that of
    the block, or that which the number is compared with."""
    diagram = model.diagram
    for use in diagram.blocks.values():
        for parameter in diagram.library[use.type].parameters if use.subsystem is None else ():
            name, number = parameter.name, _bare_number(diagram, use.settings.get(parameter.name))
            wires = use.inputs.get(parameter.unit_of, ())
            signal: BlockUse | InputPort | None = None
            if name in OF_THE_SIGNAL and not parameter.unit and use.shown.factor != 1.0:
                signal, what = use, f"its {name} {number:g}"
            elif wires:
                signal = diagram.blocks.get(wires[0].signal) or diagram.inputs.get(wires[0].signal)
                what = f"the {name} {number:g} of '{use.name}'"
            if signal is None or not _may_be_meant_in(signal.shown, number):
                continue
            unit = signal.shown.unit
            yield (
                f"'{signal.name}' is shown in {unit}, and {what} counts in SI, as "
                f"{number / signal.shown.factor:g} {unit}: write {{value: {number:g}, unit: "
                f"{unit}}}, if that is meant"
            )


def _may_be_meant_in(shown: Shown, number: float) -> bool:
    """Whether a number in SI is more likely one in the unit in which a signal is shown: it is large
    there, as degrees in rad are, or tiny, as bars in Pa are."""
    there = abs(number) / shown.factor
    if shown.factor < 1.0:
        return there > REMARK.large
    return shown.factor > 1.0 and 0.0 < there < REMARK.small


def _bare_number(diagram: Diagram, value: object) -> float:
    """A number that is written without a unit, as it is or as a parameter; zero where it is not
    known or has a unit."""
    if isinstance(value, Value) and isinstance(value.formula, Name):
        value = diagram.parameters.get(value.formula.name)
    if not isinstance(value, Value) or value.unit or value.factor != 1.0:
        return 0.0
    return value.formula.value if isinstance(value.formula, Number) else 0.0


def _of_forces(model: Model, parameters: Values) -> list[str]:
    probe = _Probe(model.flat, parameters)
    forces = [use for use in model.diagram.blocks.values() if _is_force(model, use)]
    runs = 2 * len(model.states) + 8 * len(forces)
    if not forces or model.flat.loops or len(model.flat.signals) * runs > REMARK.most_values:
        return []
    found = [text for use in forces for text in probe.pushes_on(use)]
    return found + [text for use in forces for text in probe.bends(use)]


def _is_force(model: Model, use: BlockUse) -> bool:
    family = model.diagram.library.families.get(use.type, "")
    return use.subsystem is None and family in FORCES and use.name in model.flat.signals


class _Probe:
    """The signals and rates of flat equations at states that are moved, one at a time."""

    def __init__(self, flat: Flat, parameters: Values) -> None:
        self.flat = flat
        self.known = {**parameters, "t": 0.0, **dict.fromkeys(flat.inputs, 0.0)}
        self.known |= {memory.name: 0.0 for memory in flat.memories}
        self.rest = {state.name: 0.0 for state in flat.states}
        self.kept: dict[tuple[str, float], Values] = {}

    def values(self, states: Values, fixed: Values | None = None) -> dict[str, float]:
        """All signals, and the rate of each state as `STATE'`; those without a value are left out.

        fixed: signals that have these values instead.
        """
        found, fixed = {**self.known, **states}, fixed or {}
        formulas = [*self.flat.signals.items(), *((f"{s.name}'", s.rate) for s in self.flat.states)]
        for name, formula in formulas:
            try:
                found[name] = fixed[name] if name in fixed else evaluate(formula, found)
            except FormulaError:
                continue
        return found

    def moved(self, state: str, by: float) -> Values:
        """The values where all states are zero but for one."""
        if (state, by) not in self.kept:
            self.kept[state, by] = self.values({**self.rest, state: by})
        return self.kept[state, by]

    def slope(self, name: str, state: str) -> float:
        """How much a signal grows while a state goes from below to above zero; 0 if unknown."""
        low, high = self.moved(state, -REMARK.step), self.moved(state, REMARK.step)
        return high[name] - low[name] if name in low and name in high else 0.0

    def pushes_on(self, use: BlockUse) -> Iterator[str]:
        """Where the force of a block, which opposes what it reads, drives a body on."""
        read = [wire for wires in use.inputs.values() for wire in wires if not wire.index]
        pushed = self.forced(use.name)
        for body, pushes in pushed.items():
            for state in (body, *self.places_of(body)):
                force = self.slope(use.name, state)
                opposes = any(
                    force * self.slope(w.signal, state) * (-1 if w.negative else 1) < 0
                    for w in read
                )
                if opposes and force * pushes > 0:
                    yield (
                        f"'{use.name}' pushes '{body}' on: a {use.type} acts against '{state}' by "
                        "itself, and here it acts with it. Was it added with a minus?"
                    )
                    break

    def forced(self, name: str) -> dict[str, float]:
        """By how much the rate of each state grows with a signal, where it does."""
        low, high = (self.values(self.rest, {name: value}) for value in (-1.0, 1.0))
        rates = {s.name: f"{s.name}'" for s in self.flat.states}
        return {
            state: high[rate] - low[rate]
            for state, rate in rates.items()
            if rate in low and rate in high and high[rate] != low[rate]
        }

    def places_of(self, body: str) -> list[str]:
        """The states whose rate a state is."""
        return [state.name for state in self.flat.states if state.rate == Name(body)]

    def bends(self, use: BlockUse) -> Iterator[str]:
        """What is a nonlinear function of a friction that may stick."""
        if use.type not in STICKING:
            return
        size = max(abs(self.moved(s, REMARK.step).get(use.name, 0.0)) for s in self.rest) or 1.0
        curves = [
            [self.values(self.rest, {use.name: middle + k * 0.05 * size}) for k in (-1, 0, 1)]
            for middle in (0.37 * size, -0.61 * size)  # two: one of them may be at a kink
        ]
        for name in [*self.flat.signals, *(f"{state}'" for state in self.rest)]:
            if name != use.name and all(_bent(name, *curve) for curve in curves):
                yield (
                    f"'{name.removesuffix(PRIME)}' is a nonlinear function of '{use.name}': while "
                    "this sticks it is a blend of its values on both sides, and not that of the "
                    "force that holds"
                )
                return


def _bent(name: str, low: Values, middle: Values, high: Values) -> bool:
    """Whether three values at equal distances lie on no line."""
    if not (name in low and name in middle and name in high):
        return False
    bend = low[name] - 2 * middle[name] + high[name]
    return abs(bend) > REMARK.bent * max(abs(high[name] - low[name]), abs(middle[name]))
