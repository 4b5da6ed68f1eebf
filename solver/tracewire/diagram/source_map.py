"""Where the parts of a diagram stand in its text: the nodes behind the nouns, for edits."""

from __future__ import annotations

from dataclasses import dataclass, replace

from tracewire.diagram.choose import side_by_side
from tracewire.diagram.diagram import BlockUse, Diagram, Value
from tracewire.diagram.extend import with_variant
from tracewire.diagram.files import load_text
from tracewire.diagram.names import split_index
from tracewire.diagram.packages import Packages
from tracewire.diagram.problems import Problems
from tracewire.diagram.sources import Sources
from tracewire.diagram.strict import Entries, Items, Node, Scalar, compose
from tracewire.diagram.written import Written, count_uses, find_written
from tracewire.errors import DiagramError, Location, OptionError, TracewireError, unknown


@dataclass(frozen=True)
class ParameterLocation:
    """A parameter in the text: its node, its value, and the factor to SI of a number put there.

    `into`: the block that shall get a value of its own, because others share the node.
    """

    name: str
    node: Node
    value: Value
    factor: float
    into: Entries | None = None


class SourceMap:
    """The nodes of a diagram, found by the names of its parts.

    `root` has those of the files that it extends and includes, too; `own` those of its text only,
    and `base` those of the diagram that it extends. `definitions` has the subsystems by their path,
    each with the body that is used; `bodies` has all bodies, and `removed` what one takes away.
    """

    def __init__(self, diagram: Diagram) -> None:
        self.top = diagram
        own = compose(diagram.text, diagram.file, Problems())
        sources = Sources(Packages(diagram.library, Problems()))
        root = sources.tree(diagram.text, diagram.file)
        if not isinstance(own, Entries) or root is None:
            raise DiagramError.one("a diagram must be a mapping", own.place)
        self.root, self.own = root, own
        self.included = sources.all_included(own)
        extends = own.values.get("extends")
        self.base: Entries | None = None
        if isinstance(extends, Scalar):
            self.base = sources.tree(load_text(extends.path), extends.path)
        self.definitions: dict[str, tuple[Diagram, Entries]] = {"": (diagram, root)}
        self.bodies: dict[str, list[tuple[Diagram, Entries]]] = {"": [(diagram, root)]}
        self.removed: dict[tuple[Location, str], Node] = {}
        self.nodes: dict[tuple[Location, str], Entries] = {(diagram.place, ""): root}
        self.uses, self.used = count_uses(diagram)
        self._define("", diagram, root)

    def _define(self, path: str, diagram: Diagram, entries: Entries) -> None:
        subsystems = entries.values.get("subsystems")
        for name, _, node in subsystems if isinstance(subsystems, Entries) else ():
            if isinstance(node, Entries):
                inner = f"{path}.{name}" if path else name
                usual = diagram.subsystems[name]
                known = self.used.get(usual.place, usual)  # the variant that is used, if one is
                self.bodies[inner] = []
                for variant, one in (usual.bodies or {"": known}).items():
                    body = with_variant(node, variant, Problems()) if variant else node
                    self.nodes[usual.place, variant] = body
                    self.bodies[inner].append((one, body))
                    changes = node.inside("variants").values[variant] if variant else None
                    if isinstance(changes, Entries) and "remove" in changes.values:
                        self.removed[usual.place, variant] = changes.values["remove"]
                if usual.variants:
                    at = replace(node.place, block=usual.place.block)
                    self.nodes[at, ""] = side_by_side(name, node)
                self.definitions[inner] = known, self.nodes[usual.place, known.variant]
                self._define(inner, known, self.definitions[inner][1])

    def block(self, path: str) -> tuple[Diagram, Entries, str]:
        """The diagram that a block stands in, the node of its `blocks`, and the block's name.

        path: `torque`, or `bearing.total` in the definition `bearing`; the definition of a nested
        subsystem may be named without those around it where that is clear. Raises OptionError.
        """
        where, _, name = path.rpartition(".")
        found = [where] if where in self.definitions else []
        found = found or [other for other in self.definitions if other.endswith(f".{where}")]
        if len(found) > 1:
            what = f"'{path}' may mean several blocks"
            raise OptionError.one(what, exists=[f"{other}.{name}" for other in found])
        if not found:
            included = self.top.subsystems.get(where)
            if included is not None:
                raise elsewhere(included)
            raise OptionError([unknown("subsystem", where, (p for p in self.definitions if p))])
        inside, entries = self.definitions[found[0]]
        blocks = entries.values.get("blocks")
        if name not in inside.blocks or not isinstance(blocks, Entries):
            raise OptionError([unknown("block", name, inside.blocks)])
        if row := inside.blocks[name].row:
            what = f"block '{name}' is one of the row '{row}', which have one line"
            hint = "Edit that line, or write the blocks out: tracewire show --text."
            raise OptionError.one(what, inside.blocks[name].place, hint=hint)
        holder = _holder(self.root, blocks.keys[name]) if inside.variant else blocks
        assert holder is not None
        return inside, holder, name

    def parameter(self, path: str) -> ParameterLocation:
        """Where the value of a parameter of a run is written. Raises OptionError."""
        at = find_written(self.top, path, self.uses, self._bodies_with)
        entries = self._entries(at.body)
        if at.use is None:
            return self._spot(at, entries.inside("parameters").values[at.name])
        line = entries.inside("blocks", at.use.row or at.use.name)
        if at.is_shared:
            assert at.use.subsystem is not None
            node = self._entries(at.use.subsystem).inside("parameters").values[at.name]
            return self._spot(at, node, line)
        name, index = split_index(at.name) if at.use.subsystem is None else (at.name, ())
        node = line.values[name]
        if index and isinstance(node, Items):
            node = node.items[index[0]]
        return self._spot(replace(at, name=name), node)

    def _spot(self, at: Written, node: Node, into: Entries | None = None) -> ParameterLocation:
        """A value at a node. A number in the place of a formula is in the unit that stands there;
        else in that of the parameter of the subsystem that it is a value of."""
        factor = at.value.factor
        if isinstance(node, Entries) and "unit" in node.values:
            factor = at.factor
        elif at.use is not None and at.use.subsystem is not None:
            factor = at.use.subsystem.parameters[at.name].factor
        return ParameterLocation(at.name, node, at.value, factor, into)

    def _bodies_with(self, chosen: Diagram, use: BlockUse, name: str) -> int:
        """How many bodies have the very parameter that the body of a line has."""
        assert use.subsystem is not None
        parts = [
            self.nodes[use.subsystem.place, v].values.get("parameters") for v in chosen.variants
        ]
        nodes = [part.values.get(name) for part in parts if isinstance(part, Entries)]
        own = self._entries(use.subsystem).values.get("parameters")
        node = own.values.get(name) if isinstance(own, Entries) else None
        return sum(each is node for each in nodes) if node is not None else len(nodes)

    def is_own(self, node: Node) -> bool:
        """Whether a node stands in the diagram's own text."""
        return node.place.file == str(self.top.file)

    def path(self, node: Node) -> tuple[str, ...]:
        """The names that lead to a node from the top of the text on, or to the list around it."""
        found = _path(self.root, node)
        assert found is not None
        return found

    def _entries(self, diagram: Diagram) -> Entries:
        if (diagram.place, diagram.variant) not in self.nodes:
            raise elsewhere(diagram)
        return self.nodes[diagram.place, diagram.variant]


def _holder(inside: Node, key: Scalar) -> Entries | None:
    """The mapping of the text in which a key stands: a variant has blocks of two."""
    if not isinstance(inside, Entries):
        return None
    if inside.keys.get(key.text) is key:
        return inside
    found = (_holder(part, key) for part in inside.values.values())
    return next((holder for holder in found if holder is not None), None)


def _path(inside: Node, node: Node) -> tuple[str, ...] | None:
    if inside is node:
        return ()
    if isinstance(inside, Items):
        return () if any(_path(item, node) is not None for item in inside.items) else None
    for name, _, part in inside if isinstance(inside, Entries) else ():
        rest = _path(part, node)
        if rest is not None:
            return (name, *rest)
    return None


def elsewhere(diagram: Diagram) -> TracewireError:
    """The error of an edit of a subsystem that stands in a file which is included."""
    what = f"the subsystem '{diagram.name}' is defined in another file"
    own = f"own_{diagram.name}: {{extends: {diagram.name}}}"
    hint = f"Edit that file, or write one that extends it: {own}."
    return OptionError.one(what, diagram.place, hint=hint)
