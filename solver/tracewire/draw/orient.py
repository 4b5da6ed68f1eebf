"""Which wires close a loop, and which blocks stand in a feedback, drawn from right to left."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from tracewire.draw.graph import Connection, Node

STATE = "integrator"
JOINS = {"sum", "expression", "solve", "divide", "product"}
"""Types at which the way to an integrator begins."""
SCALES = {"gain", "divide", "matrix_gain", "product"}
"""Types that may stand between two sums on that way: a mass between forces and an acceleration."""


def orient(
    nodes: Sequence[Node], wires: Sequence[Connection]
) -> tuple[tuple[Node, ...], tuple[Connection, ...]]:
    """The nodes and wires of one level with `flipped` and `back` set.

    The way forward leads from a sum over the blocks behind it to the integrators. A wire that comes
    from there to the sum, over blocks that nothing else drives, closes a loop; of the other loops
    the wire does on which a depth-first search comes back to where it was. A block is a feedback
    where all its wires lead back.
    """
    paths = _Paths(nodes, wires)
    way = paths.way_forward()
    back = paths.into_heads(way) | paths.closing(way)
    flipped = paths.feedback(way, back)
    return (
        tuple(turn_around(node) if node.id in flipped else node for node in nodes),
        tuple(
            replace(wire, back=wire.id in back, main=paths.leads_on(wire, way)) for wire in wires
        ),
    )


def turn_around(node: Node) -> Node:
    """A node drawn the other way round, with all that is inside of it where it is open."""
    inside = tuple(turn_around(inner) for inner in node.nodes)
    return replace(node, flipped=not node.flipped, nodes=inside)


@dataclass(frozen=True)
class _Way:
    """The blocks of the way forward, and those at which a part of it begins."""

    blocks: frozenset[str]
    heads: tuple[str, ...]


class _Paths:
    """The wires of one level by the blocks that they leave and reach."""

    def __init__(self, nodes: Sequence[Node], wires: Sequence[Connection]) -> None:
        self.nodes = {node.id: node for node in nodes}
        self.owner = {port.id: node.id for node in nodes for port in node.ports}
        self.after: dict[str, list[Connection]] = {id: [] for id in self.nodes}
        self.before: dict[str, list[Connection]] = {id: [] for id in self.nodes}
        self.bound: set[str] = set()  # blocks that are wired to the frame around them
        for wire in wires:
            ends = [self.owner[port] for port in (wire.source, wire.target) if port in self.owner]
            if len(ends) < 2:
                self.bound.update(ends)
                continue
            self.after[ends[0]].append(wire)
            self.before[ends[1]].append(wire)

    def drivers(self, id: str) -> list[str]:
        return [self.owner[wire.source] for wire in self.before[id]]

    def readers(self, id: str) -> list[str]:
        return [self.owner[wire.target] for wire in self.after[id]]

    def type(self, id: str) -> str:
        return self.nodes[id].type

    def leads_on(self, wire: Connection, way: _Way) -> bool:
        """Whether a wire is a part of the way forward."""
        return (
            self.owner.get(wire.source) in way.blocks and self.owner.get(wire.target) in way.blocks
        )

    def way_forward(self) -> _Way:
        """From each integrator backwards to a block of several inputs, and from a sum of
        accelerations on to the sum of forces behind it."""
        blocks: set[str] = set()
        heads: dict[str, None] = {}
        for id in self.nodes:
            if self.type(id) != STATE or id in blocks:
                continue
            chain = self._upstream(id, blocks)
            blocks.update(chain)
            head = chain[-1]
            if head in heads or self.type(head) not in JOINS:
                continue
            heads[head] = None
            for driver in dict.fromkeys(self.drivers(head)):
                further = self._scaled_sum(driver)
                blocks.update(further)
                if further:
                    heads[further[-1]] = None
        return _Way(frozenset(blocks), tuple(heads))

    def _upstream(self, id: str, known: set[str]) -> list[str]:
        chain = [id]
        while len(drivers := self.drivers(chain[-1])) == 1 and drivers[0] not in {*known, *chain}:
            chain.append(drivers[0])
        return chain

    def _scaled_sum(self, id: str) -> list[str]:
        """A sum and what scales it up to block `id`, that included; nothing where it is no such."""
        chain: list[str] = []
        while self.type(id) in SCALES and id not in chain and self.drivers(id):
            chain.append(id)
            id = self.drivers(id)[0]
        return [*chain, id] if chain and self.type(id) == "sum" else []

    def _reached(self, starts: Iterable[str], stop: frozenset[str] = frozenset()) -> set[str]:
        """The blocks behind others, and these; no further than `stop`."""
        found = set(starts)
        todo = list(found)
        while todo:
            for id in self.readers(todo.pop()):
                if id not in found and id not in stop:
                    found.add(id)
                    todo.append(id)
        return found

    def into_heads(self, way: _Way) -> set[str]:
        """The wires that come from a feedback to a head of the way forward."""
        sources = (id for id in self.nodes if not self.before[id] and id not in way.blocks)
        driven = self._reached({*sources, *self.bound}, way.blocks)
        back: set[str] = set()
        for head in way.heads:
            behind = self._reached([head])
            for wire in self.before[head]:
                driver = self.owner[wire.source]
                if driver in behind and driver not in driven and driver not in way.blocks:
                    back.add(wire.id)
        return back

    def closing(self, way: _Way) -> set[str]:
        """The wires that lead to a block from which a search came, of those not in a feedback.

        It begins at what reads nothing, then at the heads, then goes by the order of the file.
        """
        known = self.into_heads(way)
        back: set[str] = set()
        state: dict[str, int] = {}  # 1: on the way, 2: done
        sources = [id for id in self.nodes if not self.before[id]]
        for root in (*sources, *way.heads, *self.nodes):
            if root in state:
                continue
            state[root] = 1
            stack = [(root, iter(self.after[root]))]
            while stack:
                id, rest = stack[-1]
                wire = next((wire for wire in rest if wire.id not in known), None)
                if wire is None:
                    state[id] = 2
                    stack.pop()
                    continue
                to = self.owner[wire.target]
                if state.get(to) == 1:
                    back.add(wire.id)
                elif to not in state:
                    state[to] = 1
                    stack.append((to, iter(self.after[to])))
        return back

    def feedback(self, way: _Way, back: set[str]) -> set[str]:
        """The blocks all of whose outputs lead back, directly or over others of these."""
        flipped = {
            id for id in self.nodes if self.after[id] and self.before[id] and id not in way.blocks
        } - self.bound
        while True:
            kept = {
                id
                for id in flipped
                if all(w.id in back or self.owner[w.target] in flipped for w in self.after[id])
                and not any(w.id in back for w in self.before[id])
                and all(d in way.blocks or d in flipped for d in self.drivers(id))
            }
            if kept == flipped:
                return flipped
            flipped = kept
