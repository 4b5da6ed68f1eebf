"""Flat equations of vectors become equations of their elements, under names such as `q[1]`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from tracewire.compile.elements import Elements, Mismatch, Shape, shape_text
from tracewire.compile.flat import Flat, FlatMemory, FlatState, FlatTransition
from tracewire.compile.vectors import Expansion, element_names, find_shapes, has_vectors
from tracewire.diagram import split_index
from tracewire.errors import DiagramError, Location, Problem
from tracewire.formula import Expression, Number, names_of, to_text


def expand_vectors(flat: Flat, ports: Mapping[str, Location], recorded: Sequence[Location]) -> Flat:
    """The flat equations with every vector replaced by its elements.

    ports: the places of the outputs of subsystems; recorded: those of `flat.record`. Raises
    DiagramError: shapes that do not go together, an element that does not exist.
    """
    given = [*flat.signals.values(), *(f for s in flat.states for f in (s.start, s.rate))]
    given += [f for e in flat.events for f in (e.when, *e.set.values())]
    given += [f for m in flat.memories for f in _of_memory(m)]
    given += flat.guesses.values()
    indexed = any(split_index(name)[1] for name in flat.record)
    if not indexed and not any(map(has_vectors, given)):
        return flat
    return _Expander(flat, ports, recorded).expanded()


def _of_memory(memory: FlatMemory) -> Iterator[Expression]:
    yield memory.start
    for transition in memory.transitions:
        yield from (transition.when, *transition.set.values())


class _Expander:
    def __init__(
        self, flat: Flat, ports: Mapping[str, Location], recorded: Sequence[Location]
    ) -> None:
        self.flat, self.ports, self.recorded = flat, ports, recorded
        made: dict[str, Sequence[Expression]]
        made = {state.name: (state.start, state.rate) for state in flat.states}
        made |= {name: (formula,) for name, formula in flat.signals.items()}
        self.failed: set[str] = set()
        self.shapes = find_shapes(made, self.failed)
        self.expansion = Expansion(self.shapes)
        self.problems: list[Problem] = []

    def expanded(self) -> Flat:
        flat = self.flat
        signals: dict[str, Expression] = {}
        for name, formula in flat.signals.items():
            signals |= self.named(name, formula, self.place(name), "it", own=name)
        states = [state for old in flat.states for state in self.state(old)]
        events = [
            replace(e, when=self.number(e.when, e.place), set=self.values(e.set, e.place))
            for e in flat.events
        ]
        memories = [self.memory(memory) for memory in flat.memories]
        guesses: dict[str, Expression] = {}
        for name, formula in flat.guesses.items():
            guesses |= self.named(name, formula, self.place(name), "its guess")
        places = self.recorded or [Location()] * len(flat.record)
        record = [
            element
            for name, place in zip(flat.record, places, strict=False)
            for element in self.elements(name, place)
        ]
        if self.problems:
            raise DiagramError(self.problems)
        blocks, units, shown = dict(flat.blocks), dict(flat.units), dict(flat.shown)
        for name, shape in self.shapes.items():
            block = blocks.pop(name, None)
            for element in element_names(name, shape):
                if block is not None:
                    blocks[element] = replace(block, name=element)
                units[element] = units.get(name, "")
                if look := shown.get(name):
                    own = look.label and look.label + element.removeprefix(name)
                    shown[element] = replace(look, label=own)
        return replace(
            flat,
            signals=signals,
            states=tuple(states),
            events=tuple(events),
            memories=tuple(memories),
            guesses=guesses,
            record=tuple(dict.fromkeys(record)),
            blocks=blocks,
            units=units,
            shown=shown,
            shapes=self.shapes,
        )

    def place(self, name: str) -> Location:
        block = self.flat.blocks.get(name)
        return self.ports.get(name, Location()) if block is None else block.place

    def problem(self, what: str, place: Location, hint: str = "") -> None:
        problem = Problem(what, place, (), hint)
        if problem not in self.problems:
            self.problems.append(problem)

    def expand(self, formula: Expression, place: Location, own: str = "") -> Elements:
        """The elements of a formula; a zero with a problem noted where its shapes are wrong.

        What reads a name that is wrong itself is not told, but in the formula of that name, `own`.
        """
        try:
            return self.expansion.expand(formula)
        except Mismatch as mismatch:
            if self.failed.isdisjoint({*names_of(formula)} - {own}):
                self.problem(str(mismatch), place)
            return Elements((), (Number(0.0),))

    def named(
        self, name: str, formula: Expression, place: Location, what: str, own: str = ""
    ) -> dict[str, Expression]:
        """The formulas of the elements of a name; a number stands for each of them."""
        _, index = split_index(name)
        shape: Shape = () if index else self.shapes.get(name, ())
        names = self.elements(name, place) if index else element_names(name, shape)
        elements = self.expand(formula, place, own)
        if elements.shape not in ((), shape):
            shown = f"{shape_text(shape)}, and {what} is {shape_text(elements.shape)}"
            self.problem(f"'{name}' is {shown}", place, "Give both the same length.")
            return {}
        return {element: elements.at(i) for i, element in enumerate(names)}

    def state(self, state: FlatState) -> Iterator[FlatState]:
        starts = self.named(state.name, state.start, state.place, "its start", own=state.name)
        rates = self.named(state.name, state.rate, state.place, "its rate", own=state.name)
        for name in element_names(state.name, self.shapes.get(state.name, ())):
            start, rate = starts.get(name, Number(0.0)), rates.get(name, Number(0.0))
            yield replace(state, name=name, start=start, rate=rate)

    def number(self, formula: Expression, place: Location) -> Expression:
        elements = self.expand(formula, place)
        if elements.shape:
            what = f"'{to_text(formula)}' is {shape_text(elements.shape)}, and a number is needed"
            self.problem(what, place, "Name one of its elements.")
        return elements.items[0]

    def values(self, values: Mapping[str, Expression], place: Location) -> dict[str, Expression]:
        """New values of states, where a vector or an element of one may be set."""
        found: dict[str, Expression] = {}
        for name, formula in values.items():
            own = self.named(name, formula, place, "its new value")
            for twice in found.keys() & own.keys():
                self.problem(f"'{twice}' is set twice", place, "Leave one out.")
            found |= own
        return found

    def memory(self, memory: FlatMemory) -> FlatMemory:
        def changed(old: FlatTransition) -> FlatTransition:
            values = self.values(old.set, memory.place)
            return replace(old, when=self.number(old.when, memory.place), set=values)

        start = self.number(memory.start, memory.place)
        return replace(memory, start=start, transitions=tuple(map(changed, memory.transitions)))

    def elements(self, name: str, place: Location) -> list[str]:
        """The names of the elements behind a name, of which an index takes one."""
        vector, index = split_index(name)
        shape = self.shapes.get(vector, ())
        if not index:
            return element_names(name, shape)
        if name in element_names(vector, shape):
            return [name]
        shown = ", ".join(map(str, index))
        self.problem(f"'{vector}' is {shape_text(shape)}, and has no element [{shown}]", place)
        return []
