"""The units of a result; that of a parameter of an effect follows from its formulas and its place.

The rules of units (`tracewire.formula.unit_rules`), with the units of the place (of its sum, its
coordinate, its rate, s), are linear equations for the exponents of each parameter, which are solved
for all at once. A rate need not be that of the coordinate: a place may have an angle and a speed.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from weakref import WeakKeyDictionary

import numpy as np

from tracewire.compile import compile
from tracewire.diagram import Diagram, EffectType, effects_of
from tracewire.errors import TracewireError
from tracewire.formula import Expression, Term, dimension_of, times, unit_term
from tracewire.library import SENSOR_TERMS
from tracewire.trace.candidates.places import Place, find_places
from tracewire.trace.found import Found, FoundEffect, Power

BASES = "FQVTU"
"""Of exponents: what is summed at the place, its coordinate, its rate, time, and the drive."""
SYMBOL_UNITS: dict[str, Term] = {
    "q": {"\0Q": 1.0}, "v": {"\0V": 1.0}, "a": {"\0V": 1.0, "\0T": -1.0}, "u": {"\0U": 1.0},
    "other_q": {"\0Q": 1.0}, "other_v": {"\0V": 1.0},
}  # fmt: skip
RATE_OF_COORDINATE: Term = {"\0V": 1.0, "\0Q": -1.0, "\0T": 1.0}
SECOND: Term = {"s": 1.0}
PART = re.compile(r"([A-Za-z]+|1)(?:\s*(?:\^|\*\*)\s*(-?\d+(?:\.\d+)?))?")


def unit_at(found: Found, place: str) -> str:
    """The SI unit of what is missing at a place; '' where it is not known."""
    kind, _, signal = place.partition(".")
    if kind in ("sensor", "drive") and signal:
        return found.units.get(signal, "")
    if found.units.get(place):
        return found.units[place]
    known = _places(found).get(place)
    return _units_of(found, known)[0] if known else ""


def signal_of(found: Found, place: str, variable: str) -> str:
    """The user's name of a variable at a place, as `omega` for v; the variable where none is."""
    if variable == "y" and place.startswith("sensor."):
        return place.partition(".")[2]
    known = _places(found).get(place)
    if known is None:
        return variable
    return known.wires.get(variable) or variable


def is_first_order(found: Found, place: str) -> bool:
    """Whether a sum feeds a state that is the rate of nothing, as the level of a tank."""
    known = _places(found).get(place)
    return known is not None and known.kind == "sum" and not known.q


def unit_of_effect(found: Found, effect: str, place: str, parameter: str) -> str:
    """The SI unit of a parameter of an effect at a place; '' where none follows."""
    known = _places(found).get(place)
    kinds = {kind.name: kind for kind in effects_of(found.original)}
    if known is None or effect not in kinds:
        return ""
    block = kinds[effect].block
    if any(p.name == parameter and p.unit == "s" for p in (block.parameters if block else ())):
        return "s"  # as of a lag or a delay
    units = _units_of(found, known)
    exponents = _exponents(kinds[effect], _is_of_coordinate(units)).get(parameter)
    if exponents is None or any(e and not u for e, u in zip(exponents, units, strict=True)):
        return ""
    return _product(zip(units, exponents, strict=True))


def _places(found: Found) -> Mapping[str, Place]:
    """The places of the declared model by name; found once, as a report asks for each unit."""
    if found not in _PLACES:
        _PLACES[found] = _find_places(found.original)
    return _PLACES[found]


_PLACES: WeakKeyDictionary[Found, Mapping[str, Place]] = WeakKeyDictionary()


def _find_places(diagram: Diagram) -> Mapping[str, Place]:
    if not diagram.blocks:
        return {}
    try:
        model = compile(diagram, backend="quick")
    except TracewireError:
        return {}
    return {place.name: place for place in find_places(model)}


