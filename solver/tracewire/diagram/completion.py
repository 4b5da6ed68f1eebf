"""What may be written at a place of a diagram: keys, types, ports, parameters, signals, words."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from tracewire.diagram.context import Context, Level, context_of
from tracewire.diagram.diagram import Diagram
from tracewire.diagram.grammar import OF_A_BLOCK, OF_KINDS, SHAPES, named
from tracewire.diagram.limits import LIMITS
from tracewire.diagram.names import parameters, recordable, signals, states
from tracewire.diagram.shapes import (
    Either,
    Formula,
    Listed,
    Mapped,
    Named,
    Number,
    Record,
    Shape,
    Text,
)
from tracewire.formula import FUNCTIONS
from tracewire.library import Library, bounds_text, joined_doc, wiring


@dataclass(frozen=True)
class Proposal:
    """A text that may stand at the cursor, what it is, and what is inserted for it."""

    text: str
    doc: str = ""
    insert: str = ""


def complete(before: str, library: Library, diagram: Diagram | None = None) -> list[Proposal]:
    """What may stand at the end of a text, in place of the word there; see `word_before`.

    before: the text of a diagram up to the cursor. diagram: the last one that could be read, whose
    names are proposed.
    """
    context = context_of(before)
    if context is None:
        return []
    found: dict[str, Proposal] = {}
    for one in _Completer(library, diagram).at(context):
        found.setdefault(one.text, one)
    word = context.word.lower()
    begins = [p for text, p in found.items() if text.lower().startswith(word)]
    others = [p for text, p in found.items() if word and word in text.lower()[1:]]
    return list(dict.fromkeys([*begins, *others]))[: LIMITS.most_completions]


def word_before(before: str) -> str:
    """The word that a proposal replaces."""
    context = context_of(before)
    return "" if context is None else context.word


class _Completer:
    def __init__(self, library: Library, diagram: Diagram | None) -> None:
        self.library, self.diagram = library, diagram
        self.inside = diagram  # the one whose names are seen
        self.use = ""  # the name of the block whose line it is

    def at(self, context: Context) -> Iterator[Proposal]:
        shape: Shape = SHAPES["diagram"]
        levels = context.levels or (Level("mapping", 0),)
        for n, level in enumerate(levels):
            found = next((one for one in _choices(shape) if _is(one, level.kind)), None)
            last = n == len(levels) - 1
            if found is None:
                if last and n and not level.key and not level.given:  # a value on its own line
                    yield from self.values(shape, levels[n - 1])
                return
            if isinstance(found, Listed):
                shape = found.of
            elif last and not level.key:
                yield from self.keys(found, level)
                return
            else:
                inner = self.under(found, level)
                if inner is None:
                    return
                shape = inner
        yield from self.values(shape, levels[-1])

    def under(self, shape: Shape, level: Level) -> Shape | None:
        """The shape of what stands under the key of a level."""
        if isinstance(shape, Mapped):
            if shape.of == Named("subsystem") and self.inside is not None:
                self.inside = self.inside.subsystems.get(level.key)
            if shape.of == Named("block"):
                self.use = level.key
            return shape.of
        if isinstance(shape, Record):
            return shape.keys[level.key].shape if level.key in shape.keys else None
        return self.of_block(level).get(level.key, (None, ""))[0]

    def of_block(self, level: Level) -> dict[str, tuple[Shape, str]]:
        """The keys of the line of a block, by its type."""
        found: dict[str, tuple[Shape, str]] = {}
        kind = self.type_of(level)
        if kind in self.library:
            block = self.library[kind]
            for port in block.inputs:
                shape = SHAPES["wires" if port.many else "wire"]
                found[port.name] = shape, joined_doc(port.doc, port.unit, wiring(port))
            for one in block.parameters:
                doc = joined_doc(one.doc, one.unit, bounds_text(one))
                found[one.name] = SHAPES[OF_KINDS[one.kind]], doc
        elif self.inside is not None and kind in self.inside.subsystems:
            own = self.inside.subsystems[kind]
            found |= dict.fromkeys(own.inputs, (SHAPES["wire"], "an input"))
            found |= dict.fromkeys(own.parameters, (SHAPES["fitted value"], "a parameter"))
        for name, key in OF_A_BLOCK.items():
            if name != "place" or kind == "sum":
                found.setdefault(name, (key.shape, key.doc))
        return found

    def type_of(self, level: Level) -> str:
        """The type of a block, from its line, or from the diagram as it was read last."""
        given = level.given.get("type", "")
        if given or self.inside is None or self.use not in self.inside.blocks:
            return given
        return self.inside.blocks[self.use].type

    def keys(self, shape: Shape, level: Level) -> Iterator[Proposal]:
        if isinstance(shape, Record):
            docs = {name: key.doc for name, key in shape.keys.items()}
        elif isinstance(shape, Mapped):
            docs = dict(self.names(shape.names, deep=True))
        else:
            docs = {name: doc for name, (_, doc) in self.of_block(level).items()}
        for name, doc in docs.items():
            if name not in level.given:
                yield Proposal(name, doc, f"{name}: ")

    def values(self, shape: Shape, level: Level) -> Iterator[Proposal]:
        if level.key == "type" and shape == OF_A_BLOCK["type"].shape:
            own = self.inside.subsystems if self.inside is not None else {}
            yield from (Proposal(name, inside.title, name) for name, inside in own.items())
            yield from (Proposal(n, self.library[n].doc, n) for n in sorted(self.library))
            return
        if level.key == "variant" and shape == OF_A_BLOCK["variant"].shape:
            yield from self.variants(level)
            return
        for one in _choices(shape):
            if isinstance(one, Listed) and one.alone:
                yield from self.values(one.of, level)
            elif isinstance(one, Text | Number):
                yield from (Proposal(word, "", word) for word in one.words)
                if isinstance(one, Text):
                    known = self.names(one.names)
                    yield from (Proposal(name, doc, name) for name, doc in known)
            elif isinstance(one, Formula):
                names = dict(self.names("wire")) | {"t": "the time in s"} if one.signals else {}
                names |= dict.fromkeys(self.inside.parameters if self.inside else (), "a parameter")
                yield from (Proposal(name, doc, name) for name, doc in names.items())
                yield from _functions()

    def variants(self, level: Level) -> Iterator[Proposal]:
        """The bodies of the subsystem that a line uses, and the parameters that may choose one."""
        if self.inside is None or self.type_of(level) not in self.inside.subsystems:
            return
        for variant in self.inside.subsystems[self.type_of(level)].variants:
            yield Proposal(variant, "a variant", variant)
        for name in self.inside.parameters:
            yield Proposal(name, "a parameter with the number of a variant", name)

    def names(self, kind: str, deep: bool = False) -> Iterator[tuple[str, str]]:
        """The names of a kind in the diagram as it was read last, and what each is.

        deep: with the parameters of its blocks.
        """
        diagram = self.inside
        if diagram is None:
            return
        if kind in ("wire", "signal"):
            ports = [
                f"{use.name}.{port}"
                for use in diagram.blocks.values()
                for port in (use.subsystem.outputs if use.subsystem is not None else ())
            ]
            seen = recordable(diagram) if kind == "signal" else signals(diagram)
            yield from ((name, self.what(name)) for name in (*seen, *ports))
        elif kind == "state":
            yield from ((name, "a state") for name in states(diagram))
        elif kind == "parameter":
            known = parameters(diagram) if deep else diagram.parameters
            yield from ((name, "a parameter") for name in known)
        elif kind == "input":
            yield from ((name, "an input") for name in diagram.inputs)
        elif kind == "port":
            yield from ((name, self.what(name)) for name in signals(diagram))
        elif kind == "preset":
            yield from ((name, "a preset") for name in diagram.presets)

    def what(self, signal: str) -> str:
        assert self.inside is not None
        use = self.inside.blocks.get(signal.partition(".")[0])
        return "an input" if use is None else f"a signal of a {use.type}, {use.unit}".rstrip(", ")


def _choices(shape: Shape) -> list[Shape]:
    shape = named(shape)
    if isinstance(shape, Either):
        return [choice for one in shape.shapes for choice in _choices(one)]
    return [shape]


def _is(shape: Shape, kind: str) -> bool:
    if kind == "list":
        return isinstance(shape, Listed)
    return isinstance(shape, Mapped | Record) or shape == Named("block")


def _functions() -> Iterator[Proposal]:
    for name, function in FUNCTIONS.items():
        if not function.instead:
            yield Proposal(name, "a function", f"{name}(")
