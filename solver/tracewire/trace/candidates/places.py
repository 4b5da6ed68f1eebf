"""Places: where in a diagram something may be missing: sums, drives and measured channels."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from tracewire.compile import Flat, FlatBlock, FlatState, Model
from tracewire.diagram import Diagram, element_name, find_signal, split_index
from tracewire.formula import Call, Expression, Name, names_of
from tracewire.trace.candidates.inside import (
    closed_subsystems,
    diagram_at,
    extensible_subsystems,
    is_included,
    local_name,
    rows_of_sums,
)
from tracewire.trace.limits import MESSAGE

PASSED = ("sum", "gain", "divide")


@dataclass(frozen=True)
class Place:
    """A place: a sum that feeds a rate, a measured channel, or a drive.

    name: that of the sum, `sensor.SIGNAL`, or `drive.NAME`; `definition` is the sum's name in the
    text of the diagram, the measured signal, or the input or source block. Signals of a sum: the
    rate `v`, the coordinate `q` whose rate that is, the acceleration `a` that v is the integral of
    ('' where there is none), and `others`, (q, v) of the sums of other rates. `drive` holds the
    drives of the diagram, at a drive itself only that. `within` is the path of the subsystem that
    a sum stands in, '' at the top; its signals have their names of the flat equations. `element`
    is the number of an element, and how many there are, of a sum of vectors. `own` is `within`
    where an included file defines the subsystem: an effect needs a definition of its own there.
    """

    name: str
    kind: Literal["sum", "sensor", "drive"]
    definition: str
    q: str = ""
    v: str = ""
    a: str = ""
    others: tuple[tuple[str, str], ...] = ()
    drive: tuple[str, ...] = ()
    within: str = ""
    element: tuple[int, int] | None = None
    own: str = ""

    @property
    def wires(self) -> dict[str, str]:
        """The signal of each variable at the place that a block can be wired to."""
        found = {"q": self.q, "v": self.v, "a": self.a, "t": "t"}
        many = len(self.drive) > 1
        found |= {f"u of {name}" if many else "u": name for name in self.drive}
        several = len(self.others) > 1
        for q, v in self.others:
            of = f" of {v or q}" if several else ""
            found |= {f"other_q{of}": q, f"other_v{of}": v}
        return found


def find_places(model: Model) -> list[Place]:
    """The places of a model: sums, then drives, then sensors.

    Sums: from each state the search goes back through gains, divisions, sums, expressions that are
    proportional to one signal (`net/J`) and the ports of subsystems; the sums that it meets are
    places of the nearest state. A sum that only feeds another place of the same state says nothing
    new and is left out. Where the diagram itself says which sum is the place of a rate (`place: {q:
    ..., v: ...}`), that sum is the only one; it may name a coordinate alone, where nothing has a
    rate (see `untried`). A sum inside subsystems is a place where each is the only block of its
    type (see `extensible_subsystems`). Each element of a sum of vectors is a place; sums of
    matrices are not tried.

    A sum of a row is no place: a row has one line, and each block of it other signals.

    Drives: the named inputs that something reads, and the blocks whose output depends on nothing
    but the time (sine, square, step, ramp, table, a formula of t) and that something reads. Not one
    that a delay reads: its past is known, and that of what an effect made of it is not.

    For a sum at the top a signal inside a subsystem counts where an output of that carries it, and
    for a sum inside one at the top where an input carries it: a block cannot be wired to others.

    Sensors: the signals that a series measures in a column of its own; but not an input.
    """
    delayed = _delayed(model)
    drives = tuple(name for name in _drives(model) if name not in delayed)
    inside = extensible_subsystems(model.diagram)
    sums = _sums(model.flat, drives, inside)
    included = {path for path, use in inside.items() if is_included(model.diagram, use)}
    sums = [replace(p, own=p.within) if p.within in included else p for p in sums]
    sums = [place for place in sums if not _in_row(model.diagram, place)]
    sums = [place for place in sums if place.within or not _is_drive(model, place, drives)]
    return [
        *(_seen_from(model, place) for place in sums),
        *(Place(f"drive.{name}", "drive", name, drive=(name,)) for name in drives),
        *(Place(f"sensor.{name}", "sensor", name) for name in _sensors(model)),
    ]


def _shown(names: Sequence[str]) -> str:
    """Some names, the first of them where they are many."""
    return ", ".join(names[: MESSAGE.most_names]) + " ..." * (len(names) > MESSAGE.most_names)


def describe_no_sum(model: Model, places: Sequence[Place]) -> list[str]:
    """In words, that none of all places is a sum, where the diagram has sums."""
    blocks = model.diagram.blocks
    sums = [name for name, use in blocks.items() if use.type == "sum" and not use.row]
    if not sums or any(place.kind == "sum" for place in places):
        return []
    return [
        f"nothing is tried at sums: from {_shown(sums)} to a rate the way is not through gains,"
        " divisions and products alone; where one is the sum of what acts on a body, say so in "
        "it, as in `place: {q: SIGNAL, v: SIGNAL}`"
    ]


def describe_untried(model: Model, places: Sequence[Place]) -> list[str]:
    """What cannot be tried, in words: at sums inside some subsystems, at rows of sums, at sums that
    have no rate, or no coordinate, and in drives that a delay reads."""
    diagram = model.diagram
    shut: dict[str, list[str]] = {}
    for path, why in closed_subsystems(diagram).items():
        shut.setdefault(why, []).append(f"'{path}'")
    found = [
        f"nothing is tried at sums inside {_shown(paths)}: {why}" for why, paths in shut.items()
    ]
    found += [
        f"nothing is tried at the sums '{path}': they are a row of blocks"
        for path in rows_of_sums(diagram)
    ]
    found += [
        f"nothing is tried in the drive '{name}': a delay reads it, and before a window only "
        f"'{name}' itself is known"
        for name in _drives(model)
        if name in _delayed(model)
    ]
    effects = diagram.library.effects()
    for place in places:
        missing = [s for s, signal in (("q", place.q), ("v", place.v)) if not signal]
        if place.kind != "sum" or not missing:
            continue
        needs = [
            name
            for name, block in effects.items()
            if block.effect and {*missing} & {*block.effect.inputs.values()}
        ]
        lacks = " and no ".join({"q": "coordinate", "v": "rate"}[s] for s in missing)
        adds = ", ".join(f"{s}: SIGNAL" for s in missing)
        found.append(
            f"'{place.name}' has no {lacks}: {_shown(needs)} are not tried there; "
            f"name it, as in `place: {{{adds}}}`, where there is one"
        )
    return found


def _sums(flat: Flat, drives: tuple[str, ...], inside: Collection[str]) -> list[Place]:
    coordinates = {s.rate.name: s.name for s in flat.states if isinstance(s.rate, Name)}
    states = {state.name: state for state in flat.states}
    nearest: dict[str, tuple[int, str]] = {}
    for state in flat.states:
        for name, distance in _sums_behind(flat, names_of(state.rate)):
            if name not in nearest or distance < nearest[name][0]:
                nearest[name] = (distance, state.name)
    local_names = {
        name: _local(flat, name, block)
        for name, block in flat.blocks.items()
        if block.type == "sum"
        and {"q", "v"} & block.local.keys()
        and _is_reached(name, block, inside)
    }
    taken = {local["v"] for local in local_names.values() if "v" in local}
    rates = {n: (local.get("v", ""), local.get("q", "")) for n, local in local_names.items()}
    for name, (_, fed) in nearest.items():
        if name in local_names or fed in taken or not _is_reached(name, flat.blocks[name], inside):
            continue
        if not _only_feeds(flat, name, fed, nearest):
            rates[name] = fed, coordinates.get(fed, "")
    bodies = list(dict.fromkeys((q, v) for v, q in rates.values()))
    return [
        Place(
            name,
            "sum",
            flat.blocks[name].definition,
            q,
            v,
            _acceleration(v, states),
            tuple(body for body in bodies if body != (q, v)),
            drives,
            name.rpartition(".")[0],
            _element(flat, name),
        )
        for name, (v, q) in rates.items()
    ]


def _seen_from(model: Model, place: Place) -> Place:
    """The place with the signals that a block there can be wired to; '' in place of others."""

    def visible(name: str) -> str:
        if place.within:
            return name if local_name(model.diagram, place.within, name) else ""
        if not name or find_signal(model.diagram, name) == name:
            return name
        same = (other for other, formula in model.flat.signals.items() if formula == Name(name))
        return next((other for other in same if find_signal(model.diagram, other) == other), "")

    others = tuple((visible(q), visible(v)) for q, v in place.others)
    q, v, a = visible(place.q), visible(place.v), visible(place.a)
    others = tuple(body for body in others if any(body))
    drive = tuple(name for name in place.drive if visible(name))
    return replace(place, q=q, v=v, a=a, others=others, drive=drive)


def _in_row(diagram: Diagram, place: Place) -> bool:
    """Whether a sum is one of a row, which have one line."""
    inside = diagram_at(diagram, place.within)
    return inside.blocks[place.definition.rpartition(".")[2]].row != ""


def _is_reached(name: str, block: FlatBlock, inside: Collection[str]) -> bool:
    """Whether an effect can be added to a sum: at the top, or inside one of these subsystems."""
    return "." not in block.definition or name.rpartition(".")[0] in inside


def _local(flat: Flat, name: str, block: FlatBlock) -> dict[str, str]:
    """The local signals that the diagram gives a sum: of an element those of its number."""
    index = split_index(name)[1]
    return {s: element_name(n, index) if n in flat.shapes else n for s, n in block.local.items()}


def _element(flat: Flat, name: str) -> tuple[int, int] | None:
    """Of an element of a vector its number, and how many there are."""
    vector, index = split_index(name)
    return (index[0], flat.shapes[vector][0]) if index else None


def _at_top(name: str, block: FlatBlock) -> bool:
    """Whether a block stands in the diagram itself, and puts out a number."""
    return "." not in block.definition and not split_index(name)[1]


def _acceleration(v: str, states: Mapping[str, FlatState]) -> str:
    """The signal that a rate is the integral of; '' where it is another formula."""
    rate = states[v].rate if v in states else None
    return rate.name if isinstance(rate, Name) else ""


def _drives(model: Model) -> Iterator[str]:
    flat = model.flat
    formulas = [*flat.signals.values(), *(state.rate for state in flat.states)]
    formulas += [event.when for event in flat.events]
    formulas += [formula for event in flat.events for formula in event.set.values()]
    read = {name for formula in formulas for name in names_of(formula)}
    yield from (name for name in flat.inputs if name in read)
    moving = {state.name for state in flat.states} | set(flat.signals) | set(flat.inputs)
    moving |= {memory.name for memory in flat.memories}
    for name, formula in flat.signals.items():
        block = flat.blocks.get(name)
        if block is None or name not in read or not _at_top(name, block):
            continue
        effect = model.diagram.library[block.type].effect is not None
        needs = set(names_of(formula))
        if "t" in needs and formula != Name("t") and not needs & moving and not effect:
            yield name


def _delayed(model: Model) -> set[str]:
    """The signals that a delay reads."""
    return {delay.text for delay in model.lowered.delays}


def _is_drive(model: Model, place: Place, drives: tuple[str, ...]) -> bool:
    """Whether a sum holds a drive and effects at it only: its readers see the drive through it."""
    blocks, library = model.diagram.blocks, model.diagram.library
    wires = [wire.signal for wires in blocks[place.definition].inputs.values() for wire in wires]
    effects = {
        name: library[use.type].effect
        for name, use in blocks.items()
        if use.subsystem is None and name in wires
    }
    acting = [name for name, effect in effects.items() if effect and effect.place == "drive"]
    return bool(acting) and set(wires) - set(acting) <= set(drives)


def _sensors(model: Model) -> list[str]:
    found: dict[str, None] = {}
    for series in model.diagram.measured.values():
        for signal, channel in series.channels.items():
            if channel.column and signal not in model.flat.inputs:
                found.setdefault(signal)
    return list(found)


def _sums_behind(flat: Flat, names: tuple[str, ...]) -> Iterator[tuple[str, int]]:
    queue = deque((name, 1) for name in names)
    seen: set[str] = set()
    while queue:
        name, distance = queue.popleft()
        formula = flat.signals.get(name)
        if name in seen or formula is None:
            continue
        seen.add(name)
        block = flat.blocks.get(name)
        if block is not None and block.type == "sum" and len(split_index(name)[1]) < 2:
            yield name, distance
        queue.extend((read, distance + 1) for read in _passed(flat, name, formula))


def _passed(flat: Flat, name: str, formula: Expression) -> tuple[str, ...]:
    """The names that a signal passes on: what a sum, a gain or a division reads, and the only
    signal to which an expression is proportional, as `net/J`."""
    block = flat.blocks.get(name)
    if block is None or block.type in PASSED:
        return names_of(formula)
    factors = [factor for factor in _factors(formula) if factor.name in flat.signals]
    return (factors[0].name,) if len(factors) == 1 and block.type == "expression" else ()


def _factors(formula: Expression) -> Iterator[Name]:
    """The names among the factors of a formula, not those that it is divided by."""
    if isinstance(formula, Name):
        yield formula
    elif isinstance(formula, Call) and formula.function in ("*", "/", "neg"):
        for factor in formula.arguments[: 2 if formula.function == "*" else 1]:
            yield from _factors(factor)


def _only_feeds(flat: Flat, name: str, state: str, nearest: dict[str, tuple[int, str]]) -> bool:
    """Whether a sum has one reader only, which leads to another place of the same state."""
    seen: set[str] = set()  # an algebraic loop has no end
    while name not in seen:
        seen.add(name)
        readers = [n for n, formula in flat.signals.items() if name in names_of(formula)]
        rates = [s for s in flat.states if name in names_of(s.rate)]
        if len(readers) != 1 or rates:
            return False
        before, name = name, readers[0]
        if name in nearest and nearest[name][1] == state:
            return True
        if before not in _passed(flat, name, flat.signals[name]):
            return False
    return False