def _units_of(found: Found, place: Place) -> tuple[str, str, str, str, str]:
    """The units of the sum (or drive), of the coordinate, of the rate, of time, and of the drive;
    the last is not known where the drives of a sum have several."""
    units = found.units
    if place.kind != "sum":
        own = units.get(place.definition, "")
        return own, "", "", "s", own
    drives = {units.get(drive, "") for drive in place.drive}
    rate = units.get(place.v, "")
    coordinate = units.get(place.q, "") or (_product([(rate, 1.0), ("s", 1.0)]) if rate else "")
    own = units.get(place.name, "")
    if not own and place.a == place.name and coordinate:
        own = _product([(coordinate, 1.0), ("s", -2.0)])
    rate = rate or (_product([(coordinate, 1.0), ("s", -1.0)]) if coordinate else "")
    return own, coordinate, rate, "s", drives.pop() if len(drives) == 1 else ""


def _is_of_coordinate(units: tuple[str, ...]) -> bool:
    """Whether the rate of a place is in the unit of its coordinate over time."""
    coordinate, rate = map(dimension_of, units[1:3])
    return coordinate is None or rate is None or times(rate, SECOND) == coordinate


def unit_of(found: Found, effect: FoundEffect, name: str) -> str:
    """The SI unit of a parameter of an effect; '' where it has none, or where it is not known."""
    if not effect.block:
        signal = effect.place.partition(".")[2]
        own = found.units.get(f"{name}.{signal}", "")
        return own or SENSOR_TERMS[name].unit_of(found.units.get(signal, ""))
    own = found.units.get(f"{effect.block}.{name}", "")
    return own or unit_of_effect(found, effect.name, effect.place, name)


def unit_of_power(found: Found, power: Power) -> str:
    """The SI unit of the smallest coefficient; '' where it has none, or where it is not known."""
    if found.units.get(power.coefficient):
        return found.units[power.coefficient]
    if power.name.startswith("sensor_"):
        signal = power.place.partition(".")[2]
        return SENSOR_TERMS[coefficient_of(power)].unit_of(found.units.get(signal, ""))
    return unit_of_effect(found, power.name, power.place, coefficient_of(power))


def users_unit_of(found: Found, effect: FoundEffect, name: str) -> tuple[str, float]:
    """The unit in which a user has a parameter of an effect, and its factor to SI: that of the
    column for what a sensor does, that of the drive, the sum, its coordinate or its rate where
    this is of the same quantity, else that of SI."""
    if effect.block:
        return _users_unit_at(found, effect.place, unit_of(found, effect, name))
    return _users_unit_of_sensor(found, effect.place, name)


def users_unit_of_power(found: Found, power: Power) -> tuple[str, float]:
    """The same of the smallest coefficient."""
    if not power.name.startswith("sensor_"):
        return _users_unit_at(found, power.place, unit_of_power(found, power))
    return _users_unit_of_sensor(found, power.place, coefficient_of(power))


def _users_unit_at(found: Found, place: str, unit: str) -> tuple[str, float]:
    """The user's unit of what has an SI unit at a place."""
    kind, _, drive = place.partition(".")
    near = [drive] if kind == "drive" else [place, *(signal_of(found, place, x) for x in "qv")]
    for signal in near:
        if unit and found.units.get(signal) == unit:
            users, factor = users_unit(found, signal)
            if factor != 1.0:
                return users, factor
    return unit, 1.0


def _users_unit_of_sensor(found: Found, place: str, term: str) -> tuple[str, float]:
    signal = place.partition(".")[2]
    unit, factor = users_unit(found, signal)
    known = SENSOR_TERMS[term].unit_of(unit) or found.units.get(f"{term}.{signal}", "")
    return known, SENSOR_TERMS[term].factor(factor)


def coefficient_of(power: Power) -> str:
    """The coefficient of an effect as its block, or the sensor, calls it."""
    if power.name.startswith("sensor_"):
        return power.coefficient.partition(".")[0]
    return power.coefficient.rpartition(".")[2]


def known_units(found: Found) -> dict[str, str]:
    """The units of parameters of effects, by `block.parameter`, and of places, as far as known."""
    units = {f"{e.block}.{name}": unit_of(found, e, name)
             for e in found.effects if e.block for name in e.params}  # fmt: skip
    units |= {p.coefficient: unit_of_power(found, p) for p in found.power}
    places = {*(e.place for e in found.effects), *(d.place for d in found.dependences)}
    units |= {place: unit_at(found, place) for place in places}
    return {name: unit for name, unit in units.items() if unit}


def users_unit(found: Found, signal: str) -> tuple[str, float]:
    """The unit in which a user has a signal, and its factor to SI (`Diagram.users_unit`)."""
    if signal in found.users_units:
        return found.users_units[signal]
    return found.original.users_unit(signal, found.units.get(signal, ""))


# --- exponents ----------------------------------------------------------------------------------


def _exponents(kind: EffectType, of_coordinate: bool) -> dict[str, tuple[float, ...]]:
    """The exponents of (sum, coordinate, rate, time) of each parameter that its formulas determine.

    of_coordinate: the rate of the place is that of its coordinate.
    """
    block = kind.block
    if block is None or block.modes:
        return {}
    known: dict[str, Term] = {"t": {"\0T": 1.0}, "pi": {}}
    known |= {port: SYMBOL_UNITS[symbol] for port, symbol in kind.effect.inputs.items()}
    for parameter in block.parameters:
        if parameter.unit in ("s", "rad", "1"):
            known[parameter.name] = {"\0T": 1.0} if parameter.unit == "s" else {}
    equations: list[Term] = []

    def named(name: str) -> Term:
        return known.get(name, {name: 1.0})

    def note(one: Term, other: Term, *nodes: Expression | None) -> None:
        equations.append(times(one, other, -1.0))

    def same(formula: Expression, unit: Term) -> None:
        term = unit_term(formula, named, note, strict=True)
        if term is not None:
            note(term, unit)

    for formula in block.formulas.values():
        same(formula, {"\0F": 1.0})
    for state in block.states:
        same(block.rates[state.name], {state.name: 1.0, "\0T": -1.0})
        same(block.starts[state.name], {state.name: 1.0})
    if of_coordinate:
        equations = [_without_rate(equation) for equation in equations]
    return _solved(equations)


def _without_rate(term: Term) -> Term:
    """A unit where a rate is in that of the coordinate over time."""
    return times(term, RATE_OF_COORDINATE, -term.get("\0V", 0.0))


def _solved(equations: list[Term]) -> dict[str, tuple[float, ...]]:
    """The exponents of each name that the equations determine; none where they contradict."""
    names = sorted({n for e in equations for n in e if not n.startswith("\0")})
    if not names:
        return {}
    matrix = np.array([[e.get(n, 0.0) for n in names] for e in equations])
    right = np.array([[-e.get(f"\0{b}", 0.0) for b in BASES] for e in equations])
    solution, _, rank, _ = np.linalg.lstsq(matrix, right, rcond=None)
    if not np.allclose(matrix @ solution, right, atol=1e-6):
        return {}  # the formulas do not agree on units
    null = np.linalg.svd(matrix)[2][rank:]
    free = np.linalg.norm(null, axis=0) > 1e-6 if len(null) else np.zeros(len(names), bool)
    return {
        name: tuple(float(round(x, 6)) for x in row)
        for name, row, open_ in zip(names, solution, free, strict=True)
        if not open_
    }


# --- texts --------------------------------------------------------------------------------------


def _product(parts: Iterable[tuple[str, float]]) -> str:
    """The text of a product of units with exponents: `N m s/rad`."""
    powers: dict[str, float] = {}
    for text, exponent in parts:
        for symbol, power in _symbols(text):
            powers[symbol] = powers.get(symbol, 0.0) + exponent * power
    above = [_powered(s, p) for s, p in powers.items() if p > 1e-9]
    below = [_powered(s, -p) for s, p in powers.items() if p < -1e-9]
    if not above and not below:
        return ""
    return "/".join([" ".join(above) or "1", *below])


def _symbols(text: str) -> Iterator[tuple[str, float]]:
    for n, part in enumerate(re.split(r"/", text)):
        for symbol, power in PART.findall(part):
            if symbol != "1":
                yield symbol, (float(power) if power else 1.0) * (1 if n == 0 else -1)


def _powered(symbol: str, power: float) -> str:
    return symbol if abs(power - 1) < 1e-9 else f"{symbol}^{power:g}"
